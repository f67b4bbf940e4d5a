// Two hands, each with a molecule, on closed paths: what the field between them gives to both.
#include "core/files.h"
#include "core/units.h"
#include "devices/emulated_omni.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/lockstep.h"
#include "session/recording.h"
#include "session/replay.h"
#include "session/ripple.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "tests/support/emulated_hand.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/two_held.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

// A handle led along a closed path, whatever pushes at it: three waves in each direction, at rest
// at both ends.
class ClosedPath final : public Device {
public:
    ClosedPath(double size_m, double seconds, std::mt19937& random)
        : size_m_(size_m), seconds_(seconds) {
        std::uniform_real_distribution<double> uniform(-1, 1);
        for (Vec3& wave : waves_) {
            for (double& coordinate : wave) coordinate = uniform(random);
        }
    }

    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override {
        const double now_s = static_cast<double>(tick_) * servo_tick_s;
        const double phase = 2 * std::numbers::pi * minimum_jerk(now_s / seconds_);
        Vec3 place = Vec3::Zero();
        for (std::size_t k = 0; k < waves_.size(); ++k) {
            const double times = static_cast<double>(k + 1);
            place += size_m_ / times * std::sin(times * phase) * waves_[k];
        }
        return {now_s, place, 0, true};
    }
    void write(const Vec3& /*force_newton*/) noexcept override { ++tick_; }

private:
    DeviceSpec spec_{.name = "closed path", .is_real = false};
    std::array<Vec3, 3> waves_;
    double size_m_, seconds_;
    std::uint64_t tick_ = 0;
};

struct PathCase {
    test::TwoHeld pair;
    double apart_angstrom = 4;
    double size_m = 0.05, seconds = 4;
    std::uint64_t period_ms = 1;
    double A_f = 1e9, A_d = 1e9;  // 1/N, of the constant laws
    std::uint32_t seed = 1;
    bool is_swapped = false;  // the second molecule's hand comes first
};

// By molecule, whatever the order of the hands.
struct PathResult {
    double energy_J = 0;       // given to both hands
    double exchanged_J = 0;    // what went either way
    double felt_N_per_m = 0;   // the stiffest place
    double away_angstrom = 0;  // where they ended, from where they began
    std::array<std::vector<Vec3>, 2> sent;
    double fastest_m = 0;  // that a handle went in a tick
};

// Without damping, which would hide what the field gives.
ServoSettings lossless_servo(const PathCase& c) {
    ServoSettings servo;
    servo.safety.is_full = false;
    servo.safety.clamp_newton = 100;
    GuardedSettings& guarded = servo.guarded.emplace();
    guarded.force_law = ConstantForceLaw{c.A_f};
    guarded.displacement_law = ConstantDisplacementLaw{c.A_d};
    guarded.damping_N_s_per_m = 0;
    guarded.horizon_s = 0.5e-3;  // of a force that is held for a tick
    return servo;
}

PathResult run_path(PathCase c) {
    std::mt19937 random(c.seed);
    std::array<ClosedPath, 2> paths{ClosedPath(c.size_m, c.seconds, random),
                                    ClosedPath(c.size_m, c.seconds, random)};
    std::array<MoleculePose, 2> start;
    start[1].place_angstrom.x() = c.apart_angstrom;
    c.pair.period_s = 1e-3 * static_cast<double>(c.period_ms);
    if (c.is_swapped) {
        std::swap(c.pair.bodies[0], c.pair.bodies[1]);
        std::swap(start[0], start[1]);
    }
    const auto molecule_of = [&](std::size_t slot) { return c.is_swapped ? 1 - slot : slot; };
    std::vector<LockstepHand> hands;
    for (std::size_t i = 0; i < 2; ++i)
        hands.push_back({paths[molecule_of(i)], lossless_servo(c), c.pair.contact(i, start)});
    const auto step = [&](std::span<const HandPose> poses, std::span<const ContactModel>) {
        const std::array now{poses[0].molecule.value(), poses[1].molecule.value()};
        return std::vector<LocalContactModel>{c.pair.contact(0, now), c.pair.contact(1, now)};
    };
    PathResult result;
    std::array<Vec3, 2> handle{Vec3::Zero(), Vec3::Zero()}, newton = handle;
    const auto on_ticks = [&](std::span<const ServoTick> ticks) {
        result.energy_J = result.away_angstrom = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            const ServoTick& tick = ticks[i];
            const Vec3 moved = tick.reading.position_m - handle[i];
            result.energy_J += tick.hand_energy_J;
            result.exchanged_J += std::abs(newton[i].dot(moved));
            result.fastest_m = std::max(result.fastest_m, moved.norm());
            result.felt_N_per_m = std::max(result.felt_N_per_m, tick.felt_N_per_m);
            result.away_angstrom +=
                (tick.contact.molecule.place_angstrom - start[i].place_angstrom).norm();
            result.sent[molecule_of(i)].push_back(tick.sent_newton);
            handle[i] = tick.reading.position_m;
            newton[i] = tick.sent_newton;
        }
    };
    const auto ticks = static_cast<std::uint64_t>(std::lround(c.seconds * servo_rate_hz)) + 100;
    run_lockstep({ticks, c.period_ms}, hands, step, on_ticks);
    return result;
}

