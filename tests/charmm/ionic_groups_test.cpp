// EEF1-SB's neutral charges against those of its own topology file, and against CHARMM's energies.
#include "charmm/ionic_groups.h"

#include "charmm/build_topology.h"
#include "charmm/charge_groups.h"
#include "charmm/generate.h"
#include "core/files.h"
#include "core/text.h"
#include "forces/nonbonded.h"
#include "formats/crd.h"
#include "formats/pdb.h"
#include "formats/psf.h"
#include "tests/support/force_field_of.h"
#include "tests/support/native_case.h"
#include "tests/support/paths.h"
#include "tests/support/shared_data.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

// The column `elec` of a table, by name.
std::map<std::string, double> read_electrostatics(const fs::path& path) {
    std::map<std::string, double> table;
    std::size_t column = 0;
    const std::string text = read_text_file(path);
    for (const std::string_view line : split_lines(text)) {
        if (line.empty() || line.front() == '#') continue;
        std::vector<std::string> fields(1);
        for (const char c : line) {
            if (c == ',') {
                fields.emplace_back();
            } else {
                fields.back() += c;
            }
        }
        if (fields[0] == "name") {
            column = static_cast<std::size_t>(std::ranges::find(fields, "elec") - fields.begin());
        } else {
            table[fields[0]] = find_real(fields[column]).value();
        }
    }
    return table;
}

// Σ 332.0716 q q/(1.5 r^2), pairs three bonds apart in full.
double electrostatic_energy(const Connectivity& connectivity, const std::vector<Vec3>& positions) {
    Topology topology;
    topology.charge = connectivity.charge;
    topology.type.assign(topology.charge.size(), 0);
    for (const auto& [a, b] : connectivity.bonds) topology.bonds.push_back({a, b, 0, 1});
    topology.exclusions = build_exclusions(topology.bonds, topology.size());
    topology.lennard_jones = build_lennard_jones_table(std::vector<LennardJonesType>{{0, 1}}, {});
    topology.lennard_jones14 = topology.lennard_jones;
    const NonbondedSettings settings{.dielectric = 1.5, .distance_dielectric = true};
    std::vector<Vec3> forces(positions.size(), Vec3::Zero());
    return add_nonbonded_forces(topology, settings, positions, forces).electrostatic +
           add_nonbonded14_forces(topology, settings, positions, forces).electrostatic;
}

std::vector<std::string_view> types_of(const Connectivity& connectivity) {
    return {connectivity.type.begin(), connectivity.type.end()};
}

std::vector<IonicGroup> groups_of(const Connectivity& connectivity) {
    return find_ionic_groups(connectivity.names, types_of(connectivity), connectivity.charge);
}

std::vector<std::string> charged_of(const Connectivity& connectivity) {
    return find_charged(connectivity.names, types_of(connectivity), connectivity.charge);
}

}  // namespace

TEST_CASE("with neutral charges two peptides have the energies that CHARMM prints",
          "[charmm][charges]") {
    const fs::path folder = test::in_project("tests/data/solvent-charges");
    const ForceField full =
        test::force_field_of(read_text_file(folder / "residues.rtf"), "residues.rtf");
    const ForceField neutral = neutralise_ionic_groups(full);
    const auto table = read_electrostatics(folder / "energies.csv");
    REQUIRE(table.size() == 2);
    for (const auto& [name, energy] : table) {
        INFO(name);
        const Structure structure = read_crd(folder / (name + ".crd"));
        const Connectivity connectivity = build_connectivity(neutral, structure);
        CHECK(electrostatic_energy(connectivity, structure.positions) ==
              Approx(energy).margin(0.5e-5).epsilon(0));
        CHECK(charged_of(connectivity).empty());
        CHECK(groups_of(connectivity).size() == 4);
        for (const IonicGroup& group : groups_of(connectivity)) {
            CHECK(group.is_neutral());
            CHECK(group.has_neutral_charges);
        }
        // Full charges are far from it.
        const Connectivity before = build_connectivity(full, structure);
        CHECK(std::abs(electrostatic_energy(before, structure.positions) - energy) > 10);
        for (const IonicGroup& group : groups_of(before)) {
            CHECK(group.is_full());
            CHECK_FALSE(group.has_neutral_charges);
        }
        CHECK(charged_of(before).size() == 2);
    }
}

