// Reads and writes whole text files, with errors that name the file. Existing files are replaced
// only on request, and links are never followed for writing.
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

// The largest file that is read. A trace of every tick reaches it after 45 minutes.
inline constexpr std::uintmax_t most_file_bytes = std::uintmax_t{1} << 30;

// The content of the file. Throws LoadError if it is missing, not a regular file, too large or
// unreadable.
std::string read_text_file(const std::filesystem::path& path);

// What to do with an existing file. Refuse: throw LoadError and leave the file unchanged.
enum class Existing : std::uint8_t { Refuse, Replace };

// Writes the file atomically: a reader sees the old content or the new one. A device or a pipe is
// written directly. Throws LoadError if that fails.
void write_text_file(const std::filesystem::path& path, std::string_view text,
                     Existing existing = Existing::Refuse);

// Several files, written together or not at all; devices and pipes are written last.
struct TextFile {
    std::filesystem::path path;
    std::string text;
    Existing existing = Existing::Refuse;
};
void write_text_files(std::span<const TextFile> files);

// Makes the folder and those above it that are not there. Throws LoadError.
void make_folder(const std::filesystem::path& folder);

// Call before long work: throws LoadError if the result cannot be written to `path`. An existing
// file may be replaced only if `overwrites` is set and `mark`, which identifies the program's own
// files, stands near its beginning. Returns how to write. A device or a pipe is never replaced.
Existing check_output(const std::filesystem::path& path, std::string_view mark, bool overwrites);

// Whether `mark` is in the first 4 KiB of a regular file (not a link), or the file begins with
// `text`.
bool has_mark(const std::filesystem::path& path, std::string_view mark);
bool begins_with(const std::filesystem::path& path, std::string_view text);

// The entries of a folder, sorted by name, at most `most`; empty if it cannot be read.
std::vector<std::filesystem::path> list_folder(
    const std::filesystem::path& folder,
    std::size_t most = std::numeric_limits<std::size_t>::max());

// A new file that is written piece by piece; a device or a pipe is written directly. All functions
// throw LoadError.
class NewFile {
public:
    explicit NewFile(std::filesystem::path path);
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;

    void write(std::string_view text);
    void close();  // throws if the system could not write everything

private:
    std::filesystem::path path_;
    File file_;
};

// A file that is written piece by piece beside its place, and takes the place once it is whole. Its
// destructor removes what has not taken it. All functions throw LoadError.
class DraftFile {
public:
    explicit DraftFile(std::filesystem::path path);
    DraftFile(const DraftFile&) = delete;
    DraftFile& operator=(const DraftFile&) = delete;
    ~DraftFile();

    void write(std::string_view text);
    void close();  // throws if the system could not write everything
    // Call after close().
    void move(Existing existing = Existing::Refuse) const;

private:
    std::filesystem::path path_, draft_;
    File file_;
};

// A lock on a folder: while it exists, another run of the program throws LoadError when it wants to
// write into the same folder. The system releases the lock when the program ends.
class FolderLock {
public:
    explicit FolderLock(const std::filesystem::path& folder);
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    LockedFolder folder_;
};

}  // namespace palpa
