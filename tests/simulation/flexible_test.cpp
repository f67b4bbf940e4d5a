#include "simulation/flexible.h"

#include "charmm/generate.h"
#include "core/files.h"
#include "core/units.h"
#include "formats/crd.h"
#include "formats/psf.h"
#include "formats/structure.h"
#include "scene/read_scene.h"
#include "simulation/components.h"
#include "simulation/probe.h"
#include "simulation/step.h"
#include "tests/support/load_error_of.h"
#include "tests/support/native_case.h"
#include "tests/support/paths.h"
#include "tests/support/replaced.h"
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

Simulation load_peptides(const std::vector<std::string>& settings = {}) {
    return load_simulation(read_scene(peptides, settings));
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

std::size_t reference_of(const Simulation& simulation) {
    const Grab& grab = *simulation.world.find<Grab>(simulation.hand);
    return simulation.world.find<Molecule>(grab.molecule)->reference_atom;
}

Vec3 place_of(const Simulation& simulation) {
    const Grab& grab = *simulation.world.find<Grab>(simulation.hand);
    return simulation.world.find<Guide>(grab.molecule)->place;
}

const std::vector<std::string> methods{"quasi-static", "limited-memory", "inverse-mass"};
const std::vector<std::string> by_spring{"molecules.held.motion=free", "grab.atom=\"4 CB\"",
                                         "grab.spring_kcal_per_mol_angstrom2=7"};

}  // namespace

TEST_CASE("flexible molecules are at rest when the scene begins", "[simulation][flexible]") {
    const Simulation simulation = load_peptides();
    REQUIRE(simulation.flexible);
    const Flexible& flexible = *simulation.flexible;

    // Of each: ammonium and psi; phi, psi and chi 1 to 3; phi, psi and chi 1 to 5; phi, and psi of
    // the carboxylate.
    constexpr std::size_t of_each = 2 + 5 + 7 + 2;
    CHECK(flexible.joints == 2 * of_each);
    CHECK(flexible.joints_held == 0);
    CHECK(flexible.model.coordinates == static_cast<Eigen::Index>(flexible.joints));
    CHECK(flexible.relaxed.end == RelaxEnd::Converged);
    CHECK(flexible.relaxed.rms_force <= 0.05);
    CHECK(flexible.relaxed.energy_after < flexible.relaxed.energy_before);
    CHECK(simulation.atoms.positions == flexible.state.positions);
    CHECK(find_held(flexible) == simulation.atoms.positions[reference_of(simulation)]);
    // The hand's own molecule came to rest as well; then the hand took its base.
    CHECK(simulation.touch.model.force_newton.norm() < 50e-12);
}

TEST_CASE("the system of a scene has its atoms in the order of the table, and all terms",
          "[simulation][load]") {
    const SceneSystem system = load_system(read_scene(peptides, {}));
    const Simulation simulation = load_peptides({"statics.relax_steps=0"});

    REQUIRE(simulation.flexible);
    REQUIRE(system.connectivity.names.size() == std::size_t{2} * peptide_atoms);
    CHECK(system.connectivity.names[0].segment == simulation.atoms.names[0].segment);
    CHECK(system.connectivity.mass == simulation.atoms.mass);
    CHECK(system.topology.charge == simulation.atoms.charge);
    CHECK(system.positions == simulation.flexible->model.reference);
    // What is rigid in the scene is there too.
    CHECK(system.topology.bonds.size() == connectivity_of(read_peptides()).bonds.size());
    CHECK(system.topology.bonds.size() > simulation.flexible->model.topology.bonds.size());
}

TEST_CASE("without joints to turn and bases to move a scene stays rigid",
          "[simulation][flexible]") {
    const Simulation simulation =
        load_peptides({"molecules.held.shape=rigid", "molecules.resting.shape=rigid"});

    CHECK_FALSE(simulation.flexible);
    CHECK(simulation.relaxed);
}

TEST_CASE("while the hand rests the energy falls with every step", "[simulation][flexible]") {
    const std::string method = GENERATE(from_range(methods));
    INFO(method);
    Simulation simulation =
        load_peptides({"statics.method=" + method, "hand.start_offset_angstrom=[-1.5, 0, 0]"});
    const Flexible& flexible = *simulation.flexible;
    TouchModel felt = simulation.touch.model;
    double energy = flexible.safe.energy(), fallen = 0;

    for (int i = 0; i < 25; ++i) {
        const Vec3 held = find_held(flexible);
        const StepReport report = step_simulation(simulation, {}, felt);
        REQUIRE(report.settled);
        const SettleReport& settled = *report.settled;

        CHECK(report.finite);
        // What the start did to the energy shows in the first step.
        if (i > 0) CHECK(std::abs(settled.hand_work) < 1e-9);
        CHECK(settled.energy_change <= 0);
        CHECK(flexible.state.energy() - energy ==
              Approx(settled.hand_work + settled.energy_change).margin(1e-9));
        CHECK(settled.evaluations > 0);
        CHECK((find_held(flexible) - held).norm() < 1e-12);
        energy = flexible.state.energy();
        fallen -= settled.energy_change;
        felt = report.touch;
    }
    CHECK(fallen > 0.01);
}

