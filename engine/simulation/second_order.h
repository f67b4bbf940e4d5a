// Second order in a world: all joints and bases follow the hands by a linearised model, which is
// renewed on the way (statics/second_order_step.h). Used through simulation/solver.h.
#pragma once
#include "ecs/world.h"
#include "simulation/resources.h"
#include "simulation/systems/step_input.h"
#include "statics/relax_joints.h"
#include "statics/second_order_step.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace palpa {

// A renewal that releases more energy than this (kcal/mol) is a snap: a minimum had vanished.
inline constexpr double least_snap = 1;

// Energy released by renewals (kcal/mol), the atom that moved farthest, and the step of the clock.
struct Snap {
    std::uint32_t atom = 0;
    double released = 0;
    std::uint64_t step = 0;
};

// The part of a SecondOrder that cannot be rebuilt from the world.
struct SecondOrderPlan {
    SecondOrderSettings settings;
    std::vector<Entity> hands;  // in the order of the statics

    // Delay until a pending renewal is used: a declared time, or until the step's input says so.
    // Steps use the old model meanwhile.
    std::optional<double> delay_s;
    std::uint64_t due = 0;  // step of the clock, with a declared delay

    // In real time without a declared delay: as many model evaluations per step as fit into most of
    // the period, from the wall time of the last ones.
    std::size_t most_evaluations = 0;
    double evaluation_us = 0;

    std::optional<Snap> snap;  // the last one
};

struct SecondOrder : SecondOrderPlan {
    SecondOrderStatics statics;
    bool lacks_caches = false;  // all of `statics` but what hands hold

    // Another thread may be making the pending renewal meanwhile.
    SecondOrder without_caches() const;
    std::size_t count_bytes() const noexcept;
};

// After the springs were gathered.
SecondOrder build_second_order(const QuasiStaticSettings& settings, const World& world);

// Lists the mobile parts that hands hold, in their order, and these hands.
HeldParts find_held_parts(const World& world, std::vector<Entity>& hands);

// The functions that simulation/solver.h calls for every solver that relaxes.

void start(World& world, SecondOrder& second);
void restart(World& world, SecondOrder& second);
void restore(World& world, SecondOrder& second);
RelaxStepReport relax(World& world, SecondOrder& second, const StepInput& input);
// Use the linearised model if there is one, else the forces of the state.
Vec3 find_force(const World& world, const SecondOrder& second, Entity hand) noexcept;
Vec6 find_pull(const World& world, const SecondOrder& second, Entity hand) noexcept;

// In real time: adapts the evaluations in a step to the time of the last ones.
void note_time(const World& world, const StepReport& report, SecondOrder& second);

}  // namespace palpa
