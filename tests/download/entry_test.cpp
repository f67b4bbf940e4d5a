#include "download/entry.h"
#include "core/files.h"
#include "tests/support/load_error_of.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <string_view>

using namespace palpa;
using namespace std::string_view_literals;
using Catch::Matchers::Contains;

namespace {

// printf 'data_1HSG\n' | gzip -n
constexpr std::string_view packed =
    "\x1f\x8b\x08\0\0\0\0\0\0\x03\x4b\x49\x2c\x49\x8c\x37\xf4\x08\x76\xe7\x02\0\x53\x7a\x6b\x7b\x0a\0\0\0"sv;

}  // namespace

TEST_CASE("mmCIF of the entry is accepted, plain or packed", "[download][entry]") {
    for (const std::string_view text :
         {"data_1HSG\n#\n"sv, "data_1hsg"sv, "# made by hand\r\n\n  DATA_1hsg\n"sv,
          "data_pdb_00001hsg\n"sv, packed})
        CHECK_NOTHROW(check_entry(text, "1hsg", "address"));
    CHECK_NOTHROW(check_entry("data_PDB_A0001HSG\n", "pdb_a0001hsg", "address"));
}

TEST_CASE("anything else is refused with its beginning", "[download][entry]") {
    const auto refusal = [](std::string_view data) {
        return test::load_error_of([&] { check_entry(data, "1hsg", "address"); });
    };

    CHECK_THAT(refusal("data_2ABC\n"),
               Contains("address: is not the mmCIF file of 1hsg") && Contains("'data_2ABC'"));
    CHECK_THAT(refusal("<!DOCTYPE html>"), Contains("'<!DOCTYPE'"));
    CHECK_THAT(refusal(""), Contains("is not the mmCIF file"));
    CHECK_THAT(refusal("data_"), Contains("is not the mmCIF file"));
    CHECK_THAT(refusal("# only a comment"), Contains("is not the mmCIF file"));
    CHECK_THAT(refusal("HEADER    data_1HSG"), Contains("'HEADER'"));
    CHECK_THAT(refusal("\x1b[2J"), Contains("\\x1b"));
    CHECK_THAT(refusal(packed.substr(0, packed.size() - 9)), Contains("is cut off"));
    CHECK_THAT(refusal("\x1f\x8b not gzip at all"), Contains("damaged"));
}

TEST_CASE("an entry in the cache needs no network", "[download][entry]") {
    const test::TemporaryFolder folder;
    folder.add_file("1hsg.cif.gz", packed);
    const EntrySource source{.base = "http://example.org/", .cache = folder.path()};

    const FetchedEntry entry = fetch_entry("1hsg", source);

    CHECK(entry.is_from_cache);
    CHECK(entry.bytes == packed.size());
    CHECK(read_text_file(entry.file) == packed);
    CHECK_THAT(describe(entry), Contains("taken from the cache: ") && Contains("1hsg.cif.gz"));
    CHECK_THAT(test::load_error_of([&] { (void)fetch_entry("1hsg", source, true); }),
               Contains("http://example.org/1hsg.cif.gz: "));
}
