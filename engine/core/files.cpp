#include "core/files.h"

#include "core/load_error.h"

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

namespace palpa {
namespace {

// The reason of the last failed call, in the system's words.
std::string last_reason() { return std::generic_category().message(errno); }

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
    const bool is_special =
        std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error);
    std::filesystem::path draft = path;
    if (!is_special) draft += ".draft";
    errno = 0;
    std::ofstream file(draft, std::ios::binary | std::ios::trunc);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file) {
        const std::string reason = last_reason();
        std::error_code ignored;
        if (!is_special) std::filesystem::remove(draft, ignored);
        throw LoadError({path.string()}, "cannot be written: " + reason);
    }
    if (is_special) return;
    std::filesystem::rename(draft, path, error);
    if (error) {
        std::error_code ignored;
        std::filesystem::remove(draft, ignored);
        throw LoadError({path.string()}, "cannot be written: " + error.message());
    }
}

}  // namespace palpa
