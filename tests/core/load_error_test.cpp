#include "core/load_error.h"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <vector>

using namespace palpa;

TEST_CASE("a place is written as file, line and column, as far as they are known",
          "[core][load_error]") {
    CHECK(to_string(TextPlace{"scene.toml", 12, 7}) == "scene.toml:12:7");
    CHECK(to_string(TextPlace{"scene.toml", 12, 0}) == "scene.toml:12");
    CHECK(to_string(TextPlace{"scene.toml", 0, 0}) == "scene.toml");
    // A column of no line says nothing.
    CHECK(to_string(TextPlace{"scene.toml", 0, 7}) == "scene.toml");
}

TEST_CASE("a load error says its place before its message", "[core][load_error]") {
    const LoadError error({"water.str", 3, 0}, "no {} here");

    const std::runtime_error& as_any_handler_sees_it = error;

    CHECK(std::string(as_any_handler_sees_it.what()) == "water.str:3: no {} here");
    CHECK(std::string(LoadError({"a\n.pdb", 1, 0}, "'\x01' is not a name").what()) ==
          "a\\x0a.pdb:1: '\\x01' is not a name");
}

TEST_CASE("a load error keeps the problems that its message only counts", "[core][load_error]") {
    const LoadError error({"a.pdb", 3, 0}, "this; and 2 more", {"that", "the other"});
    std::vector<LoadError> copies(2, error);
    copies.pop_back();
    const LoadError& copy = copies.front();

    CHECK(std::string(copy.what()) == "a.pdb:3: this; and 2 more");
    CHECK(copy.further() == std::vector<std::string>{"that", "the other"});
    CHECK(LoadError({"a.pdb"}, "this").further().empty());
}
