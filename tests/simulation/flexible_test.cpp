#include "simulation/mechanics.h"

#include "charmm/generate.h"
#include "core/files.h"
#include "core/units.h"
#include "formats/crd.h"
#include "formats/psf.h"
#include "formats/structure.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "simulation/step.h"
#include "simulation/systems/follow_hands.h"
#include "tests/support/held_scene.h"
#include "tests/support/load_error_of.h"
#include "tests/support/native_case.h"
#include "tests/support/paths.h"
#include "tests/support/replaced.h"
#include "tests/support/step_once.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;

namespace {

constexpr std::uint32_t peptide_atoms = 62;

// The tetrapeptide AERA twice, 11 Å apart.
const std::filesystem::path peptides = test::test_data("two_peptides");

World load_peptides(const std::vector<std::string>& settings = {}) {
    return load_world(read_scene(peptides, settings));
}

Structure read_peptides() { return read_structure(peptides / "both.crd"); }

Connectivity connectivity_of(const Structure& structure) {
    return build_connectivity(test::read_charmm(peptides, {"aera_c36m.rtf", "aera_c36m.prm"}),
                              structure);
}

// The same scene in a folder of its own, to be changed.
class ChangedPeptides {
public:
    ChangedPeptides() : ChangedPeptides(read_peptides(), connectivity_of(read_peptides())) {}
    ChangedPeptides(const Structure& structure, const Connectivity& connectivity) {
        folder_.add_file("both.crd", format_crd(structure, "two peptides"));
        folder_.add_file("both.psf", format_psf(connectivity, "two peptides"));
        folder_.add_file("scene.toml", text());
        for (const char* const name : {"aera_c36m.rtf", "aera_c36m.prm"})
            std::filesystem::copy_file(peptides / name, folder_.path() / name);
    }

    static std::string text() { return read_text_file(peptides / "scene.toml"); }
    SceneDescription scene(const std::vector<std::string>& settings = {}) const {
        return read_scene(folder_.path(), settings);
    }
    const test::TemporaryFolder& folder() const { return folder_; }

private:
    test::TemporaryFolder folder_;
};

// A handle that travelled so that the molecule goes by that much.
HandPose hand_at(const Vec3& angstrom) {
    HandPose hand;
    hand.travel_m = angstrom * 0.25e9 * 1e-10;
    return hand;
}

std::size_t reference_of(const World& world) {
    return world.find<Molecule>(grip_of(world, hand_at(world, 0)).molecule)->reference_atom;
}

Vec3 place_of(const World& world) { return grip_of(world, hand_at(world, 0)).pose.place_angstrom; }

const std::vector<std::string> methods{"quasi-static", "second-order"};
const std::vector<std::string> by_spring{"molecules.held.motion=free", "grab.atom=\"4 CB\"",
                                         "grab.spring_kcal_per_mol_angstrom2=7"};

}  // namespace

TEST_CASE("flexible molecules are at rest when the scene begins", "[simulation][flexible]") {
    const World world = load_peptides();
    REQUIRE(has_mobile(world));

    // Of each: ammonium and psi; phi, psi and chi 1 to 3; phi, psi and chi 1 to 5; phi, and psi of
    // the carboxylate.
    constexpr std::size_t of_each = 2 + 5 + 7 + 2;
    CHECK(world.resource<StartReport>().joints == 2 * of_each);
    CHECK(world.resource<StartReport>().joints_held == 0);
    CHECK(model_of(world).coordinates ==
          static_cast<Eigen::Index>(world.resource<StartReport>().joints));
    CHECK(world.resource<StartReport>().joints_at_rest.value().end == RelaxEnd::Converged);
    CHECK(world.resource<StartReport>().joints_at_rest.value().rms_force <= 0.05);
    CHECK(world.resource<StartReport>().joints_at_rest.value().energy_after <
          world.resource<StartReport>().joints_at_rest.value().energy_before);
    CHECK(world.resource<AtomTable>().positions == world.resource<TorsionState>().positions);
    CHECK(held_place(world, hand_at(world, 0)) ==
          world.resource<AtomTable>().positions[reference_of(world)]);
    // The hand's own molecule came to rest as well; then the hand took its base.
    CHECK(contact_at(world, 0).model.force_newton.norm() < 50e-12);
}

