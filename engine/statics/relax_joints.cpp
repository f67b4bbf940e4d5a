#include "statics/relax_joints.h"

#include "math/minimiser.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpa {
namespace {

// The energy over the coordinates, from where the state is.
class Descent {
public:
    Descent(const TorsionModel& model, const RelaxSettings& settings, TorsionState& state,
            QuasiStatics& statics)
        : model_(model), settings_(settings), state_(state), statics_(statics) {}

    double value() const { return state_.energy(); }
    const Coordinates& forces() const { return state_.coordinate_forces; }
    const Coordinates& trial_forces() const { return statics_.trial.coordinate_forces; }

    Coordinates precondition(const Coordinates& forces) {
        if (settings_.precondition) return settings_.precondition(forces);
        Coordinates accelerations;
        multiply_by_inverse_mass(model_, state_, forces, statics_.assembly, accelerations);
        return accelerations;
    }

    // Moves are limited where atoms are placed.
    static Coordinates limit(Coordinates direction) { return direction; }

    double try_move(Coordinates& direction, double& length) {
        direction *= std::exchange(length, 1);
        TorsionState& trial = statics_.trial;
        place_within(model_, state_, settings_.largest_move, direction, trial);
        move_ = direction;
        update_forces(model_, settings_.step.forces, statics_.memory, trial);
        update_coordinate_forces(model_, trial);
        return trial.energy();
    }

    const Coordinates& trial_move() const { return move_; }

    bool accepts(double value, double linear_change) const {
        if (settings_.step.forces.fast)
            return is_lower(settings_.step.forces, state_, statics_.trial, move_);
        if (is_sufficient(state_.energy(), value, linear_change)) return true;
        // Rounding may hide what a move gains: there smaller forces decide.
        constexpr double rounding = 1e-14;
        return std::abs(value - state_.energy()) <= rounding * sum_of_terms(state_) &&
               trial_forces().norm() < forces().norm();
    }

    void accept() { take_over(statics_.trial, state_); }

    // Whether there was a step that is accepted.
    bool step() { return step_downhill(*this, statics_.pairs); }

private:
    const TorsionModel& model_;
    const RelaxSettings& settings_;
    TorsionState& state_;
    QuasiStatics& statics_;
    Coordinates move_;
};

}  // namespace

double rms_of(const Coordinates& values) noexcept {
    return values.size() == 0
               ? 0
               : std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

JointRelaxReport relax_joints(const TorsionModel& model, const RelaxSettings& settings,
                              TorsionState& state, QuasiStatics& statics,
                              const std::function<bool(const RelaxProgress&)>& on_step) {
    const std::vector<Vec3> start = state.positions;
    const std::size_t evaluations = statics.memory.evaluations;
    update_forces(model, settings.step.forces, statics.memory, state);
    update_coordinate_forces(model, state);
    JointRelaxReport report;
    report.energy_before = state.energy();
    statics.pairs.clear();
    Descent descent(model, settings, state, statics);
    int refused = 0;
    while (true) {
        report.rms_force = rms_of(state.coordinate_forces);
        if (!std::isfinite(report.rms_force) || !std::isfinite(state.energy())) {
            report.end = RelaxEnd::NotFinite;
            break;
        }
        if (report.rms_force <= settings.force_tolerance) {
            report.end = RelaxEnd::Converged;
            break;
        }
        if (on_step && !on_step({report.steps, state.energy(), report.rms_force})) break;
        if (report.steps >= settings.steps) break;

        if (settings.method == RelaxMethod::QuasiStatic) {
            const QuasiStaticReport step = step_quasi_static(model, settings.step, state, statics);
            refused = step.is_taken ? 0 : refused + 1;
            constexpr int patience = 40;
            if (refused > patience || !step.is_finite) {
                report.end = step.is_finite ? RelaxEnd::Stuck : RelaxEnd::NotFinite;
                break;
            }
            if (!step.is_taken) continue;
            update_coordinate_forces(model, state);
        } else if (!descent.step()) {
            report.end = RelaxEnd::Stuck;
            break;
        }
        ++report.steps;
    }
    report.energy_after = state.energy();
    report.evaluations = statics.memory.evaluations - evaluations;
    report.largest_move = find_largest_move(start, state.positions);
    return report;
}

}  // namespace palpa
