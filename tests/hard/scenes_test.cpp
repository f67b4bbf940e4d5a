// Scenes in hands that do what no careful hand does, in every way of stepping.
#include "core/files.h"
#include "core/units.h"
#include "devices/emulated_omni.h"
#include "formats/crd.h"
#include "formats/structure.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/probe.h"
#include "simulation/simulation.h"
#include "simulation/step.h"
#include "tests/hard/ways_of_stepping.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"
#include "tools/hands.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::all_ways_of_stepping;
using test::WayOfStepping;

namespace {

const std::filesystem::path peptides = test::test_data("two_peptides");
const std::filesystem::path protease = test::in_project("scenes/hiv/flexible.toml");

// Å, from the molecule in the hand to the other one.
const Vec3 onto_the_other(-11, -2, -1);

SceneDescription scene_in(const std::filesystem::path& path, const WayOfStepping& way,
                          std::vector<std::string> settings) {
    settings.insert(settings.end(), way.settings.begin(), way.settings.end());
    return read_scene(path, settings);
}

// A scene in a hand that goes where it is told, with what must hold looked at after every step.
class Watched {
public:
    Watched(const std::filesystem::path& path, const WayOfStepping& way,
            const std::vector<std::string>& settings = {})
        : scene_(scene_in(path, way, settings)),
          way_(way),
          simulation_(load_simulation(scene_)),
          felt_(simulation_.touch.model),
          first_energy_(flexible().state.energy()) {}
    Watched(const Watched&) = delete;
    Watched& operator=(const Watched&) = delete;
    ~Watched() = default;

    // Moves what the hand holds.
    StepReport move(const Vec3& by) {
        handle_m_ += by * scene_.coupling.A_d / units::angstrom_per_metre;
        const Vec3 held = find_held(flexible());
        const TorsionState before = flexible().state;
        const StepReport report = step_simulation(simulation_, hand_pose(), felt_);
        look_at(report);
        if (report.finite) {
            CHECK(((find_held(flexible()) - held) - by).norm() <= 1e-9 * (1 + by.norm()));
            look_at_energies(*report.settled, before, by);
        } else {
            CHECK((find_held(flexible()) - held).norm() == 0);
            // To rounding: they are had from the coordinates again.
            CHECK(find_largest_move(flexible().state.positions, before.positions) <= 1e-9);
        }
        felt_ = report.touch;
        return report;
    }

    void rest(int steps) {
        for (int i = 0; i < steps; ++i) CHECK(move(Vec3::Zero()).finite);
    }

    // Over the whole run.
    void look_back() const {
        const double gained = flexible().state.energy() - first_energy_;
        if (gained > hand_work_)
            CHECK(gained - hand_work_ <= rounding_of(flexible().state) + rounding_);
        test::check_shape(flexible().model, simulation_.atoms.positions);
    }

    const SceneDescription& scene() const { return scene_; }
    const Simulation& simulation() const { return simulation_; }
    const Flexible& flexible() const { return *simulation_.flexible; }
    std::size_t sums_in_double() const { return flexible().statics.memory.fast_pairs.in_double; }

private:
    HandPose hand_pose() const {
        HandPose pose;
        pose.travel_m = handle_m_;
        return pose;
    }

    double rounding_of(const TorsionState& state) const {
        return test::rounding_of(way_.forces) * test::sum_of_terms(flexible().model, state);
    }

    void look_at(const StepReport& report) const {
        REQUIRE(report.settled);
        CHECK(report.finite == report.settled->is_finite);
        CHECK(test::is_finite(flexible().state));
        CHECK(simulation_.atoms.positions == flexible().state.positions);
        CHECK(report.touch.force_newton.allFinite());
        CHECK(report.touch.torque_newton_metre.allFinite());
        CHECK(std::isfinite(report.touch.stiffness_N_per_m));
        CHECK(std::isfinite(report.touch.potential_kcal_per_mol));
    }

    void look_at_energies(const SettleReport& settled, const TorsionState& before, const Vec3& by) {
        const double now = flexible().state.energy();
        TorsionState moved = before;
        if (moved.tether) {
            moved.tether->place += by;
        } else {
            shift_base(flexible().model, flexible().grabbed, by, moved);
        }
        // What was rounded in a clash stays until all is summed anew, some steps later.
        const double own = rounding_of(moved);
        largest_rounding_ = std::max(largest_rounding_, own);
        if (settled.energy_change > 0)
            CHECK(settled.energy_change <= (way_.is_renewed ? largest_rounding_ : own));
        // Sums of numbers so large; the clash that the hand made has come down since.
        const double scale = std::abs(settled.hand_work) + std::abs(settled.energy_change) +
                             std::abs(before.energy());
        CHECK(std::abs(now - before.energy() - settled.hand_work - settled.energy_change) <=
              1e-12 * scale);
        hand_work_ += settled.hand_work;
        rounding_ += 1e-12 * scale;
        constexpr std::size_t few = 500;  // atoms
        if (moved.positions.size() > few) return;
        // What the hand did, by the twin in double.
        const double work = test::exact_energy(flexible().model, moved) -
                            test::exact_energy(flexible().model, before);
        const double most = rounding_of(moved) + rounding_of(before);
        CHECK(std::abs(settled.hand_work - work) <= (way_.is_renewed ? 4 : 1) * most);
        test::check_no_rise(flexible().model, moved, flexible().state,
                            test::rounding_of(way_.forces));
        rounding_ += std::max(0.0, settled.energy_change);
    }

