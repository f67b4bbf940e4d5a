// Scenes in hands that do what no careful hand does, in every way of stepping.
#include "core/files.h"
#include "core/units.h"
#include "devices/emulated_omni.h"
#include "formats/crd.h"
#include "formats/structure.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/probe.h"
#include "simulation/solver.h"
#include "simulation/step.h"
#include "simulation/systems/follow_hands.h"
#include "tests/hard/ways_of_stepping.h"
#include "tests/support/emulated_hand.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"

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

// Those of single steppers, and that which follows hands alone.
std::vector<WayOfStepping> ways_of_scenes() {
    std::vector<WayOfStepping> ways = all_ways_of_stepping();
    ways.push_back(
        {"second order", test::fast_forces(), {"statics.method=second-order"}, true, {}});
    return ways;
}

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
          world_(load_world(scene_)),
          felt_(contact_at(world_, 0).model),
          first_energy_(find_energy(world())) {}
    Watched(const Watched&) = delete;
    Watched& operator=(const Watched&) = delete;
    ~Watched() = default;

    // Moves what the hand holds.
    StepReport move(const Vec3& by) {
        handle_m_ += by * scene_.coupling.A_d / units::angstrom_per_metre;
        const Vec3 held = held_place(world(), hand_at(world(), 0));
        const TorsionState before = world().resource<TorsionState>();
        const double energy = find_energy(world());
        const StepReport& report = step_world(world_, hand_pose(), felt_);
        look_at(report);
        if (report.finite) {
            CHECK(((held_place(world(), hand_at(world(), 0)) - held) - by).norm() <=
                  1e-9 * (1 + by.norm()));
            look_at_energies(*report.relaxed, before, energy, by);
        } else {
            CHECK((held_place(world(), hand_at(world(), 0)) - held).norm() == 0);
            // To rounding: they are had from the coordinates again.
            CHECK(find_largest_move(world().resource<TorsionState>().positions, before.positions) <=
                  1e-9);
        }
        felt_ = contact_at(world(), 0).model;
        return report;
    }

    void rest(int steps) {
        for (int i = 0; i < steps; ++i) CHECK(move(Vec3::Zero()).finite);
    }

    // Over the whole run.
    void look_back() const {
        const double gained = find_energy(world()) - first_energy_;
        if (gained > hand_work_)
            CHECK(gained - hand_work_ <= rounding_of(world().resource<TorsionState>()) + rounding_);
        test::check_shape(model_of(world()), world_.resource<AtomTable>().positions);
    }

    const SceneDescription& scene() const { return scene_; }
    const World& world() const { return world_; }
    std::size_t sums_in_double() const { return count_forces(world()).in_double; }

