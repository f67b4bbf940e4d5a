#include "platform/library.h"

#include "platform/windows/text.h"

#include <windows.h>
#include <array>

namespace palpa {

std::vector<std::string> list_library_files(std::string_view name,
                                            std::initializer_list<std::string_view> /*versions*/) {
    return {std::string(name) + ".dll"};
}

std::string how_to_place_library(std::string_view file) {
    return "put " + std::string(file) + " beside palpa.exe";
}

SharedLibrary::SharedLibrary(const std::string& file)
    : handle_(LoadLibraryW(to_wide(file).c_str())) {
    if (!handle_) problem_ = file + ": Windows' error " + std::to_string(GetLastError());
}

void* SharedLibrary::find(const char* function) const noexcept {
    return reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(handle_), function));
}

std::string SharedLibrary::path_of(void* /*function*/) const {
    std::array<wchar_t, MAX_PATH> path{};
    const DWORD letters = GetModuleFileNameW(static_cast<HMODULE>(handle_), path.data(),
                                             static_cast<DWORD>(path.size()));
    return to_utf8({path.data(), letters});
}

}  // namespace palpa
