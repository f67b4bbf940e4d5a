// Whole text files, in and out, with errors that name the file. Nothing that is there is replaced
// unless the caller says so, and links are never written through.
#pragma once
#include "platform/file.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// The largest file that is read; a trace of every tick gets there after three quarters of an hour.
inline constexpr std::uintmax_t most_file_bytes = std::uintmax_t{1} << 30;

// The file's content. Throws LoadError if it is missing, no regular file, too large, or cannot be
// read.
std::string read_text_file(const std::filesystem::path& path);

// What happens where a file is there already. Refuse: LoadError, and the file stays as it is.
enum class Existing : std::uint8_t { Refuse, Replace };

// Writes the file in one move, so that a reader sees nothing or the old content, or the new, never
// half. A device or a pipe is written into. Throws LoadError if that cannot be done.
void write_text_file(const std::filesystem::path& path, std::string_view text,
                     Existing existing = Existing::Refuse);

// Several files, none of them where one cannot be written.
struct TextFile {
    std::filesystem::path path;
    std::string text;
    Existing existing = Existing::Refuse;
};
void write_text_files(std::span<const TextFile> files);

// Before long work: throws LoadError where its result could not be written to `path`. A file that
// is there may be replaced only if `overwrites`, and only if `mark` stands near its beginning: by
// that the program knows what it wrote itself. Returns what to write with.
Existing check_output(const std::filesystem::path& path, std::string_view mark, bool overwrites);

// Whether `mark` stands in the first 4 KiB of a regular file that is no link, or the file begins
// with `text`.
bool has_mark(const std::filesystem::path& path, std::string_view mark);
bool begins_with(const std::filesystem::path& path, std::string_view text);

// What a folder holds, sorted by name, at most `most`; nothing where it cannot be read.
std::vector<std::filesystem::path> list_folder(
    const std::filesystem::path& folder,
    std::size_t most = std::numeric_limits<std::size_t>::max());

// A file that was not there before, written piece by piece. All throw LoadError.
class NewFile {
public:
    explicit NewFile(std::filesystem::path path);
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;

    void write(std::string_view text);
    void close();  // says what the system could not write

private:
    std::filesystem::path path_;
    File file_;
};

// As long as this lives, no other run of the program gets the same folder to write into: it throws
// LoadError there. The system takes the lock away from a program that ends, however it ends.
class FolderLock {
public:
    explicit FolderLock(const std::filesystem::path& folder);
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    LockedFolder folder_;
};

}  // namespace palpa
