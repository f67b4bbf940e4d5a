// Structures of the Protein Data Bank by their codes, from a server or the cache.
#pragma once
#include "core/stage.h"
#include "download/transfer.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace palpa {

// The wwPDB's download service: CODE.cif.gz below it.
inline constexpr std::string_view usual_download_base = "https://files.wwpdb.org/download/";

struct EntrySource {
    std::string base{usual_download_base};
    TransferLimits limits{};
    std::filesystem::path cache{};  // folder, made when it is needed
};

struct FetchedEntry {
    std::filesystem::path file{};
    std::string address{};
    std::uintmax_t bytes = 0;
    bool is_from_cache = false;  // nothing was downloaded
};

// The mmCIF file of a plain code (download/pdb_code.h): from the cache, or downloaded into it. A
// file comes there whole or not at all, and only if it is mmCIF of this entry. `again` downloads
// it in any case. Throws LoadError, Interrupted.
FetchedEntry fetch_entry(const std::string& code, const EntrySource& source, bool again = false,
                         const StageFunction& on_stage = {});

// One sentence: where it came from, its size, where it lies.
std::string describe(const FetchedEntry& entry);

// Throws LoadError unless the data, packed by gzip or plain, are mmCIF that begins with the data
// block of this entry. `address`: of the message.
void check_entry(std::string_view data, const std::string& code, const std::string& address);

}  // namespace palpa
