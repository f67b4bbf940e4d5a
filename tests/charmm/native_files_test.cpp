// CHARMM's own files, from text to energies: what the readers, the residues and patches and the
// parameter lookup make together, against what CHARMM and other programs print.
#include "charmm/build_topology.h"
#include "charmm/force_field.h"
#include "charmm/generate.h"
#include "core/files.h"
#include "core/text.h"
#include "forces/force_field.h"
#include "formats/crd.h"
#include "formats/pdb.h"
#include "formats/psf.h"
#include "tests/support/native_case.h"
#include "tests/support/paths.h"
#include "tests/support/reference_case.h"
#include "tests/support/shared_data.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace palpa;
namespace fs = std::filesystem;

namespace {

// The folder of the larger inputs; empty, and the test skipped, where it has none of CHARMM's
// files.
fs::path data_folder() {
    const auto charmm = test::find_shared_data("data/charmm");
    return charmm ? charmm->parent_path().parent_path() : fs::path();
}

ForceField read_c36m(const fs::path& data) {
    return test::read_charmm(data / "data/charmm", {"top_all36_prot.rtf", "par_all36m_prot.prm"});
}

struct Column {
    const char* name;
    double value;
};

// Five digits after the point, as CHARMM prints; half of the last, and what doubles round.
void check_printed(const std::vector<Column>& printed, const EnergyTerms& energy,
                   double half_digit) {
    const std::map<std::string, double> ours{
        {"bond", energy.bond},
        {"angle", energy.angle},
        {"urey_bradley", energy.urey_bradley},
        {"dihedral", energy.dihedral},
        {"improper", energy.improper},
        {"cmap", energy.cmap},
        {"vdw", energy.lj + energy.lj14},
        {"vdw_vfswitch_10_12", energy.lj + energy.lj14},
        {"elec", energy.coulomb + energy.coulomb14},
        {"elec_fshift_12", energy.coulomb + energy.coulomb14},
        {"total", energy.total()}};  // "total_no_solv" is a sum of rounded numbers
    int compared = 0;
    for (const Column& column : printed) {
        const auto found = ours.find(column.name);
        if (found == ours.end()) continue;
        INFO(column.name);
        CHECK(found->second == Approx(column.value).margin(half_digit * (1 + 1e-6)).epsilon(0));
        ++compared;
    }
    CHECK(compared >= 6);
}

// The rows of a .csv file by their first column.
std::map<std::string, std::vector<std::pair<std::string, double>>> read_table(
    const fs::path& path) {
    const std::string text = read_text_file(path);
    const auto cells = [](std::string_view line) {
        std::vector<std::string> result{""};
        for (const char letter : line) {
            if (letter == ',') {
                result.emplace_back();
            } else {
                result.back() += letter;
            }
        }
        return result;
    };
    std::map<std::string, std::vector<std::pair<std::string, double>>> table;
    std::vector<std::string> head;
    for (const std::string_view line : split_lines(text)) {
        const std::vector<std::string> row = cells(line);
        if (head.empty()) {
            head = row;
            continue;
        }
        for (std::size_t i = 1; i < row.size(); ++i) {
            table[row[0]].emplace_back(head[i], find_real(row[i]).value());
        }
    }
    return table;
}

std::vector<Column> columns(const std::vector<std::pair<std::string, double>>& row) {
    std::vector<Column> result;
    for (const auto& [name, value] : row) result.push_back({name.c_str(), value});
    return result;
}

EnergyTerms energy_of(const Topology& topology, const std::vector<Vec3>& positions,
                      const NonbondedSettings& settings) {
    std::vector<Vec3> forces(positions.size(), Vec3::Zero());
    return add_forces(topology, settings, positions, forces);
}

// Types and charges, then the energies of every frame.
void check_reference(const fs::path& folder, const std::string& name, const ForceField& force_field,
                     const GenerateSettings& settings = {}) {
    INFO(name);
    std::vector<test::ReferenceFrame> frames;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string file = entry.path().filename().string();
        if (!file.starts_with(name + ".") || file.ends_with(".ff.json") ||
            file.ends_with(".torsion.json"))
            continue;
        for (test::ReferenceFrame& frame : test::read_reference_frames(entry.path())) {
            frames.push_back(std::move(frame));
        }
    }
    REQUIRE(!frames.empty());
    test::NativeAtoms atoms = test::read_native_atoms(folder / (name + ".ff.json"));
    atoms.structure.positions = frames[0].positions;
    const test::ReferenceCase reference = test::read_reference_case(folder / (name + ".ff.json"));

    const Connectivity connectivity = build_connectivity(force_field, atoms.structure, settings);
    const Topology topology = build_topology(connectivity, force_field);

