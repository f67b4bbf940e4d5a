#include "tools/lab/bench/mouse.h"

#include "app/live_session.h"
#include "core/units.h"
#include "devices/emulated_hand.h"
#include "devices/mouse_handle.h"
#include "experiments/emulated_hand.h"
#include "experiments/mouse_person.h"
#include "loading/load.h"
#include "session/statistics.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <thread>

namespace palpa {
namespace {

constexpr double pull_angstrom = 50;

// The direction of the scene's path, else away from the centre of all other atoms.
Vec3 find_direction(const SceneDescription& scene, const World& world) {
    Vec3 farthest = Vec3::Zero();
    if (scene.hands.front().stroke == Stroke::Lead) {
        for (const PathPoint& point : scene.hands.front().path) {
            const Vec3 place(point.place.data());
            if (place.norm() > farthest.norm()) farthest = place;
        }
    }
    if (!farthest.isZero()) return farthest.normalized();
    const Entity hand = hand_at(world, 0);
    const std::vector<Vec3>& positions = world.resource<AtomTable>().positions;
    Vec3 own = Vec3::Zero(), all = Vec3::Zero();
    const std::vector<std::uint32_t> held = held_atoms(world, hand);
    for (const Vec3& place : positions) all += place;
    for (const std::uint32_t i : held) own += positions[i];
    const auto others = static_cast<double>(positions.size() - held.size());
    const Vec3 away = own / static_cast<double>(held.size()) - (all - own) / std::max(others, 1.0);
    return away.isZero() ? Vec3::UnitX() : Vec3(away.normalized());
}

struct MousePlay {
    double seconds = 0;
    UnbindingPath path;
    HandTravel travel;
    double largest_N = 0;
};

MousePlay play_mouse(const SceneDescription& scene, const EmulatedOmniSettings& hand,
                     const Vec3& direction, double longest_s, std::uint64_t seed) {
    using Clock = std::chrono::steady_clock;
    HandOrders orders;
    MouseHandle mouse(build_mouse(hand, &orders));
    LiveSession session(scene, {}, mouse, &orders);
    Statistics statistics(servo_tick_s);
    MousePersonAtWindow person(mouse_reach_m(hand), orders, seed);
    Vec3 start = Vec3::Zero();
    MousePlay played;
    const Clock::time_point begin = Clock::now();
    for (Clock::time_point next_look = begin;;) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        for (ServoTick tick; session.pop_ticks({&tick, 1});) {
            statistics.add(tick);
            if (statistics.ticks() == 1) start = tick.contact.molecule.place_angstrom;
            person.see(tick, start + pull_angstrom * direction);
        }
        played.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        if (Clock::now() < next_look) continue;
        next_look += std::chrono::milliseconds(500);
        played.path = session.find_unbinding().value_or(UnbindingPath());
        if (played.path.free_s || played.seconds > longest_s) break;
    }
    if (played.path.free_s) played.seconds = std::min(played.seconds, *played.path.free_s);
    const Summary summary = statistics.summary();
    played.travel = summary.travel;
    played.largest_N = summary.largest_felt_N;
    return played;
}

}  // namespace

void bench_mouse(const std::string& name, const SceneDescription& scene, int runs, double longest_s,
                 std::vector<BenchRow>& rows) {
    BenchRow row{"mouse/" + name, {}, "s"};
    const World world = load_world(scene);
    const EmulatedOmniSettings hand = build_emulated_omni(scene, world);
    const Vec3 direction = find_direction(scene, world);
    std::vector<double> way, speed, handle, lost, strokes, largest;
    for (int run = 0; run < runs; ++run) {
        const MousePlay played =
            play_mouse(scene, hand, direction, longest_s, static_cast<std::uint64_t>(run) + 1);
        row.samples.push_back(played.seconds);
        way.push_back(played.path.farthest);
        speed.push_back(played.path.farthest / played.seconds);
        handle.push_back(played.travel.handle_m);
        lost.push_back(played.travel.lost_m / std::max(played.travel.handle_m, 1e-9));
        strokes.push_back(static_cast<double>(played.travel.strokes));
        largest.push_back(played.largest_N);
    }
    row.reference = "until no heavy atom of others is within 4 A";
    for (const auto& [key, values] : {std::pair{"way", way},
                                      {"speed", speed},
                                      {"handle_m", handle},
                                      {"lost_share", lost},
                                      {"strokes", strokes},
                                      {"largest_N", largest}})
        row.more.emplace_back(key, quantile(values, 0.5));
    rows.push_back(std::move(row));
}

}  // namespace palpa
