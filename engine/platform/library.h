// Loads shared libraries at run time.
#pragma once
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// File names of a library on this system: "HD" gives HD.dll, or libHD.so, also with each of the
// versions.
std::vector<std::string> list_library_files(std::string_view name,
                                            std::initializer_list<std::string_view> versions);

// Advice to put a library's file where the system searches it.
std::string how_to_place_library(std::string_view file);

// A library that is never unloaded, so its functions stay valid until the program ends.
class SharedLibrary {
public:
    // Loads by a path, or by a name that the system searches.
    explicit SharedLibrary(const std::string& file);

    bool is_open() const noexcept { return handle_ != nullptr; }
    // Error message, which begins with the file.
    const std::string& problem() const noexcept { return problem_; }

    void* find(const char* function) const noexcept;  // nullptr if the library does not have it
    // Path of the loaded file, found by one of its functions.
    std::string path_of(void* function) const;

private:
    void* handle_;
    std::string problem_;
};

}  // namespace palpa