TEST_CASE("the system of a scene has its atoms in the order of the table, and all terms",
          "[simulation][load]") {
    const SceneSystem system = load_system(read_scene(peptides, {}));
    const World world = load_peptides({"statics.relax_steps=0"});

    REQUIRE(has_mobile(world));
    REQUIRE(system.connectivity.names.size() == std::size_t{2} * peptide_atoms);
    CHECK(system.connectivity.names[0].segment == world.resource<AtomTable>().names[0].segment);
    CHECK(system.connectivity.mass == world.resource<AtomTable>().mass);
    CHECK(system.topology.charge == world.resource<AtomTable>().charge);
    CHECK(system.positions == model_of(world).reference);
    // What is rigid in the scene is there too.
    CHECK(system.topology.bonds.size() == connectivity_of(read_peptides()).bonds.size());
    CHECK(system.topology.bonds.size() > model_of(world).topology.bonds.size());
}

TEST_CASE("without joints to turn and bases to move a scene stays rigid",
          "[simulation][flexible]") {
    const World world =
        load_peptides({"molecules.held.shape=rigid", "molecules.resting.shape=rigid"});

    CHECK_FALSE(has_mobile(world));
    CHECK(world.resource<StartReport>().rigid);
}

TEST_CASE("while the hand rests the energy falls with every step", "[simulation][flexible]") {
    World world =
        load_peptides({"statics.method=quasi-static", "hand.start_offset_angstrom=[-1.5, 0, 0]"});
    ContactModel felt = contact_at(world, 0).model;
    double energy = world.resource<TorsionState>().energy(), fallen = 0;

    for (int i = 0; i < 25; ++i) {
        const Vec3 held = held_place(world, hand_at(world, 0));
        const StepReport& report = step_world(world, {}, felt);
        REQUIRE(report.relaxed);
        const RelaxStepReport& relaxed = *report.relaxed;

        CHECK(report.finite);
        // What the start did to the energy shows in the first step.
        if (i > 0) CHECK(std::abs(relaxed.hand_work) < 1e-9);
        CHECK(relaxed.energy_change <= 0);
        CHECK(world.resource<TorsionState>().energy() - energy ==
              Approx(relaxed.hand_work + relaxed.energy_change).margin(1e-9));
        CHECK(relaxed.evaluations > 0);
        CHECK((held_place(world, hand_at(world, 0)) - held).norm() < 1e-12);
        energy = world.resource<TorsionState>().energy();
        fallen -= relaxed.energy_change;
        felt = contact_at(world, 0).model;
    }
    CHECK(fallen > 0.01);
}

TEST_CASE("work of the hand and what is given up add to the change of energy",
          "[simulation][flexible]") {
    std::vector<std::string> settings{"statics.method=quasi-static"};
    if (GENERATE(false, true)) settings.insert(settings.end(), by_spring.begin(), by_spring.end());
    World world = load_peptides(settings);
    ContactModel felt = contact_at(world, 0).model;
    const double start = world.resource<TorsionState>().energy();
    double sum = 0;

    for (int i = 1; i <= 20; ++i) {
        const StepReport& report = step_world(world, hand_at(Vec3(-0.1 * i, 0.03 * i, 0)), felt);
        CHECK(report.relaxed->energy_change <= 0);
        sum += report.relaxed->hand_work + report.relaxed->energy_change;
        CHECK(world.resource<TorsionState>().energy() == Approx(start + sum).margin(1e-8));
        felt = contact_at(world, 0).model;
    }
    CHECK(std::abs(sum) > 0.1);
}

TEST_CASE("what the hand moves is the base, and nobody else", "[simulation][flexible]") {
    World world = load_peptides();
    const std::vector<Vec3> before = world.resource<AtomTable>().positions;
    const Vec3 place = place_of(world), held = held_place(world, hand_at(world, 0));
    const Vec3 by(-0.2, 0.1, 0.05);

    const AtomRange in_hand = held_range(world, hand_at(world, 0));
    REQUIRE(in_hand.count == peptide_atoms);
    move_held(world, by);
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Vec3 moved = world.resource<TorsionState>().positions[i] - before[i];
        CHECK((moved - (has_atom(in_hand, i) ? by : Vec3(Vec3::Zero()))).norm() < 1e-13);
    }
    move_held(world, -by);

    const StepReport& report = step_world(world, hand_at(by), contact_at(world, 0).model);
    CHECK(report.moves.front().angstrom == Approx(by.norm()));
    CHECK((place_of(world) - place - by).norm() < 1e-12);
    CHECK((held_place(world, hand_at(world, 0)) - held - by).norm() < 1e-12);
    // The base of the other one is fixed: so is its reference atom.
    const Grip& grip = grip_of(world, hand_at(world, 0));
    const std::size_t fixed = world.find<Molecule>(grip.measured_from)->reference_atom;
    CHECK((world.resource<AtomTable>().positions[fixed] - before[fixed]).norm() < 1e-12);
}

