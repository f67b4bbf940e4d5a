#include "tools/lab/experiments/closed_paths.h"

#include "core/draws.h"
#include "core/load_error.h"
#include "core/text.h"
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "tools/lab/experiments/continuous_law.h"
#include "tools/lab/experiments/scenarios.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <optional>

namespace palpa {
namespace {

// A polygon of three to five corners within the box that a clutch is not needed in, and back to
// where it began; a rest at the end.
std::vector<std::string> draw_closed_path(Draws& draws, bool turn, bool& in_plane) {
    constexpr double lead_s = 0.3, rest_s = 8, most_degrees = 120;
    const Vec3 box_mm(60, 45, 25);
    std::vector<std::string> settings = draw_hand(draws);
    in_plane = draws.below(2) == 0;
    const double off_z = in_plane ? 0 : draws.between(-0.5, 0.5);
    const double off_y = draws.between(-0.5, 0.5);
    const double off_x = draws.between(-0.1, 2.5);
    settings.push_back(
        fmt::format("hand.start_offset_angstrom=[{:.4f}, {:.4f}, {:.4f}]", off_x, off_y, off_z));
    const double mm_per_s = draws.scale(15, 150);
    const auto draw_within = [&](const Vec3& most) {
        Vec3 place;
        for (double& x : place) x = draws.between(-1, 1);
        return Vec3(place.cwiseProduct(most));
    };
    const std::size_t corners = 3 + draws.below(3);
    std::vector<std::string> points;
    double time_s = lead_s;
    Vec3 place = Vec3::Zero();
    const auto go_to = [&](const Vec3& next, const Vec3& degrees) {
        time_s += std::max(0.3, (next - place).norm() / mm_per_s);
        place = next;
        points.push_back(fmt::format("[{:.4f}, {:.3f}, {:.3f}, {:.3f}, {:.3f}, {:.3f}, {:.3f}]",
                                     time_s, next.x(), next.y(), next.z(), degrees.x(), degrees.y(),
                                     degrees.z()));
    };
    points.push_back(fmt::format("[{:.4f}, 0, 0, 0]", time_s));
    for (std::size_t i = 0; i < corners; ++i) {
        Vec3 next = draw_within(box_mm);
        if (in_plane) next.z() = 0;
        go_to(next, turn ? draw_within(Vec3::Constant(most_degrees)) : Vec3(Vec3::Zero()));
    }
    go_to(Vec3::Zero(), Vec3::Zero());
    settings.push_back(fmt::format("hand.path=[{}]", fmt::join(points, ", ")));
    settings.push_back(fmt::format("run.seconds={:.3f}", time_s + rest_s));
    return settings;
}

// Takes every tick of a path.
class ClosedPathWatch {
public:
    ClosedPathWatch(const SceneDescription& scene, const World& world, const DeviceSpec& device)
        : servo_(build_servo_settings(scene, world, 0, device)),
          cap_N_per_m_(servo_.guarded.value_or(GuardedSettings{}).cap_N_per_m),
          law_(servo_.guarded.value_or(GuardedSettings{}), load_world(scene)),
          start_(law_.pose().place_angstrom),
          under_way_(static_cast<std::size_t>(servo_.delay_ticks) + 1, Vec3::Zero()) {}

    void add(const ServoTick& tick) {
        const DeviceReading& reading = tick.reading;
        HandleStep step;
        if (before_) {
            step = {reading.position_m - before_->position_m,
                    reading.orientation * before_->orientation.conjugate()};
        } else {
            first_ = reading;
        }
        before_ = reading;
        // At the thermal limit this share of the force was played, and the molecule followed the
        // same share of the travel.
        step.moved_m *= tick.followed;
        // The force of the tick before did this, with a damping that was so much older.
        damped_J_ += under_way_[tick_ % under_way_.size()].dot(step.moved_m);
        under_way_[tick_ % under_way_.size()] = tick.damping_newton;
        if (!tick.clutched) law_.follow(step);
        result_.work_J = tick.hand_energy_J - damped_J_;
        result_.was_limited = result_.was_limited || !tick.overtravel_m.isZero() ||
                              tick.stage == SafetyStage::ThermalLimit;
        result_.clipped_mm += 1e3 * tick.clipped_m.norm();
        result_.largest_N = std::max(result_.largest_N, tick.sent_newton.norm());
        result_.was_held_back = result_.was_held_back || tick.stage > SafetyStage::ThermalLimit;
        constexpr std::uint64_t seldom = 10;
        if (tick_ % seldom == 0) {
            result_.felt_share =
                std::max(result_.felt_share,
                         law_.felt_stiffness(tick.contact.molecule, tick.molecule_per_handle) /
                             cap_N_per_m_);
        }
        last_ = tick.contact.molecule;
        ++tick_;
    }

