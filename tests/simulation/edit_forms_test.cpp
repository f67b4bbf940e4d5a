// Every edit of simulation/edit.h has a form in a scene's [[edits]].
#include "core/files.h"
#include "scene/edits.h"
#include "tests/support/paths.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <regex>
#include <string>
#include <vector>

using namespace palpa;

namespace {

struct Function {
    std::string name, arguments;
};

// Free functions that change a world: they begin their line, and take it by reference.
std::vector<Function> list_edits(const std::string& header) {
    static const std::regex declaration(
        R"((?:^|\n)[A-Za-z_][\w:<>,&*\[\] ]*[ &*](\w+)\(\s*World\s*&([^)]*)\))");
    std::vector<Function> functions;
    for (std::sregex_iterator i(header.begin(), header.end(), declaration), end; i != end; ++i)
        functions.push_back({(*i)[1], (*i)[2]});
    return functions;
}

std::string in_snake_case(const std::string& camel_case) {
    std::string key;
    for (const char letter : camel_case) {
        if (std::isupper(letter) && !key.empty()) key += '_';
        key += static_cast<char>(std::tolower(letter));
    }
    return key;
}

// `take(World&, Entity, const TakeEdit&)` is "take", and so is `take(World&)`.
std::string key_of(const Function& function) {
    static const std::regex edit(R"((\w+)Edit\b)");
    std::smatch found;
    return std::regex_search(function.arguments, found, edit) ? in_snake_case(found[1])
                                                              : function.name;
}

bool has_form(const std::string& key) {
    return std::ranges::find(edit_names, key) != edit_names.end();
}

std::vector<std::string> list_keys(const std::string& header) {
    std::vector<std::string> keys;
    for (const Function& function : list_edits(header)) keys.push_back(key_of(function));
    return keys;
}

std::vector<std::string> without_form(const std::string& header) {
    std::vector<std::string> names, seen;
    for (const Function& function : list_edits(header)) {
        const std::string key = key_of(function);
        if (!has_form(key) || std::ranges::find(seen, key) != seen.end())
            names.push_back(function.name);
        seen.push_back(key);
    }
    return names;
}

}  // namespace

TEST_CASE("every edit of a world has a form in a scene's [[edits]]", "[simulation][edit]") {
    const std::string header = read_text_file(test::in_project("engine/simulation/edit.h"));

    CHECK(without_form(header) == std::vector<std::string>{});

    // And every form of a scene is an edit, or goes back and forth between them.
    std::vector<std::string> expected(edit_names.begin(), edit_names.end());
    std::erase_if(expected, [](const std::string& key) { return key == "undo" || key == "redo"; });
    CHECK_THAT(list_keys(header), Catch::UnorderedEquals(expected));
}

TEST_CASE("an edit that a scene cannot make is found", "[simulation][edit]") {
    const std::string header = read_text_file(test::in_project("engine/simulation/edit.h"));
    for (const char* const more :
         {"void set_foo(World& world, const FooEdit& edit);", "void set_foo(World& world);",
          "Entity set_foo(World& world,\n               double stiffness);",
          "bool set_foo(World&);", "void set_foo(World& world, const TakeEdit& edit);"}) {
        INFO(more);
        CHECK(without_form(header + more + "\n") == std::vector<std::string>{"set_foo"});
    }
}
