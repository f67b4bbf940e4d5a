#include "charmm/packed_force_field.h"

#include "core/files.h"
#include "core/text.h"
#include "tests/support/force_field_of.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "tests/support/same_force_field.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using Catch::StartsWith;
using test::load_error_of;

namespace {

const std::vector<std::string> about{"Small", "Cite: nobody, J. Nowhere 1, 1 (2024)."};

// Every kind of line, and numbers that are hard to keep.
constexpr std::string_view all_kinds = R"(read rtf
MASS 7 CT1 12.011 C
MASS -1 H 1.008
AUTO ANGLES DIHE
DEFA FIRST NTER LAST NONE
RESI ALA -0.1
GROUP
ATOM N NH1 -0.4700000001
ATOM HN H 0.1e-20
GROUP
ATOM CA CT1 123456789.123456789
BOND N CA HN N
ANGLE HN N CA
DIHE HN N CA C
IMPR N -C CA HN
CMAP -C N CA C N CA C +N
IC -C CA *N HN 1.3551 126.49 180.0 115.42 0.9996
IC N CA C O 0.0 0.0 -0.0 0.0 -1e-9
PRES NTER 1.0 NOANG NODIH
DELETE ATOM HN
DELETE BOND A B
DELETE ANGLE A B C
DELETE DIHE A B C D
DELETE IMPR A B C D
DELETE CMAP A B C D E F G H
ATOM N NH3 -0.3
LONEPAIR COLI LP1 CL C
END
read para
BONDS
A B 340.1 1.53
B B 1e300 -3.5
ANGLES
A B C 50.0 107.123456789012345
P O P 15.0 140.0 -40.0 2.80
DIHEDRALS
A B C D 0.1 1 0.0
A B C D 0.3333333333333333 3 180.0
X B C X 0.2 6 -103.0
IMPROPER
A X X D 2.0 0 35.26
CMAP
A B C D A B C D 2
0.13 -0.5 7 1e5
NONBONDED
A 0.0 -0.1 2.0
B 0.0 -0.1521 1.7682 0.0 -0.01 1.9
NBFIX
A B -0.07502 3.23
END
)";

std::string packed(std::string_view text = all_kinds) {
    return pack_force_field(test::force_field_of(text), about);
}

}  // namespace

TEST_CASE("a packed force field is what it was, every name and every bit",
          "[charmm][packed_force_field]") {
    const ForceField before = test::force_field_of(all_kinds);

    const ForceField after = unpack_force_field(packed(), "folder/small.ff");

    CHECK(test::is_same_force_field(before, after));
    CHECK(after.about == about);
    CHECK(after.files == std::vector<std::string>{"Small"});
    CHECK(to_string(after.residues.at("ALA").place) == "small.ff");
    CHECK(after.notes.empty());
    // That the comparison sees what it should.
    for (const auto& [old, other] :
         {std::pair{"0.1e-20", "0.2e-20"}, std::pair{"*N HN", "N HN"},
          std::pair{"3.23\n", "3.230000001\n"}, std::pair{"DELETE BOND A B", "DELETE BOND A C"},
          std::pair{"LAST NONE", "LAST CTER"}}) {
        std::string text(all_kinds);
        text.replace(text.find(old), std::string_view(old).size(), other);
        INFO(other);
        CHECK_FALSE(test::is_same_force_field(before, unpack_force_field(packed(text), "b")));
    }
}

TEST_CASE("the parts of CHARMM36m and the waters that come with scenes are packed exactly",
          "[charmm][packed_force_field]") {
    const ForceField before = read_force_field(std::array<std::filesystem::path, 3>{
        test::test_data("two_peptides/aera_c36m.rtf"),
        test::test_data("two_peptides/aera_c36m.prm"), test::in_project("scenes/water/tip3p.str")});

    CHECK(test::is_same_force_field(
        before, unpack_force_field(pack_force_field(before, about), "aera.ff")));
}

