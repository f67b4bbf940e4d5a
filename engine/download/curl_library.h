// The library libcurl, if there is one.
#pragma once
#ifdef PALPA_CURL
#define CURL_DISABLE_DEPRECATION  // older libraries lack the options that replace deprecated ones
#include <curl/curl.h>

namespace palpa {

// The functions of the library.
struct Curl {
    decltype(&curl_global_init) global_init;
    decltype(&curl_version_info) version_info;
    decltype(&curl_easy_init) easy_init;
    decltype(&curl_easy_setopt) easy_setopt;
    decltype(&curl_easy_getinfo) easy_getinfo;
    decltype(&curl_easy_strerror) easy_strerror;
    decltype(&curl_easy_cleanup) easy_cleanup;
    decltype(&curl_multi_init) multi_init;
    decltype(&curl_multi_add_handle) multi_add_handle;
    decltype(&curl_multi_remove_handle) multi_remove_handle;
    decltype(&curl_multi_perform) multi_perform;
    decltype(&curl_multi_poll) multi_poll;
    decltype(&curl_multi_info_read) multi_info_read;
    decltype(&curl_multi_cleanup) multi_cleanup;
};

// Loads the library at the first call, from any thread; nullptr if it is not installed.
const Curl* curl_of_system();

}  // namespace palpa
#endif
