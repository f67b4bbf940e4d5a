#include "tools/lab/bench/real_time_way.h"

#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/solver.h"
#include "simulation/step.h"
#include "statics/renewal_worker.h"

#include <fmt/format.h>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr double period_s = 1e-3, speed_angstrom_per_s = 1, spacing_angstrom = 0.1;

struct Place {
    TorsionState state;
    Vec3 felt;  // pN
};

struct Played {
    std::vector<Place> places;
    std::vector<double> step_ms, ages;
    std::size_t missed = 0;
};

Played play(World& world) {
    using Clock = std::chrono::steady_clock;
    const auto period =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period_s));
    const Entity hand = hand_at(world, 0);
    const MoleculePose start = grip_of(world, hand).pose;
    RenewalWorker worker;
    Played played;
    double next_place = spacing_angstrom;
    Clock::time_point due = Clock::now();
    for (double way = 0; way < way_angstrom; way += speed_angstrom_per_s * period_s) {
        std::this_thread::sleep_until(due);
        due += period;
        HandPose pose;
        pose.molecule = {start.place_angstrom + Vec3(way, 0, 0), start.orientation};
        pose.grip_number = contact_of(world, hand).sent.model.grip_number;
        const ContactModel felt = contact_of(world, hand).sent.model;
        const StepReport& report =
            step_world(world, {{&pose, 1},
                               {&felt, 1},
                               {},
                               worker.is_ready(find_solver<SecondOrder>(world)->statics),
                               [&] { worker.await(); }});
        played.step_ms.push_back(1e-3 * report.took_us);
        played.ages.push_back(report.relaxed->model_age.value_or(0));
        if (way >= next_place) {
            next_place += spacing_angstrom;
            played.places.push_back({world.resource<TorsionState>(), pN * find_force(world)});
        }
        if (const std::optional<RenewalWork> work = find_renewal(world))
            worker.start_if_pending(work->model, work->settings, work->statics);
        const Clock::time_point now = Clock::now();
        played.missed += now > due ? 1 : 0;
        due = std::max(due, now);  // late: the clock goes on from here
    }
    worker.await();
    return played;
}

}  // namespace

void bench_real_time_way(const std::string& name, SceneDescription scene, Truth& truth,
                         std::vector<BenchRow>& rows) {
    scene.period_ms = 1e3 * period_s;
    scene.statics.renews_beside = true;
    World world = load_world(second_order_scene(std::move(scene)));
    const Played played = play(world);
    WayErrors errors;
    for (const Place& place : played.places) {
        TorsionState state = place.state;
        errors.add(place.felt, truth.relax(state));
    }
    BenchRow row{name, played.step_ms, "ms"};
    add_way_errors(errors, row);
    const double missed =
        static_cast<double>(played.missed) / static_cast<double>(played.step_ms.size());
    row.more.emplace_back("missed_share", missed);
    row.more.emplace_back("age_90", quantile(played.ages, 0.9));
    row.reference = "complete relaxation of the state, each 0.1 A";
    say(
        fmt::format("{}: {}, {:.1f} % of the periods missed, model {:.2f} Å old at nine of ten "
                    "steps",
                    name, describe(errors), 100 * missed, quantile(played.ages, 0.9)));
    rows.push_back(std::move(row));
}

}  // namespace palpa
