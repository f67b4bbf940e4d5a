// Reads text files, plain or compressed by gzip.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace palpa {

// Largest unpacked size; the largest entries of the Protein Data Bank have a third of it.
inline constexpr std::size_t most_unpacked_bytes = std::size_t{1} << 28;

// As read_text_file (core/files.h); what begins as gzip does is unpacked, whatever its name.
// Throws LoadError for data that are damaged or cut off, and for more than most_unpacked_bytes.
std::string read_packed_text_file(const std::filesystem::path& path);

bool is_gzip(std::string_view data) noexcept;
std::string unpack_gzip(std::string_view data, const std::string& file,
                        std::size_t most = most_unpacked_bytes);

}  // namespace palpa
