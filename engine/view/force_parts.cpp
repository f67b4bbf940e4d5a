#include "view/force_parts.h"

#include "core/units.h"
#include "molecule/point_grid.h"
#include "simulation/resources.h"
#include "view/place.h"
#include "view/residue_structure.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace palpa {
namespace {

constexpr double nanonewton_per_unit = 1e-3 * units::piconewton_per_kcal_per_mol_angstrom;

// Those bonded to held ones over three bonds or fewer, and these.
std::vector<bool> find_bonded(const AtomTable& atoms, std::span<const std::uint32_t> numbers) {
    std::vector<bool> held(atoms.size(), false);
    for (const std::uint32_t atom : numbers) held[atom] = true;
    for (int bonds = 0; bonds < 3; ++bonds) {
        const std::vector<bool> before = held;
        for (const auto& [a, b] : atoms.bonds) {
            if (before[a]) held[b] = true;
            if (before[b]) held[a] = true;
        }
    }
    return held;
}

// Each counts by its force.
Vec3 find_middle(std::span<const Vec3> places, std::span<const Vec3> forces) {
    Vec3 sum = Vec3::Zero();
    double weight = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        sum += forces[i].norm() * places[i];
        weight += forces[i].norm();
    }
    return weight > 0 ? Vec3(sum / weight) : places.front();
}

}  // namespace

HeldPoints gather_held(const World& world, std::vector<std::uint32_t> numbers) {
    const AtomTable& atoms = world.resource<AtomTable>();
    std::vector<bool> is_bonded = find_bonded(atoms, numbers);
    GatheredPoints points(atoms, numbers);
    return {std::move(numbers), std::move(is_bonded), std::move(points)};
}

std::vector<Vec3> find_forces_by_atoms(const World& world, const HeldPoints& held, double reach) {
    const AtomTable& atoms = world.resource<AtomTable>();
    std::vector<Vec3> forces(atoms.size(), Vec3::Zero());
    if (held.numbers.empty()) return forces;
    std::optional<PointGrid> grid;
    if (std::isfinite(reach)) grid.emplace(held.points.positions);
    std::vector<std::uint32_t> near;
    for (std::uint32_t i = 0; i < atoms.size(); ++i) {
        if (held.is_bonded[i]) continue;
        if (!grid || grid->has_near(atoms.positions[i], reach)) near.push_back(i);
    }
    const GatheredPoints environment(atoms, near);
    std::vector<Vec3> on_held(held.numbers.size(), Vec3::Zero());
    std::vector<Vec3> on_near(near.size(), Vec3::Zero());
    (void)add_pair_forces(held.points.view(), environment.view(), pair_rule(world), on_held,
                          on_near);
    for (std::size_t i = 0; i < near.size(); ++i) forces[near[i]] = -on_near[i];
    return forces;
}

std::vector<ForcePart> find_force_parts(const World& world, Entity hand, const HeldPoints& held,
                                        ShownForces of, std::span<const ResidueSpan> residues,
                                        double least_nN) {
    std::vector<ForcePart> parts;
    if (of == ShownForces::Hand) return parts;
    const std::vector<Vec3> forces = find_forces_by_atoms(world, held);
    const Mat3& projector = grip_of(world, hand).projector;
    const auto add = [&](std::size_t first, std::size_t end) {
        ForcePart part{first, end, Vec3::Zero()};
        for (std::size_t i = first; i < end; ++i) part.force += forces[i];
        part.force = projector * part.force;
        if (part.force.norm() * nanonewton_per_unit > least_nN) parts.push_back(part);
    };
    for (const ResidueSpan& residue : residues) {
        if (of == ShownForces::Residues) {
            add(residue.first, residue.end);
        } else {
            for (std::size_t i = residue.first; i < residue.end; ++i) add(i, i + 1);
        }
    }
    std::ranges::stable_sort(parts, std::greater(),
                             [](const ForcePart& part) { return part.force.norm(); });
    return parts;
}

ForceEnds find_ends(const World& world, const HeldPoints& held, const ForcePart& part) {
    std::vector<std::uint32_t> exerting;
    for (std::size_t i = part.first; i < part.end; ++i)
        if (!held.is_bonded[i]) exerting.push_back(static_cast<std::uint32_t>(i));
    const GatheredPoints others(world.resource<AtomTable>(), exerting);
    std::vector<Vec3> on_held(held.numbers.size(), Vec3::Zero());
    std::vector<Vec3> on_others(exerting.size(), Vec3::Zero());
    (void)add_pair_forces(held.points.view(), others.view(), pair_rule(world), on_held, on_others);
    return {find_middle(others.positions, on_others), find_middle(held.points.positions, on_held)};
}

glm::vec3 add_force_part(const Vec3& force_nN, const ForceEnds& ends, float decade,
                         FrameScene& frame) {
    constexpr float thinner = 0.5F;
    const bool is_attraction = force_nN.dot(ends.from - ends.on) > 0;
    const float length = arrow_length(force_nN.norm(), decade);
    const glm::vec3 on = as_float(ends.on);
    const glm::vec3 other =
        on + (is_attraction ? length : -length) * as_float(force_nN.normalized());
    if (is_attraction) {
        add_arrow(on, other, thinner * decade, force_part_pick, frame);
    } else {
        add_arrow(other, on, thinner * decade, force_part_pick, frame);
    }
    return other;
}

void add_force_parts(const World& world, Entity hand, ShownForces of,
                     std::span<const ResidueSpan> residues, const HeldMolecule& held,
                     FrameScene& frame, std::vector<ViewLabel>& labels) {
    constexpr std::size_t most_residues = 10, most_atoms = 20, most_certain = 6;
    if (of == ShownForces::Hand) return;
    const HeldPoints points = gather_held(world, held_atoms(world, hand));
    std::vector<ForcePart> parts = find_force_parts(world, hand, points, of, residues);
    parts.resize(std::min(parts.size(), of == ShownForces::Atoms ? most_atoms : most_residues));
    const float decade = decade_of(held, frame);
    const ResidueNames names(world.resource<AtomTable>(), residues);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Vec3 force_nN = nanonewton_per_unit * parts[i].force;
        const glm::vec3 place =
            add_force_part(force_nN, find_ends(world, points, parts[i]), decade, frame);
        labels.push_back({place,
                          fmt::format("{} {}", names.name(parts[i].first, of == ShownForces::Atoms),
                                      force_in_words(force_nN.norm())),
                          i >= most_certain});
    }
}

}  // namespace palpa
