#include "prepare/solvent.h"

#include "charmm/force_field.h"
#include "core/files.h"
#include "formats/crd.h"
#include "formats/psf.h"
#include "prepare/choose.h"
#include "prepare/prepare.h"
#include "tests/prepare/small_system.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;

namespace {

// What AERA needs of CHARMM36m, a water, an ion, and a ligand of one charged atom.
ForceField peptide_field() {
    const std::filesystem::path folder = test::in_project("tests/data/two_peptides");
    const std::vector<std::filesystem::path> files{folder / "aera_c36m.rtf",
                                                   folder / "aera_c36m.prm"};
    ForceField field = read_force_field(files);
    parse_force_field(R"(read rtf card append
36 1
MASS -1 SOD 22.98977 NA
MASS -1 OT 15.9994 O
MASS -1 HT 1.008 H
RESI SOD 1.0
ATOM SOD SOD 1.0
PATCHING FIRS NONE LAST NONE
RESI NEG -1.0
ATOM O1 OC -1.0
ATOM C1 CC 0.0
BOND O1 C1
PATCHING FIRS NONE LAST NONE
RESI TIP3 0.0 NOANG NODIH
ATOM OH2 OT -0.834
ATOM H1 HT 0.417
ATOM H2 HT 0.417
BOND OH2 H1 OH2 H2
PATCHING FIRS NONE LAST NONE
END
read para card append
BONDS
OT HT 450.0 0.9572
NONBONDED
SOD 0.0 -0.0469 1.41075
OT 0.0 -0.1521 1.7682
HT 0.0 -0.046 0.2245
END
)",
                      "more.str", field);
    return field;
}

Structure peptide() { return read_crd(test::in_project("tests/data/solvent-charges/aera.crd")); }

void add(Structure& structure, const std::string& chain, const std::string& residue,
         const std::string& number, const std::string& atom, const Vec3& place) {
    structure.names.push_back({chain, residue, number, atom});
    structure.positions.push_back(place);
    structure.lines.push_back(structure.names.size());
}

void add_water(Structure& structure, const std::string& number, double x) {
    add(structure, "X", "TIP3", number, "OH2", {x, 0, 20});
    add(structure, "X", "TIP3", number, "H1", {x + 0.76, 0.59, 20});
    add(structure, "X", "TIP3", number, "H2", {x - 0.76, 0.59, 20});
}

PreparedSystem prepared(const Structure& structure, PrepareSettings settings) {
    settings.relaxes = false;
    return prepare_system(peptide_field(), structure, settings, {});
}

PrepareSettings with(std::optional<Solvent> solvent) {
    PrepareSettings settings;
    settings.solvent = solvent;
    return settings;
}

double charge_of(const PreparedSystem& system, const std::string& number, const std::string& atom) {
    for (std::size_t i = 0; i < system.connectivity.names.size(); ++i) {
        const AtomName& name = system.connectivity.names[i];
        if (name.number == number && name.atom == atom) return system.connectivity.charge[i];
    }
    return std::nan("");
}

}  // namespace

TEST_CASE("without a word of a solvent a system is prepared as for vacuum", "[prepare][solvent]") {
    const PreparedSystem system = prepared(peptide(), {});
    CHECK(system.solvent == Solvent::None);
    CHECK_FALSE(system.topology.solvation);
    CHECK(charge_of(system, "3", "CZ") == 0.64);
    CHECK(system.parameters.nbfix.size() == 1);
    CHECK_THAT(system.report.to_text(), !Contains("Solvent"));
    CHECK(topology_title(system, "a\nb") == "a\nb");
}

