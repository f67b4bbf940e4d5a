#include "molecule/surface/surface_cache.h"

#include "core/assertion.h"
#include "molecule/surface/excluded_field.h"
#include "molecule/surface/gaussian_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <unordered_map>

namespace palpa {
namespace {

// Cells of the grid of atoms, Å: small against the reach of an atom.
constexpr double grid_edge = 3;
constexpr double most_spacings = 500000;  // of the lattice, from its origin
const Vec3 nowhere = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());

std::unique_ptr<SurfaceField> make_field(const SurfaceSettings& settings) {
    if (settings.kind == SurfaceKind::Excluded)
        return std::make_unique<ExcludedField>(settings.spacing, settings.probe);
    return std::make_unique<GaussianField>(settings.spacing, settings.sharpness);
}

std::uint64_t edge_number(const BlockIndex& block, const LatticeCrossing& crossing) {
    constexpr std::int64_t half = std::int64_t{1} << 19;  // 20 bits a coordinate
    std::uint64_t number = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int64_t point = std::int64_t{block[k]} * block_cells + crossing.point[k];
        number = number << 20U | static_cast<std::uint64_t>(point + half);
    }
    return number << 2U | static_cast<std::uint64_t>(crossing.axis);
}

}  // namespace

SurfaceCache::SurfaceCache(std::vector<double> radii, const SurfaceSettings& settings)
    : radii_(std::move(radii)),
      settings_(settings),
      positions_(radii_.size(), nowhere),
      waiting_(radii_.size(), 0) {
    if (!(settings.spacing > 0) || !(settings.sharpness > 0) || !(settings.probe >= 0) ||
        !(settings.tolerance >= 0)) {
        throw std::invalid_argument(
            "a surface needs a spacing (Å) and a sharpness above 0, and a probe radius and a "
            "tolerance (Å) of 0 or more");
    }
    field_ = make_field(settings);
}

// Where an atom has a part in the surface; elsewhere not a number.
Vec3 SurfaceCache::usable(const Vec3& place) const {
    const double limit = most_spacings * settings_.spacing;
    if (place.allFinite() && place.cwiseAbs().maxCoeff() < limit) return place;
    return nowhere;
}

std::vector<MovedBall> SurfaceCache::find_moved(std::span<const Vec3> positions) const {
    std::vector<MovedBall> moved;
    for (std::uint32_t atom = 0; atom < radii_.size(); ++atom) {
        if (!(radii_[atom] > 0)) continue;
        const Vec3 &from = positions_[atom], to = usable(positions[atom]);
        const bool was = from.allFinite(), is = to.allFinite();
        if (was != is || (is && (to - from).norm() > settings_.tolerance))
            moved.push_back({atom, from, to});
    }
    return moved;
}

void SurfaceCache::sort_by_distance(std::vector<MovedBall>& moved, const Vec3& near) const {
    std::vector<std::pair<double, MovedBall>> by_distance;
    by_distance.reserve(moved.size());
    for (const MovedBall& ball : moved) {
        const Vec3& place = ball.to.allFinite() ? ball.to : ball.from;
        by_distance.emplace_back((place - near).norm() - waiting_[ball.atom], ball);
    }
    std::ranges::stable_sort(by_distance, {}, &std::pair<double, MovedBall>::first);
    std::ranges::transform(by_distance, moved.begin(), &std::pair<double, MovedBall>::second);
}

// Every block with a point within the atom's reach, those included that only touch.
void SurfaceCache::add_blocks(std::uint32_t atom, const Vec3& place,
                              std::vector<BlockIndex>& blocks) const {
    if (!place.allFinite()) return;
    const double edge = block_cells * settings_.spacing;
    const double far = field_->reach(radii_[atom]);
    BlockIndex low{}, high{};
    for (int k = 0; k < 3; ++k) {
        low[static_cast<std::size_t>(k)] =
            static_cast<std::int32_t>(std::ceil((place[k] - far) / edge)) - 1;
        high[static_cast<std::size_t>(k)] =
            static_cast<std::int32_t>(std::floor((place[k] + far) / edge));
    }
    for (std::int32_t x = low[0]; x <= high[0]; ++x)
        for (std::int32_t y = low[1]; y <= high[1]; ++y)
            for (std::int32_t z = low[2]; z <= high[2]; ++z) blocks.push_back({x, y, z});
}