TEST_CASE("wherever what is held stands in the table, each atom feels the same",
          "[simulation][flexible]") {
    std::vector<std::string> settings{"statics.pairs=double", "statics.relax_steps=0",
                                      "hand.start_offset_angstrom=[-1, 0.5, 0]"};
    if (GENERATE(false, true)) settings.emplace_back("statics.cutoff_angstrom=9");
    const SceneDescription scene = read_scene(peptides, settings);
    const World first = load_world(test::with_held_at(0, scene)),
                last = load_world(test::with_held_at(1, scene));
    const TorsionState& expected = last.resource<TorsionState>();
    const TorsionState& found = first.resource<TorsionState>();
    REQUIRE(first.resource<AtomTable>().names[0].segment == "PEPB");
    REQUIRE(last.resource<AtomTable>().names[0].segment == "PEPA");

    double largest = 0;
    for (const Vec3& force : expected.forces) largest = std::max(largest, force.norm());
    for (const char* const name : {"held", "resting"}) {
        const std::uint32_t from = test::range_called(first, name).first,
                            to = test::range_called(last, name).first;
        for (std::uint32_t i = 0; i < peptide_atoms; ++i) {
            REQUIRE(found.positions[from + i] == expected.positions[to + i]);
            CHECK((found.forces[from + i] - expected.forces[to + i]).norm() < 1e-12 * largest);
        }
    }
    CHECK(found.energy() == Approx(expected.energy()).epsilon(1e-12));
    const Vec6 pull = find_pull_on_held(last, hand_at(last, 0));
    REQUIRE(pull.tail<3>().norm() > 1e-3 * largest);
    CHECK((find_pull_on_held(first, hand_at(first, 0)) - pull).norm() < 1e-9 * pull.norm());
}

TEST_CASE("a molecule that turns by itself does so about its reference atom",
          "[simulation][flexible]") {
    const std::string method = GENERATE(from_range(methods));
    INFO(method);
    World world = load_peptides(
        {"statics.method=" + method, "molecules.held.motion=translate-and-turn",
         "molecules.held.shape=rigid", "molecules.resting.shape=rigid", "statics.steps=20"});
    CHECK(world.resource<StartReport>().joints == 0);
    REQUIRE(model_of(world).coordinates == 3);
    ContactModel felt = contact_at(world, 0).model;
    CHECK(felt.active_freedom == 6);

    // The other end of the molecule comes too close, and gives way.
    for (int i = 1; i <= 10; ++i) {
        const StepReport& report = step_world(world, hand_at({-0.3 * i, 0, 0}), felt);
        CHECK((held_place(world, hand_at(world, 0)) - grip_of(world, hand_at(world, 0)).anchor -
               place_of(world))
                  .norm() < 1e-12);
        CHECK(report.relaxed->energy_change <= 0);
        felt = contact_at(world, 0).model;
    }
    CHECK(Eigen::AngleAxisd(world.resource<TorsionState>().turns[held_part(world).base]).angle() >
          0.01);
    CHECK(world.resource<TorsionState>().turns[1 - held_part(world).base].isApprox(
        Eigen::Quaterniond::Identity()));
}