    REQUIRE(connectivity.type.size() == atoms.typed.size());
    for (std::size_t i = 0; i < atoms.typed.size(); ++i) {
        INFO(to_string(connectivity.names[i]));
        CHECK(connectivity.type[i] == atoms.typed[i].type);
        CHECK(connectivity.charge[i] == Approx(atoms.typed[i].charge).margin(1e-12));
    }
    CHECK(topology.bonds.size() == reference.topology.bonds.size());
    CHECK(topology.angles.size() == reference.topology.angles.size());
    CHECK(topology.urey_bradleys.size() == reference.topology.urey_bradleys.size());
    CHECK(topology.cmap_terms.size() == reference.topology.cmap_terms.size());
    CHECK(topology.exclusions.atoms == reference.topology.exclusions.atoms);
    CHECK(topology.exclusions.pairs14 == reference.topology.exclusions.pairs14);

    double worst = 0;
    for (const test::ReferenceFrame& frame : frames) {
        INFO("frame " << frame.name);
        const EnergyTerms energy = energy_of(
            topology, frame.positions, {.coulomb_constant = test::reference_coulomb_constant});
        const auto check = [&](const char* term, double ours) {
            INFO(term);
            const double expected = frame.energy.at(term);
            const double error = std::abs(ours - expected) / (1 + std::abs(expected));
            CHECK(error <= 1e-8);  // parameters in the file have twelve digits
            worst = std::max(worst, error);
        };
        check("bond", energy.bond);
        check("angle", energy.angle);
        check("urey", energy.urey_bradley);
        check("proper", energy.dihedral);
        // GROMACS gives the blocked alanine one improper more than CHARMM's patch CT3 does.
        if (name != "ala_dipeptide") check("improper", energy.improper);
        check("cmap", energy.cmap);
        check("lj", energy.lj);
        check("lj14", energy.lj14);
        check("coulomb", energy.coulomb);
        check("coulomb14", energy.coulomb14);
    }
    std::cout << fmt::format(
        "{}: {} bonds, {} angles, {} dihedrals, {} impropers, {} CMAP; worst "
        "energy {:.1e}\n",
        name, connectivity.bonds.size(), connectivity.angles.size(), connectivity.dihedrals.size(),
        connectivity.impropers.size(), connectivity.cmaps.size(), worst);
}

}  // namespace

TEST_CASE("a tetrapeptide typed from its part of CHARMM36m has its reference energies",
          "[charmm][native]") {
    const fs::path folder = test::test_data("");

    check_reference(folder, "tetra_aera_c36m",
                    test::read_charmm(folder / "two_peptides", {"aera_c36m.rtf", "aera_c36m.prm"}));
}

TEST_CASE("every force field file of CHARMM's that is at hand is read", "[charmm][native]") {
    const fs::path data = data_folder();
    if (data.empty()) return;
    const fs::path charmm = data / "data/charmm";
    const std::vector<std::vector<std::string>> sets{
        {"top_all36_prot.rtf", "top_all36_cgenff.rtf", "par_all36m_prot.prm",
         "par_all36_cgenff.prm", "toppar_water_ions.str", "../hiv/derived/3tl_draft.rtf",
         "../hiv/derived/3tl_draft.prm"},
        {"top_all22_prot.rtf", "par_all22_prot.prm"},
        {"older/top_all22_prot.inp", "older/par_all22_prot.inp"},
        {"older/par_all36_prot.prm", "older/toppar_water_ions.str"},
        {"../energies/eef1sb/top_all36_prot_eef1sb.rtf",
         "../energies/eef1sb/param_all36_eef1sb.prm"}};
    for (const std::vector<std::string>& set : sets) {
        INFO(set[0]);
        const ForceField force_field = test::read_charmm(charmm, set);

        CHECK(force_field.files.size() == set.size());
        // Every map is whole, and CHARMM's are 24 x 24.
        for (const auto& [types, map] : force_field.cmaps) CHECK(map.energies.size() == 576);
    }
    const ForceField all = test::read_charmm(charmm, sets[0]);
    // Counted in the files.
    CHECK(all.residues.size() == 24 + 937 + 15 + 1);
    CHECK(all.patches.size() == 24 + 96);
    CHECK(all.residues.at("CHLB").lone_pair_line == 31058);
    CHECK(all.residues.at("TRP").last_patch == "CTER");
    CHECK(all.residues.at("GLY").first_patch == "GLYP");
    CHECK(all.residues.at("PEGM").first_patch == "HYD1");
    CHECK(all.residues.at("ACO").first_patch == "NONE");
}

TEST_CASE("every residue of CHARMM36m and CGenFF alone has all of its parameters",
          "[charmm][native]") {
    const fs::path data = data_folder();
    if (data.empty()) return;
    const ForceField force_field = test::read_charmm(
        data / "data/charmm", {"top_all36_prot.rtf", "par_all36m_prot.prm", "top_all36_cgenff.rtf",
                               "par_all36_cgenff.prm", "toppar_water_ions.str"});

    std::size_t refused = 0;
    for (const auto& [name, residue] : force_field.residues) {
        INFO(name);
        if (residue.lone_pair_line != 0) {
            ++refused;
            continue;
        }
        Structure structure{.file = "one.pdb", .names = {}, .positions = {}, .lines = {}};
        for (const ResidueAtom& atom : residue.atoms) {
            structure.names.push_back({"A", name, "1", atom.name});
            structure.positions.push_back(Vec3::Zero());
            structure.lines.push_back(structure.names.size());
        }

        const Connectivity connectivity = build_connectivity(
            force_field, structure, {.segments = {{"A", "NONE", "NONE", true}}, .patches = {}});

        CHECK_NOTHROW(build_topology(connectivity, force_field));
    }
    CHECK(refused == 33);  // counted in the files
}