// Takes from `moved` what fits into the budget; the others stay where the surface has them.
std::set<BlockIndex> SurfaceCache::take_moved(std::vector<MovedBall>& moved,
                                              std::size_t most_blocks) {
    std::set<BlockIndex> blocks;
    std::vector<MovedBall> taken;
    std::vector<BlockIndex> reached;
    for (const MovedBall& ball : moved) {
        reached.clear();
        add_blocks(ball.atom, ball.from, reached);
        add_blocks(ball.atom, ball.to, reached);
        std::ranges::sort(reached);
        reached.erase(std::ranges::unique(reached).begin(), reached.end());
        const auto more = static_cast<std::size_t>(std::ranges::count_if(
            reached, [&](const BlockIndex& block) { return !blocks.contains(block); }));
        if (!taken.empty() && more > 0 && blocks.size() + more > most_blocks) continue;
        blocks.insert(reached.begin(), reached.end());
        taken.push_back(ball);
    }
    moved = std::move(taken);
    return blocks;
}

bool SurfaceCache::remake(const BlockIndex& block) {
    const auto old = blocks_.find(block);
    const bool had = old != blocks_.end();
    BlockSamples samples;
    if (field_->sample(block, samples)) {
        polygonise(samples, lattice_);
    } else {
        lattice_ = {};
    }
    if (lattice_.vertices.empty()) {
        if (had) blocks_.erase(old);
        return had;
    }
    SurfaceBlock& made = had ? old->second : blocks_[block];
    made.mesh.places.clear();
    made.mesh.normals.clear();
    made.mesh.atoms.clear();
    made.edges.clear();
    for (const LatticeCrossing& crossing : lattice_.vertices) {
        Vec3 place;
        for (int k = 0; k < 3; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            place[k] = point_coordinate(block[axis], crossing.point[axis], settings_.spacing);
        }
        place[crossing.axis] += static_cast<double>(crossing.share) * settings_.spacing;
        const SurfacePoint point = field_->refine(place);
        made.mesh.places.emplace_back(point.place.cast<float>());
        made.mesh.normals.emplace_back(point.normal.cast<float>());
        made.mesh.atoms.push_back(point.atom);
        made.edges.push_back(edge_number(block, crossing));
    }
    made.mesh.indices = lattice_.indices;
    return true;
}

SurfaceUpdate SurfaceCache::update(std::span<const Vec3> positions,
                                   const std::optional<SurfaceBudget>& budget) {
    PALPA_ASSERT(positions.size() == radii_.size());
    SurfaceUpdate report;
    std::vector<MovedBall> moved = find_moved(positions);
    if (moved.empty()) return report;
    const std::size_t all = moved.size();
    if (budget) {
        for (const MovedBall& ball : moved) ++waiting_[ball.atom];
        sort_by_distance(moved, budget->near);
    }
    const std::set<BlockIndex> blocks =
        take_moved(moved, budget ? budget->blocks : std::numeric_limits<std::size_t>::max());
    for (const MovedBall& ball : moved) {
        positions_[ball.atom] = ball.to;
        waiting_[ball.atom] = 0;
    }
    grid_ = BallGrid(positions_, radii_, grid_edge);
    field_->move(grid_, moved);
    for (const BlockIndex& block : blocks)
        if (remake(block)) report.changed.push_back(block);
    report.waiting = all - moved.size();
    return report;
}

SurfaceMesh join_blocks(const SurfaceCache& cache) {
    SurfaceMesh joined;
    std::unordered_map<std::uint64_t, std::uint32_t> number_of_edge;
    std::vector<std::uint32_t> numbers;  // of a block's vertices, in the whole mesh
    for (const auto& [index, block] : cache.blocks()) {
        numbers.clear();
        for (std::size_t i = 0; i < block.edges.size(); ++i) {
            const auto next = static_cast<std::uint32_t>(joined.places.size());
            const auto [entry, is_new] = number_of_edge.try_emplace(block.edges[i], next);
            numbers.push_back(entry->second);
            if (!is_new) continue;
            joined.places.push_back(block.mesh.places[i]);
            joined.normals.push_back(block.mesh.normals[i]);
            joined.atoms.push_back(block.mesh.atoms[i]);
        }
        for (const std::uint32_t i : block.mesh.indices) joined.indices.push_back(numbers[i]);
    }
    return joined;
}

SurfaceMesh build_surface(std::span<const Vec3> positions, std::span<const double> radii,
                          const SurfaceSettings& settings) {
    SurfaceCache cache(std::vector<double>(radii.begin(), radii.end()), settings);
    cache.update(positions);
    return join_blocks(cache);
}

}  // namespace palpa