TEST_CASE("work of the hand and what is given up add to the change of energy",
          "[simulation][flexible]") {
    const std::string method = GENERATE(from_range(methods));
    INFO(method);
    std::vector<std::string> settings{"statics.method=" + method};
    if (GENERATE(false, true)) settings.insert(settings.end(), by_spring.begin(), by_spring.end());
    Simulation simulation = load_peptides(settings);
    const Flexible& flexible = *simulation.flexible;
    TouchModel felt = simulation.touch.model;
    const double start = flexible.state.energy();
    double sum = 0;

    for (int i = 1; i <= 20; ++i) {
        const StepReport report =
            step_simulation(simulation, hand_at(Vec3(-0.1 * i, 0.03 * i, 0)), felt);
        CHECK(report.settled->energy_change <= 0);
        sum += report.settled->hand_work + report.settled->energy_change;
        CHECK(flexible.state.energy() == Approx(start + sum).margin(1e-8));
        felt = report.touch;
    }
    CHECK(std::abs(sum) > 0.1);
}

TEST_CASE("what the hand moves is the base, and nobody else", "[simulation][flexible]") {
    Simulation simulation = load_peptides();
    Flexible& flexible = *simulation.flexible;
    const std::vector<Vec3> before = simulation.atoms.positions;
    const Vec3 place = place_of(simulation), held = find_held(flexible);
    const Vec3 by(-0.2, 0.1, 0.05);

    move_held(flexible, by);
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Vec3 moved = flexible.state.positions[i] - before[i];
        CHECK((moved - (i < peptide_atoms ? by : Vec3(Vec3::Zero()))).norm() < 1e-13);
    }
    move_held(flexible, -by);

    const StepReport report = step_simulation(simulation, hand_at(by), simulation.touch.model);
    CHECK(report.move == Approx(by.norm()));
    CHECK((place_of(simulation) - place - by).norm() < 1e-12);
    CHECK((find_held(flexible) - held - by).norm() < 1e-12);
    // The base of the other one is fixed: so is its reference atom.
    const Grab& grab = *simulation.world.find<Grab>(simulation.hand);
    const std::size_t fixed = simulation.world.find<Molecule>(grab.measured_from)->reference_atom;
    CHECK((simulation.atoms.positions[fixed] - before[fixed]).norm() < 1e-12);
}

TEST_CASE("a molecule that turns by itself does so about its reference atom",
          "[simulation][flexible]") {
    const std::string method = GENERATE(from_range(methods));
    INFO(method);
    Simulation simulation = load_peptides(
        {"statics.method=" + method, "molecules.held.motion=translate-and-turn",
         "molecules.held.shape=rigid", "molecules.resting.shape=rigid", "statics.steps=20"});
    const Flexible& flexible = *simulation.flexible;
    CHECK(flexible.joints == 0);
    REQUIRE(flexible.model.coordinates == 3);
    TouchModel felt = simulation.touch.model;
    CHECK(felt.active_freedom == 6);

    // The other end of the molecule comes too close, and gives way.
    for (int i = 1; i <= 10; ++i) {
        const StepReport report = step_simulation(simulation, hand_at({-0.3 * i, 0, 0}), felt);
        CHECK((find_held(flexible) - simulation.anchor - place_of(simulation)).norm() < 1e-12);
        CHECK(report.settled->energy_change <= 0);
        felt = report.touch;
    }
    CHECK(Eigen::AngleAxisd(flexible.state.turns[flexible.grabbed]).angle() > 0.01);
    CHECK(flexible.state.turns[1 - flexible.grabbed].isApprox(Eigen::Quaterniond::Identity()));
}

