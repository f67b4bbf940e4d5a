// Reads text files, plain or compressed by gzip, and compresses them.
#pragma once
#include "core/files.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Largest unpacked size; the largest entries of the Protein Data Bank have a third of it.
inline constexpr std::size_t most_unpacked_bytes = std::size_t{1} << 28;

// As read_text_file (core/files.h); what begins as gzip does is unpacked, whatever its name.
// Throws LoadError for data that are damaged or cut off, and for more than `most` bytes.
std::string read_packed_text_file(const std::filesystem::path& path,
                                  std::size_t most = most_unpacked_bytes);

// The file itself, or else the one of the same name with ".gz" behind it if that is there.
std::filesystem::path find_plain_or_packed(const std::filesystem::path& path);

// The text of a file of a recording, which is there as it is or with ".gz"; at most
// most_file_bytes, as of a plain file.
std::string read_recorded_file(const std::filesystem::path& path);

bool is_gzip(std::string_view data) noexcept;
std::string unpack_gzip(std::string_view data, const std::string& file,
                        std::size_t most = most_unpacked_bytes);

// Compresses a file, a piece at a time: NAME becomes NAME.gz. Until its last piece the plain file
// is whole, from then on the compressed one, even if the program is killed. All functions throw
// LoadError, and leave the plain file then.
class FilePacker {
public:
    explicit FilePacker(const std::filesystem::path& file);
    FilePacker(const FilePacker&) = delete;
    FilePacker& operator=(const FilePacker&) = delete;
    ~FilePacker();

    // Compresses the next piece; false after the last one.
    [[nodiscard]] bool pack_piece();

    std::uint64_t read_bytes() const noexcept { return read_; }

private:
    class Deflater;

    void write_packed(std::string_view piece, bool is_last);

    std::filesystem::path file_;
    File source_;
    DraftFile draft_;
    std::unique_ptr<Deflater> deflater_;
    std::vector<char> piece_, packed_;
    std::uint64_t read_ = 0;
};

}  // namespace palpa
