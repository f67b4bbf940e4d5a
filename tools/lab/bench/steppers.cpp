#include "tools/lab/bench/steppers.h"

#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/solver.h"
#include "tools/lab/bench/stroke.h"

#include <fmt/format.h>
#include <cstddef>

namespace palpa {
namespace {

// Both of them start here.
struct Start {
    const TorsionModel& model;
    const TorsionState& state;
    QuasiStaticSettings settings;
    std::size_t steps;     // towards rest, after each move of the hand
    std::size_t molecule;  // in hand
};

constexpr int moves = 400;
const Vec3 hand_move(0.005, 0, 0);  // Å, of what is in hand: half of the moves one way, half back

class PlainStepper {
public:
    explicit PlainStepper(const Start& start)
        : start_(start), state_(start.state), statics_(build_quasi_statics(start.model)) {}

    void step(const Vec3& by) {
        const auto& [model, at, settings, steps, molecule] = start_;
        shift_base(model, molecule, by, state_);
        update_forces(model, settings.forces, statics_.memory, state_);
        for (std::size_t i = 0; i < steps; ++i)
            (void)step_quasi_static(model, settings, state_, statics_);
    }

    double energy() const { return state_.energy(); }

private:
    const Start& start_;
    TorsionState state_;
    QuasiStatics statics_;
};

class AdaptiveStepper {
public:
    explicit AdaptiveStepper(const Start& start)
        : start_(start), state_(start.state), statics_(build_adaptive_statics(start.model)) {
        settings_.step = start.settings;
    }

    void step(const Vec3& by) {
        shift_base(start_.model, start_.molecule, by, state_, statics_);
        (void)update_adaptive_forces(start_.model, settings_, state_, statics_);
        for (std::size_t i = 0; i < start_.steps; ++i)
            (void)step_adaptive(start_.model, settings_, state_, statics_);
    }

    double energy() const { return state_.energy(); }

private:
    const Start& start_;
    AdaptiveSettings settings_;
    TorsionState state_;
    AdaptiveStatics statics_;
};

void bench_pairs(const std::string& name, const Start& start, std::vector<BenchRow>& rows) {
    PlainStepper plain(start);
    AdaptiveStepper adaptive(start);
    std::vector<double> plain_us, adaptive_us;
    for (int i = 0; i < moves; ++i) {
        const Vec3 by = i < moves / 2 ? hand_move : Vec3(-hand_move);
        plain_us.push_back(1e6 * seconds_of([&] { plain.step(by); }));
        adaptive_us.push_back(1e6 * seconds_of([&] { adaptive.step(by); }));
    }
    const auto add = [&](const std::string& stepper, const std::vector<double>& samples,
                         double energy) {
        rows.push_back(
            {fmt::format("statics/{}/stepper={}", name, stepper),
             samples,
             "us",
             {},
             "",
             fmt::format("mean {:.0f} us, {:.4f} of the quasi-static step's, "
                         "{:.2f} kcal/mol",
                         mean_of(samples), mean_of(samples) / mean_of(plain_us), energy)});
    };
    add("quasi-static", plain_us, plain.energy());
    add("adaptive", adaptive_us, adaptive.energy());
}

}  // namespace

void bench_steppers(const std::string& scene_name, const World& world,
                    std::vector<BenchRow>& rows) {
    const auto steps = static_cast<std::size_t>(world.resource<MechanicsSettings>().statics.steps);
    Start start{model_of(world), world.resource<TorsionState>(), build_step_settings(world), steps,
                held_part(world).base};
    for (const bool ends : {false, true}) {
        NonbondedSettings& pairs = start.settings.forces.nonbonded;
        if (ends) {
            pairs.electrostatics = ElectrostaticCutoff::ForceSwitch;
            pairs.van_der_waals = VanDerWaalsCutoff::ForceSwitch;
            pairs.cutoff = 12;
            pairs.switch_from = 10;
        }
        bench_pairs(scene_name + (ends ? "/cutoff=12" : "/all-pairs"), start, rows);
    }
}

}  // namespace palpa
