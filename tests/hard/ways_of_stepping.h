// Every way in which flexible molecules step, and what each must keep on every system.
#pragma once
#include "statics/step_quasi_static.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace palpa::test {

// One step. What it remembers from one to the next is its own.
using Stepper = std::function<QuasiStaticReport(TorsionState&)>;

struct WayOfStepping {
    std::string name;
    ForceSettings forces;
    std::vector<std::string> settings;  // of a scene that steps so
    // Places and energies are had anew in between, which changes their last digits.
    bool is_renewed = false;
    // The model outlives the stepper.
    std::function<Stepper(const TorsionModel&, const QuasiStaticSettings&)> start;
};

const std::vector<WayOfStepping>& all_ways_of_stepping();

ForceSettings fast_forces();

// By which the energy may rise, of its terms without signs.
double rounding_of(const ForceSettings& forces);

// Energies in double, by the reference of every faster way.
double exact_energy(const TorsionModel& model, const TorsionState& state);
// All its terms without their signs: of pairs repulsion, attraction and electrostatics, each. The
// largest pair counts twice, as field/pair_kernel.h says.
double sum_of_terms(const TorsionModel& model, const TorsionState& state);

bool is_finite(const TorsionState& state);

// Checks that distances within rigid bodies, and so bonds and angles, are those of the reference.
void check_shape(const TorsionModel& model, const std::vector<Vec3>& positions);

// Checks that the energy did not rise from one state to the other by more than that of its terms.
void check_no_rise(const TorsionModel& model, const TorsionState& from, const TorsionState& to,
                   double rounding);

struct Outcome {
    std::size_t taken = 0, refused = 0;
    std::size_t bounded = 0;  // taken, and shorter than they would have been
    bool is_finite = true;    // else the last step said so
};

// Takes so many steps at a hand that rests, or as many as are finite. Checks after each of them
// that all is finite, that the energy did not rise, that the report is true and no atom went too
// far; and in the end the shape.
Outcome check_steps(const TorsionModel& model, const WayOfStepping& way, TorsionState& state,
                    int steps);

// check_steps in every way from that state, then every method of relax_joints.
void check_all_ways(const TorsionModel& model, const TorsionState& start, int steps,
                    const std::function<void(const Outcome&, const TorsionState&)>& look = {});

}  // namespace palpa::test
