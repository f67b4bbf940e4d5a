#include "download/address.h"

#include "core/load_error.h"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace palpa {
namespace {

// Skips "127.0.0.1", "localhost" or "[::1]"; the rest of the address, if it begins so.
std::optional<std::string_view> skip_own_host(std::string_view text) {
    for (const std::string_view name : {"localhost", "[::1]"})
        if (text.starts_with(name)) return text.substr(name.size());
    if (!text.starts_with("127.")) return {};
    for (int number = 0; number < 4; ++number) {
        if (number > 0) {
            if (!text.starts_with('.')) return {};
            text.remove_prefix(1);
        }
        const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
        if (digits == 0 || digits > 3) return {};
        text.remove_prefix(digits);
    }
    return text;
}

}  // namespace

bool is_local_address(std::string_view address) {
    constexpr std::string_view scheme = "http://";
    if (!address.starts_with(scheme)) return false;
    std::optional<std::string_view> rest = skip_own_host(address.substr(scheme.size()));
    if (!rest) return false;
    if (rest->starts_with(':')) {
        rest->remove_prefix(1);
        rest->remove_prefix(std::min(rest->find_first_not_of("0123456789"), rest->size()));
    }
    return rest->empty() || rest->starts_with('/');
}

void check_address(const std::string& address, bool may_be_local) {
    constexpr std::string_view scheme = "https://";
    if (address.starts_with(scheme) && address.size() > scheme.size()) return;
    if (may_be_local && is_local_address(address)) return;
    throw LoadError({address}, "cannot be downloaded from; expected an address with https://");
}

}  // namespace palpa