TEST_CASE("a spring pulls at the hand with k times its stretch", "[simulation][flexible]") {
    std::vector<std::string> settings = by_spring;
    const bool is_residue = GENERATE(false, true);
    if (is_residue) settings[1] = "grab.atom=\"4\"";
    World world = load_peptides(settings);
    // By hand, of residue 4 or its CB.
    const auto tethered = [&] {
        Vec3 sum = Vec3::Zero();
        double mass = 0;
        for (std::size_t i = 0; i < world.resource<AtomTable>().size(); ++i) {
            const AtomName& name = world.resource<AtomTable>().names[i];
            if (name.segment != "PEPB") continue;
            if (name.number != "4" || (!is_residue && name.atom != "CB")) continue;
            sum += world.resource<AtomTable>().mass[i] * world.resource<AtomTable>().positions[i];
            mass += world.resource<AtomTable>().mass[i];
        }
        return Vec3(sum / mass);
    };
    CHECK(spring_of(world, hand_at(world, 0))->atoms.size() == (is_residue ? 11 : 1));
    CHECK((held_place(world, hand_at(world, 0)) - tethered()).norm() < 1e-12);
    const Vec3 start = tethered();
    ContactModel felt = contact_at(world, 0).model;
    CHECK(felt.force_newton.norm() < 1e-20);
    CHECK(felt.active_freedom == 3 + static_cast<int>(world.resource<StartReport>().joints) + 6);

    for (int i = 1; i <= 15; ++i) {
        felt = test::step_once(world, hand_at({0.2 * i, 0, 0}), felt);
        const Vec3 stretch = tethered() - (start + Vec3(0.2 * i, 0, 0));
        CHECK((felt.force_newton - 7 * stretch * units::newton_per_kcal_per_mol_angstrom).norm() <
              1e-9 * felt.force_newton.norm());
        CHECK(felt.force_newton.x() < 0);
    }
    CHECK(felt.stiffness_N_per_m == Approx(7 * units::newton_per_metre_per_kcal_per_mol_angstrom2));
    CHECK(felt.potential_kcal_per_mol == Approx(world.resource<TorsionState>().energy()));
    // It follows.
    CHECK((tethered() - start).x() > 0.1);
}

TEST_CASE("anchors pull at the hand from where the file has their atoms",
          "[simulation][flexible]") {
    // So far from the other molecule that nothing else acts.
    const World world =
        load_peptides({"molecules.held.anchors=[\"2 CA\", \"4\"]",
                       "molecules.held.anchor_kcal_per_mol_angstrom2=0.03",
                       "hand.start_offset_angstrom=[20, 0, 0]", "statics.cutoff_angstrom=10"});
    const Structure file = read_peptides();
    const AtomTable& atoms = world.resource<AtomTable>();
    // Of atom CA of residue 2, and all of residue 4, by hand.
    Vec3 pull = Vec3::Zero();
    for (const bool is_residue : {false, true}) {
        Vec3 then = Vec3::Zero(), now = Vec3::Zero();
        double mass = 0;
        for (std::size_t i = 0; i < atoms.size(); ++i) {
            const AtomName& name = atoms.names[i];
            const bool is_one =
                is_residue ? name.number == "4" : name.number == "2" && name.atom == "CA";
            if (name.segment != "PEPB" || !is_one) continue;
            const auto same = [&](const AtomName& other) {
                return other.segment == name.segment && other.number == name.number &&
                       other.atom == name.atom;
            };
            const auto there = std::ranges::find_if(file.names, same) - file.names.begin();
            then += atoms.mass[i] * file.positions[static_cast<std::size_t>(there)];
            now += atoms.mass[i] * atoms.positions[i];
            mass += atoms.mass[i];
        }
        pull += 0.03 * (then - now) / mass;
    }
    const Vec3 felt = contact_at(world, 0).model.force_newton;
    CHECK(pull.norm() > 1);
    CHECK((felt - pull * units::newton_per_kcal_per_mol_angstrom).norm() < 1e-9 * felt.norm());
}

TEST_CASE("loading relaxes what anchors leave free", "[simulation][flexible]") {
    const Structure file = read_peptides();
    // How far the farthest alpha carbon of the molecule in the hand is from where the file has it.
    const auto way = [&](const std::vector<std::string>& settings) {
        const World world = load_peptides(settings);
        const AtomTable& atoms = world.resource<AtomTable>();
        double farthest = 0;
        for (std::size_t i = 0; i < atoms.size(); ++i) {
            if (atoms.names[i].segment != "PEPB" || atoms.names[i].atom != "CA") continue;
            const auto same = [&](const AtomName& other) {
                return other.segment == "PEPB" && other.number == atoms.names[i].number &&
                       other.atom == "CA";
            };
            const auto there = std::ranges::find_if(file.names, same) - file.names.begin();
            const Vec3& then = file.positions[static_cast<std::size_t>(there)];
            farthest = std::max(farthest, (atoms.positions[i] - then).norm());
        }
        return farthest;
    };
    CHECK(way({}) > 0.5);
    CHECK(way({"molecules.held.anchors=[\"1 CA\", \"2 CA\", \"3 CA\", \"4 CA\"]",
               "molecules.held.anchor_kcal_per_mol_angstrom2=10000"}) < 0.05);
}

