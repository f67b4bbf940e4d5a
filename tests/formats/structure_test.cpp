#include "formats/structure.h"

#include "formats/crd.h"
#include "formats/pdb.h"
#include "tests/support/load_error_of.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

#include <zlib.h>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;
using Catch::EndsWith;
using test::load_error_of;

namespace {

constexpr std::string_view one_atom_pdb =
    "ATOM      1  C   ALA A   1       1.000   2.000   3.000\nEND\n";
constexpr std::string_view one_atom_cif =
    "data_x\n_atom_site.Cartn_x 1\n_atom_site.Cartn_y 2\n_atom_site.Cartn_z 3\n"
    "_atom_site.label_seq_id 1\n_atom_site.label_comp_id ALA\n_atom_site.label_asym_id A\n"
    "_atom_site.label_atom_id C\n";
constexpr std::string_view crd =
    "    1\n    1    1 ALA  C      1.00000   2.00000   3.00000 A    1      0.00000\n";

// What README.md of the shared data says, and `grep -c` of chains and columns.
struct Expected {
    const char* file;
    std::size_t atoms;
    std::map<std::string, std::size_t> chains;
    std::size_t hetero = 0, alternates = 0, guessed = 0, chain_ends = 1;
};

const std::vector<Expected> all_expected{
    {"structures/1crn.pdb", 327, {{"A", 327}}},
    {"structures/alanine_dipeptide.pdb", 22, {{"", 22}}, 0, 0, 22},
    {"energies/ala_ala_ala/ala_ala_ala.pdb", 33, {{"A", 33}}, 0, 0, 33},
    {"hiv/5vea_protein.pdb", 1540, {{"A", 770}, {"B", 770}}, 0, 44, 0, 2},
    {"hiv/5vea_ligand.pdb", 66, {{"A", 33}, {"B", 33}}, 66, 0, 0, 0},
    {"hiv/5w5w_protein.pdb", 1516, {{"A", 758}, {"B", 758}}, 0, 0, 0, 2},
    {"hiv/5w5w_ligand.pdb", 66, {{"A", 66}}, 66, 0, 0, 0},
    {"hiv/4k4p_protein.pdb", 1500, {{"A", 750}, {"B", 750}}, 0, 0, 0, 2},
    {"hiv/4k4p_ligand.pdb", 66, {{"B", 66}}, 66, 0, 0, 0},
    {"hiv/4k4q_protein.pdb", 1486, {{"A", 744}, {"B", 742}}, 0, 0, 0, 2},
    {"hiv/4k4q_ligand.pdb", 66, {{"A", 66}}, 66, 0, 0, 0},
    {"hiv/1hsg_protein.pdb", 1514, {{"A", 757}, {"B", 757}}, 0, 0, 0, 2},
    {"hiv/1hsg_ligand.pdb", 45, {{"B", 45}}, 45, 0, 0, 0},
    {"hiv/1hxw_protein.pdb", 1852, {{"A", 926}, {"B", 926}}, 0, 0, 0, 2},
    {"hiv/1hxw_ligand.pdb", 50, {{"B", 50}}, 50, 0, 0, 0},
    {"hiv/1hpv_protein.pdb", 1516, {{"A", 758}, {"B", 758}}, 0, 0, 0, 2},
    {"hiv/1hpv_ligand.pdb", 35, {{"B", 35}}, 35, 0, 0, 0},
    {"hiv/1hvr_protein.pdb", 1844, {{"A", 922}, {"B", 922}}, 18, 0, 0, 2},
    {"hiv/1hvr_ligand.pdb", 46, {{"A", 46}}, 46, 0, 0, 0},
    {"hiv/1tw7_charmm_allH.pdb", 3110, {{"", 3110}}, 0, 0, 3110, 0},
    {"hiv/derived/5w5w_tl3_complex.pdb", 1646, {{"A", 758}, {"B", 758}, {"L", 130}}, 130, 0, 0, 2},
    {"hiv/derived/standin_2az8_tl3.pdb", 1648, {{"A", 759}, {"B", 759}, {"L", 130}}, 130, 0, 0, 2},
};

std::map<std::string, std::size_t> chains_of(const Structure& structure) {
    std::map<std::string, std::size_t> chains;
    for (const AtomRecord& record : structure.records) ++chains[record.chain];
    return chains;
}

template <class Wanted>
std::size_t count(const Structure& structure, const Wanted& wanted) {
    return static_cast<std::size_t>(
        std::count_if(structure.records.begin(), structure.records.end(), wanted));
}

void check_round_trip(const Structure& structure) {
    const Structure back = parse_pdb(format_pdb(structure, "x"), "back.pdb");
    CHECK(back.positions == structure.positions);
    CHECK(back.chain_ends == structure.chain_ends);
    CHECK(chains_of(back) == chains_of(structure));
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        if (to_string(back.names[i]) == to_string(structure.names[i])) continue;
        FAIL_CHECK(to_string(structure.names[i]) << " became " << to_string(back.names[i]));
    }
}

std::string unpacked(const std::filesystem::path& path) {
    std::string text;
    const gzFile file = gzopen(path.string().c_str(), "rb");
    REQUIRE(file);
    std::array<char, 65536> block{};
    for (int size = 0; (size = gzread(file, block.data(), block.size())) > 0;) {
        text.append(block.data(), static_cast<std::size_t>(size));
    }
    REQUIRE(gzclose(file) == Z_OK);
    return text;
}

}  // namespace

