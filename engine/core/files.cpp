#include "core/files.h"

#include "core/load_error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <deque>
#include <optional>
#include <system_error>
#include <utility>
#ifndef _WIN32
#include <sys/file.h>
#endif

namespace palpa {
namespace {

namespace fs = std::filesystem;

#ifdef _WIN32
constexpr int read_flags = O_RDONLY | O_BINARY, write_flags = O_WRONLY | O_BINARY, no_links = 0;
#else
// A pipe that nobody writes into would be waited for when it is opened; it is refused afterwards.
constexpr int read_flags = O_RDONLY | O_CLOEXEC | O_NONBLOCK, write_flags = O_WRONLY | O_CLOEXEC,
              no_links = O_NOFOLLOW;
#endif

constexpr const char* is_there = "is there already; expected another name, or --overwrite";

// The reason of the last failed call, in the system's words.
std::string last_reason() { return std::generic_category().message(errno); }

// Closes what it holds.
class Descriptor {
public:
    explicit Descriptor(int value) : value_(value) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (value_ >= 0) ::close(value_);
    }
    int get() const noexcept { return value_; }

private:
    int value_;
};

int open_new(const fs::path& path) {
    return ::open(path.string().c_str(), write_flags | O_CREAT | O_EXCL | no_links, 0666);
}

void write_all(int descriptor, std::string_view text, const fs::path& path) {
    while (!text.empty()) {
        const std::size_t most = std::min(text.size(), std::size_t{1} << 24);
        const auto written = ::write(descriptor, text.data(), most);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) throw LoadError({path.string()}, "cannot be written: " + last_reason());
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

// A device or a pipe, which is written into: a draft moved there would take its place.
bool is_stream(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    return fs::is_character_file(status) || fs::is_fifo(status) || fs::is_socket(status);
}

// What there is of that name; a link is there even where it leads nowhere.
fs::file_status status_of(const fs::path& path) {
    std::error_code error;
    return fs::symlink_status(path, error);
}

void write_into(const fs::path& path, std::string_view text) {
    const Descriptor stream(::open(path.string().c_str(), write_flags));
    if (stream.get() < 0) throw LoadError({path.string()}, "cannot be written: " + last_reason());
    write_all(stream.get(), text, path);
}

// A whole file beside the one that it will become; gone unless moved there.
class Draft {
public:
    explicit Draft(const fs::path& path) : path_(path) {
        constexpr int most_drafts = 1000;  // of other programs, or left by one that was killed
        for (int number = 0; number < most_drafts; ++number) {
            draft_ = path;
            draft_ += number == 0 ? ".draft" : fmt::format(".draft{}", number);
            descriptor_ = open_new(draft_);
            if (descriptor_ >= 0 || errno != EEXIST) break;
        }
        if (descriptor_ < 0) {
            throw LoadError({path.string()}, "cannot be written: " + last_reason());
        }
    }
    Draft(const Draft&) = delete;
    Draft& operator=(const Draft&) = delete;
    ~Draft() {
        if (descriptor_ >= 0) ::close(descriptor_);
        std::error_code ignored;
        fs::remove(draft_, ignored);
    }

    void write(std::string_view text) {
        write_all(descriptor_, text, path_);
        if (::close(std::exchange(descriptor_, -1)) != 0) {
            throw LoadError({path_.string()}, "cannot be written: " + last_reason());
        }
    }

    void move(Existing existing) const {
        std::error_code error;
        if (existing == Existing::Refuse) {
            fs::create_hard_link(draft_, path_, error);  // which replaces nothing
            if (!error) return;
            if (fs::exists(status_of(path_))) throw LoadError({path_.string()}, is_there);
            // A file system without hard links.
        }
        fs::rename(draft_, path_, error);
        if (error) throw LoadError({path_.string()}, "cannot be written: " + error.message());
    }

private:
    fs::path path_, draft_;
    int descriptor_ = -1;
};

std::string size_text(std::uintmax_t bytes) {
    return fmt::format("{:.1f} GiB", static_cast<double>(bytes) / (1 << 30));
}

[[noreturn]] void refuse_size(const fs::path& path, const std::string& size) {
    throw LoadError({path.string()}, fmt::format("is {} large; expected at most {}", size,
                                                 size_text(most_file_bytes)));
}

// Appends up to `most` bytes; false where reading failed.
bool read_some(int descriptor, std::size_t most, std::string& content) {
    std::array<char, 1 << 16> part{};
    while (most > 0) {
        const auto got = ::read(descriptor, part.data(), std::min(most, part.size()));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return false;
        if (got == 0) return true;
        content.append(part.data(), static_cast<std::size_t>(got));
        most -= static_cast<std::size_t>(got);
    }
    return true;
}

// Of a regular file that is no link; empty otherwise.
std::string beginning_of(const fs::path& path) {
    std::string beginning;
    if (!fs::is_regular_file(status_of(path))) return beginning;
    const Descriptor file(::open(path.string().c_str(), read_flags | no_links));
    if (file.get() < 0 || !read_some(file.get(), 4096, beginning)) beginning.clear();
    return beginning;
}

}  // namespace

std::string read_text_file(const fs::path& path) {
    std::error_code error;
    if (!fs::exists(path, error)) throw LoadError({path.string()}, "no such file");
    if (fs::is_directory(path, error)) {
        throw LoadError({path.string()}, "is a folder, a file was expected");
    }
    if (!fs::is_regular_file(path, error)) {
        throw LoadError({path.string()}, "is no regular file, one was expected");
    }
    const Descriptor file(::open(path.string().c_str(), read_flags));
    struct stat status{};
    if (file.get() < 0 || ::fstat(file.get(), &status) != 0) {
        throw LoadError({path.string()}, "cannot be read: " + last_reason());
    }
    if (!S_ISREG(status.st_mode)) {
        throw LoadError({path.string()}, "is no regular file, one was expected");
    }
    const auto bytes =
        static_cast<std::uintmax_t>(std::max<decltype(status.st_size)>(status.st_size, 0));
    if (bytes > most_file_bytes) refuse_size(path, size_text(bytes));
    std::string content;
    content.reserve(static_cast<std::size_t>(bytes));
    // One more than may be: what grows meanwhile, or has no size before it is read, ends there.
    if (!read_some(file.get(), most_file_bytes + 1, content)) {
        throw LoadError({path.string()}, "cannot be read: " + last_reason());
    }
    if (content.size() > most_file_bytes)
        refuse_size(path, "more than " + size_text(most_file_bytes));
    return content;
}

void write_text_file(const fs::path& path, std::string_view text, Existing existing) {
    if (is_stream(path)) return write_into(path, text);
    Draft draft(path);
    draft.write(text);
    draft.move(existing);
}

void write_text_files(std::span<const TextFile> files) {
    std::deque<Draft> drafts;  // which cannot be moved
    for (const TextFile& file : files) {
        const fs::file_status status = status_of(file.path);
        if (fs::is_directory(status)) {
            throw LoadError({file.path.string()}, "is a folder; expected a file, or nothing");
        }
        if (fs::exists(status) && file.existing == Existing::Refuse) {
            throw LoadError({file.path.string()}, is_there);
        }
        drafts.emplace_back(file.path).write(file.text);
    }
    for (std::size_t i = 0; i < files.size(); ++i) drafts[i].move(files[i].existing);
}

bool has_mark(const fs::path& path, std::string_view mark) {
    return beginning_of(path).find(mark) != std::string::npos;
}

bool begins_with(const fs::path& path, std::string_view text) {
    return beginning_of(path).starts_with(text);
}

Existing check_output(const fs::path& path, std::string_view mark, bool overwrites) {
    std::error_code error;
    const fs::path folder = path.parent_path();
    if (!folder.empty() && !fs::is_directory(folder, error)) {
        throw LoadError({path.string()},
                        "is in a folder that does not exist; expected an existing one");
    }
    if (is_stream(path)) return Existing::Replace;
    const fs::file_status status = status_of(path);
    if (fs::is_directory(status)) {
        throw LoadError({path.string()}, "is a folder; expected a file to write");
    }
    if (fs::exists(status)) {
        if (!overwrites) throw LoadError({path.string()}, is_there);
        if (fs::is_symlink(status)) {
            throw LoadError({path.string()},
                            "is a link; expected a file that palpa wrote, or none");
        }
        if (!has_mark(path, mark)) {
            throw LoadError({path.string()},
                            "is no file that this command wrote, and is not replaced; expected "
                            "another name");
        }
    }
    const Draft possible(path);
    return fs::exists(status) ? Existing::Replace : Existing::Refuse;
}

NewFile::NewFile(fs::path path) : path_(std::move(path)), descriptor_(open_new(path_)) {
    if (descriptor_ >= 0) return;
    if (errno == EEXIST) throw LoadError({path_.string()}, is_there);
    throw LoadError({path_.string()}, "cannot be written: " + last_reason());
}

NewFile::~NewFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void NewFile::write(std::string_view text) { write_all(descriptor_, text, path_); }

void NewFile::close() {
    if (descriptor_ < 0 || ::close(std::exchange(descriptor_, -1)) == 0) return;
    throw LoadError({path_.string()}, "cannot be written: " + last_reason());
}

#ifdef _WIN32
FolderLock::FolderLock(const fs::path&) {}
#else
FolderLock::FolderLock(const fs::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    // Other failures are of file systems that know no locks.
    if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) {
        return;
    }
    ::close(descriptor_);
    throw LoadError({folder.string()},
                    "another run is writing into this folder; expected another folder");
}
#endif

FolderLock::~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

fs::path find_program_folder() {
    std::error_code error;
    return fs::read_symlink("/proc/self/exe", error).parent_path();
}

}  // namespace palpa
