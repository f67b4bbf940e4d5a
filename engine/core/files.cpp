#include "core/files.h"

#include "core/load_error.h"

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>
#include <vector>

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

void write_text_files(std::span<const TextFile> files) {
    std::vector<std::filesystem::path> drafts;
    const auto remove_drafts = [&] {
        std::error_code ignored;
        for (const auto& draft : drafts) std::filesystem::remove(draft, ignored);
    };
    try {
        for (const TextFile& file : files) {
            if (std::filesystem::is_directory(file.path)) {
                throw LoadError({file.path.string()}, "is a folder; expected a file, or nothing");
            }
            std::filesystem::path draft = file.path;
            draft += ".whole";
            drafts.push_back(draft);
            write_text_file(draft, file.text);
        }
        for (std::size_t i = 0; i < files.size(); ++i) {
            std::filesystem::rename(drafts[i], files[i].path);
        }
    } catch (const std::filesystem::filesystem_error& error) {
        remove_drafts();
        throw LoadError({error.path1().string()}, "cannot be written: " + error.code().message());
    } catch (const LoadError&) {
        remove_drafts();
        throw;
    }
}

}  // namespace palpa