TEST_CASE("anchors that are not there are refused", "[simulation][flexible][errors]") {
    const std::string error =
        load_error_of([] { load_peptides({"molecules.resting.anchors=[\"2 CA\", \"7 CA\"]"}); });
    CHECK_THAT(error, Contains("'resting' has no atom or residue \"7 CA\"; expected"));
    // Of what does not move they do nothing.
    const auto felt = [](std::vector<std::string> settings) {
        settings.emplace_back("molecules.resting.shape=rigid");
        return contact_at(load_peptides(settings), 0).model.force_newton;
    };
    CHECK(felt({"molecules.resting.anchors=[\"2 CA\"]"}) == felt({}));
}

TEST_CASE("joints outside of a region are held, and counted", "[simulation][flexible]") {
    const World everywhere = load_peptides();
    const std::string around = GENERATE("", "resting");
    const World world =
        load_peptides({"joints.within_angstrom=5", fmt::format("joints.around=\"{}\"", around)});

    CHECK(world.resource<StartReport>().joints_held > 0);
    CHECK(world.resource<StartReport>().joints > 0);
    CHECK(world.resource<StartReport>().joints + world.resource<StartReport>().joints_held ==
          everywhere.resource<StartReport>().joints);
    CHECK(model_of(world).tree.bodies.joints() == world.resource<StartReport>().joints);
    // Residues with an atom near one of that molecule in the file; its own all are.
    const Structure file = read_peptides();
    std::set<std::string> near;
    for (std::size_t i = 0; i < file.names.size(); ++i) {
        for (std::size_t j = 0; j < file.names.size(); ++j) {
            if (file.names[j].segment != (around.empty() ? "PEPB" : "PEPA")) continue;
            if ((file.positions[i] - file.positions[j]).norm() <= 5)
                near.insert(file.names[i].segment + file.names[i].number);
        }
    }
    const auto name_of = [&](std::uint32_t atom) {
        return world.resource<AtomTable>().names[atom].segment +
               world.resource<AtomTable>().names[atom].number;
    };
    std::size_t joints = 0;
    for (const World* const each : {&everywhere, &world}) {
        const TorsionBodies& bodies = model_of(*each).tree.bodies;
        for (const Body& body : bodies.bodies) {
            if (body.parent == no_body) continue;
            const bool is_near =
                near.contains(name_of(body.axis[0])) && near.contains(name_of(body.axis[1]));
            if (each == &world) CHECK(is_near);
            if (each == &everywhere) joints += is_near ? 1 : 0;
        }
    }
    CHECK(joints == world.resource<StartReport>().joints);
}

TEST_CASE("only joints of flexible molecules turn, and those that the scene names",
          "[simulation][flexible]") {
    const auto joints_with = [](std::vector<std::string> settings) {
        settings.emplace_back("statics.relax_steps=0");
        return load_peptides(settings).resource<StartReport>().joints;
    };
    const std::size_t one = joints_with({"molecules.resting.shape=rigid"});

    CHECK(joints_with({}) == 2 * one);
    CHECK(joints_with({"molecules.resting.shape=rigid", "joints.methyl=true"}) == one + 2);
    CHECK(joints_with({"molecules.resting.shape=rigid", "joints.amide=true"}) == one + 3);
    CHECK(joints_with({"joints.rigid=[\"PEPB 2 CA CB\"]"}) == 2 * one - 1);
    CHECK(joints_with({"joints.turn=[\"PEPA 2 C 3 N\", \"PEPB 1 CA CB\"]"}) == 2 * one + 2);
    // Of a rigid molecule a bond may be named as rigid, and not as turning.
    CHECK(joints_with({"molecules.resting.shape=rigid", "joints.rigid=[\"PEPA 2 CA CB\"]"}) == one);
    CHECK_THAT(load_error_of([&] {
                   joints_with({"molecules.resting.shape=rigid", "joints.turn=[\"PEPA 2 CA CB\"]"});
               }),
               Contains("joints.turn") &&
                   Contains("bond PEPA GLU 2 CA - PEPA GLU 2 CB belongs to a rigid molecule"));
}

