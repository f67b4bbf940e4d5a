#include "session/unbinding_path.h"

#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace palpa {
namespace {

constexpr double heavier_than_hydrogen = 2.5;  // amu

bool is_heavy(const AtomTable& atoms, std::size_t i) noexcept {
    return atoms.mass[i] >= heavier_than_hydrogen;
}

// The heavy atoms that a hand holds.
std::vector<std::size_t> find_heavy(const World& world, Entity hand) {
    std::vector<std::size_t> heavy;
    for (const std::uint32_t i : held_atoms(world, hand)) {
        if (is_heavy(world.resource<AtomTable>(), i)) heavy.push_back(i);
    }
    return heavy;
}

Vec3 centre_of_held(const World& world) {
    const Entity hand = hand_at(world, 0);
    if (const ModelSpring* const spring = spring_of(world, hand))
        return find_centre_of_mass(model_of(world), spring->atoms,
                                   world.resource<TorsionState>().positions);
    return centre_of_mass(world.resource<AtomTable>(), held_range(world, hand));
}

}  // namespace

bool UnbindingLog::suits(const World& world) const {
    return world.resource<AtomTable>().size() == start_.size() &&
           find_heavy(world, hand_at(world, 0)) == heavy_;
}

UnbindingLog::UnbindingLog(const World& start, double time_s)
    : comparison_(start), start_(start.resource<AtomTable>().positions) {
    const AtomTable& atoms = start.resource<AtomTable>();
    const Entity hand = hand_at(start, 0);
    heavy_ = find_heavy(start, hand);
    const AtomRange grabbed = held_range(start, hand);
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const bool is_grabbed = i >= grabbed.first && i < grabbed.first + grabbed.count;
        if (!is_grabbed && is_heavy(atoms, i)) other_heavy_.push_back(i);
    }
    start_centre_ = centre_of_held(start);
    unbinding_.closest = std::numeric_limits<double>::infinity();
    unbinding_.farthest = -1;  // so that the start counts
    is_whole_ = !spring_of(start, hand);
    add(start, time_s);
}

void UnbindingLog::add(const World& world, double time_s) {
    const std::vector<Vec3>& positions = world.resource<AtomTable>().positions;
    double nearest2 = std::numeric_limits<double>::infinity();
    for (const std::size_t own : heavy_) {
        const Vec3& place = positions[own];
        for (const std::size_t other : other_heavy_) {
            nearest2 = std::min(nearest2, (positions[other] - place).squaredNorm());
        }
    }
    const double clearance = std::sqrt(nearest2);
    unbinding_.closest = std::min(unbinding_.closest, clearance);
    const bool is_free = is_whole_ && std::isfinite(clearance) && clearance > free_angstrom;
    if (is_free && !unbinding_.free_s) unbinding_.free_s = time_s;
    const Vec3 centre = centre_of_held(world);
    const double distance = (centre - start_centre_).norm();
    if (distance > unbinding_.farthest) {
        unbinding_.farthest = distance;
        unbinding_.clearance = clearance;
    }
    last_ = positions;
}

UnbindingPath UnbindingLog::unbinding() const {
    UnbindingPath unbinding = unbinding_;
    const PoseDistance distance = comparison_.between(last_, start_);
    unbinding.last_rmsd = distance.held;
    unbinding.last_backbone = distance.backbone;
    unbinding.last_pocket = distance.pocket;
    return unbinding;
}

}  // namespace palpa
