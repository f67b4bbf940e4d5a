// Recognises codes of PDB entries, and links to their pages and files.
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace palpa {

// Returns whether the text is a code: a digit from 1 to 9 and three letters or digits ("1hsg"), or
// the extended form, "pdb_" and eight letters or digits ("pdb_00001hsg").
bool is_pdb_code(std::string_view text) noexcept;

// The code in lower case. An extended one that stands for a short one becomes the short one.
std::string plain_pdb_code(std::string_view code);

// The plain code that a text names: a code, or a link to an entry at a site of the wwPDB.
std::optional<std::string> find_pdb_code(std::string_view text);

}  // namespace palpa