TEST_CASE("runs repeat to the bit", "[simulation][flexible]") {
    const std::string pairs = GENERATE("double", "fast");
    const auto run = [&] {
        World world = load_peptides({"statics.pairs=" + pairs, "statics.method=second-order"});
        ContactModel felt = contact_at(world, 0).model;
        for (int i = 1; i <= 10; ++i) {
            felt = test::step_once(world, hand_at({-0.1 * i, 0, 0}), felt);
        }
        return world.resource<AtomTable>().positions;
    };

    const std::vector<Vec3> first = run();
    CHECK(first == run());
}

TEST_CASE("residues of two molecules with the same names are not one, where few joints may turn",
          "[simulation][flexible]") {
    // The other one's residues go on where the first's end, in a segment of the same name.
    const auto count_joints = [](double within, bool has_same_names) {
        World world = load_peptides({"statics.relax_steps=0"});
        JointsDescription& joints = world.write<MechanicsSettings>().joints;
        joints.within_angstrom = within;
        joints.around = "held";
        BondedTerms& terms = world.write<BondedTerms>();
        Connectivity connectivity = *terms.connectivity;
        if (has_same_names) {
            const AtomRange other = held_range(world, hand_at(world, 0));
            REQUIRE(connectivity.names.front().number == "1");
            const AtomName last = connectivity.names[other.first - 1];
            for (std::uint32_t i = other.first; i < other.first + other.count; ++i) {
                AtomName& name = connectivity.names[i];
                name.segment = last.segment;
                name.number = std::to_string(std::stoi(name.number) + std::stoi(last.number) - 1);
                if (name.number == last.number) name.residue = last.residue;
            }
        }
        terms.connectivity = std::make_shared<const Connectivity>(std::move(connectivity));
        rebuild_mechanics(world);
        return model_of(world).tree.bodies.joints();
    };
    std::set<std::size_t> counts;
    for (const double within : {2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 17.0}) {
        INFO(within << " Å");
        const std::size_t joints = count_joints(within, false);
        CHECK(count_joints(within, true) == joints);
        counts.insert(joints);
    }
    CHECK(counts.size() > 2);
}

TEST_CASE("a hand that is nowhere changes nothing", "[simulation][flexible]") {
    std::vector<std::string> settings;
    if (GENERATE(false, true)) settings = by_spring;
    World world = load_peptides(settings);
    ContactModel felt = contact_at(world, 0).model;
    felt = test::step_once(world, hand_at({-0.1, 0, 0}), felt);
    const TorsionState before = world.resource<TorsionState>();
    const std::vector<Vec3> positions = world.resource<AtomTable>().positions;
    const Vec3 place = place_of(world), held = held_place(world, hand_at(world, 0));

    const StepReport report =
        step_world(world, hand_at({0, std::numeric_limits<double>::quiet_NaN(), 0}), felt);

    CHECK_FALSE(report.finite);
    CHECK(contact_at(world, 0).model.force_newton == felt.force_newton);
    CHECK(world.resource<AtomTable>().positions == positions);
    CHECK(world.resource<TorsionState>().positions == before.positions);
    CHECK(world.resource<TorsionState>().angles == before.angles);
    CHECK(held_place(world, hand_at(world, 0)) == held);
    CHECK(place_of(world) == place);
    // And it can go on.
    begin_grip(world, hand_at(world, 0), hand_at({0, 0, 0}));
    CHECK(step_world(world, hand_at({0.1, 0, 0}), felt).finite);
}

TEST_CASE("a step that is not finite leaves everything as it was", "[simulation][flexible]") {
    std::vector<std::string> settings = by_spring;
    if (GENERATE(false, true)) settings.emplace_back("statics.active=4");
    World world = load_peptides(settings);
    const ContactModel felt =
        test::step_once(world, hand_at({-0.1, 0, 0}), contact_at(world, 0).model);
    const TorsionState before = world.resource<TorsionState>();
    const std::vector<Vec3> positions = world.resource<AtomTable>().positions;
    const Vec3 place = place_of(world);

    world.write<Spring>(hand_at(world, 0))->k = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(step_world(world, hand_at({-0.2, 0, 0}), felt).finite);
    world.write<Spring>(hand_at(world, 0))->k = before.springs.front().k;

    const TorsionState state = world.resource<TorsionState>();
    CHECK(state.angles == before.angles);
    CHECK(state.shifts == before.shifts);
    CHECK(state.springs.front().place == before.springs.front().place);
    CHECK(find_largest_move(state.positions, before.positions) < 1e-9);
    CHECK(find_largest_move(world.resource<AtomTable>().positions, positions) < 1e-9);
    CHECK((place_of(world) - place).norm() < 1e-12);
    CHECK(contact_at(world, 0).model.force_newton == felt.force_newton);
    CHECK(step_world(world, hand_at({-0.3, 0, 0}), felt).finite);
    CHECK(std::isfinite(world.resource<TorsionState>().energy()));
}

