// The actions of a person in the window: the list for `palpa help actions`, and the file of
// `--actions`.
#pragma once
#include "app/actions.h"

#include <cstdio>
#include <filesystem>
#include <memory>

namespace palpa {

// Prints all actions with their menus, keys and meanings.
void print_actions();

// A CSV file with a row for each action as it is done: s since the start, action, way. A crash
// loses none. Throws LoadError.
class ActionFile {
public:
    ActionFile(const std::filesystem::path& file, bool overwrites);
    void add(double time_s, const Action& action, By by);

private:
    struct Close {
        void operator()(std::FILE* file) const noexcept { (void)std::fclose(file); }
    };
    std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace palpa
