// Lennard-Jones and Coulomb between two sets of points, all pairs, in double: the reference kernel.
#pragma once
#include "field/cutoff.h"
#include "field/solvation_parameters.h"
#include "math/vec.h"

#include <cstdint>
#include <optional>
#include <span>

namespace palpa {

// A set of points, an array per property, all of one length; `type` may be empty where no pair is
// replaced.
struct FieldPoints {
    std::span<const Vec3> positions;       // Å
    std::span<const double> charge;        // e
    std::span<const double> sqrt_epsilon;  // (kcal/mol)^(1/2)
    std::span<const double> half_rmin;     // Å
    std::span<const std::uint32_t> type = {};
    SolvationParameters solvation = {};  // empty: the points have none
};

// Lennard-Jones numbers that two types have together in place of the combination rule: CHARMM's
// NBFIX. Counts either way round.
struct ReplacedPair {
    std::uint32_t a = 0, b = 0;
    double epsilon = 0;  // kcal/mol, >= 0
    double rmin = 0;     // Å
};

// The law of EEF1-SB (forces/nonbonded.h): a dielectric that grows with the distance, `CubicShift`
// and `SmoothSwitch` of field/cutoff.h, and solvation.
struct SmoothEnds {
    double switch_from = 7;  // m, Å
    double cutoff = 9;       // c, Å
    SolvationEnd solvation = SolvationEnd::Smooth;

    double reach() const noexcept;  // Å, from where on pairs have nothing
};

// What all pairs have in common.
struct PairRule {
    double coulomb_constant = 0;  // C, kcal Å/mol/e^2; over eps with smooth ends
    std::span<const ReplacedPair> replaced = {};
    std::optional<SmoothEnds> smooth = {};  // none: no pair has an end
};

// What the environment does to the group as a whole.
struct FieldSum {
    double van_der_waals = 0;       // kcal/mol
    double electrostatic = 0;       // kcal/mol
    double solvation = 0;           // kcal/mol
    Vec3 force = Vec3::Zero();      // on the group, kcal/mol/Å
    Vec3 torque = Vec3::Zero();     // on the group about the origin, kcal/mol
    Mat3 stiffness = Mat3::Zero();  // -d(force)/d(translation of the group), kcal/mol/Å^2

    double energy() const noexcept { return van_der_waals + electrostatic + solvation; }
    Vec3 torque_about(const Vec3& place) const noexcept { return torque - place.cross(force); }

    friend FieldSum operator+(const FieldSum& a, const FieldSum& b) noexcept {
        return {a.van_der_waals + b.van_der_waals,
                a.electrostatic + b.electrostatic,
                a.solvation + b.solvation,
                a.force + b.force,
                a.torque + b.torque,
                a.stiffness + b.stiffness};
    }
};

// Inside this distance (Å) a pair's force falls linearly to zero at zero distance, so that energy,
// force and stiffness are finite wherever the points are, on top of each other included; energy and
// force are continuous there. Walls of thousands of nanonewtons keep points far outside it; it is
// there for accidents.
inline constexpr double pair_core_radius = 0.1;

// Every pair of one point of the group and one of the environment, with CHARMM's combination rules:
//   E = ε[(Rmin/r)^12 - 2 (Rmin/r)^6] + C q q'/r,  ε = (ε_i ε_j)^(1/2),  Rmin = Rmin_i/2 + Rmin_j/2
// or with the rule's smooth ends. Sums run in one order, whatever the processor: four neighbours of
// the environment beside each other without ends, one by one with them.
FieldSum evaluate_pair_field(const FieldPoints& group, const FieldPoints& environment,
                             const PairRule& rule) noexcept;

// The same pairs; adds the force on every point (kcal/mol/Å) to the two spans, of one entry a
// point.
FieldSum add_pair_forces(const FieldPoints& group, const FieldPoints& environment,
                         const PairRule& rule, std::span<Vec3> group_forces,
                         std::span<Vec3> environment_forces) noexcept;

}  // namespace palpa
