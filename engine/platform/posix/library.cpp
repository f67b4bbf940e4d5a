#include "platform/library.h"

#include <dlfcn.h>

namespace palpa {

std::vector<std::string> list_library_files(std::string_view name,
                                            std::initializer_list<std::string_view> versions) {
    const std::string file = "lib" + std::string(name) + ".so";
    std::vector<std::string> files{file};
    for (const std::string_view version : versions)
        files.push_back(file + "." + std::string(version));
    return files;
}

std::string how_to_place_library(std::string_view file) {
    std::string advice =
        "put " + std::string(file) + " where the system finds it, for example into /usr/local/lib";
#ifndef __APPLE__
    advice += ", then 'sudo ldconfig'";
#endif
    return advice;
}

SharedLibrary::SharedLibrary(const std::string& file)
    : handle_(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle_) return;
    problem_ = dlerror();
    // A library that this one needs is named alone.
    if (!problem_.starts_with(file)) problem_ = file + ": " + problem_;
}

void* SharedLibrary::find(const char* function) const noexcept { return dlsym(handle_, function); }

std::string SharedLibrary::path_of(void* function) const {
    Dl_info info{};
    return dladdr(function, &info) != 0 && info.dli_fname ? info.dli_fname : "";
}

}  // namespace palpa