TEST_CASE("with EEF1-SB ionic groups are neutral, and all of it is told", "[prepare][solvent]") {
    const PreparedSystem system = prepared(peptide(), with(Solvent::Eef1Sb));
    CHECK(system.solvent == Solvent::Eef1Sb);
    // Arg 3, Glu 2, and both ends.
    const std::map<std::pair<std::string, std::string>, double> expected{
        {{"3", "CZ"}, -0.20}, {{"3", "NH1"}, -0.121}, {{"3", "HH22"}, 0.2005}, {{"2", "CD"}, 1.0},
        {{"2", "OE1"}, -0.5}, {{"2", "HG1"}, 0.14},   {{"1", "N"}, -0.9},      {{"1", "HT3"}, 0.3},
        {{"1", "CA"}, 0},     {{"4", "OT2"}, -0.5},   {{"4", "C"}, 1.0},       {{"2", "CB"}, -0.18},
        {{"2", "N"}, -0.47}};
    for (const auto& [where, charge] : expected) {
        INFO(where.first << ' ' << where.second);
        CHECK(charge_of(system, where.first, where.second) == charge);
    }
    double sum = 0;
    for (const double q : system.topology.charge) sum += q;
    CHECK(std::abs(sum) < 1e-9);
    REQUIRE(system.topology.solvation);
    CHECK(system.topology.solvation->volume.size() == system.topology.size());
    CHECK(std::ranges::count(system.topology.solvation->lambda, 6.0) == 8);  // N, 3 N, 2 O, 2 O
    CHECK(system.parameters.nbfix.empty());

    const std::string report = system.report.to_text();
    CHECK_THAT(report, Contains("implicit water, EEF1-SB, as requested"));
    CHECK_THAT(report, Contains("ARG neutral, not +1 e (1): A 3\n"));
    CHECK_THAT(report, Contains("GLU neutral, not -1 e (1): A 2\n"));
    CHECK_THAT(report, Contains("NTER neutral, not +1 e (1): A 1\n"));
    CHECK_THAT(report, Contains("CTER neutral, not -1 e (1): A 4\n"));
    CHECK_THAT(report, Contains("charge groups, all neutral"));
    CHECK_THAT(report, Contains("charge +0.00 e") || Contains("charge -0.00 e"));
    CHECK_THAT(report, Contains("NBFIX of NC2 and OC: switched off"));
    CHECK_THAT(report,
               Contains("left out: the parameter files do not have it; EEF1-SB with CHARMM36m"));

    const std::string psf = format_psf(system.connectivity, topology_title(system, "title"));
    CHECK_THAT(psf, Contains(" REMARKS Charges: EEF1-SB, every ionic group neutral;"));
    CHECK_THAT(psf, Contains(" REMARKS title\n"));
    CHECK(parse_psf(psf, "a.psf").charge == system.connectivity.charge);
}

TEST_CASE("coordinates are the same with and without a solvent", "[prepare][solvent]") {
    PrepareSettings settings;
    const auto places = [&](std::optional<Solvent> solvent) {
        settings.solvent = solvent;
        return prepare_system(peptide_field(), peptide(), settings, {}).structure.positions;
    };
    const std::vector<Vec3> vacuum = places(Solvent::None), water = places(Solvent::Eef1Sb);
    CHECK(vacuum == water);
    CHECK(vacuum != peptide().positions);  // relaxing moves them
}

TEST_CASE("left open, the solvent is EEF1-SB where it covers everything", "[prepare][solvent]") {
    const PreparedSystem covered = prepared(peptide(), with({}));
    CHECK(covered.solvent == Solvent::Eef1Sb);
    CHECK_THAT(covered.report.to_text(),
               Contains("implicit water, EEF1-SB, because it covers every atom type"));

    Structure with_ion = peptide();
    add(with_ion, "I", "SOD", "1", "SOD", {0, 0, 20});
    const PreparedSystem ion = prepared(with_ion, with({}));
    CHECK(ion.solvent == Solvent::None);
    CHECK_FALSE(ion.topology.solvation);
    CHECK(charge_of(ion, "3", "CZ") == 0.64);
    CHECK_THAT(
        ion.report.to_text(),
        Contains("none (vacuum), because EEF1-SB has no parameters for a type of atoms: SOD ("));

    Structure with_water = peptide();
    add_water(with_water, "1", 0);
    const PreparedSystem dropped = prepared(with_water, with({}));
    CHECK(dropped.solvent == Solvent::Eef1Sb);
    CHECK(dropped.structure.names.size() == covered.structure.names.size());
    CHECK_THAT(dropped.report.to_text(), Contains("left out 1 waters"));
    PrepareSettings keeping = with({});
    keeping.keeps_waters = true;
    const PreparedSystem kept = prepared(with_water, keeping);
    CHECK(kept.solvent == Solvent::None);
    CHECK_THAT(kept.report.to_text(),
               Contains("none (vacuum), because the system has explicit waters"));
}

