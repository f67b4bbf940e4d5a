// Decides which addresses may be downloaded from.
#pragma once
#include <string>
#include <string_view>

namespace palpa {

// Whether the address is http at this computer: localhost, 127.x.x.x or [::1].
bool is_local_address(std::string_view address);

// Throws LoadError unless the address is https, or http at this computer where `may_be_local`.
void check_address(const std::string& address, bool may_be_local);

}  // namespace palpa
