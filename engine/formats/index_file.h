// Reads index files of GROMACS (.ndx): named groups of atoms.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct IndexGroup {
    std::string name;
    std::vector<std::uint32_t> atoms;  // from 0, in the order of the file
    std::size_t line = 0;              // line of its name
};

// Groups as "[ name ]", behind each its atoms, counted from 1; comments begin with ';'. Throws
// LoadError with the line of what is wrong: atoms before a group, a number that is no atom, no
// group at all.
std::vector<IndexGroup> read_index_file(const std::filesystem::path& path);
std::vector<IndexGroup> parse_index_file(std::string_view text, const std::string& file);

}  // namespace palpa