test::TwoHeld spheres() { return {{test::sphere_body(0.4), test::sphere_body(-0.4)}, {}}; }
test::TwoHeld waters() { return {{test::water_body(), test::water_body()}, {}}; }

}  // namespace

TEST_CASE("closed paths of two hands in space give no energy, whatever they hold and both move",
          "[session][held][coupling]") {
    PathCase c;
    const bool is_water = GENERATE(false, true);
    c.pair = is_water ? waters() : spheres();
    c.apart_angstrom = is_water ? 3.4 : 4.2;
    c.period_ms = GENERATE(1, 14);
    double exchanged = 0;
    for (c.seed = 1; c.seed <= 6; ++c.seed) {
        const PathResult result = run_path(c);
        INFO("path " << c.seed);
        CHECK(result.away_angstrom < 1e-3);  // or what is stored would count as given
        CHECK(std::abs(result.energy_J) < 1e-3);
        exchanged += result.exchanged_J;
    }
    CHECK(exchanged > 6 * 0.02);
}

// In space a raised A_d leaves the molecules elsewhere; along a line they come back to the distance
// that they had.
TEST_CASE("on a line two hands get no energy where the cap raises A_d either",
          "[session][held][coupling]") {
    PathCase c;
    const bool is_water = GENERATE(false, true);
    c.pair = is_water ? waters() : spheres();
    c.pair.projector = Vec3::UnitX().asDiagonal();
    c.apart_angstrom = is_water ? 3.2 : 4.2;
    c.period_ms = GENERATE(1, 14);
    c.A_d = 0.25e9;
    c.size_m = 0.02;
    double stiffest = 0;
    for (c.seed = 1; c.seed <= 6; ++c.seed) {
        const PathResult result = run_path(c);
        INFO("path " << c.seed);
        CHECK(std::abs(result.energy_J) < 1e-3);
        stiffest = std::max(stiffest, result.felt_N_per_m);
    }
    CHECK(stiffest > 190);
}

TEST_CASE("the order in which two hands stand makes no more than a tick of difference",
          "[session][held]") {
    PathCase c;
    c.pair = waters();
    c.apart_angstrom = 3.4;
    c.period_ms = 14;
    for (c.seed = 1; c.seed <= 3; ++c.seed) {
        c.is_swapped = false;
        const PathResult first = run_path(c);
        c.is_swapped = true;
        const PathResult second = run_path(c);
        // What the stiffest place makes of the way of a tick.
        const double lag_newton = first.felt_N_per_m * first.fastest_m;
        double largest = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            REQUIRE(first.sent[i].size() == second.sent[i].size());
            for (std::size_t k = 0; k < first.sent[i].size(); ++k)
                largest = std::max(largest, (first.sent[i][k] - second.sent[i][k]).norm());
            CHECK((first.sent[i].back() - second.sent[i].back()).norm() < 1e-5);
        }
        CHECK(largest < lag_newton);
    }
}