TEST_CASE("a packed force field is read like any file, first, and others add to it",
          "[charmm][packed_force_field]") {
    const test::TemporaryFolder folder;
    const auto base = folder.add_file("base.ff", packed());
    const auto more = folder.add_file("more.prm", "BONDS\nA B 350.0 1.53\nA D 1.0 1.0\nEND\n");

    const ForceField field = read_force_field(std::array{base, more});

    CHECK(field.bonds.at({"A", "B"}).k == 350);
    CHECK(field.bonds.at({"A", "D"}).k == 1);
    CHECK(field.bonds.at({"B", "B"}).k == 1e300);
    REQUIRE(field.notes.size() == 1);
    CHECK_THAT(describe_note(field.notes[0]),
               Contains("more.prm:2: bond A B replaces that of base.ff"));
    CHECK(field.files == std::vector<std::string>{"Small", more.string()});
    CHECK_THAT(load_error_of([&] { read_force_field(std::array{more, base}); }),
               Contains("base.ff: is a packed force field") && Contains("the first file"));
}

TEST_CASE("a packed force field that is cut, changed or of another version is refused",
          "[charmm][packed_force_field]") {
    const std::string whole = packed();
    const auto error = [](const std::string& bytes) {
        return load_error_of([&] { unpack_force_field(bytes, "a.ff"); });
    };

    CHECK(error(whole) == "no error");
    for (std::size_t size = 0; size < whole.size(); ++size) {
        INFO(size);
        REQUIRE_THAT(error(whole.substr(0, size)), StartsWith("a.ff: "));
    }
    const std::size_t content = whole.find("\n\n") + 2;
    int unchanged = 0;
    for (std::size_t at = content; at < whole.size(); ++at) {
        std::string changed = whole;
        changed[at] = static_cast<char>(changed[at] ^ 4);
        INFO(at);
        if (error(changed) == "no error") {  // zlib fills its last byte with bits that say nothing
            REQUIRE(test::is_same_force_field(unpack_force_field(changed, "a.ff"),
                                              unpack_force_field(whole, "a.ff")));
            ++unchanged;
        } else {
            REQUIRE_THAT(error(changed), StartsWith("a.ff: "));
        }
    }
    CHECK(unchanged <= 1);
    CHECK_THAT(error("Palpa packed force field 2\n"), Contains("of this version"));
    CHECK_THAT(error(whole + "x"), StartsWith("a.ff: "));
}

TEST_CASE("what a packed force field is can be read without the rest",
          "[charmm][packed_force_field]") {
    CHECK(read_packed_about(packed(), "a.ff") == about);
    CHECK(packed().starts_with("Palpa packed force field 1\nSmall\nCite: nobody"));
    const ForceField field = test::force_field_of(all_kinds);
    CHECK(load_error_of([&] { pack_force_field(field, {}); }) != "no error");
    CHECK_THAT(load_error_of([&] { pack_force_field(field, std::vector<std::string>{"a", ""}); }),
               StartsWith("about: "));
}

TEST_CASE("a folder of CHARMM's files is read in its order", "[charmm][force_field]") {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "stream");
    for (const char* const name :
         {"stream/a.str", "b.str", "a.prm", "z.rtf", "b.rtf", "README.md"}) {
        folder.add_file(name, "");
    }

    std::vector<std::string> names;
    for (const auto& file : list_force_field_files(folder.path())) {
        names.push_back(file.lexically_relative(folder.path()).generic_string());
    }

    CHECK(names == std::vector<std::string>{"b.rtf", "z.rtf", "a.prm", "b.str", "stream/a.str"});
    CHECK(list_force_field_files("a.rtf") == std::vector<std::filesystem::path>{"a.rtf"});
    std::filesystem::create_directory(folder.path() / "empty");
    CHECK_THAT(load_error_of([&] { (void)list_force_field_files(folder.path() / "empty"); }),
               Contains("contains no force field files; expected .rtf, .prm or .str"));
}

TEST_CASE("the force field of the program is CHARMM's release", "[charmm][packed_force_field]") {
    const auto release = test::find_shared_data("data/charmm36_2024");
    if (!release) return;
    const std::string bytes = read_text_file(test::in_project("engine/charmm/charmm36.ff"));
    std::vector<std::string> lines;
    const std::string about_text = read_text_file(test::in_project("engine/charmm/charmm36.txt"));
    for (const std::string_view line : split_lines(about_text)) {
        lines.emplace_back(line);
    }

    const ForceField field = read_force_field(list_force_field_files(*release));

    CHECK(bytes.size() < 3'000'000);
    CHECK(test::is_same_force_field(field, unpack_force_field(bytes, "charmm36.ff")));
    CHECK(read_packed_about(bytes, "charmm36.ff") == lines);
}
