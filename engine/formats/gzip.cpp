#include "formats/gzip.h"

#include "core/load_error.h"

#include <fmt/format.h>
#include <zlib.h>
#include <algorithm>
#include <limits>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;

// A piece takes some 20 ms.
constexpr std::size_t piece_bytes = std::size_t{1} << 18;

fs::path add_ending(fs::path path) { return path += ".gz"; }

// zlib's state, ended with its scope.
class Inflater {
public:
    explicit Inflater(const std::string& file) : file_(file) {
        constexpr int gzip_window = 15 + 16;  // zlib's way to ask for gzip's header
        if (inflateInit2(&stream_, gzip_window) != Z_OK)
            fail("cannot be unpacked: not enough memory");
    }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
    ~Inflater() { inflateEnd(&stream_); }

    // Members may stand one behind another, and blocks of zeros behind the last.
    void unpack(std::string_view data, std::size_t most, std::string& text) {
        // zlib writes nothing there.
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
        stream_.avail_in = static_cast<uInt>(data.size());
        while (is_gzip(rest(data))) {
            unpack_member(most, text);
            if (inflateReset(&stream_) != Z_OK) fail("cannot be unpacked");
        }
    }

private:
    [[noreturn]] void fail(const std::string& what) const { throw LoadError({file_}, what); }

    std::string_view rest(std::string_view data) const {
        return data.substr(data.size() - stream_.avail_in);
    }

    void unpack_member(std::size_t most, std::string& text) {
        constexpr std::size_t step = 1 << 20;
        for (int state = Z_OK; state != Z_STREAM_END;) {
            const std::size_t before = text.size();
            // One byte more than allowed shows that there are more.
            const std::size_t room = std::min(step, most + 1 - before);
            text.resize(before + room);
            stream_.next_out = reinterpret_cast<Bytef*>(text.data() + before);
            stream_.avail_out = static_cast<uInt>(room);
            state = inflate(&stream_, Z_NO_FLUSH);
            text.resize(before + room - stream_.avail_out);
            if (text.size() > most) {
                fail(
                    fmt::format("holds more than {} MiB when it is unpacked; expected at most that",
                                most >> 20U));
            }
            if (state == Z_BUF_ERROR ||
                (state == Z_OK && stream_.avail_in == 0 && stream_.avail_out > 0)) {
                fail("is cut off: its compressed data have no end; download or copy it again");
            }
            if (state != Z_OK && state != Z_STREAM_END) {
                fail(
                    "is damaged: its compressed data cannot be unpacked; download or copy it "
                    "again");
            }
        }
    }

    const std::string& file_;
    z_stream stream_{};
};

}  // namespace

bool is_gzip(std::string_view data) noexcept {
    return data.size() > 2 && data[0] == '\x1f' && data[1] == '\x8b';
}

std::string unpack_gzip(std::string_view data, const std::string& file, std::size_t most) {
    if (data.size() > std::numeric_limits<uInt>::max()) {
        throw LoadError({file}, "is too large to be unpacked");
    }
    std::string text;
    Inflater(file).unpack(data, most, text);
    return text;
}

std::string read_packed_text_file(const fs::path& path, std::size_t most) {
    std::string data = read_text_file(path);
    return is_gzip(data) ? unpack_gzip(data, path.string(), most) : data;
}

fs::path find_plain_or_packed(const fs::path& path) {
    std::error_code error;
    const fs::path packed = add_ending(path);
    return !fs::exists(path, error) && fs::exists(packed, error) ? packed : path;
}

std::string read_recorded_file(const fs::path& path) {
    return read_packed_text_file(find_plain_or_packed(path), most_file_bytes);
}

// ---- compressing -------------------------------------------------------------------------------

class FilePacker::Deflater {
public:
    explicit Deflater(const fs::path& file) {
        // Numbers have many short repetitions by chance: filtered, which leaves these alone,
        // makes traces 10 % smaller.
        constexpr int level = 6, gzip_window = 15 + 16, memory = 8;
        if (deflateInit2(&stream_, level, Z_DEFLATED, gzip_window, memory, Z_FILTERED) != Z_OK)
            throw LoadError({file.string()}, "cannot be compressed: not enough memory");
    }
    Deflater(const Deflater&) = delete;
    Deflater& operator=(const Deflater&) = delete;
    ~Deflater() { deflateEnd(&stream_); }

    void begin(std::string_view piece) noexcept {
        // zlib writes nothing there.
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(piece.data()));
        stream_.avail_in = static_cast<uInt>(piece.size());
    }
    // Takes what fits of the piece; all of it is there once not all of `into` was needed.
    std::string_view pack(std::vector<char>& into, bool is_last) noexcept {
        stream_.next_out = reinterpret_cast<Bytef*>(into.data());
        stream_.avail_out = static_cast<uInt>(into.size());
        (void)deflate(&stream_, is_last ? Z_FINISH : Z_NO_FLUSH);
        return {into.data(), into.size() - stream_.avail_out};
    }

private:
    z_stream stream_{};
};

FilePacker::FilePacker(const fs::path& file)
    : file_(file),
      draft_(add_ending(file)),
      deflater_(std::make_unique<Deflater>(file)),
      piece_(piece_bytes),
      packed_(piece_bytes) {
    std::error_code error;
    source_ = File(file, FileUse::ReadHere, error);
    if (error) throw LoadError({file.string()}, "cannot be read: " + error.message());
}

FilePacker::~FilePacker() = default;

bool FilePacker::pack_piece() {
    std::error_code error;
    const std::size_t got = source_.read(piece_, error);
    if (error) throw LoadError({file_.string()}, "cannot be read: " + error.message());
    read_ += got;
    write_packed({piece_.data(), got}, got == 0);
    if (got > 0) return true;
    draft_.close();
    source_.close(error);  // some systems remove no open file
    draft_.move(Existing::Replace);
    fs::remove(file_, error);
    if (error) throw LoadError({file_.string()}, "cannot be removed: " + error.message());
    return false;
}

void FilePacker::write_packed(std::string_view piece, bool is_last) {
    deflater_->begin(piece);
    for (bool is_full = true; is_full;) {
        const std::string_view packed = deflater_->pack(packed_, is_last);
        draft_.write(packed);
        is_full = packed.size() == packed_.size();
    }
}

}  // namespace palpa