TEST_CASE("two hands that press their molecules against each other are calm",
          "[session][held][coupling]") {
    const HandGrip grip = GENERATE(HandGrip::Light, HandGrip::Medium, HandGrip::Firm);
    const double depth_m = GENERATE(0.01, 0.02);
    test::TwoHeld pair = waters();
    pair.projector = Vec3::UnitX().asDiagonal();
    const std::uint64_t period_ms = GENERATE(1, 14);
    pair.period_s = 1e-3 * static_cast<double>(period_ms);
    std::array<MoleculePose, 2> start;
    start[1].place_angstrom.x() = 3.2;
    const auto omni_of = [&](double way) {
        EmulatedOmniSettings settings;
        settings.friction_newton = 0;
        settings.hand = hand_model(grip);
        settings.script.path = {{0.1, 0}, {1.1, way * depth_m}};
        settings.script.kick_N_s = way * 0.005;
        settings.script.kick_time_s = 2;
        return settings;
    };
    EmulatedOmni left(omni_of(1)), right(omni_of(-1));
    ServoSettings servo;
    servo.safety.is_full = false;
    servo.delay_ticks = 1;
    GuardedSettings& guarded = servo.guarded.emplace();
    guarded.force_law = ConstantForceLaw{1e9};
    guarded.displacement_law = ConstantDisplacementLaw{0.25e9};
    const std::array hands{LockstepHand{left, servo, pair.contact(0, start)},
                           LockstepHand{right, servo, pair.contact(1, start)}};
    const auto step = [&](std::span<const HandPose> poses, std::span<const ContactModel>) {
        const std::array now{poses[0].molecule.value(), poses[1].molecule.value()};
        return std::vector<LocalContactModel>{pair.contact(0, now), pair.contact(1, now)};
    };
    std::array<std::vector<double>, 2> sent;

    run_lockstep({7000, period_ms}, hands, step, [&](std::span<const ServoTick> ticks) {
        for (std::size_t i = 0; i < 2; ++i) sent[i].push_back(ticks[i].sent_newton.x());
    });

    for (const std::vector<double>& forces : sent) {
        const Ripple ripple =
            measure_ripple(std::span(forces).last(4000), servo_tick_s).value_or(Ripple{});
        // Two encoder steps of 0.055 mm under the cap of 200 N/m.
        CHECK(ripple.rms < 0.022);
    }
    CHECK(std::abs(sent[0].back()) > 0.2);
    CHECK(sent[0].back() == Approx(-sent[1].back()).margin(0.05));
}

namespace {

SceneDescription two_waters(const std::vector<std::string>& settings = {}) {
    return read_scene(test::in_project("scenes/water/two-hands.toml"), settings);
}

// What the coupling would be without period, delay, limits, friction and damping: both molecules go
// by dx/A_d of the forces at the live places of both, in double, by the midpoint rule.
class TwoLaws {
public:
    TwoLaws(const GuardedSettings& settings, World world)
        : settings_(settings), world_(std::move(world)), hands_(find_hands(world_)) {}

    void follow(const std::array<Vec3, 2>& moved_m) {
        constexpr double longest = 0.01;  // Å
        const Here before = find_here();
        double way = 0;
        for (std::size_t i = 0; i < 2; ++i)
            way = std::max(way, (before[i].angstrom_per_metre * moved_m[i]).norm());
        const auto steps = std::max(1, static_cast<int>(std::ceil(way / longest)));
        for (int step = 0; step < steps; ++step) {
            const Here start = step == 0 ? before : find_here();
            const std::array<Vec3, 2> from{place(0), place(1)};
            const auto go = [&](const Here& by, double share) {
                for (std::size_t i = 0; i < 2; ++i)
                    place_grabbed(world_,
                                  from[i] + share / steps * by[i].angstrom_per_metre * moved_m[i],
                                  hands_[i]);
            };
            go(start, 0.5);
            const Here middle = find_here();
            go(middle, 1);
            for (std::size_t i = 0; i < 2; ++i)
                work_J_ += middle[i].hand_newton.dot(moved_m[i]) / steps;
        }
    }

