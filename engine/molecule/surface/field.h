// The interface of a field whose zero level is the surface.
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

// A ball that moved, appeared or disappeared (then one place is not finite).
struct MovedBall {
    std::uint32_t atom = 0;
    Vec3 from{0, 0, 0}, to{0, 0, 0};  // Å
};

// A function of space from moving balls, positive inside and negative outside.
class SurfaceField {
public:
    virtual ~SurfaceField() = default;
    SurfaceField() = default;
    SurfaceField(const SurfaceField&) = delete;
    SurfaceField& operator=(const SurfaceField&) = delete;

    // Distance from its centre within which a ball of this radius affects the surface, Å.
    virtual double reach(double radius) const noexcept = 0;

    // Updates the balls; `moved` lists those that moved since the last call. The caller owns the
    // grid.
    virtual void move(const BallGrid& grid, std::span<const MovedBall> moved) = 0;

    // Samples all points of a block. Returns false and leaves `samples` unchanged if no ball
    // affects it.
    virtual bool sample(const BlockIndex& block, BlockSamples& samples) = 0;

    // The surface's point beside a place that is less than a lattice edge away.
    virtual SurfacePoint refine(const Vec3& near) = 0;
};

}  // namespace palpa
