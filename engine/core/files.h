// Whole text files, in and out, with errors that name the file.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace palpa {

// The file's content. Throws LoadError if it is missing, a folder, or cannot be read.
std::string read_text_file(const std::filesystem::path& path);

// Replaces the file in one move, so that a reader sees the old content or the new, never half.
// Throws LoadError if that cannot be done.
void write_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace palpa