TEST_CASE("neutral charges of CHARMM36's residues have the energies that CHARMM prints",
          "[charmm][charges][native]") {
    const auto folder = test::find_shared_data("data/energies/eef1sb");
    const auto charmm = test::find_shared_data("data/charmm");
    if (!folder || !charmm) return;
    const ForceField neutral =
        neutralise_ionic_groups(test::read_charmm(*charmm, {"top_all36_prot.rtf"}));
    const auto check = [&](const Structure& structure, double energy) {
        INFO(structure.file);
        const Connectivity connectivity = build_connectivity(neutral, structure);
        CHECK(electrostatic_energy(connectivity, structure.positions) ==
              Approx(energy).margin(0.5e-5).epsilon(0));
        CHECK(find_charged_groups(connectivity, find_charge_groups(neutral, structure, {})) ==
              std::vector<std::string>{});
    };
    const auto peptides = read_electrostatics(*folder / "tetra_energies.csv");
    CHECK(peptides.size() == 76);
    for (const auto& [name, energy] : peptides)
        check(read_pdb(*folder / "tetra" / (name + ".pdb")), energy);
    const auto proteins = read_electrostatics(*folder / "protein_energies.csv");
    CHECK(proteins.size() == 5);
    for (const auto& [name, energy] : proteins)
        check(read_crd(*folder / "proteins" / (name + ".crd")), energy);
}

TEST_CASE("templates with neutral groups are those of EEF1-SB's own file",
          "[charmm][charges][native]") {
    const auto folder = test::find_shared_data("data/energies/eef1sb");
    const auto charmm = test::find_shared_data("data/charmm");
    if (!folder || !charmm) return;
    const ForceField theirs = test::read_charmm(*folder, {"top_all36_prot_eef1sb.rtf"});
    const ForceField ours =
        neutralise_ionic_groups(test::read_charmm(*charmm, {"top_all36_prot.rtf"}));
    const auto compare = [](const Residue& a, const Residue& b) {
        REQUIRE(a.atoms.size() == b.atoms.size());
        for (std::size_t i = 0; i < a.atoms.size(); ++i) {
            INFO(a.atoms[i].name);
            CHECK(a.atoms[i].name == b.atoms[i].name);
            CHECK(a.atoms[i].type == b.atoms[i].type);
            CHECK(a.atoms[i].charge == Approx(b.atoms[i].charge).margin(1e-12));
        }
    };
    for (const char* const name :
         {"ALA", "ARG", "ASN", "ASP", "CYS", "GLN", "GLU", "GLY", "HSD", "HSE", "HSP",
          "ILE", "LEU", "LYS", "MET", "PHE", "PRO", "SER", "THR", "TRP", "TYR", "VAL"}) {
        INFO(name);
        compare(ours.residues.at(name), theirs.residues.at(name));
        CHECK(ours.residues.at(name).charge == Approx(0).margin(1e-9));
    }
    for (const char* const name : {"NTER", "GLYP", "CTER"}) {
        INFO(name);
        compare(ours.patches.at(name), theirs.patches.at(name));
    }
    // What theirs leaves charged.
    double sum = 0;
    for (const ResidueAtom& atom : theirs.patches.at("PROP").atoms) sum += atom.charge;
    CHECK(sum == Approx(1));
    for (const char* const name : {"ASPP", "GLUP", "LSN", "NNEU", "CNEU", "ACE", "CT3"}) {
        INFO(name);
        compare(ours.patches.at(name),
                test::read_charmm(*charmm, {"top_all36_prot.rtf"}).patches.at(name));
    }
    // Neutral already: nothing changes twice.
    const ForceField again = neutralise_ionic_groups(theirs);
    compare(again.residues.at("ASP"), theirs.residues.at("ASP"));
    compare(again.patches.at("NTER"), theirs.patches.at("NTER"));
}

