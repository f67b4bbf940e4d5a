#include "download/curl_library.h"

#ifdef PALPA_CURL
#include "platform/library.h"

#include <optional>
#include <string>
#include <vector>

namespace palpa {
namespace {

#ifdef PALPA_LOADS_CURL
// Sets a function; whether the library has it.
template <class Function>
bool find_function(const SharedLibrary& library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(library.find(name));
    return function != nullptr;
}

std::optional<Curl> find_curl() {
    std::vector<std::string> files = list_library_files("curl", {"4"});
    files.emplace_back("libcurl-gnutls.so.4");  // of Debian, which many systems have
    for (const std::string& file : files) {
        const SharedLibrary library(file);
        Curl curl{};
        if (library.is_open() && find_function(library, "curl_global_init", curl.global_init) &&
            find_function(library, "curl_version_info", curl.version_info) &&
            find_function(library, "curl_easy_init", curl.easy_init) &&
            find_function(library, "curl_easy_setopt", curl.easy_setopt) &&
            find_function(library, "curl_easy_getinfo", curl.easy_getinfo) &&
            find_function(library, "curl_easy_strerror", curl.easy_strerror) &&
            find_function(library, "curl_easy_cleanup", curl.easy_cleanup) &&
            find_function(library, "curl_multi_init", curl.multi_init) &&
            find_function(library, "curl_multi_add_handle", curl.multi_add_handle) &&
            find_function(library, "curl_multi_remove_handle", curl.multi_remove_handle) &&
            find_function(library, "curl_multi_perform", curl.multi_perform) &&
            find_function(library, "curl_multi_poll", curl.multi_poll) &&
            find_function(library, "curl_multi_info_read", curl.multi_info_read) &&
            find_function(library, "curl_multi_cleanup", curl.multi_cleanup))
            return curl;
    }
    return {};
}
#else
std::optional<Curl> find_curl() {
    return Curl{curl_global_init,         curl_version_info,  curl_easy_init,
                curl_easy_setopt,         curl_easy_getinfo,  curl_easy_strerror,
                curl_easy_cleanup,        curl_multi_init,    curl_multi_add_handle,
                curl_multi_remove_handle, curl_multi_perform, curl_multi_poll,
                curl_multi_info_read,     curl_multi_cleanup};
}
#endif

}  // namespace

const Curl* curl_of_system() {
    static const std::optional<Curl> curl = [] {
        std::optional<Curl> found = find_curl();
        if (found && found->global_init(CURL_GLOBAL_DEFAULT) != CURLE_OK) found.reset();
        return found;
    }();
    return curl ? &*curl : nullptr;
}

}  // namespace palpa
#endif