TEST_CASE("a hand that is farther away than any molecule moves nothing", "[simulation][flexible]") {
    World world = load_peptides();
    const std::vector<Vec3> positions = world.resource<AtomTable>().positions;
    HandPose far_out;
    far_out.molecule = {Vec3(1e200, 0, 0), Quat::Identity()};

    CHECK_FALSE(step_world(world, far_out, {}).finite);
    CHECK(find_largest_move(world.resource<AtomTable>().positions, positions) < 1e-9);
}

TEST_CASE("a scene is told which of its joints, atoms and springs are not there",
          "[simulation][flexible][errors]") {
    struct Row {
        const char* table;
        const char* line;
        const char* what;
    };
    const auto row = GENERATE(values<Row>({
        {"joints", "turn = [\"PEPB 2 CA CX\"]",
         "\"PEPB 2 CA CX\" names atom 'CX' of residue 2 of segment 'PEPB', which does not exist"},
        {"joints", "rigid = [\"PEPC 2 C 3 N\"]", "segment 'PEPC', which does not exist"},
        {"joints", "springs = [\"PEPB 2 CA\"]",
         "\"PEPB 2 CA\" is not a bond; expected \"A 25 CB CG\" or, between residues, \"A 25 C 26 "
         "N\""},
        {nullptr, "atom = \"7 CA\"",
         "'held' has no atom or residue \"7 CA\"; expected \"25 CA\" or \"25\""},
        {nullptr, "atom = \"2 CA CB\"", "has no atom or residue"},
        {nullptr, "atom = \" \"", "has no atom or residue"},
    }));
    INFO(row.line);
    // A line of a table of its own, or behind what the hand holds.
    const bool is_joint = row.table != nullptr;
    const ChangedPeptides broken;
    std::string text = ChangedPeptides::text();
    if (is_joint) {
        text += fmt::format("[{}]\n{}\n", row.table, row.line);
    } else {
        text = test::replaced(text, "motion = \"translate\"", "motion = \"free\"");
        text = test::replaced(text, "[statics]\n", fmt::format("{}\n[statics]\n", row.line));
    }
    const std::filesystem::path file = broken.folder().add_file("scene.toml", text);
    const auto line = 1 + std::count(text.data(), text.data() + text.find(row.line), '\n');

    const std::string error = load_error_of([&] { load_world(broken.scene()); });

    CHECK_THAT(error, Catch::StartsWith(fmt::format("{}:{}:", file.string(), line)));
    CHECK_THAT(error, Contains(row.what));
}

TEST_CASE("molecules that are bonded across segments cannot move apart",
          "[simulation][flexible][errors]") {
    Structure structure = read_peptides();
    Connectivity connectivity = connectivity_of(structure);
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        if (structure.names[i].segment != "PEPB" || structure.names[i].number != "4") continue;
        structure.names[i].segment = "TAIL";
    }
    connectivity.names = structure.names;
    const ChangedPeptides broken(structure, connectivity);

    const std::string error = load_error_of([&] { load_world(broken.scene()); });

    CHECK_THAT(error, Contains("both.psf:"));
    CHECK_THAT(error,
               Contains("atoms PEPB ARG 3 C and TAIL ALA 4 N of different segments are bonded"));
    CHECK_THAT(error, Contains("expected molecules without bonds between them"));
}

TEST_CASE("a hand holds one molecule, not two under one name", "[simulation][flexible][errors]") {
    Structure structure = read_peptides();
    for (std::size_t i = 0; i < peptide_atoms; ++i) {
        structure.names.push_back(structure.names[i]);
        structure.names.back().segment = "PEPC";
        structure.names.back().number = fmt::format("1{}", structure.names[i].number);
        structure.positions.emplace_back(structure.positions[i] + Vec3(0, 30, 0));
        structure.lines.push_back(structure.lines.size() + 1);
    }
    Connectivity connectivity = connectivity_of(structure);
    // Two chains in one segment, as a PSF file may have them.
    for (AtomName& name : structure.names) {
        if (name.segment == "PEPC") name.segment = "PEPB";
    }
    connectivity.names = structure.names;
    const ChangedPeptides broken(structure, connectivity);

    CHECK_THAT(load_error_of([&] { load_world(broken.scene()); }),
               Contains("scene.toml:18:") &&
                   Contains("'held' has parts without bonds between them; expected"));
    // A spring may hold one of them.
    CHECK(model_of(load_world(broken.scene(by_spring))).bases.size() == 3);
}

