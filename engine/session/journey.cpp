#include "session/journey.h"

#include "simulation/components.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace palpa {
namespace {

constexpr double heavier_than_hydrogen = 2.5;  // amu

AtomRange grabbed_atoms(const Simulation& simulation) {
    const Grab& grab = *simulation.world.find<Grab>(simulation.hand);
    return simulation.world.find<Molecule>(grab.molecule)->atoms;
}

std::vector<std::uint32_t> held_atoms(const Simulation& simulation) {
    if (simulation.flexible && simulation.flexible->state.tether) {
        return simulation.flexible->state.tether->atoms;
    }
    const AtomRange grabbed = grabbed_atoms(simulation);
    std::vector<std::uint32_t> atoms(grabbed.count);
    std::iota(atoms.begin(), atoms.end(), grabbed.first);
    return atoms;
}

Vec3 centre_of_held(const Simulation& simulation) {
    if (simulation.flexible && simulation.flexible->state.tether) {
        const Flexible& flexible = *simulation.flexible;
        return find_tethered(flexible.model, *flexible.state.tether, flexible.state.positions);
    }
    return centre_of_mass(simulation.atoms, grabbed_atoms(simulation));
}

}  // namespace

JourneyLog::JourneyLog(const Simulation& start) {
    const auto is_heavy = [&](std::size_t i) {
        return start.atoms.mass[i] >= heavier_than_hydrogen;
    };
    for (const std::uint32_t i : held_atoms(start)) {
        if (!is_heavy(i)) continue;
        heavy_.push_back(i);
        start_.push_back(start.atoms.positions[i]);
    }
    const AtomRange grabbed = grabbed_atoms(start);
    for (std::size_t i = 0; i < start.atoms.size(); ++i) {
        const bool is_grabbed = i >= grabbed.first && i < grabbed.first + grabbed.count;
        if (!is_grabbed && is_heavy(i)) other_heavy_.push_back(i);
    }
    start_centre_ = centre_of_held(start);
    journey_.closest = std::numeric_limits<double>::infinity();
    journey_.farthest = -1;  // so that the start counts
    add(start);
}

void JourneyLog::add(const Simulation& simulation) {
    const std::vector<Vec3>& positions = simulation.atoms.positions;
    double nearest2 = std::numeric_limits<double>::infinity(), square = 0;
    for (std::size_t i = 0; i < heavy_.size(); ++i) {
        const Vec3& place = positions[heavy_[i]];
        square += (place - start_[i]).squaredNorm();
        for (const std::size_t other : other_heavy_) {
            nearest2 = std::min(nearest2, (positions[other] - place).squaredNorm());
        }
    }
    const double clearance = std::sqrt(nearest2);
    journey_.closest = std::min(journey_.closest, clearance);
    const Vec3 centre = centre_of_held(simulation);
    const double distance = (centre - start_centre_).norm();
    if (distance > journey_.farthest) {
        journey_.farthest = distance;
        journey_.clearance = clearance;
    }
    journey_.last_rmsd =
        heavy_.empty() ? 0 : std::sqrt(square / static_cast<double>(heavy_.size()));
}

}  // namespace palpa
