#include "platform/file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <string>

namespace palpa {
namespace {

std::error_code last_error() noexcept { return {errno, std::generic_category()}; }

int flags_of(FileUse use) noexcept {
    switch (use) {
        // A pipe that nobody writes into would be waited for when it is opened; who reads refuses
        // it afterwards.
        case FileUse::Read:
            return O_RDONLY | O_CLOEXEC | O_NONBLOCK;
        case FileUse::ReadHere:
            return O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW;
        case FileUse::Write:
            return O_WRONLY | O_CLOEXEC;
        case FileUse::Create:
            break;
    }
    return O_WRONLY | O_CLOEXEC | O_CREAT | O_EXCL | O_NOFOLLOW;
}

}  // namespace

File::File(const std::filesystem::path& path, FileUse use, std::error_code& error) noexcept
    : descriptor_(::open(path.c_str(), flags_of(use), 0666)) {
    error = descriptor_ < 0 ? last_error() : std::error_code();
}

File::~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

std::optional<std::uintmax_t> File::find_size(std::error_code& error) const noexcept {
    struct stat status{};
    error.clear();
    if (::fstat(descriptor_, &status) != 0) {
        error = last_error();
        return std::nullopt;
    }
    if (!S_ISREG(status.st_mode)) return std::nullopt;
    return static_cast<std::uintmax_t>(std::max<decltype(status.st_size)>(status.st_size, 0));
}

std::size_t File::read(std::span<char> into, std::error_code& error) const noexcept {
    for (;;) {
        const ssize_t got = ::read(descriptor_, into.data(), into.size());
        if (got < 0 && errno == EINTR) continue;
        error = got < 0 ? last_error() : std::error_code();
        return got < 0 ? 0 : static_cast<std::size_t>(got);
    }
}

void File::write(std::string_view text, std::error_code& error) const noexcept {
    error.clear();
    while (!text.empty()) {
        const std::size_t most = std::min(text.size(), std::size_t{1} << 24);
        const ssize_t written = ::write(descriptor_, text.data(), most);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) {
            error = last_error();
            return;
        }
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

void File::close(std::error_code& error) noexcept {
    error.clear();
    if (descriptor_ >= 0 && ::close(std::exchange(descriptor_, -1)) != 0) error = last_error();
}

bool may_read_and_write(const std::filesystem::path& path) noexcept {
    return ::access(path.c_str(), R_OK | W_OK) == 0;
}

bool may_write(const std::filesystem::path& path) noexcept {
    return ::access(path.c_str(), W_OK) == 0;
}

LockedFolder::LockedFolder(const std::filesystem::path& folder) noexcept
    : handle_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    const int descriptor = static_cast<int>(handle_);
    // Other failures are of file systems that know no locks.
    is_taken_ =
        descriptor >= 0 && ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

LockedFolder::~LockedFolder() {
    if (handle_ >= 0) ::close(static_cast<int>(handle_));
}

std::filesystem::path make_temporary_folder(std::error_code& error) {
    std::string name = (std::filesystem::temp_directory_path(error) / "palpa-XXXXXX").string();
    if (error) return {};
    if (::mkdtemp(name.data()) == nullptr) {
        error = last_error();
        return {};
    }
    return name;
}

}  // namespace palpa
