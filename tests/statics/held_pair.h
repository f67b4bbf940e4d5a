// Two peptides of which a hand holds one, for tests of second order.
#pragma once
#include "statics/second_order_step.h"
#include "tests/support/torsion_case.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

namespace palpa::test {

// Two tetrapeptides beside each other: the first on a hand that moves its base, which may turn; the
// second free but for springs at three of its atoms.
struct HeldPair {
    TorsionModel model;
    TorsionState state;
    HeldParts held;
    SecondOrderSettings settings;

    explicit HeldPair(double rms = 1e-6) {
        PeptidePair pair = peptide_pair({BaseFreedom::Turning, BaseFreedom::Free});
        model = std::move(pair.model);
        state = std::move(pair.state);
        const std::size_t half = model.masses.size() / 2;
        held.hands = {{.molecule = 0}};
        held.atoms.resize(half);
        std::iota(held.atoms.begin(), held.atoms.end(), 0U);
        for (const std::size_t atom : {half, half + half / 2, 2 * half - 1}) {
            state.springs.push_back({.atoms = {static_cast<std::uint32_t>(atom)},
                                     .k = 5,
                                     .place = state.positions[atom]});
        }
        relax(rms);
    }

    void relax(double rms) {
        RelaxSettings to_rest;
        to_rest.force_tolerance = rms;
        to_rest.steps = 20000;
        QuasiStatics statics = build_quasi_statics(model);
        const JointRelaxReport report = relax_joints(model, to_rest, state, statics);
        REQUIRE(report.rms_force < std::max(10 * rms, 3e-5));
    }

    void move_hand(const Vec3& by) { shift_base(model, 0, by, state); }

    LinearisedModel linearised() const {
        Lineariser lineariser = build_lineariser(model, held);
        LinearisedModel linear;
        REQUIRE(linearise(model, settings, state, lineariser, linear));
        return linear;
    }
};

// Energy and gradient of everything, at coordinates about the state.
inline ModelValue whole_at(const HeldPair& c, const LinearisedModel& linear,
                           const Eigen::VectorXd& at) {
    TorsionState state = c.state;
    place_about(c.model, linear.coordinates, linear.at, at, state);
    ForceMemory memory;
    update_forces(c.model, c.settings.forces, memory, state);
    return {state.energy(), find_gradient(c.model, linear.coordinates, linear.at, at, state)};
}

inline ModelValue model_at(const HeldPair& c, const LinearisedModel& linear,
                           const Eigen::VectorXd& at) {
    ModelValue value;
    TorsionState state = c.state;
    NearPairs near = linear.near;
    evaluate_model(c.model, c.settings.forces, linear, at, near, state, value);
    return value;
}

}  // namespace palpa::test