TEST_CASE("a spring pulls at the hand with k times its stretch", "[simulation][flexible]") {
    std::vector<std::string> settings = by_spring;
    const bool is_residue = GENERATE(false, true);
    if (is_residue) settings[1] = "grab.atom=\"4\"";
    Simulation simulation = load_peptides(settings);
    const Flexible& flexible = *simulation.flexible;
    // By hand, of residue 4 or its CB.
    const auto tethered = [&] {
        Vec3 sum = Vec3::Zero();
        double mass = 0;
        for (std::size_t i = 0; i < peptide_atoms; ++i) {
            const AtomName& name = simulation.atoms.names[i];
            if (name.number != "4" || (!is_residue && name.atom != "CB")) continue;
            sum += simulation.atoms.mass[i] * simulation.atoms.positions[i];
            mass += simulation.atoms.mass[i];
        }
        return Vec3(sum / mass);
    };
    CHECK(flexible.state.tether->atoms.size() == (is_residue ? 11 : 1));
    CHECK((find_held(flexible) - tethered()).norm() < 1e-12);
    const Vec3 start = tethered();
    TouchModel felt = simulation.touch.model;
    CHECK(felt.force_newton.norm() < 1e-20);
    CHECK(felt.active_freedom == 3 + static_cast<int>(flexible.joints) + 6);

    for (int i = 1; i <= 15; ++i) {
        felt = step_simulation(simulation, hand_at({0.2 * i, 0, 0}), felt).touch;
        const Vec3 stretch = tethered() - (start + Vec3(0.2 * i, 0, 0));
        CHECK((felt.force_newton - 7 * stretch * units::newton_per_kcal_per_mol_angstrom).norm() <
              1e-9 * felt.force_newton.norm());
        CHECK(felt.force_newton.x() < 0);
    }
    CHECK(felt.stiffness_N_per_m == Approx(7 * units::newton_per_metre_per_kcal_per_mol_angstrom2));
    CHECK(felt.potential_kcal_per_mol == Approx(flexible.state.energy()));
    // It follows.
    CHECK((tethered() - start).x() > 0.1);
}

TEST_CASE("joints outside of a region are held, and counted", "[simulation][flexible]") {
    const Simulation everywhere = load_peptides();
    const std::string around = GENERATE("", "resting");
    const Simulation simulation =
        load_peptides({"joints.within_angstrom=5", fmt::format("joints.around=\"{}\"", around)});
    const Flexible& flexible = *simulation.flexible;

    CHECK(flexible.joints_held > 0);
    CHECK(flexible.joints > 0);
    CHECK(flexible.joints + flexible.joints_held == everywhere.flexible->joints);
    CHECK(flexible.model.tree.bodies.joints() == flexible.joints);
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
        return simulation.atoms.names[atom].segment + simulation.atoms.names[atom].number;
    };
    std::size_t joints = 0;
    for (const Simulation* const each : {&everywhere, &simulation}) {
        const TorsionBodies& bodies = each->flexible->model.tree.bodies;
        for (const Body& body : bodies.bodies) {
            if (body.parent == no_body) continue;
            const bool is_near =
                near.contains(name_of(body.axis[0])) && near.contains(name_of(body.axis[1]));
            if (each == &simulation) CHECK(is_near);
            if (each == &everywhere) joints += is_near ? 1 : 0;
        }
    }
    CHECK(joints == flexible.joints);
}

TEST_CASE("only joints of flexible molecules turn, and those that the scene names",
          "[simulation][flexible]") {
    const auto joints_with = [](std::vector<std::string> settings) {
        settings.emplace_back("statics.relax_steps=0");
        return load_peptides(settings).flexible->joints;
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
                   Contains("bond PEPA GLU 2 CA - PEPA GLU 2 CB is of a rigid molecule"));
}

TEST_CASE("runs repeat to the bit", "[simulation][flexible]") {
    const std::string pairs = GENERATE("double", "fast");
    const auto run = [&] {
        Simulation simulation = load_peptides(
            {"statics.pairs=" + pairs, "statics.method=inverse-mass", "statics.steps=4"});
        TouchModel felt = simulation.touch.model;
        for (int i = 1; i <= 10; ++i) {
            felt = step_simulation(simulation, hand_at({-0.1 * i, 0, 0}), felt).touch;
        }
        return simulation.atoms.positions;
    };

    const std::vector<Vec3> first = run();
    CHECK(first == run());
}

TEST_CASE("a hand that is nowhere changes nothing", "[simulation][flexible]") {
    std::vector<std::string> settings;
    if (GENERATE(false, true)) settings = by_spring;
    Simulation simulation = load_peptides(settings);
    TouchModel felt = simulation.touch.model;
    felt = step_simulation(simulation, hand_at({-0.1, 0, 0}), felt).touch;
    const TorsionState before = simulation.flexible->state;
    const std::vector<Vec3> positions = simulation.atoms.positions;
    const Vec3 place = place_of(simulation), held = find_held(*simulation.flexible);

    const StepReport report = step_simulation(
        simulation, hand_at({0, std::numeric_limits<double>::quiet_NaN(), 0}), felt);

    CHECK_FALSE(report.finite);
    CHECK(report.touch.force_newton == felt.force_newton);
    CHECK(simulation.atoms.positions == positions);
    CHECK(simulation.flexible->state.positions == before.positions);
    CHECK(simulation.flexible->state.angles == before.angles);
    CHECK(find_held(*simulation.flexible) == held);
    CHECK(place_of(simulation) == place);
    // And it can go on.
    take_hold(simulation, hand_at({0, 0, 0}));
    CHECK(step_simulation(simulation, hand_at({0.1, 0, 0}), felt).finite);
}

