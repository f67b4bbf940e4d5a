#include "formats/bytes.h"

#include "core/files.h"
#include "core/load_error.h"

#include <sstream>
#include <system_error>
#include <utility>

namespace palpa {

ByteSource::ByteSource(const std::filesystem::path& path) : name_(path.string()) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) throw LoadError({name_}, "no such file");
    if (!std::filesystem::is_regular_file(path, error)) {
        throw LoadError({name_}, "is not a regular file; expected one");
    }
    stream_ = std::make_unique<std::ifstream>(path, std::ios::binary);
    size_ = std::filesystem::file_size(path, error);
    if (!*stream_ || error) throw LoadError({name_}, "cannot be read");
}

ByteSource::ByteSource(std::string bytes, std::string name)
    : name_(std::move(name)), size_(bytes.size()) {
    stream_ = std::make_unique<std::istringstream>(std::move(bytes), std::ios::binary);
}

void ByteSource::read(std::uint64_t offset, std::span<char> into) {
    if (into.empty()) return;
    const auto count = static_cast<std::streamsize>(into.size());
    stream_->clear();
    stream_->seekg(static_cast<std::streamoff>(offset));
    stream_->read(into.data(), count);
    if (!*stream_ || stream_->gcount() != count) {
        throw LoadError({name_},
                        "became shorter while it was being read; expected a file that no other "
                        "program changes");
    }
}

GrowingFile::GrowingFile(const std::filesystem::path& path) : name_(path.string()) {
    NewFile(path).close();  // which refuses what is there
    stream_.open(path, std::ios::binary | std::ios::in | std::ios::out);
    check();
}

void GrowingFile::append(std::string_view bytes) {
    stream_.seekp(0, std::ios::end);
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream_.flush();
    check();
}

void GrowingFile::replace(std::uint64_t offset, std::string_view bytes) {
    stream_.seekp(static_cast<std::streamoff>(offset));
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream_.flush();
    check();
}

void GrowingFile::close() {
    stream_.close();
    check();
}

void GrowingFile::check() {
    if (!stream_) throw LoadError({name_}, "cannot be written: the disk may be full");
}

}  // namespace palpa