private:
    HandPose hand_pose() const {
        HandPose pose;
        pose.travel_m = handle_m_;
        return pose;
    }

    double rounding_of(const TorsionState& state) const {
        return test::rounding_of(way_.forces) * test::sum_of_terms(model_of(world()), state);
    }

    void look_at(const StepReport& report) const {
        REQUIRE(report.relaxed);
        CHECK(report.finite == report.relaxed->is_finite);
        CHECK(test::is_finite(world().resource<TorsionState>()));
        CHECK(world_.resource<AtomTable>().positions == world().resource<TorsionState>().positions);
        CHECK(contact_at(world(), 0).model.force_newton.allFinite());
        CHECK(contact_at(world(), 0).model.torque_newton_metre.allFinite());
        CHECK(std::isfinite(contact_at(world(), 0).model.stiffness_N_per_m));
        CHECK(std::isfinite(contact_at(world(), 0).model.potential_kcal_per_mol));
    }

    void look_at_energies(const RelaxStepReport& relaxed, const TorsionState& before, double energy,
                          const Vec3& by) {
        const double now = find_energy(world());
        TorsionState moved = before;
        if (!moved.springs.empty()) {
            moved.springs.front().place += by;
        } else {
            shift_base(model_of(world()), held_part(world()).base, by, moved);
        }
        // What was rounded in a clash stays until all is summed anew, some steps later.
        const double own = rounding_of(moved);
        largest_rounding_ = std::max(largest_rounding_, own);
        if (relaxed.energy_change > 0)
            CHECK(relaxed.energy_change <= (way_.is_renewed ? largest_rounding_ : own));
        // Sums of numbers so large; the clash that the hand made has come down since.
        const double scale =
            std::abs(relaxed.hand_work) + std::abs(relaxed.energy_change) + std::abs(energy);
        CHECK(std::abs(now - energy - relaxed.hand_work - relaxed.energy_change) <= 1e-12 * scale);
        hand_work_ += relaxed.hand_work;
        rounding_ += 1e-12 * scale;
        constexpr std::size_t few = 500;  // atoms
        // By second order everything follows while the hand goes, so that no state is between.
        if (moved.positions.size() > few || !way_.start) return;
        // What the hand did, by the reference in double.
        const double work = test::exact_energy(model_of(world()), moved) -
                            test::exact_energy(model_of(world()), before);
        const double most = rounding_of(moved) + rounding_of(before);
        CHECK(std::abs(relaxed.hand_work - work) <= (way_.is_renewed ? 4 : 1) * most);
        test::check_no_rise(model_of(world()), moved, world().resource<TorsionState>(),
                            test::rounding_of(way_.forces));
        rounding_ += std::max(0.0, relaxed.energy_change);
    }

    SceneDescription scene_;
    const WayOfStepping& way_;
    World world_;
    ContactModel felt_;
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
    World world = load_world(scene);
    const EmulatedOmniSettings settings = test::build_played_omni(scene, world);
    EmulatedOmni device(settings);
    return run_headless(scene, world, device, list_warnings(scene, world, settings.script), nullptr,
                        {});
}

const std::vector<std::string> by_spring{"molecules.held.motion=free", "grab.atom=\"4 CB\""};

}  // namespace

