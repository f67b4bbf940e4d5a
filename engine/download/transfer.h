// Downloads one file over HTTPS by libcurl.
#pragma once
#include "core/stage.h"

#include <cstddef>
#include <string>

namespace palpa {

struct TransferLimits {
    std::size_t most_bytes = 200'000'000;
    double stall_s = 30;  // ends when less than 100 bytes a second arrive for so long
    int most_redirects = 5;
};

// Returns the content behind the address, which stays in memory. Redirects lead to https alone; to
// this computer where the address is there. The certificate of the server must be valid. Throws
// LoadError with the address and why it cannot be had; Interrupted after a signal. `on_stage` is
// called every 50 ms and may throw to cancel.
std::string download(const std::string& address, const TransferLimits& limits = {},
                     const StageFunction& on_stage = {});

// The version of libcurl that is used, or "none: " and why.
std::string describe_curl();

}  // namespace palpa
