#include "prepare/scene_of.h"

#include "scene/read_scene.h"
#include "tests/prepare/small_system.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::StructureWriter;

namespace {

// A chain of ten residues along x, a ligand beside its third, a water and an ion.
struct Complex {
    Structure structure;
    std::vector<SystemSegment> segments;

    Complex() {
        StructureWriter writer;
        for (int i = 0; i < 10; ++i) writer.backbone("ALA", "A", i + 1, 4.0 * i);
        for (int i = 0; i < 4; ++i) {
            writer.atom("LIG", "L", 1, "C" + std::to_string(i), {10.0 + i, 5, 0}, "C");
        }
        writer.atom("TIP3", "W", 1, "OH2", {0, 9, 0}, "O");
        writer.atom("SOD", "I", 1, "SOD", {0, 15, 0}, "NA");
        structure = writer.structure();
        Connectivity connectivity;
        for (std::uint32_t i = 1; i < 44; ++i) {
            if (i != 40) connectivity.bonds.push_back({i - 1, i});
        }
        segments = find_segments(structure, connectivity);
    }

    std::string scene(const std::string& grab, const SceneTuning& tuning,
                      const Vec3& way = Vec3::UnitX(), Solvent solvent = Solvent::None) const {
        SceneText text{"t", "a", "m"};
        text.solvent = solvent;
        return format_scene(structure, segments, choose_hand(structure, segments, grab), way, text,
                            tuning);
    }
};

// Of a table, up to the next one.
std::string section(const std::string& scene, const std::string& name) {
    const std::size_t from = scene.find("[" + name + "]");
    REQUIRE(from != std::string::npos);
    return scene.substr(from, scene.find("\n\n", from) - from);
}

}  // namespace

TEST_CASE("a prepared scene moves molecules and holds waters and ions", "[prepare][scene]") {
    const std::string scene = Complex().scene("", {});
    CHECK_THAT(section(scene, "molecules.\"A\""),
               Contains("shape = \"flexible\"") && !Contains("motion"));
    CHECK_THAT(section(scene, "molecules.\"L\""),
               Contains("shape = \"flexible\"\nmotion = \"translate-and-turn\""));
    CHECK_THAT(section(scene, "molecules.\"W\""), !Contains("shape"));
    CHECK_THAT(section(scene, "molecules.\"I\""), !Contains("shape"));
    CHECK_THAT(section(scene, "grab"),
               Contains("molecule = \"L\"\nmeasured_from = \"A\"") && !Contains("atom"));
    CHECK_THAT(scene, !Contains("mode ="));  // guarded, which is the default
}

TEST_CASE("a prepared scene says its solvent, and nothing of it in vacuum", "[prepare][scene]") {
    const std::string vacuum = Complex().scene("", {});
    CHECK_THAT(vacuum, !Contains("solvent") && !Contains("structural_water"));
    const std::string scene = Complex().scene("", {}, Vec3::UnitX(), Solvent::Eef1Sb);
    CHECK_THAT(section(scene, "force_field"), Contains("solvent = \"eef1-sb\""));
    CHECK_THAT(section(scene, "molecules.\"W\""), Contains("structural_water = true"));
    CHECK_THAT(section(scene, "molecules.\"A\""), !Contains("structural_water"));
}

TEST_CASE("what is on a spring is away from the base of its molecule", "[prepare][scene]") {
    const Complex complex;
    // The middle is between residues 5 and 6, 16 Å from the first; of the sixth it is a neighbour,
    // and the farthest heavy atom is then at the chain's other end.
    std::string scene = complex.scene("A:1", {});
    CHECK_THAT(section(scene, "grab"), Contains("measured_from = \"A\"\natom = \"1\""));
    CHECK_THAT(section(scene, "molecules.\"A\""),
               Contains("reference_atom = \"5 ") || Contains("reference_atom = \"6 "));
    CHECK_THAT(section(complex.scene("A:6", {}), "molecules.\"A\""),
               Contains("reference_atom = \"1 "));
}

TEST_CASE("the hand leads along the way, and what was measured is in the file",
          "[prepare][scene]") {
    const Complex complex;
    const std::string first = complex.scene("", {}, {0, 0.6, 0.8});
    CHECK_THAT(section(first, "hand"),
               Contains("[0.5, 0.000, 0.000, 0.000], [3, 0.000, 2.400, 3.200]"));
    CHECK_THAT(section(first, "coupling"), Contains("force_law = \"constant\""));
    SceneTuning tuning;
    tuning.feel_pN = {{120, 3600}};
    tuning.period_ms = 7;
    tuning.relax_steps = 0;
    tuning.period_note = "measured";
    const std::string tuned = complex.scene("", tuning);
    CHECK_THAT(section(tuned, "coupling"),
               Contains("feel_pN = [120, 3600]") && !Contains("force_law"));
    CHECK_THAT(section(tuned, "run"), Contains("# measured\nperiod_ms = 7\n"));
    CHECK_THAT(section(tuned, "statics"), Contains("relax_steps = 0"));
}

TEST_CASE("of a large system the scene shows what is in the hand, and moves what is around it",
          "[prepare][scene]") {
    const Complex complex;
    CHECK_THAT(complex.scene("", {}), !Contains("[joints]") && !Contains("[view]"));
    SceneTuning tuning;
    tuning.region_angstrom = 12;
    tuning.region_note = "Few.";
    CHECK_THAT(section(complex.scene("", tuning), "joints"),
               Contains("# Few.\nregion_angstrom = 12"));

    Complex large;
    StructureWriter writer;
    for (int i = 0; i < 101; ++i) writer.backbone("ALA", "B", i + 1, 4.0 * i);
    const auto join = [&](const Structure& other) {
        large.structure.names.insert(large.structure.names.end(), other.names.begin(),
                                     other.names.end());
        large.structure.positions.insert(large.structure.positions.end(), other.positions.begin(),
                                         other.positions.end());
        large.structure.records.insert(large.structure.records.end(), other.records.begin(),
                                       other.records.end());
        large.structure.lines.resize(large.structure.names.size());
    };
    join(writer.structure());
    CHECK_THAT(section(large.scene("", {}), "view"), Contains("representation = \"pocket\""));
    CHECK_THAT(section(large.scene("A:3", {}), "view"), Contains("representation = \"pocket\""));
}

TEST_CASE("names with odd letters read as they were written", "[prepare][scene]") {
    const test::TemporaryFolder folder;
    for (const char* const name : {"system.prm", "relaxed.crd", "system.psf"}) {
        folder.add_file(name, "");
    }
    const std::string odd = "\" \\ \t\x1b\x7f \u0085 \u200b \u00c5 \u6c34";
    Complex complex;
    complex.segments[1].name = odd;
    const HandChoice hand = choose_hand(complex.structure, complex.segments, "");
    REQUIRE(hand.segment == odd);

    const SceneDescription read =
        parse_scene(format_scene(complex.structure, complex.segments, hand, Vec3::UnitX(),
                                 {"title " + odd, "about " + odd, "made by " + odd}, {}),
                    folder.path() / "scene.toml");

    CHECK(read.title == "title " + odd);
    CHECK(read.about == "about " + odd);
    CHECK(read.made_by == "made by " + odd);
    CHECK(read.hands.front().grab.molecule == odd);
    CHECK(std::ranges::count(read.molecules, odd, &MoleculeDescription::name) == 1);
    CHECK(std::ranges::count(read.molecules, odd, &MoleculeDescription::segment) == 1);
}
