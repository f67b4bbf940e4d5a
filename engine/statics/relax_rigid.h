// Relaxes a rigid group of points in a fixed environment: six degrees of freedom.
#pragma once
#include "field/pair_field.h"
#include "math/vec.h"

#include <span>

namespace palpa {

// Engine units.
struct RelaxReport {
    double energy_before = 0, energy_after = 0;  // kcal/mol
    double displacement = 0;                     // Å, of the centre
    double angle = 0;                            // rad, turned about the centre
    double force = 0;                            // kcal/mol/Å, norm of the residual
    double torque = 0;                           // kcal/mol, about the centre, of the residual
    int evaluations = 0;                         // number of evaluations of the pair field
};

// Moves `positions` of the group as one rigid body downhill until the norm of its force, and that
// of its torque divided by its radius of gyration, are below `force_tolerance` (kcal/mol/Å), or
// until the energy falls no further; see the report. BFGS steps in translation and rotation about
// `centre`; no point moves more than 0.1 Å in a step, and every step lowers the energy.
// Deterministic. Uses everything of `group` except its positions.
RelaxReport relax_rigid(std::span<Vec3> positions, const Vec3& centre, FieldPoints group,
                        const FieldPoints& environment, const PairRule& rule,
                        double force_tolerance);

}  // namespace palpa
