#include "formats/gzip.h"

#include "core/files.h"
#include "core/load_error.h"

#include <fmt/format.h>
#include <zlib.h>
#include <algorithm>
#include <limits>

namespace palpa {
namespace {

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
                fail(fmt::format("holds more than {} MiB; expected a structure file", most >> 20U));
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

std::string read_packed_text_file(const std::filesystem::path& path) {
    std::string data = read_text_file(path);
    return is_gzip(data) ? unpack_gzip(data, path.string()) : data;
}

}  // namespace palpa
