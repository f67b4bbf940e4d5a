// The solvent-excluded surface as a distance field.
#pragma once
#include "molecule/surface/accessible_arcs.h"
#include "molecule/surface/field.h"

#include <vector>

namespace palpa {

// F. M. Richards, Annu. Rev. Biophys. Bioeng. 6, 151 (1977): the probe's centre may be wherever it
// is a probe radius away from every atom's sphere. The field is a place's distance from there, less
// the probe radius, and so Å to the surface. It is exact: the nearest place for the centre touches
// one atom (and is then the projection on the sphere that the place is deepest in), or two or three
// (accessible_arcs.h). Where patches cut each other the surface has edges, as it should. Free
// places for a probe that are enclosed by atoms count: the surface has cavities.
class ExcludedField : public SurfaceField {
public:
    ExcludedField(double spacing, double probe) noexcept : spacing_(spacing), probe_(probe) {}

    double reach(double radius) const noexcept override;
    void move(const BallGrid& grid, std::span<const MovedBall> moved) override;
    bool sample(const BlockIndex& block, BlockSamples& samples) override;
    SurfacePoint refine(const Vec3& near) override;

private:
    struct Deepest {
        double depth = 0;  // within the sphere with the probe's radius, Å
        AtomBall ball;
    };
    struct Block;

    bool is_accessible(const Vec3& place, std::uint32_t atom) const;
    Deepest find_deepest(const Vec3& place) const;
    double find_free(const Vec3& place, const Deepest& deepest, Vec3& free);
    void set_values(const Block& found, BlockSamples& samples);
    const std::vector<AccessibleArc>& arcs_of(const AtomBall& ball);

    const BallGrid* grid_ = nullptr;
    double spacing_;  // Å
    double probe_;    // Å
    double largest_radius_ = 0;
    // Arcs by atom, computed on demand.
    std::vector<std::vector<AccessibleArc>> arcs_;
    std::vector<bool> has_arcs_;
};

}  // namespace palpa