TEST_CASE("crambin from its coordinates has CHARMM's counts and printed energies",
          "[charmm][native]") {
    const fs::path data = data_folder();
    if (data.empty()) return;
    const ForceField force_field = read_c36m(data);
    const Structure structure = read_crd(data / "data/energies/crambin_c36m.crd");

    const Connectivity connectivity = build_connectivity(force_field, structure);

    CHECK(connectivity.bonds.size() == 652);
    CHECK(connectivity.angles.size() == 1183);
    CHECK(connectivity.dihedrals.size() == 1747);
    CHECK(connectivity.impropers.size() == 111);
    CHECK(connectivity.cmaps.size() == 44);
    const Topology topology = build_topology(connectivity, force_field);
    const EnergyTerms energy = energy_of(topology, structure.positions,
                                         {.electrostatics = ElectrostaticCutoff::ForceShift,
                                          .van_der_waals = VanDerWaalsCutoff::ForceSwitch,
                                          .switch_from = 10,
                                          .cutoff = 12});
    const auto table = read_table(data / "data/energies/crambin_energies.csv");
    check_printed(columns(table.at("CHARMM36m")), energy, 0.5e-5);
}

TEST_CASE("76 tetrapeptides and five proteins have the energies that CHARMM prints",
          "[charmm][native]") {
    const fs::path data = data_folder();
    if (data.empty()) return;
    const fs::path folder = data / "data/energies/eef1sb";
    const ForceField force_field =
        test::read_charmm(folder, {"top_all36_prot_eef1sb.rtf", "param_all36_eef1sb.prm"});
    const NonbondedSettings settings{.dielectric = 1.5, .distance_dielectric = true};
    const auto check = [&](const Structure& structure, const auto& row) {
        INFO(structure.file);
        const Topology topology =
            build_topology(build_connectivity(force_field, structure), force_field);
        check_printed(columns(row), energy_of(topology, structure.positions, settings), 0.5e-5);
    };

    const auto peptides = read_table(folder / "tetra_energies.csv");
    CHECK(peptides.size() == 76);
    for (const auto& [name, row] : peptides) {
        check(read_pdb(folder / "tetra" / (name + ".pdb")), row);
    }
    const auto proteins = read_table(folder / "protein_energies.csv");
    CHECK(proteins.size() == 5);
    for (const auto& [name, row] : proteins) {
        check(read_crd(folder / "proteins" / (name + ".crd")), row);
    }
}

TEST_CASE("an alanine peptide whose types are numbers has CHARMM's energies", "[charmm][native]") {
    const fs::path data = data_folder();
    if (data.empty()) return;
    const fs::path folder = data / "data/energies/ala_ala_ala";
    const ForceField force_field =
        test::read_charmm(data / "data/charmm/older", {"top_all22_prot.inp", "par_all22_prot.inp"});
    const Connectivity connectivity = read_psf(folder / "ala_ala_ala.psf");
    const Structure structure = read_crd(folder / "ala_ala_ala.crd");
    REQUIRE(structure.names.size() == connectivity.names.size());

    const Topology topology = build_topology(connectivity, force_field);

    const auto table = read_table(folder / "energies.csv");
    const EnergyTerms energy = energy_of(topology, structure.positions, {});
    // Four digits; "nonbonded_no_cutoff" adds two such numbers.
    check_printed(columns(table.at("CHARMM22_CMAP")), energy, 0.5e-4);
    CHECK(energy.lj + energy.lj14 + energy.coulomb + energy.coulomb14 ==
          Approx(9.2210).margin(2 * 0.5e-4).epsilon(0));
}

TEST_CASE("reference cases typed from CHARMM's files have their types, charges and energies",
          "[charmm][native]") {
    const fs::path data = data_folder();
    if (data.empty()) return;
    const fs::path folder = data / "reference";
    const fs::path charmm = data / "data/charmm";

    const ForceField c36m = read_c36m(data);
    for (const char* const name :
         {"crambin_c36m", "tetra_aera_c36m", "tetra_adka_c36m", "tetra_ampa_c36m"}) {
        check_reference(folder, name, c36m);
    }
    check_reference(folder, "hiv_tl3_c36m",
                    test::read_charmm(
                        charmm, {"top_all36_prot.rtf", "top_all36_cgenff.rtf",
                                 "par_all36m_prot.prm", "par_all36_cgenff.prm",
                                 "../hiv/derived/3tl_draft.rtf", "../hiv/derived/3tl_draft.prm"}));
    const ForceField c22 = test::read_charmm(charmm, {"top_all22_prot.rtf", "par_all22_prot.prm"});
    check_reference(folder, "ala_dipeptide", c22,
                    {.segments = {{"S1", "ACED", "CT3", true}}, .patches = {}});
    for (const char* const name : {"ubiquitin", "hiv_protease_1hpv"}) {
        check_reference(folder, name, c22);
    }
}
