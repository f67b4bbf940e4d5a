// Compressed files are unpacked, and none can fill the memory.
#include "formats/gzip.h"

#include "core/files.h"
#include "formats/psf.h"
#include "formats/structure.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <zlib.h>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <random>
#include <string>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;

namespace {

// By zlib's own writer, into one member.
std::string packed(const std::string& text) {
    z_stream stream{};
    REQUIRE(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) == Z_OK);
    std::string data(deflateBound(&stream, text.size()) + 64, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(data.data());
    stream.avail_out = static_cast<uInt>(data.size());
    REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
    data.erase(stream.total_out);
    deflateEnd(&stream);
    return data;
}

// Unpacks by zlib's own reader.
std::string read_by_zlib(const std::filesystem::path& file) {
    std::string text;
    gzFile stream = gzopen(file.string().c_str(), "rb");
    REQUIRE(stream);
    std::array<char, 4096> part{};
    for (int got = 0; (got = gzread(stream, part.data(), part.size())) > 0;)
        text.append(part.data(), static_cast<std::size_t>(got));
    CHECK(gzclose(stream) == Z_OK);
    return text;
}

// Rows that do not repeat themselves.
std::string numbers(std::size_t bytes) {
    std::mt19937_64 random;
    std::string text;
    while (text.size() < bytes)
        text += fmt::format("{},{}\n", random(), static_cast<double>(random()) * 1e-3);
    return text;
}

const std::string one_atom_line =
    "ATOM      1  C   ALA A   1       1.000   2.000   3.000  1.00  0.00           C\nEND\n";

}  // namespace

TEST_CASE("what gzip packs is unpacked, also in several members", "[formats][gzip]") {
    const std::string text(3'000'000, 'x');
    CHECK(is_gzip(packed(text)));
    CHECK(unpack_gzip(packed(text), "w.gz") == text);
    CHECK(unpack_gzip(packed("one") + packed("") + packed("two"), "w.gz") == "onetwo");
    CHECK(unpack_gzip(packed("one") + std::string(512, '\0'), "w.gz") == "one");
    CHECK(unpack_gzip(packed(text), "w.gz", text.size()) == text);
}

TEST_CASE("damaged, cut off and endless compressed files are refused", "[formats][gzip]") {
    const std::string data = packed("some text that is packed, some text that is packed");
    const auto error_of = [](const std::string& bytes, std::size_t most = 1000) {
        return load_error_of([&] { unpack_gzip(bytes, "w.gz", most); });
    };
    for (std::size_t length = 3; length < data.size(); ++length) {
        INFO(length);
        CHECK_THAT(error_of(data.substr(0, length)), Contains("cut off"));
    }
    std::string damaged = data;
    damaged[data.size() - 6] ^= 1;  // of the checksum
    CHECK_THAT(error_of(damaged), Contains("is damaged"));
    CHECK_THAT(error_of(packed(std::string(1001, 'x'))), Contains("holds more than"));
    CHECK_THAT(error_of(packed(std::string(600, 'x')) + packed(std::string(600, 'x'))),
               Contains("holds more than"));
}

TEST_CASE("a compressed structure is read whatever it is called", "[formats][gzip]") {
    const test::TemporaryFolder folder;
    for (const char* const name : {"a.pdb.gz", "b.ENT.GZ", "c.pdb"}) {
        INFO(name);
        CHECK(read_structure(folder.add_file(name, packed(one_atom_line))).names.size() == 1);
    }
    CHECK(read_structure(folder.add_file("d.pdb.gz", one_atom_line)).names.size() == 1);
}

TEST_CASE("a compressed PSF file is read as the plain one", "[formats][gzip]") {
    const test::TemporaryFolder folder;
    const std::string text = read_text_file(test::in_project("scenes/salt-bridge/vacuum.psf"));
    const Connectivity packed_system = read_psf(folder.add_file("w.psf.gz", packed(text)));
    const Connectivity plain = parse_psf(text, "w.psf");
    CHECK(packed_system.charge == plain.charge);
    CHECK(packed_system.bonds == plain.bonds);
}

TEST_CASE("a file is compressed piece by piece to what zlib reads back", "[formats][gzip]") {
    const test::TemporaryFolder folder;
    const std::string text =
        GENERATE(std::string(), std::string("one line\n"), std::string(1 << 18, '0'),
                 numbers(3'000'000), numbers(1'000'000) + std::string(5'000'000, ','));
    const std::filesystem::path plain = folder.add_file("trace.csv", text),
                                packed_file = folder.path() / "trace.csv.gz";
    {
        FilePacker packer(plain);
        while (packer.pack_piece()) CHECK_FALSE(std::filesystem::exists(packed_file));
        CHECK(packer.read_bytes() == text.size());
    }

    CHECK(list_folder(folder.path()) == std::vector{packed_file});
    CHECK(read_by_zlib(packed_file) == text);
    CHECK(read_recorded_file(plain) == text);
    CHECK(find_plain_or_packed(plain) == packed_file);
}

TEST_CASE("a compression that ends early leaves the file alone", "[formats][gzip]") {
    const test::TemporaryFolder folder;
    const std::string text = numbers(2'000'000);
    const std::filesystem::path plain = folder.add_file("trace.csv", text);
    {
        FilePacker packer(plain);
        CHECK(packer.pack_piece());
        CHECK(packer.pack_piece());
    }
    CHECK(list_folder(folder.path()) == std::vector{plain});
    CHECK(read_text_file(plain) == text);
}

TEST_CASE("the plain file of a recording counts where both forms are there", "[formats][gzip]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path plain = folder.path() / "trace.csv";
    CHECK_THAT(load_error_of([&] { (void)read_recorded_file(plain); }),
               Contains("trace.csv: no such file"));
    (void)folder.add_file("trace.csv.gz", packed("packed").substr(0, 12));
    CHECK_THAT(load_error_of([&] { (void)read_recorded_file(plain); }),
               Contains("trace.csv.gz: is cut off"));
    (void)folder.add_file("trace.csv", "plain");
    CHECK(read_recorded_file(plain) == "plain");
}