TEST_CASE("coordinates that are no numbers are not stepped into", "[simulation][flexible]") {
    Simulation simulation = load_peptides();
    Flexible& flexible = *simulation.flexible;
    const TorsionState safe = flexible.safe;
    move_held(flexible, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));

    const SettleReport report = step_flexible(flexible);

    CHECK_FALSE(report.is_finite);
    CHECK(flexible.state.positions == safe.positions);
    CHECK(flexible.state.energy() == safe.energy());
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
         "\"PEPB 2 CA CX\" names atom 'CX' of residue 2 of segment 'PEPB', which is not there"},
        {"joints", "rigid = [\"PEPC 2 C 3 N\"]", "segment 'PEPC', which is not"},
        {"joints", "springs = [\"PEPB 2 CA\"]",
         "\"PEPB 2 CA\" is no bond; expected \"A 25 CB CG\" or, between residues, \"A 25 C 26 N\""},
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

    const std::string error = load_error_of([&] { load_simulation(broken.scene()); });

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

    const std::string error = load_error_of([&] { load_simulation(broken.scene()); });

    CHECK_THAT(error, Contains("both.psf:"));
    CHECK_THAT(error, Contains("PEPB ARG 3 C and TAIL ALA 4 N are bonded, across segments"));
    CHECK_THAT(error, Contains("expected molecules that are not bonded to others"));
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

    CHECK_THAT(
        load_error_of([&] { load_simulation(broken.scene()); }),
        Contains("scene.toml:18:") && Contains("'held' is not all bonded together; expected"));
    // A spring may hold one of them.
    CHECK(load_simulation(broken.scene(by_spring)).flexible->model.bases.size() == 3);
}

TEST_CASE("few active joints leave the force that is felt at first as it is",
          "[simulation][flexible]") {
    const Simulation all = load_peptides();
    const Simulation few = load_peptides({"statics.active=2"});

    const Vec6 expected = find_pull_on_held(*all.flexible),
               found = find_pull_on_held(*few.flexible);

    CHECK(find_active_freedom(*few.flexible) <= 2);
    CHECK((found - expected).norm() < 1e-4 * expected.norm());
}

TEST_CASE("a joint counts the less the more atoms it moves, and the farther it is from the hand",
          "[simulation][flexible]") {
    const std::string weights = GENERATE("light", "near-hand");
    Simulation simulation =
        load_peptides({"statics.active=8", "statics.weights=" + weights, "statics.choose_every=1"});
    (void)step_simulation(simulation, hand_at(Vec3(0.6, 0, 0)), simulation.touch.model);
    (void)step_simulation(simulation, hand_at(Vec3(1.2, 0, 0)), simulation.touch.model);
    const Flexible& flexible = *simulation.flexible;
    const std::vector<double>& factors = flexible.adaptive->settings.factors;
    const std::vector<Body>& bodies = flexible.model.tree.bodies.bodies;
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
        if (flexible.model.tree.bodies.is_base(b)) continue;
        const auto [j, k] = bodies[b].axis;
        const double n = count_behind(j, k);
        INFO("joint " << j << " -> " << k << ", " << n << " atoms");
        // 1/2.3 of 8 atoms, 1/25 of 30: by the third power at last.
        const double light = 1 / ((1 + n / 20) * (1 + n * n / 100));
        const double nearness = factors[b] / light;
        if (weights == "light") {
            CHECK(nearness == Approx(1));
            continue;
        }
        by_distance.emplace_back(
            (flexible.state.positions[k] - flexible.adaptive->near_to->centre).norm(), nearness);
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
    if (weights == "near-hand") {
        CHECK(by_distance.front().second == Approx(1));
        CHECK(by_distance.back().second < 0.1);
    }
}

TEST_CASE("a time budget that nothing has strained leaves joints to be chosen as often as asked",
          "[simulation][flexible]") {
    Simulation simulation =
        load_peptides({"statics.active=8", "statics.choose_every=12", "statics.budget_us=1000000"});
    Flexible& flexible = *simulation.flexible;
    REQUIRE(flexible.adaptive->budget);
    move_held(flexible, Vec3(0.1, 0, 0));
    int choices = 0;
    for (int i = 0; i < 8; ++i) choices += step_flexible(flexible).is_chosen ? 1 : 0;

    // Three of the paper's steps are in each: there is a choice in every fourth.
    CHECK(choices >= 1);

    CHECK(flexible.adaptive->settings.choose_every == 12);
}