    // At the end: friction and forces have held the handle somewhere near to where it began, and
    // the law is brought home from there, straight.
    ClosedPathResult take() {
        ClosedPathResult result = result_;
        const Vec3 end = law_.pose().place_angstrom;
        result.law_J = law_.work_joule();
        result.drift_angstrom = (last_.place_angstrom - end).norm();
        result.farthest_angstrom = law_.farthest_angstrom();
        if (!before_) return result;
        const HandleStep home{first_.position_m - before_->position_m,
                              first_.orientation * before_->orientation.conjugate()};
        result.open_mm = 1e3 * home.moved_m.norm();
        law_.follow(home);
        result.closed_law_J = law_.work_joule();
        result.closure_angstrom = (law_.pose().place_angstrom - start_).norm();
        return result;
    }

private:
    ServoSettings servo_;
    double cap_N_per_m_;
    ContinuousLaw law_;
    Vec3 start_;
    std::vector<Vec3> under_way_;  // damping of the last ticks, N
    DeviceReading first_;
    std::optional<DeviceReading> before_;
    MoleculePose last_;
    double damped_J_ = 0;
    std::uint64_t tick_ = 0;
    ClosedPathResult result_;
};

}  // namespace

bool meets_limits(const ClosedPathResult& r, bool turned) noexcept {
    // Beyond these limits there is no continuous law but that nothing is generated.
    const double extra = r.was_limited ? r.extra_joule() : std::abs(r.extra_joule());
    const bool keeps_energy = turned || extra <= most_extra_J;
    const bool stays = turned || r.was_limited || r.farthest_angstrom > near_angstrom ||
                       r.drift_angstrom <= most_drift_angstrom;
    return keeps_energy && stays && r.ripple_N <= most_closed_path_ripple_N &&
           r.felt_share <= most_felt_share && !r.was_held_back;
}

void check_closed_paths(const ClosedPathOptions& options) {
    for (const std::string& setting : options.settings) {
        const std::string key(trimmed(setting.substr(0, setting.find('='))));
        for (const std::string own : {"hand.stroke", "hand.path", "run.seconds"}) {
            if (key != own && !own.ends_with("." + key)) continue;
            throw LoadError(
                {"--set " + setting},
                "closed-paths sets the path and its duration itself; expected no " + own);
        }
    }
    const SceneDescription scene = read_scene(options.scene, options.settings);
    if (coupling_of(scene, 0).mode != CouplingMode::Guarded) {
        throw LoadError(
            scene.place_of("coupling.mode"),
            "closed-paths compares with guarded coupling; expected coupling.mode = \"guarded\"");
    }
    for (const MoleculeDescription& molecule : scene.molecules) {
        if (molecule.name != scene.hands.front().grab.molecule) continue;
        const bool turns = molecule.motion == Motion::WithHandle;
        if (options.turn && !turns) {
            throw LoadError(scene.place_of("grab.molecule"),
                            "does not turn with the handle; expected a molecule whose motion is "
                            "with-handle, or no --turn");
        }
        if (!scene.has_statics() && (turns || molecule.motion == Motion::Translate)) continue;
        throw LoadError(scene.place_of("grab.molecule"),
                        "expected a rigid molecule with motion translate or with-handle, and no "
                        "other molecule that moves by itself");
    }
}

ClosedPathCost find_closed_path_cost(const ClosedPathOptions& options) {
    constexpr double pair_s = 1.9e-4;  // a pair on a path, on scenes/hiv
    const World world = load_world(read_scene(options.scene, options.settings));
    const std::size_t held = held_range(world, hand_at(world, 0)).count;
    const auto pairs =
        static_cast<double>(held * (world.resource<AtomTable>().positions.size() - held));
    return {pairs, pair_s * pairs};
}

ClosedPathResult play_closed_path(const ClosedPathOptions& options, std::size_t number) {
    Draws draws(options.seed, number);
    bool in_plane = false;
    std::vector<std::string> settings = draw_closed_path(draws, options.turn, in_plane);
    settings.insert(settings.end(), options.settings.begin(), options.settings.end());
    const SceneDescription scene = read_scene(options.scene, settings);
    World world = load_world(scene);
    EmulatedOmni device(build_emulated_omni(scene, world));
    ClosedPathWatch watch(scene, world, device.spec());
    const Summary summary = run_headless(scene, world, device, {}, nullptr, {}, {},
                                         [&](const ServoTick& tick) { watch.add(tick); });
    ClosedPathResult result = watch.take();
    result.settings = settings;
    result.in_plane = in_plane;
    result.period_ms = scene.period_ms;
    result.clamped_share = summary.clamped_share;
    result.ripple_N = summary.ripple ? summary.ripple->rms : 0;
    return result;
}

std::vector<ClosedPathResult> play_closed_paths(
    const ClosedPathOptions& options,
    const std::function<void(std::size_t number, const ClosedPathResult&)>& on_result) {
    std::vector<ClosedPathResult> results;
    for (std::size_t i = options.first; i < options.first + options.count; ++i) {
        results.push_back(play_closed_path(options, i));
        if (on_result) on_result(i, results.back());
    }
    return results;
}

}  // namespace palpa
