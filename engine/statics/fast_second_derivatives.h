// Second derivatives of the energy with respect to joints, bases and hand coordinates, with the
// fastest instructions of the processor: pairs in single precision, sums in double.
#pragma once
#include "field/body_hessian.h"
#include "statics/second_derivatives.h"

namespace palpa {

// Constant data of a model and its coordinates.
struct FastSecondDerivatives {
    ModelPaths paths;
    HessianPlan plan;
    LocalCoordinates ordered;             // in the plan's numbering
    std::vector<Eigen::Index> column_of;  // column of each coordinate in the caller's numbering
};

FastSecondDerivatives build_fast_second_derivatives(const TorsionModel& model,
                                                    const LocalCoordinates& coordinates);

// Memory reused between calls.
struct SecondDerivativesMemory {
    HessianSums sums;
    std::vector<CoordinateMotion> motions;
};

// The same as update_second_derivatives. Pairs are in single precision if their energies have no
// cutoff, both forces are switched, or both have the smooth ends of EEF1-SB; for other schemes, and
// where atoms coincide, the reference implementation does everything. Returns whether single
// precision was used.
//
// Diagonal blocks come from the same numbers as the off-diagonal ones. So moving everything
// together costs no energy up to double rounding, and soft directions are preserved: for HIV-1
// protease with TL-3 the lowest eigenvalue and the stiffness at the hand agree within 5e-4.
bool update_fast_second_derivatives(const TorsionModel& model, const LocalCoordinates& coordinates,
                                    const FastSecondDerivatives& fast,
                                    const NonbondedSettings& settings, const TorsionState& state,
                                    SecondDerivativesMemory& memory,
                                    SecondDerivatives& derivatives);

}  // namespace palpa
