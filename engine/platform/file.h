// Files without streams: what must not be there, must be no link, or must be no pipe that is waited
// for, is said when a file is opened. Errors are errno's, in std::generic_category.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

namespace palpa {

enum class FileUse : std::uint8_t {
    Read,      // opens without waiting
    ReadHere,  // refuses links
    Write,     // overwrites an existing file from its beginning
    Create,    // creates a new file; fails if a file or link exists
};

// An open file, closed with its owner.
class File {
public:
    File() = default;
    // Not open if `error` is set.
    File(const std::filesystem::path& path, FileUse use, std::error_code& error) noexcept;
    File(File&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    File& operator=(File&& other) noexcept {
        std::swap(descriptor_, other.descriptor_);
        return *this;
    }
    ~File();

    bool is_open() const noexcept { return descriptor_ >= 0; }

    // Size in bytes; unset if it is not a regular file.
    std::optional<std::uintmax_t> find_size(std::error_code& error) const noexcept;
    // Reads up to the size of the span; returns the number of bytes, 0 at the end.
    std::size_t read(std::span<char> into, std::error_code& error) const noexcept;
    void write(std::string_view text, std::error_code& error) const noexcept;
    // Closes the file; `error` says if the system could not write everything.
    void close(std::error_code& error) noexcept;

private:
    int descriptor_ = -1;
};

// Whether this user may read and write a file, or make files in a folder.
bool may_read_and_write(const std::filesystem::path& path) noexcept;
bool may_write(const std::filesystem::path& path) noexcept;

// A folder that one program at a time has; the system frees it when a program ends, however it
// ends.
class LockedFolder {
public:
    explicit LockedFolder(const std::filesystem::path& folder) noexcept;
    LockedFolder(const LockedFolder&) = delete;
    LockedFolder& operator=(const LockedFolder&) = delete;
    ~LockedFolder();

    // Whether another program has the lock; false if the file system has no locks.
    bool is_taken() const noexcept { return is_taken_; }

private:
    std::intptr_t handle_ = -1;
    bool is_taken_ = false;
};

// A new folder, which only this user may enter, among the temporary ones; empty where `error` is
// set.
std::filesystem::path make_temporary_folder(std::error_code& error);

}  // namespace palpa
