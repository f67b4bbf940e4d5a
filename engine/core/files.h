// Whole text files, in and out, with errors that name the file.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace palpa {

// The file's content. Throws LoadError if it is missing, a folder, or cannot be read.
std::string read_text_file(const std::filesystem::path& path);

// Replaces the file in one move, so that a reader sees the old content or the new, never half.
// Throws LoadError if that cannot be done.
void write_text_file(const std::filesystem::path& path, std::string_view text);

// Several files, all of them or, where one cannot be written, none.
struct TextFile {
    std::filesystem::path path;
    std::string text;
};
void write_text_files(std::span<const TextFile> files);

}  // namespace palpa
