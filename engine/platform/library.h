// Shared libraries that are looked for while the program runs.
#pragma once
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// What files of a library are called here: "HD" gives HD.dll, or libHD.so and with each of the
// versions behind it.
std::vector<std::string> list_library_files(std::string_view name,
                                            std::initializer_list<std::string_view> versions);

// Never unloaded: its functions may be called until the program ends.
class SharedLibrary {
public:
    // By a path, or by a name that the system looks for.
    explicit SharedLibrary(const std::string& file);

    bool is_open() const noexcept { return handle_ != nullptr; }
    const std::string& problem() const noexcept { return problem_; }  // begins with the file

    void* find(const char* function) const noexcept;  // nullptr: it has none
    // The file that was loaded, by one of its functions.
    std::string path_of(void* function) const;

private:
    void* handle_;
    std::string problem_;
};

}  // namespace palpa