    SceneDescription scene_;
    const WayOfStepping& way_;
    Simulation simulation_;
    TouchModel felt_;
    Vec3 handle_m_ = Vec3::Zero();
    double first_energy_;
    double largest_rounding_ = 0;          // so far, kcal/mol
    double hand_work_ = 0, rounding_ = 0;  // in all so far, kcal/mol
};

std::string all_of(const std::vector<std::string>& warnings) {
    std::string text;
    for (const std::string& warning : warnings) text += warning + "\n";
    return text;
}

Summary run(const SceneDescription& scene) {
    Simulation simulation = load_simulation(scene);
    const EmulatedOmniSettings settings = build_emulated_omni(scene, simulation);
    EmulatedOmni device(settings);
    return run_headless(scene, simulation, device,
                        list_warnings(scene, simulation, settings.script), nullptr, {});
}

const std::vector<std::string> by_spring{"molecules.held.motion=free", "grab.atom=\"4 CB\""};

}  // namespace

TEST_CASE("a hand that jumps onto, through and far beyond the other molecule", "[hard]") {
    std::vector<std::string> settings;
    if (GENERATE(false, true)) settings = by_spring;
    const auto jump = GENERATE(as<Vec3>{}, onto_the_other, Vec3(-30, 0, 0), Vec3(-30, -5.5, -2.7));
    for (const WayOfStepping& way : all_ways_of_stepping()) {
        INFO(way.name);
        Watched watched(peptides, way, settings);

        CHECK(watched.move(jump).finite);
        watched.rest(10);
        CHECK(watched.move(-jump).finite);
        watched.rest(10);
        watched.look_back();
    }
}

TEST_CASE("a molecule rammed through the other one by 1.2 Å a step", "[hard]") {
    std::vector<std::string> settings{"hand.start_offset_angstrom=[0, -2, -1]"};
    if (GENERATE(false, true)) settings.insert(settings.end(), by_spring.begin(), by_spring.end());
    for (const WayOfStepping& way : all_ways_of_stepping()) {
        INFO(way.name);
        Watched watched(peptides, way, settings);

        for (int i = 0; i < 18; ++i) CHECK(watched.move({-1.2, 0, 0}).finite);
        watched.rest(10);
        watched.look_back();
    }
}

TEST_CASE("a molecule that starts in the other one, and is warned of", "[hard]") {
    for (const WayOfStepping& way : all_ways_of_stepping()) {
        INFO(way.name);
        Watched watched(peptides, way, {"hand.start_offset_angstrom=[-11, -2, -1]"});
        CHECK_THAT(all_of(list_warnings(watched.scene(), watched.simulation(), {})),
                   Contains("atoms are on each other at the start: PEP") && Contains(" Å apart"));

        watched.rest(30);
        watched.look_back();
    }
}

TEST_CASE("molecules that lie on each other in the file come apart, or are told of", "[hard]") {
    Structure structure = read_structure(peptides / "both.crd");
    const std::size_t atoms = structure.positions.size() / 2;
    const double beside = GENERATE(0.0, 1e-3, 0.7);
    for (std::size_t i = 0; i < atoms; ++i)
        structure.positions[i + atoms] = structure.positions[i] + Vec3(0, 0, beside);
    const test::TemporaryFolder folder;
    const std::string file =
        folder.add_file("both.crd", format_crd(structure, "one in the other")).string();
    for (const WayOfStepping& way : all_ways_of_stepping()) {
        INFO(way.name);
        Watched watched(peptides, way,
                        {"molecules.resting.structure=" + file, "molecules.held.structure=" + file,
                         "statics.relax_steps=100", std::string(allow_outside)});
        const Flexible& flexible = watched.flexible();
        const std::string warnings =
            all_of(list_warnings(watched.scene(), watched.simulation(), {}));
        CHECK(flexible.relaxed.energy_after <= flexible.relaxed.energy_before);
        if (flexible.relaxed.end != RelaxEnd::Converged)
            CHECK_THAT(warnings, Contains("not at rest at the start"));
        if (flexible.state.energy() > 1e6)
            CHECK_THAT(warnings, Contains("atoms are on each other at the start"));

        watched.rest(20);
        watched.look_back();
    }
}

TEST_CASE("charges whose energies are no numbers are refused in words", "[hard]") {
    const test::TemporaryFolder folder;
    const std::string file =
        folder
            .add_file("both.psf", test::replaced(read_text_file(peptides / "both.psf"),
                                                 " -0.300000", " 1.000e200"))
            .string();
    for (const WayOfStepping& way : all_ways_of_stepping()) {
        INFO(way.name);
        const SceneDescription scene =
            scene_in(peptides, way,
                     {"molecules.resting.topology=" + file, "molecules.held.topology=" + file,
                      std::string(allow_outside)});

        CHECK_THAT(test::load_error_of([&] { load_simulation(scene); }),
                   Contains("scene.toml:") && Contains("the energy at the start is not finite; "
                                                       "expected atoms apart from each other"));
    }
}