TEST_CASE("EEF1-SB that was asked for and cannot be is refused with what to do",
          "[prepare][solvent]") {
    const auto error = [](const Structure& structure, const PrepareSettings& settings) {
        return load_error_of([&] { (void)prepared(structure, settings); });
    };
    Structure with_ion = peptide();
    add(with_ion, "I", "SOD", "1", "SOD", {0, 0, 20});
    CHECK_THAT(error(with_ion, with(Solvent::Eef1Sb)),
               Contains("SOD (") && Contains("--no-ions") && Contains("--solvent none"));
    PrepareSettings without_ions = with(Solvent::Eef1Sb);
    without_ions.keeps_ions = false;
    CHECK(prepared(with_ion, without_ions).solvent == Solvent::Eef1Sb);

    Structure with_ligand = peptide();
    add(with_ligand, "L", "NEG", "9", "O1", {0, 0, 20});
    add(with_ligand, "L", "NEG", "9", "C1", {1.25, 0, 20});
    CHECK_THAT(error(with_ligand, with(Solvent::Eef1Sb)),
               Contains("has no charges for") && Contains("NEG 9, O1 C1: -1.00 e"));

    Structure with_water = peptide();
    add_water(with_water, "1", 0);
    PrepareSettings keeping = with(Solvent::Eef1Sb);
    keeping.keeps_waters = true;
    CHECK_THAT(error(with_water, keeping),
               Contains("count twice") && Contains("--structural-water"));
}

TEST_CASE("a structural water stays, and counts for nothing", "[prepare][solvent]") {
    Structure structure = peptide();
    add_water(structure, "1", 0);
    add_water(structure, "2", 10);
    PrepareSettings settings = with(Solvent::Eef1Sb);
    settings.structural_waters = {{"X", "2"}};
    const PreparedSystem system = prepared(structure, settings);
    CHECK(system.structure.names.size() == peptide().names.size() + 3);
    REQUIRE(system.topology.solvation);
    CHECK(system.topology.solvation->volume.end()[-3] == 0);
    CHECK(system.topology.solvation->dg_ref.end()[-3] == 0);
    CHECK(system.topology.charge.end()[-3] == -0.834);
    CHECK_THAT(system.report.to_text(),
               Contains("structural waters, as requested: 1,") && Contains("left out 1 waters"));
    settings.structural_waters = {{"X", "3"}};
    CHECK_THAT(load_error_of([&] { (void)prepared(structure, settings); }),
               Contains("--structural-water X:3: no water there"));
}

TEST_CASE("the backbone's term is told where parameter files have it", "[prepare][solvent]") {
    ForceField field = peptide_field();
    field.dihedrals[in_order({"CT1", "CT1", "C", "NH1"})] = {{0.519574473371, 1, -103, {}}};
    PrepareSettings settings = with(Solvent::Eef1Sb);
    settings.relaxes = false;
    const PreparedSystem system = prepare_system(field, peptide(), settings, {});
    CHECK_THAT(system.report.to_text(),
               Contains("Cβ-Cα-C-N, 0.519574473371 kcal/mol, is in the parameter files"));
}