TEST_CASE("few active joints leave the force that is felt at first as it is",
          "[simulation][flexible]") {
    const World all = load_peptides();
    const World few = load_peptides({"statics.active=2"});

    const Vec6 expected = find_pull_on_held(all, hand_at(all, 0)),
               found = find_pull_on_held(few, hand_at(few, 0));

    CHECK(find_active_freedom(few) <= 2);
    CHECK((found - expected).norm() < 1e-4 * expected.norm());
}

TEST_CASE("a joint counts the less the more atoms it moves, and the farther it is from the hand",
          "[simulation][flexible]") {
    World world = load_peptides({"statics.active=8", "statics.choose_every=1"});
    (void)step_world(world, hand_at(Vec3(0.6, 0, 0)), contact_at(world, 0).model);
    (void)step_world(world, hand_at(Vec3(1.2, 0, 0)), contact_at(world, 0).model);
    const std::vector<double>& factors = find_solver<PaperStep>(world)->settings.factors;
    const std::vector<Body>& bodies = model_of(world).tree.bodies.bodies;
    const std::vector<std::array<std::uint32_t, 2>> bonds = connectivity_of(read_peptides()).bonds;
    // All that is bonded to k once the bond to j is cut: what the joint j -> k turns.
    const auto count_behind = [&](std::uint32_t j, std::uint32_t k) {
        std::set<std::uint32_t> behind{k};
        for (bool grows = true; grows;) {
            grows = false;
            for (const auto& [a, b] : bonds) {
                if ((a == j && b == k) || (a == k && b == j)) continue;
                if (behind.contains(a) && behind.insert(b).second) grows = true;
                if (behind.contains(b) && behind.insert(a).second) grows = true;
            }
        }
        return static_cast<double>(behind.size());
    };
    REQUIRE(factors.size() == bodies.size());

    std::vector<std::pair<double, double>> by_distance;  // Å from the middle of what is held
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (model_of(world).tree.bodies.is_base(b)) continue;
        const auto [j, k] = bodies[b].axis;
        const double n = count_behind(j, k);
        INFO("joint " << j << " -> " << k << ", " << n << " atoms");
        // 1/2.3 of 8 atoms, 1/25 of 30: by the third power at last.
        const double light = 1 / ((1 + n / 20) * (1 + n * n / 100));
        const double nearness = factors[b] / light;
        by_distance.emplace_back((world.resource<TorsionState>().positions[k] -
                                  find_solver<PaperStep>(world)->near_to.front().centre)
                                     .norm(),
                                 nearness);
    }
    std::ranges::sort(by_distance);
    for (std::size_t i = 1; i < by_distance.size(); ++i) {
        const auto [distance, nearness] = by_distance[i];
        CHECK(nearness > 0);
        const double before = by_distance[i - 1].second;
        // Atoms have moved by less than that since the choice; within what is held all are alike.
        if (distance > by_distance[i - 1].first + 0.1)
            CHECK((nearness < before || before > 1 - 1e-9));
    }
    CHECK(by_distance.front().second == Approx(1));
    CHECK(by_distance.back().second < 0.1);
}

TEST_CASE("a time budget that nothing has strained leaves joints to be chosen as often as asked",
          "[simulation][flexible]") {
    World world =
        load_peptides({"statics.active=8", "statics.choose_every=12", "statics.budget_us=1000000"});
    REQUIRE(find_solver<PaperStep>(world)->budget);
    move_held(world, Vec3(0.1, 0, 0));
    int choices = 0;
    for (int i = 0; i < 8; ++i) choices += relax_mobile(world, {}).value().is_chosen ? 1 : 0;

    // Three of the paper's steps are in each: there is a choice in every fourth.
    CHECK(choices >= 1);

    CHECK(find_solver<PaperStep>(world)->settings.choose_every == 12);
}
