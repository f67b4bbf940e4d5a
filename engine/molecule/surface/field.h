// What a surface is the zero of.
#pragma once
#include "molecule/ball_grid.h"
#include "molecule/surface/lattice.h"

#include <cstdint>
#include <span>

namespace palpa {

struct SurfacePoint {
    Vec3 place{0, 0, 0};   // Å
    Vec3 normal{0, 0, 1};  // unit vector, outward
    std::uint32_t atom = 0;
};

// A ball that has moved, or that has come or gone (a place that is not finite).
struct MovedBall {
    std::uint32_t atom = 0;
    Vec3 from{0, 0, 0}, to{0, 0, 0};  // Å
};

// A function of space, above 0 inside and below outside, of balls that move.
class SurfaceField {
public:
    virtual ~SurfaceField() = default;
    SurfaceField() = default;
    SurfaceField(const SurfaceField&) = delete;
    SurfaceField& operator=(const SurfaceField&) = delete;

    // How far from its centre a ball of this radius has an influence on the surface, Å.
    virtual double reach(double radius) const noexcept = 0;

    // The balls as they now stand; `moved` lists those that moved since the last call. The grid is
    // kept by the caller.
    virtual void move(const BallGrid& grid, std::span<const MovedBall> moved) = 0;

    // At every point of a block. False, with `samples` untouched, where no ball has an influence.
    virtual bool sample(const BlockIndex& block, BlockSamples& samples) = 0;

    // The surface's point beside a place that is less than a lattice edge away.
    virtual SurfacePoint refine(const Vec3& near) = 0;
};

}  // namespace palpa