    double work_joule() const { return work_J_; }
    Vec3 place(std::size_t i) const { return grip_of(world_, hands_[i]).pose.place_angstrom; }

private:
    struct OfHand {
        Vec3 hand_newton;
        Mat3 angstrom_per_metre;  // molecule travel of handle travel
    };
    using Here = std::array<OfHand, 2>;

    Here find_here() const {
        Here here;
        for (std::size_t i = 0; i < 2; ++i) {
            const FieldSum field = field_on_held(world_, hands_[i]);
            const Vec3 force = units::newton_per_kcal_per_mol_angstrom * field.force;
            const Mat3 stiffness =
                units::newton_per_metre_per_kcal_per_mol_angstrom2 * field.stiffness;
            here[i] = {
                hand_force(settings_.force_law, force),
                units::angstrom_per_metre * guarded_gain(settings_, force, stiffness).inverse};
        }
        return here;
    }

    GuardedSettings settings_;
    World world_;
    std::vector<Entity> hands_;
    double work_J_ = 0;
};

struct ShippedResult {
    double extra_J = 0;         // done on both hands beyond the laws', net of the servo's damping
    double exchanged_J = 0;     // what went either way
    double drift_angstrom = 0;  // of either molecule from where the laws have it
    double least_angstrom = 0;  // between the oxygens
    bool was_limited = false;
};

// Both hands on closed paths in the coupling that the scene ships.
ShippedResult run_shipped(std::uint32_t seed, std::uint64_t period_ms) {
    std::mt19937 random(seed);
    std::array<ClosedPath, 2> paths{ClosedPath(0.02, 6, random), ClosedPath(0.02, 6, random)};
    const SceneDescription scene =
        two_waters({"run.seconds=7", "run.period_ms=" + std::to_string(period_ms),
                    "hand.start_offset_angstrom=[-0.4, 0, 0]",
                    "second.hand.start_offset_angstrom=[0.4, 0, 0]"});
    World world = load_world(scene);
    const ServoSettings servo = build_servo_settings(scene, world, 0, paths[0].spec());
    const std::vector<Entity> hands = find_hands(world);
    TwoLaws laws(servo.guarded.value(), world);
    ShippedResult result;
    result.least_angstrom = 100;
    const std::size_t late = static_cast<std::size_t>(servo.delay_ticks) + 1;
    std::array<Vec3, 2> handle{Vec3::Zero(), Vec3::Zero()}, newton = handle;
    std::array<std::vector<Vec3>, 2> damping{std::vector<Vec3>(late, Vec3::Zero()),
                                             std::vector<Vec3>(late, Vec3::Zero())};
    std::size_t tick_number = 0;
    double damped_J = 0;
    Device* const devices[] = {&paths[0], &paths[1]};
    (void)run_headless(
        scene, world, devices, {}, nullptr, {}, {}, [&](std::span<const ServoTick> ticks) {
            std::array<Vec3, 2> moved;
            double work_J = 0;
            for (std::size_t i = 0; i < 2; ++i) {
                const ServoTick& tick = ticks[i];
                moved[i] = tick.reading.position_m - handle[i];
                handle[i] = tick.reading.position_m;
                Vec3& under_way = damping[i][tick_number % late];
                damped_J += under_way.dot(moved[i]);
                under_way = tick.damping_newton;
                work_J += tick.hand_energy_J;
                result.exchanged_J += std::abs(newton[i].dot(moved[i]));
                newton[i] = tick.sent_newton;
                result.was_limited = result.was_limited || !tick.overtravel_m.isZero() ||
                                     !tick.clipped_m.isZero() || tick.clamped;
            }
            ++tick_number;
            laws.follow(moved);
            result.extra_J = work_J - damped_J - laws.work_joule();
            const Vec3 apart =
                ticks[1].contact.molecule.place_angstrom - ticks[0].contact.molecule.place_angstrom;
            result.least_angstrom = std::min(result.least_angstrom, apart.norm());
            result.drift_angstrom = 0;
            for (std::size_t i = 0; i < 2; ++i)
                result.drift_angstrom +=
                    (ticks[i].contact.molecule.place_angstrom - laws.place(i)).norm();
        });
    return result;
}

}  // namespace