TEST_CASE("a hand that jumps onto, through and far beyond the other molecule", "[hard]") {
    std::vector<std::string> settings;
    if (GENERATE(false, true)) settings = by_spring;
    const auto jump = GENERATE(as<Vec3>{}, onto_the_other, Vec3(-30, 0, 0), Vec3(-30, -5.5, -2.7));
    for (const WayOfStepping& way : ways_of_scenes()) {
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
    for (const WayOfStepping& way : ways_of_scenes()) {
        INFO(way.name);
        Watched watched(peptides, way, settings);

        for (int i = 0; i < 18; ++i) CHECK(watched.move({-1.2, 0, 0}).finite);
        watched.rest(10);
        watched.look_back();
    }
}

TEST_CASE("a molecule that starts in the other one, and is warned of", "[hard]") {
    for (const WayOfStepping& way : ways_of_scenes()) {
        INFO(way.name);
        Watched watched(peptides, way, {"hand.start_offset_angstrom=[-11, -2, -1]"});
        CHECK_THAT(all_of(list_warnings(watched.scene(), watched.world(), {})),
                   Contains("atoms overlap at the start: PEP") && Contains(" Å apart"));

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
    for (const WayOfStepping& way : ways_of_scenes()) {
        INFO(way.name);
        Watched watched(peptides, way,
                        {"molecules.resting.structure=" + file, "molecules.held.structure=" + file,
                         "statics.relax_steps=100", std::string(allow_outside)});
        const World& world = watched.world();
        const std::string warnings = all_of(list_warnings(watched.scene(), watched.world(), {}));
        CHECK(world.resource<StartReport>().joints_at_rest.value().energy_after <=
              world.resource<StartReport>().joints_at_rest.value().energy_before);
        if (world.resource<StartReport>().joints_at_rest.value().end != RelaxEnd::Converged)
            CHECK_THAT(warnings, Contains("not at rest at the start"));
        if (world.resource<TorsionState>().energy() > 1e6)
            CHECK_THAT(warnings, Contains("atoms overlap at the start"));

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
    for (const WayOfStepping& way : ways_of_scenes()) {
        INFO(way.name);
        const SceneDescription scene =
            scene_in(peptides, way,
                     {"molecules.resting.topology=" + file, "molecules.held.topology=" + file,
                      std::string(allow_outside)});

        CHECK_THAT(
            test::load_error_of([&] { load_world(scene); }),
            Contains("scene.toml:") &&
                Contains(
                    "the energy at the start is not finite; expected atoms that do not overlap"));
    }
}

TEST_CASE("a scene in which nothing can move but by the hand", "[hard]") {
    for (const WayOfStepping& way : ways_of_scenes()) {
        INFO(way.name);
        // Of the flexible one no residue is as near as that.
        Watched watched(peptides, way, {"molecules.held.shape=rigid", "joints.within_angstrom=0"});
        REQUIRE(watched.world().resource<StartReport>().joints_held > 0);
        REQUIRE(model_of(watched.world()).coordinates == 0);

        for (int i = 0; i < 10; ++i)
            CHECK(watched.move(0.1 * onto_the_other).relaxed->energy_change == 0);
        watched.look_back();
    }
}

TEST_CASE("a hand thrown out of the world and back", "[hard]") {
    std::vector<std::string> settings{"statics.relax_steps=0"};
    if (GENERATE(false, true)) settings.insert(settings.end(), by_spring.begin(), by_spring.end());
    if (GENERATE(false, true)) settings.emplace_back("statics.cutoff_angstrom=9");
    const double far = GENERATE(1e4, 1e7, 1e12, 1e100, 1e160, 1e300);
    INFO(far << " Å");
    for (const WayOfStepping& way : ways_of_scenes()) {
        INFO(way.name);
        SceneDescription scene = scene_in(peptides, way, settings);
        World world = load_world(scene);
        ContactModel felt = contact_at(world, 0).model;
        HandPose pose;
        pose.travel_m = Vec3(far, -far, 0) * scene.coupling.A_d / units::angstrom_per_metre;
        const std::vector<Vec3> before = world.resource<AtomTable>().positions;

        const StepReport& report = step_world(world, pose, felt);

        CHECK(test::is_finite(world.resource<TorsionState>()));
        CHECK(contact_at(world, 0).model.force_newton.allFinite());
        if (!report.finite)
            CHECK(find_largest_move(world.resource<AtomTable>().positions, before) <=
                  (way.is_renewed ? 1e-9 : 0));
        // And on from there.
        begin_grip(world, hand_at(world, 0), {});
        CHECK(step_world(world, {}, felt).finite);
        CHECK(test::is_finite(world.resource<TorsionState>()));
    }
}

TEST_CASE("a run that rams one molecule through the other says so in words", "[hard]") {
    // By second order molecules make room, so that nothing goes through.
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
        if (way.forces.fast) CHECK_THAT(warnings, Contains("force sums were computed in double"));
    }
}

TEST_CASE("TL-3 started in the wall of the protease", "[hard][long]") {
    for (const WayOfStepping& way : ways_of_scenes()) {
        INFO(way.name);
        Watched watched(protease, way, {"hand.start_offset_angstrom=[0, 6, 2]"});
        CHECK_THAT(all_of(list_warnings(watched.scene(), watched.world(), {})),
                   Contains("atoms overlap at the start"));

        watched.rest(way.forces.fast ? 20 : 4);
        watched.look_back();
    }
}

TEST_CASE("TL-3 rammed through the protease by a handle at 0.5 m/s", "[hard][long]") {
    for (const WayOfStepping& way : ways_of_scenes()) {
        INFO(way.name);
        Watched watched(protease, way);
        // Of each period.
        const double angstrom = 0.5 * watched.world().resource<Clock>().period_s /
                                watched.scene().coupling.A_d * units::angstrom_per_metre;
        CHECK(angstrom == Approx(1.2).epsilon(0.01));

        for (int i = 0; i < (way.forces.fast ? 30 : 6); ++i)
            CHECK(watched.move({0, angstrom, 0}).finite);
        watched.rest(way.forces.fast ? 5 : 1);
        watched.look_back();
    }
}

TEST_CASE("TL-3 in a hand that jumps by 30 Å and back", "[hard][long]") {
    for (const WayOfStepping& way : ways_of_scenes()) {
        INFO(way.name);
        Watched watched(protease, way);

        for (const Vec3& jump : {Vec3(0, 30, 0), Vec3(0, -30, 0)}) {
            CHECK(watched.move(jump).finite);
            watched.rest(way.forces.fast ? 8 : 2);
        }
        watched.look_back();
    }
}
