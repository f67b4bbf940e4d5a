// A surface that follows its atoms and recomputes only changed parts.
#pragma once
#include "molecule/surface/field.h"
#include "molecule/surface/mesh.h"
#include "molecule/surface/polygonise.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

namespace palpa {

enum class SurfaceKind : std::uint8_t {
    Gaussian,  // gaussian_field.h
    Excluded,  // excluded_field.h
};

struct SurfaceSettings {
    SurfaceKind kind = SurfaceKind::Gaussian;
    double spacing = 1;      // lattice spacing, Å
    double sharpness = 1.5;  // sharpness of Gaussians
    double probe = 1.4;      // probe radius of the excluded surface, Å
    // An atom counts as moved once it is farther than this from where the surface has it, Å.
    double tolerance = 0;
};

// How much one update may do: the surface changes first where it is `near`. A block's edge is 8
// spacings, so that an atom reaches 8 to 27 blocks at a spacing of 1 Å, and some 60 at 0.5 Å.
struct SurfaceBudget {
    std::size_t blocks = 32;
    Vec3 near{0, 0, 0};  // Å
};

struct SurfaceUpdate {
    std::vector<BlockIndex> changed;  // blocks with a changed or removed mesh
    std::size_t waiting = 0;          // atoms that moved but are not yet updated
};

// A block's part of the surface. Vertices on the face of two blocks are in both, at the same place.
struct SurfaceBlock {
    SurfaceMesh mesh;
    // Which lattice edge each vertex is on; the same number in all blocks that have it.
    std::vector<std::uint64_t> edges;
};

// At every moment the blocks together are the closed surface of the atoms at `positions()`, which
// are where the last update found them, or, where its budget did not reach, an earlier one.
class SurfaceCache {
public:
    // One radius per atom, Å; atoms with radius 0 have no part in the surface. Throws
    // std::invalid_argument where spacing or sharpness is not above 0, or probe or tolerance below.
    SurfaceCache(std::vector<double> radii, const SurfaceSettings& settings);

    // One place per atom. Without a budget everything is up to date afterwards. With one, atoms are
    // taken by their distance from `near`, until the blocks that they reach are used up, one atom
    // at least; an atom that waits counts as 1 Å nearer with every update, so none waits for ever.
    // Atoms that are not finite, or farther than 500000 lattice points from the origin, have no
    // part in the surface while they are there.
    SurfaceUpdate update(std::span<const Vec3> positions,
                         const std::optional<SurfaceBudget>& budget = std::nullopt);

    std::span<const Vec3> positions() const noexcept { return positions_; }  // Å
    const SurfaceSettings& settings() const noexcept { return settings_; }

    // Blocks that have triangles.
    const std::map<BlockIndex, SurfaceBlock>& blocks() const noexcept { return blocks_; }

private:
    Vec3 usable(const Vec3& place) const;
    std::vector<MovedBall> find_moved(std::span<const Vec3> positions) const;
    void sort_by_distance(std::vector<MovedBall>& moved, const Vec3& near) const;
    void add_blocks(std::uint32_t atom, const Vec3& place, std::vector<BlockIndex>& blocks) const;
    std::set<BlockIndex> take_moved(std::vector<MovedBall>& moved, std::size_t most_blocks);
    bool remake(const BlockIndex& block);

    std::vector<double> radii_;
    SurfaceSettings settings_;
    std::vector<Vec3> positions_;         // not finite: no part in the surface
    std::vector<std::uint32_t> waiting_;  // updates that an atom has waited
    BallGrid grid_;
    std::unique_ptr<SurfaceField> field_;
    std::map<BlockIndex, SurfaceBlock> blocks_;
    LatticeSurface lattice_;  // the present block
};

// All blocks in one mesh, vertices between blocks once.
SurfaceMesh join_blocks(const SurfaceCache& cache);

// The surface of fixed atoms.
SurfaceMesh build_surface(std::span<const Vec3> positions, std::span<const double> radii,
                          const SurfaceSettings& settings);

}  // namespace palpa
