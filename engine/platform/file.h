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
    Read,      // waits for nobody
    ReadHere,  // and is no link
    Write,     // from its beginning, into what is there
    Create,    // for writing; neither a file nor a link is there
};

// An open file, closed with its owner.
class File {
public:
    File() = default;
    // Not open where `error` is set.
    File(const std::filesystem::path& path, FileUse use, std::error_code& error) noexcept;
    File(File&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    File& operator=(File&& other) noexcept {
        std::swap(descriptor_, other.descriptor_);
        return *this;
    }
    ~File();

    bool is_open() const noexcept { return descriptor_ >= 0; }

    // In bytes; nothing where it is no regular file.
    std::optional<std::uintmax_t> find_size(std::error_code& error) const noexcept;
    // How many bytes came, at most the span's; 0 at the end.
    std::size_t read(std::span<char> into, std::error_code& error) const noexcept;
    void write(std::string_view text, std::error_code& error) const noexcept;
    // Afterwards it is not open; `error` says what the system could not write.
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

    // Another has it. Where a file system knows no locks, nobody has.
    bool is_taken() const noexcept { return is_taken_; }

private:
    std::intptr_t handle_ = -1;
    bool is_taken_ = false;
};

// A new folder, which only this user may enter, among the temporary ones; empty where `error` is
// set.
std::filesystem::path make_temporary_folder(std::error_code& error);

}  // namespace palpa
