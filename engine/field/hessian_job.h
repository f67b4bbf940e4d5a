// The part of field/body_hessian.h that is compiled for each instruction set.
#pragma once
#include "field/body_hessian.h"

namespace palpa {

// The rows of one panel.
struct HessianJob {
    const HessianPlan* plan;
    const PairScheme* scheme;
    std::size_t panel;
    Vec3 origin;                      // of the panel, from that of the call, Å
    std::span<const Vec3> positions;  // of all atoms
    Vec3 call_origin;
    std::span<const RadialSlopes> replaced;
    HessianSums::Workspace* workspace;
};

// Writes D S of all motions that columns from the panel's first on have, and the sum of each lane's
// blocks; both about the lane's own point, which is written too.
void run_hessian_panel(const HessianJob& job, HessianBlock& rows) noexcept;

// Carries these sums of the rows up the tree.
void carry_rows(const HessianPlan& plan, std::size_t panel, HessianSums& sums) noexcept;

}  // namespace palpa
