#include "platform/file.h"

#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <sys/stat.h>
#include <windows.h>
#include <algorithm>
#include <cerrno>
#include <climits>
#include <random>
#include <string>

namespace palpa {
namespace {

constexpr DWORD all_sharing = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

std::error_code last_error() noexcept { return {errno, std::generic_category()}; }

bool is_link(const std::filesystem::path& path) noexcept {
    const DWORD attributes = GetFileAttributesW(path.c_str());
    return attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_REPARSE_POINT);
}

int open(const std::filesystem::path& path, FileUse use) noexcept {
    constexpr int always = _O_BINARY | _O_NOINHERIT;
    int descriptor = -1;
    const auto open_as = [&](int flags) {
        errno =
            _wsopen_s(&descriptor, path.c_str(), flags | always, _SH_DENYNO, _S_IREAD | _S_IWRITE);
    };
    switch (use) {
        case FileUse::Read:
            open_as(_O_RDONLY);
            break;
        case FileUse::ReadHere:
            errno = ELOOP;
            if (!is_link(path)) open_as(_O_RDONLY);
            break;
        case FileUse::Write:
            open_as(_O_WRONLY);
            break;
        case FileUse::Create:
            errno = EEXIST;  // a link to nowhere would be written through
            if (!is_link(path)) open_as(_O_WRONLY | _O_CREAT | _O_EXCL);
            break;
    }
    return descriptor;
}

bool may_open(const std::filesystem::path& path, DWORD access) noexcept {
    const HANDLE handle = CreateFileW(path.c_str(), access, all_sharing, nullptr, OPEN_EXISTING,
                                      FILE_FLAG_BACKUP_SEMANTICS, nullptr);  // also of folders
    if (handle == INVALID_HANDLE_VALUE) return false;
    CloseHandle(handle);
    return true;
}

}  // namespace

File::File(const std::filesystem::path& path, FileUse use, std::error_code& error) noexcept
    : descriptor_(open(path, use)) {
    error = descriptor_ < 0 ? last_error() : std::error_code();
}

File::~File() {
    if (descriptor_ >= 0) _close(descriptor_);
}

std::optional<std::uintmax_t> File::find_size(std::error_code& error) const noexcept {
    struct _stat64 status{};
    error.clear();
    if (_fstat64(descriptor_, &status) != 0) {
        error = last_error();
        return std::nullopt;
    }
    if ((status.st_mode & _S_IFMT) != _S_IFREG) return std::nullopt;
    return static_cast<std::uintmax_t>(std::max<decltype(status.st_size)>(status.st_size, 0));
}

std::size_t File::read(std::span<char> into, std::error_code& error) const noexcept {
    const auto most = static_cast<unsigned>(std::min(into.size(), std::size_t{INT_MAX}));
    const int got = _read(descriptor_, into.data(), most);
    error = got < 0 ? last_error() : std::error_code();
    return got < 0 ? 0 : static_cast<std::size_t>(got);
}

void File::write(std::string_view text, std::error_code& error) const noexcept {
    error.clear();
    while (!text.empty()) {
        const auto most = static_cast<unsigned>(std::min(text.size(), std::size_t{1} << 24));
        const int written = _write(descriptor_, text.data(), most);
        if (written < 0) {
            error = last_error();
            return;
        }
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

void File::close(std::error_code& error) noexcept {
    error.clear();
    if (descriptor_ >= 0 && _close(std::exchange(descriptor_, -1)) != 0) error = last_error();
}

bool may_read_and_write(const std::filesystem::path& path) noexcept {
    return may_open(path, GENERIC_READ | GENERIC_WRITE);
}

bool may_write(const std::filesystem::path& path) noexcept { return may_open(path, GENERIC_WRITE); }

// Who has the folder has it open as if to add files, and shares reading alone. Files in it are
// opened without it.
LockedFolder::LockedFolder(const std::filesystem::path& folder) noexcept {
    const HANDLE handle =
        CreateFileW(folder.c_str(), FILE_ADD_FILE, FILE_SHARE_READ | FILE_SHARE_DELETE, nullptr,
                    OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
    is_taken_ = handle == INVALID_HANDLE_VALUE && GetLastError() == ERROR_SHARING_VIOLATION;
    handle_ = reinterpret_cast<std::intptr_t>(handle);  // an invalid one is -1
}

LockedFolder::~LockedFolder() {
    if (handle_ != -1) CloseHandle(reinterpret_cast<HANDLE>(handle_));
}

// A person's temporary files lie in a folder that others may not enter.
std::filesystem::path make_temporary_folder(std::error_code& error) {
    const std::filesystem::path all = std::filesystem::temp_directory_path(error);
    std::random_device random;
    while (!error) {
        std::filesystem::path path = all / ("palpa-" + std::to_string(random()));
        if (std::filesystem::create_directory(path, error)) return path;
    }
    return {};
}

}  // namespace palpa
