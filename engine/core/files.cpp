#include "core/files.h"

#include "core/load_error.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <deque>
#include <optional>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

namespace fs = std::filesystem;

constexpr const char* is_there = "already exists; expected another name, or --overwrite";

[[noreturn]] void refuse_write(const fs::path& path, const std::error_code& error) {
    throw LoadError({path.string()}, "cannot be written: " + error.message());
}

void write_all(const File& file, std::string_view text, const fs::path& path) {
    std::error_code error;
    file.write(text, error);
    if (error) refuse_write(path, error);
}

void close_all(File& file, const fs::path& path) {
    std::error_code error;
    file.close(error);
    if (error) refuse_write(path, error);
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
    std::error_code error;
    const File stream(path, FileUse::Write, error);
    if (error) refuse_write(path, error);
    write_all(stream, text, path);
}

std::string size_text(std::uintmax_t bytes) {
    return fmt::format("{:.1f} GiB", static_cast<double>(bytes) / (1 << 30));
}

[[noreturn]] void refuse_size(const fs::path& path, const std::string& size) {
    throw LoadError({path.string()}, fmt::format("is {} large; expected at most {}", size,
                                                 size_text(most_file_bytes)));
}

// Appends up to `most` bytes.
void read_some(const File& file, std::size_t most, std::string& content, std::error_code& error) {
    std::array<char, 1 << 16> part{};
    while (most > 0) {
        const std::size_t got =
            file.read(std::span(part).first(std::min(most, part.size())), error);
        if (got == 0) return;  // or an error
        content.append(part.data(), got);
        most -= got;
    }
}

// Of a regular file that is no link; empty otherwise.
std::string beginning_of(const fs::path& path) {
    std::string beginning;
    if (!fs::is_regular_file(status_of(path))) return beginning;
    std::error_code error;
    const File file(path, FileUse::ReadHere, error);
    if (!error) read_some(file, 4096, beginning, error);
    if (error) beginning.clear();
    return beginning;
}

}  // namespace

std::string read_text_file(const fs::path& path) {
    std::error_code error;
    if (!fs::exists(path, error)) throw LoadError({path.string()}, "no such file");
    if (fs::is_directory(path, error)) {
        throw LoadError({path.string()}, "is a folder; expected a file");
    }
    if (!fs::is_regular_file(path, error)) {
        throw LoadError({path.string()}, "is not a regular file; expected one");
    }
    const File file(path, FileUse::Read, error);
    std::optional<std::uintmax_t> bytes;
    if (!error) bytes = file.find_size(error);
    if (error) throw LoadError({path.string()}, "cannot be read: " + error.message());
    if (!bytes) throw LoadError({path.string()}, "is not a regular file; expected one");
    if (*bytes > most_file_bytes) refuse_size(path, size_text(*bytes));
    std::string content;
    content.reserve(static_cast<std::size_t>(*bytes));
    // One more than may be: what grows meanwhile, or has no size before it is read, ends there.
    read_some(file, most_file_bytes + 1, content, error);
    if (error) throw LoadError({path.string()}, "cannot be read: " + error.message());
    if (content.size() > most_file_bytes)
        refuse_size(path, "more than " + size_text(most_file_bytes));
    return content;
}

void write_text_file(const fs::path& path, std::string_view text, Existing existing) {
    if (is_stream(path)) return write_into(path, text);
    DraftFile draft(path);
    draft.write(text);
    draft.close();
    draft.move(existing);
}

void write_text_files(std::span<const TextFile> files) {
    std::deque<std::optional<DraftFile>> drafts;  // none for a stream, which is written last
    for (const TextFile& file : files) {
        std::optional<DraftFile>& draft = drafts.emplace_back();
        if (is_stream(file.path)) continue;
        const fs::file_status status = status_of(file.path);
        if (fs::is_directory(status)) {
            throw LoadError({file.path.string()}, "is a folder; expected a file, or nothing");
        }
        if (fs::exists(status) && file.existing == Existing::Refuse) {
            throw LoadError({file.path.string()}, is_there);
        }
        draft.emplace(file.path).write(file.text);
        draft->close();
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (const std::optional<DraftFile>& draft = drafts[i]) draft->move(files[i].existing);
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (!drafts[i]) write_into(files[i].path, files[i].text);
    }
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
                        "is in a folder that does not exist; make the folder first");
    }
    if (is_stream(path)) return Existing::Replace;
    const fs::file_status status = status_of(path);
    if (fs::is_directory(status)) {
        throw LoadError({path.string()}, "is a folder; expected a file to write");
    }
    if (fs::exists(status)) {
        if (!overwrites) throw LoadError({path.string()}, is_there);
        if (fs::is_symlink(status)) {
            throw LoadError(
                {path.string()},
                "is a link and is not replaced; expected a file that palpa wrote, or another name");
        }
        if (!has_mark(path, mark)) {
            throw LoadError(
                {path.string()},
                "was not written by this command and is not replaced; expected another name");
        }
    }
    const DraftFile possible(path);
    return fs::exists(status) ? Existing::Replace : Existing::Refuse;
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw LoadError({folder.string()}, "cannot be made: " + error.message());
}

std::vector<fs::path> list_folder(const fs::path& folder, std::size_t most) {
    std::vector<fs::path> paths;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end;
         !error && entry != end && paths.size() < most; entry.increment(error)) {
        paths.push_back(entry->path());
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

NewFile::NewFile(fs::path path) : path_(std::move(path)) {
    std::error_code error;
    file_ = File(path_, is_stream(path_) ? FileUse::Write : FileUse::Create, error);
    if (error == std::errc::file_exists) throw LoadError({path_.string()}, is_there);
    if (error) refuse_write(path_, error);
}

void NewFile::write(std::string_view text) { write_all(file_, text, path_); }

void NewFile::close() { close_all(file_, path_); }

DraftFile::DraftFile(fs::path path) : path_(std::move(path)) {
    constexpr int most_drafts = 1000;  // of other programs, or left by one that was killed
    std::error_code error;
    for (int number = 0; number < most_drafts; ++number) {
        draft_ = path_;
        draft_ += number == 0 ? ".draft" : fmt::format(".draft{}", number);
        file_ = File(draft_, FileUse::Create, error);
        if (error != std::errc::file_exists) break;
    }
    if (error) refuse_write(path_, error);
}

DraftFile::~DraftFile() {
    std::error_code ignored;
    file_.close(ignored);  // some systems remove no open file
    fs::remove(draft_, ignored);
}

void DraftFile::write(std::string_view text) { write_all(file_, text, path_); }

void DraftFile::close() { close_all(file_, path_); }

void DraftFile::move(Existing existing) const {
    std::error_code error;
    if (existing == Existing::Refuse) {
        fs::create_hard_link(draft_, path_, error);  // which replaces nothing
        if (!error) return;
        if (fs::exists(status_of(path_))) throw LoadError({path_.string()}, is_there);
        // A file system without hard links.
    }
    fs::rename(draft_, path_, error);
    if (error) refuse_write(path_, error);
}

FolderLock::FolderLock(const fs::path& folder) : folder_(folder) {
    if (!folder_.is_taken()) return;
    throw LoadError(
        {folder.string()},
        "another run is writing into this folder; expected another folder, or wait until it ends");
}

}  // namespace palpa
