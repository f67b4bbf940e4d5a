#include "core/files.h"

#include "core/load_error.h"

#include <cerrno>
#include <deque>
#include <fstream>
#include <sstream>
#include <system_error>

namespace palpa {
namespace {

// The reason of the last failed call, in the system's words.
std::string last_reason() { return std::generic_category().message(errno); }

// Replaces the content of `file`, which may be a draft of `path`: errors tell the latter.
void write_to(const std::filesystem::path& file, const std::filesystem::path& path,
              std::string_view text) {
    errno = 0;
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.close();
    if (!stream) throw LoadError({path.string()}, "cannot be written: " + last_reason());
}

// A whole file beside the one that it will replace; gone unless moved there.
class Draft {
public:
    explicit Draft(const std::filesystem::path& path) : path_(path), draft_(path) {
        draft_ += ".draft";
    }
    Draft(const Draft&) = delete;
    Draft& operator=(const Draft&) = delete;
    ~Draft() {
        std::error_code ignored;
        std::filesystem::remove(draft_, ignored);
    }

    void write(std::string_view text) const { write_to(draft_, path_, text); }

    void move() const {
        std::error_code error;
        std::filesystem::rename(draft_, path_, error);
        if (error) throw LoadError({path_.string()}, "cannot be written: " + error.message());
    }

private:
    std::filesystem::path path_, draft_;
};

}  // namespace

std::string read_text_file(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) throw LoadError({path.string()}, "no such file");
    if (std::filesystem::is_directory(path, error)) {
        throw LoadError({path.string()}, "is a folder, a file was expected");
    }
    if (!std::filesystem::is_regular_file(path, error)) {
        throw LoadError({path.string()}, "is no regular file");
    }
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    std::ostringstream content;
    if (file) content << file.rdbuf();
    if (!file || file.bad()) throw LoadError({path.string()}, "cannot be read: " + last_reason());
    return std::move(content).str();
}

void write_text_file(const std::filesystem::path& path, std::string_view text) {
    std::error_code error;
    // A device or a pipe is written into; a draft moved there would take its place.
    if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
        return write_to(path, path, text);
    }
    const Draft draft(path);
    draft.write(text);
    draft.move();
}

void write_text_files(std::span<const TextFile> files) {
    std::deque<Draft> drafts;  // which cannot be moved
    for (const TextFile& file : files) {
        std::error_code error;
        if (std::filesystem::is_directory(file.path, error)) {
            throw LoadError({file.path.string()}, "is a folder; expected a file, or nothing");
        }
        drafts.emplace_back(file.path).write(file.text);
    }
    for (const Draft& draft : drafts) draft.move();
}

}  // namespace palpa
