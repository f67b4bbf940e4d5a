// The surface around a sum of Gaussians.
#pragma once
#include "molecule/surface/field.h"

namespace palpa {

// Where sum_i exp(-sharpness (|p - c_i|^2/R_i^2 - 1)) is 1: a lone atom's sphere has its own
// radius; beside each other atoms flow together, the more the lower the sharpness is (J. F. Blinn,
// ACM Trans. Graph. 1, 235 (1982), whose blobbiness is -sharpness). Terms below e^-7 are omitted.
// The field is the sum's logarithm.
class GaussianField : public SurfaceField {
public:
    GaussianField(double spacing, double sharpness) noexcept
        : spacing_(spacing), sharpness_(sharpness) {}

    double reach(double radius) const noexcept override;
    void move(const BallGrid& grid, std::span<const MovedBall> moved) override;
    bool sample(const BlockIndex& block, BlockSamples& samples) override;
    SurfacePoint refine(const Vec3& near) override;

private:
    SurfacePoint step_to_surface(const Vec3& from) const;

    const BallGrid* grid_ = nullptr;
    double spacing_;  // Å
    double sharpness_;
};

}  // namespace palpa