TEST_CASE("a structure file is read as its name says", "[formats][structure]") {
    const test::TemporaryFolder folder;
    const auto [name, text] =
        GENERATE(table<std::string, std::string_view>({{"a.pdb", one_atom_pdb},
                                                       {"a.ENT", one_atom_pdb},
                                                       {"a.cif", one_atom_cif},
                                                       {"a.mmCIF", one_atom_cif},
                                                       {"a.crd", crd},
                                                       {"a.Cor", crd}}));
    INFO(name);

    const Structure structure = read_structure(folder.add_file(name, text));

    REQUIRE(structure.names.size() == 1);
    CHECK(to_string(structure.names[0]) == "A ALA 1 C");
    CHECK(structure.positions[0] == Vec3(1, 2, 3));
}

TEST_CASE("a structure file of another name is refused", "[formats][structure]") {
    CHECK(load_error_of([] { read_structure("a.xyz"); }) ==
          "a.xyz: '.xyz' is not the ending of a structure file; expected .pdb, .ent, .cif, .mmcif, "
          ".crd, .cor or .gro, or one of these followed by .gz");
    CHECK_THAT(load_error_of([] { read_structure("a"); }),
               Catch::StartsWith("a: '' is not the ending"));
    CHECK_THAT(load_error_of([] { read_structure("a.gz"); }), Catch::Contains("'.gz' is no"));
    CHECK(load_error_of([] { read_structure("none.pdb"); }) == "none.pdb: no such file");
    const test::TemporaryFolder folder;
    CHECK_THAT(load_error_of([&] { read_structure(folder.path()); }),
               Catch::EndsWith(": is a folder; expected a structure file in it"));
}

TEST_CASE("the PDB files of the shared data hold what is told of them", "[formats][structure]") {
    const auto folder = test::find_shared_data("data");
    if (!folder) return;
    const Expected& expected = GENERATE(from_range(all_expected));
    INFO(expected.file);

    const Structure structure = read_structure(*folder / expected.file);

    CHECK(structure.names.size() == expected.atoms);
    CHECK(chains_of(structure) == expected.chains);
    CHECK(count(structure, [](const AtomRecord& a) { return a.hetero; }) == expected.hetero);
    CHECK(count(structure, [](const AtomRecord& a) { return a.alternate != ' '; }) ==
          expected.alternates);
    CHECK(count(structure, [](const AtomRecord& a) { return a.element_guessed; }) ==
          expected.guessed);
    CHECK(structure.chain_ends.size() == expected.chain_ends);
    check_round_trip(structure);
}

TEST_CASE("every tetrapeptide of the shared data is read and written", "[formats][structure]") {
    const auto folder = test::find_shared_data("data/energies/eef1sb/tetra");
    if (!folder) return;
    std::size_t files = 0;
    for (const auto& file : std::filesystem::directory_iterator(*folder)) {
        INFO(file.path());
        const Structure structure = read_structure(file.path());
        CHECK(structure.chain_ends == std::vector{structure.names.size()});
        CHECK(structure.notes.empty());
        check_round_trip(structure);
        ++files;
    }
    CHECK(files == 76);
}

TEST_CASE("an element guessed from a name is the one that a file names", "[formats][structure]") {
    const auto folder = test::find_shared_data("data/energies/eef1sb/tetra");
    if (!folder) return;
    for (const auto& file : std::filesystem::directory_iterator(*folder)) {
        Structure named = read_structure(file.path());
        std::vector<std::string> elements;
        for (AtomRecord& record : named.records) {
            elements.push_back(record.element);
            record.element.clear();
        }
        const Structure guessed = parse_pdb(format_pdb(named, ""), "guessed.pdb");
        for (std::size_t i = 0; i < elements.size(); ++i) {
            if (guessed.records[i].element == elements[i]) continue;
            FAIL_CHECK(to_string(named.names[i]) << " is no " << guessed.records[i].element);
        }
    }
}

TEST_CASE("GroEL with its 58,674 atoms is read", "[formats][structure]") {
    const auto packed = test::find_shared_data("data/structures/1aon.pdb.gz");
    if (!packed) return;

    const Structure structure = parse_pdb(unpacked(*packed), "1aon.pdb");

    const std::size_t hetero = count(structure, [](const AtomRecord& a) { return a.hetero; });
    CHECK(hetero == 196);
    CHECK(structure.names.size() - hetero == 58674);
    CHECK(chains_of(structure).size() == 21);
    CHECK(structure.chain_ends.size() == 21);
    // Its REMARK 350, three lines of chains and the identity.
    REQUIRE(structure.assemblies.size() == 1);
    REQUIRE(structure.assemblies[0].parts.size() == 1);
    CHECK(structure.assemblies[0].parts[0].chains == "A,B,C,D,E,F,G,H,I,J,K,L,M,N,O,P,Q,R,S,T,U,");
    REQUIRE(structure.operators.size() == 1);
    CHECK(structure.operators[0].rotation == Mat3::Identity());
    CHECK(structure.operators[0].translation == Vec3::Zero());
    check_round_trip(structure);
}