TEST_CASE("closed paths of two hands in the shipped coupling give no more than the laws do",
          "[session][held][second][coupling]") {
    const std::uint64_t period_ms = GENERATE(1, 14);
    double exchanged = 0;
    int free = 0;  // of limits, beyond which there is no law but that nothing is given
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        const ShippedResult result = run_shipped(seed, period_ms);
        INFO("path " << seed << ": " << result.least_angstrom << " Å, limited "
                     << result.was_limited << ", " << result.exchanged_J << " J either way");
        CHECK(result.extra_J < 1e-3);
        if (!result.was_limited) CHECK(std::abs(result.extra_J) < 1e-3);
        free += result.was_limited ? 0 : 1;
        CHECK(result.drift_angstrom < 0.5);
        exchanged += result.exchanged_J;
    }
    CHECK(exchanged > 6 * 0.02);
    CHECK(free >= 3);
}

namespace {

Summary play_two_hands(const SceneDescription& scene, Recording* recording,
                       const HandTicksFunction& watch = {}) {
    World world = load_world(scene);
    std::vector<std::unique_ptr<EmulatedOmni>> omnis;
    std::vector<Device*> devices;
    for (std::size_t slot = 0; slot < 2; ++slot) {
        omnis.push_back(
            std::make_unique<EmulatedOmni>(test::build_played_omni(scene, world, slot)));
        devices.push_back(omnis.back().get());
    }
    return run_headless(scene, world, devices, {}, recording, {}, {}, watch);
}

std::string record_two_hands(const SceneDescription& scene, const std::filesystem::path& folder) {
    Recording recording(folder, scene, false, 2);
    (void)play_two_hands(scene, &recording);
    return read_text_file(folder / "trace.csv");
}

}  // namespace

TEST_CASE("two runs of two hands, and the recorded session, are the same to the byte",
          "[session][second]") {
    const test::TemporaryFolder folder;
    const SceneDescription scene = two_waters();
    const std::string trace = record_two_hands(scene, folder.path() / "a");
    CHECK(trace == record_two_hands(scene, folder.path() / "b"));
    const SceneDescription again = read_scene(folder.path() / "a" / "session.toml", {});
    CHECK(trace == record_two_hands(again, folder.path() / "c"));

    TraceCheck check(folder.path() / "a", count_ticks(scene), scene.every, 2);
    (void)play_two_hands(scene, nullptr,
                         [&](std::span<const ServoTick> ticks) { check.add(ticks); });
    CHECK(check.compared() == count_ticks(scene));
    CHECK(check.different() == 0);
    CHECK(trace.starts_with(trace_header(2) + "\n"));
}

TEST_CASE("in the shipped scene both hands feel the bond, go around and come back",
          "[session][second]") {
    const SceneDescription scene = two_waters();
    std::array<Vec3, 2> first, last;
    std::array<double, 2> most_newton{0, 0};
    double least = 100;
    std::uint64_t ticks_seen = 0;
    const Summary summary = play_two_hands(scene, nullptr, [&](std::span<const ServoTick> ticks) {
        for (std::size_t i = 0; i < 2; ++i) {
            last[i] = ticks[i].contact.molecule.place_angstrom;
            if (ticks_seen == 0) first[i] = last[i];
            most_newton[i] = std::max(most_newton[i], ticks[i].contact.force_newton.norm());
        }
        least = std::min(least, (last[0] - last[1]).norm());
        ++ticks_seen;
    });
    CHECK(ticks_seen == 10'000);
    REQUIRE(summary.other_hands.size() == 1);
    CHECK(least < 4);
    CHECK((first[0] - first[1]).norm() > least + 1);
    for (const double newton : most_newton) {
        CHECK(newton > 100e-12);
        CHECK(newton < 1e-9);
    }
    CHECK(summary.largest_felt_N > 0.3);
    CHECK(summary.other_hands[0].largest_felt_N > 0.3);
    CHECK(summary.ripple.value().rms < 0.02);
    CHECK(summary.other_hands[0].ripple.value().rms < 0.02);
    CHECK_FALSE(summary.stopped);
}