TEST_CASE("Asp's turn about its carboxylate keeps its numbers, and NC2 with OC is combined again",
          "[charmm][charges][native]") {
    const auto folder = test::find_shared_data("data/energies/eef1sb");
    const auto charmm = test::find_shared_data("data/charmm");
    if (!folder || !charmm) return;
    const ForceField theirs = test::read_charmm(*folder, {"param_all36_eef1sb.prm"});
    const ForceField m = test::read_charmm(*charmm, {"par_all36m_prot.prm"});
    const ForceField ours = neutralise_ionic_groups(m);
    const auto row = in_order({"CT1", "CT2", "CC", "OC"});
    REQUIRE(ours.dihedrals.contains(row));
    CHECK_FALSE(m.dihedrals.contains(row));
    const auto& a = ours.dihedrals.at(row);
    const auto& b = theirs.dihedrals.at(row);
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        CHECK(a[i].k == b[i].k);
        CHECK(a[i].multiplicity == b[i].multiplicity);
        CHECK(a[i].phase_deg == b[i].phase_deg);
    }
    CHECK(m.nbfix.contains({"NC2", "OC"}));
    CHECK_FALSE(ours.nbfix.contains({"NC2", "OC"}));
    CHECK(find_backbone_term(theirs) == 0.5);  // that repository's, the authors' file has 0.5196
    CHECK(find_backbone_term(ours) == 0);
}

TEST_CASE("charge groups are whole through patches", "[charmm][charges][native]") {
    const auto charmm = test::find_shared_data("data/charmm");
    const auto crambin = test::find_shared_data("data/energies/crambin_c36m.crd");
    if (!charmm || !crambin) return;
    const ForceField full = test::read_charmm(*charmm, {"top_all36_prot.rtf"});
    const Structure structure = read_crd(*crambin);  // three disulphides
    const auto charged_before = find_charged_groups(build_connectivity(full, structure),
                                                    find_charge_groups(full, structure, {}));
    // 2 Arg, 1 Asp, 1 Glu and both ends.
    CHECK(charged_before.size() == 6);
    CHECK_THAT(charged_before.front(), Contains("N HT1 HT2 HT3 CA HA: +1.00 e"));
    const ForceField neutral = neutralise_ionic_groups(full);
    const auto groups = find_charge_groups(neutral, structure, {});
    CHECK(find_charged_groups(build_connectivity(neutral, structure), groups).empty());
    std::size_t atoms = 0;
    for (const auto& group : groups) atoms += group.size();
    CHECK(atoms == structure.names.size());
}

TEST_CASE("ionic groups of the protease are found in its files, all in full", "[charmm][charges]") {
    const Connectivity hiv = read_psf(test::in_project("scenes/hiv/system.psf"));
    std::map<std::string_view, int> count;
    double sum = 0;
    for (const IonicGroup& group : groups_of(hiv)) {
        CHECK(group.is_full());
        CHECK_FALSE(group.is_neutral());
        ++count[group.kind];
        sum += group.full_charge;
    }
    CHECK(count["PROP"] == 2);
    CHECK(count["CTER"] == 2);
    CHECK(count["NTER"] == 0);
    CHECK(sum == 7);  // as report.txt says of the whole
    const std::vector<std::string> charged = charged_of(hiv);
    REQUIRE(charged.size() == 3);
    CHECK_THAT(charged[0], Contains("PROP of A PRO 1 (+1.00 e)") && Contains(" more"));
    CHECK(charged[2] == "the total charge is +7.00 e, not 0");
}

TEST_CASE("groups with other charges than known ones stay as they are", "[charmm][charges]") {
    const ForceField field = neutralise_ionic_groups(test::force_field_of(R"(
MASS -1 C 12.0 C
MASS -1 OC 16.0 O
MASS -1 O 16.0 O
PRES CTER -1.0
ATOM C C 0.34
ATOM OT1 OC -0.67
ATOM OT2 OC -0.67
PRES ODD -0.5
ATOM C C 0.5
ATOM OT1 OC -0.5
ATOM OT2 OC -0.5
PRES ACID 0.0
ATOM C C 0.4
ATOM OT1 O -0.2
ATOM OT2 O -0.2
END
)"));
    CHECK(field.patches.at("CTER").atoms[0].charge == 1);
    CHECK(field.patches.at("CTER").charge == Approx(0).margin(1e-12));
    CHECK(field.patches.at("ODD").atoms[0].charge == 0.5);
    CHECK(field.patches.at("ACID").atoms[0].charge == 0.4);
}