TEST_CASE("a scene in which nothing can move but by the hand", "[hard]") {
    for (const WayOfStepping& way : all_ways_of_stepping()) {
        INFO(way.name);
        // Of the flexible one no residue is as near as that.
        Watched watched(peptides, way, {"molecules.held.shape=rigid", "joints.within_angstrom=0"});
        REQUIRE(watched.flexible().joints_held > 0);
        REQUIRE(watched.flexible().model.coordinates == 0);

        for (int i = 0; i < 10; ++i)
            CHECK(watched.move(0.1 * onto_the_other).settled->energy_change == 0);
        watched.look_back();
    }
}

TEST_CASE("a hand thrown out of the world and back", "[hard]") {
    std::vector<std::string> settings{"statics.relax_steps=0"};
    if (GENERATE(false, true)) settings.insert(settings.end(), by_spring.begin(), by_spring.end());
    if (GENERATE(false, true)) settings.emplace_back("statics.cutoff_angstrom=9");
    const double far = GENERATE(1e4, 1e7, 1e12, 1e100, 1e160, 1e300);
    INFO(far << " Å");
    for (const WayOfStepping& way : all_ways_of_stepping()) {
        INFO(way.name);
        SceneDescription scene = scene_in(peptides, way, settings);
        Simulation simulation = load_simulation(scene);
        const Flexible& flexible = *simulation.flexible;
        TouchModel felt = simulation.touch.model;
        HandPose pose;
        pose.travel_m = Vec3(far, -far, 0) * scene.coupling.A_d / units::angstrom_per_metre;
        const std::vector<Vec3> before = simulation.atoms.positions;

        const StepReport report = step_simulation(simulation, pose, felt);

        CHECK(test::is_finite(flexible.state));
        CHECK(report.touch.force_newton.allFinite());
        if (!report.finite)
            CHECK(find_largest_move(simulation.atoms.positions, before) <=
                  (way.is_renewed ? 1e-9 : 0));
        // And on from there.
        take_hold(simulation, {});
        CHECK(step_simulation(simulation, {}, felt).finite);
        CHECK(test::is_finite(flexible.state));
    }
}

TEST_CASE("a run that rams one molecule through the other says so in words", "[hard]") {
    for (const WayOfStepping& way : all_ways_of_stepping()) {
        INFO(way.name);
        const SceneDescription scene =
            scene_in(peptides, way,
                     {"mode=5", "A_d=0.03e9", "stroke=path", "period_ms=10", "seconds=0.6",
                      "hand.path=[[0.1, 60], [0.4, -60], [0.6, -60]]",
                      "hand.start_offset_angstrom=[0, -2, -1]"});
        const Summary summary = run(scene);

        CHECK(summary.steps > 50);
        CHECK(summary.steps_not_finite == 0);
        CHECK_FALSE(summary.stopped);
        CHECK(std::isfinite(summary.net_work_J));
        const std::string warnings = all_of(summary.warnings);
        CHECK_THAT(warnings, Contains("the hand pushed the molecule through the other one"));
        CHECK((summary.sums_in_double > 0) == way.forces.fast);
        if (way.forces.fast) CHECK_THAT(warnings, Contains("sums of forces were in double"));
    }
}

TEST_CASE("TL-3 started in the wall of the protease", "[hard][slow]") {
    for (const WayOfStepping& way : all_ways_of_stepping()) {
        INFO(way.name);
        Watched watched(protease, way, {"hand.start_offset_angstrom=[0, 6, 2]"});
        CHECK_THAT(all_of(list_warnings(watched.scene(), watched.simulation(), {})),
                   Contains("atoms are on each other at the start"));

        watched.rest(way.forces.fast ? 20 : 4);
        watched.look_back();
    }
}

TEST_CASE("TL-3 rammed through the protease by a handle at 0.5 m/s", "[hard][slow]") {
    for (const WayOfStepping& way : all_ways_of_stepping()) {
        INFO(way.name);
        Watched watched(protease, way);
        // Of each period.
        const double angstrom = 0.5 * watched.simulation().period_s / watched.scene().coupling.A_d *
                                units::angstrom_per_metre;
        CHECK(angstrom == Approx(1.2).epsilon(0.01));

        for (int i = 0; i < (way.forces.fast ? 30 : 6); ++i)
            CHECK(watched.move({0, angstrom, 0}).finite);
        watched.rest(way.forces.fast ? 5 : 1);
        watched.look_back();
    }
}

TEST_CASE("TL-3 in a hand that jumps by 30 Å and back", "[hard][slow]") {
    for (const WayOfStepping& way : all_ways_of_stepping()) {
        INFO(way.name);
        Watched watched(protease, way);

        for (const Vec3& jump : {Vec3(0, 30, 0), Vec3(0, -30, 0)}) {
            CHECK(watched.move(jump).finite);
            watched.rest(way.forces.fast ? 8 : 2);
        }
        watched.look_back();
    }
}
