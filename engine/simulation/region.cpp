#include "simulation/region.h"

#include "simulation/grip_queries.h"
#include "simulation/resources.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace palpa {
namespace {

// Places, and a ball around all of them so that most others need not be looked at.
class Places {
public:
    Places(std::span<const Vec3> positions, std::span<const std::uint32_t> atoms) {
        for (const std::uint32_t atom : atoms) places_.push_back(positions[atom]);
        for (const Vec3& place : places_) centre_ += place / static_cast<double>(places_.size());
        for (const Vec3& place : places_) radius_ = std::max(radius_, (place - centre_).norm());
    }

    bool has_within(double reach, const Vec3& of) const {
        if (!((of - centre_).norm() <= radius_ + reach)) return false;
        return std::ranges::any_of(places_, [&](const Vec3& place) {
            return (of - place).squaredNorm() <= reach * reach;
        });
    }

private:
    std::vector<Vec3> places_;
    Vec3 centre_ = Vec3::Zero();
    double radius_ = 0;
};

// The table's numbers of what hands hold, or held last of what there is still.
std::vector<std::uint32_t> update_centre(World& world) {
    RegionCentre centre;
    world.each<Grip>(
        [&](Entity hand, const Grip&) { centre.parts.push_back(held_part_of(world, hand)); });
    if (centre.parts.empty()) {
        if (const RegionCentre* const last = world.find_resource<RegionCentre>()) centre = *last;
        std::erase_if(centre.parts, [&](const AtomsOf& part) {
            return world.find<Molecule>(part.molecule) == nullptr;
        });
    }
    std::vector<std::uint32_t> atoms;
    for (const AtomsOf& part : centre.parts) {
        const std::vector<std::uint32_t> numbers = numbers_of(world, part);
        atoms.insert(atoms.end(), numbers.begin(), numbers.end());
    }
    world.set_resource(std::move(centre));
    return atoms;
}

// Marks residues with an atom so near, or the whole molecule if one is and it moves as a whole.
void mark_inside(const AtomTable& table, const Molecule& molecule, const Mobility& mobility,
                 const Places& around, double reach, std::span<std::uint8_t> is_inside) {
    const std::uint32_t first = molecule.atoms.first, end = first + molecule.atoms.count;
    const auto mark = [&](std::uint32_t from, std::uint32_t to) {
        std::fill(is_inside.begin() + from, is_inside.begin() + to, std::uint8_t{1});
    };
    for (std::uint32_t from = first, to = from; from < end; from = to) {
        bool is_near = false;
        for (; to < end && is_same_residue(table.names[from], table.names[to]); ++to)
            is_near = is_near || around.has_within(reach, table.positions[to]);
        if (!is_near) continue;
        if (mobility.motion != Motion::Fixed) return mark(first, end);
        if (mobility.shape == Shape::Flexible) mark(from, to);
    }
}

}  // namespace

std::optional<Region> find_region(World& world) {
    const MechanicsSettings& settings = world.resource<MechanicsSettings>();
    if (!settings.joints.region_angstrom) return {};
    const AtomTable& table = world.resource<AtomTable>();
    const std::vector<std::uint32_t> held = update_centre(world);
    const Places around(table.positions, held);
    Region region;
    region.is_inside.assign(table.size(), 0);
    world.each<Molecule, Mobility>([&](Entity, const Molecule& molecule, const Mobility& mobility) {
        mark_inside(table, molecule, mobility, around, *settings.joints.region_angstrom,
                    region.is_inside);
    });
    std::vector<std::uint32_t> inside;
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        if (region.is_inside[i] != 0) inside.push_back(i);
    }
    if (inside.empty()) return region;
    std::vector<std::uint8_t> is_needed = region.is_inside;
    for (const std::uint32_t i : held) is_needed[i] = 1;
    world.each<Spring>([&](Entity, const Spring& spring) {
        if (spring.owner != Entity{}) return;
        for (const AtomsOf& end : spring.ends) {
            for (const std::uint32_t i : numbers_of(world, end)) is_needed[i] = 1;
        }
    });
    const Places mobile(table.positions, inside);
    const double reach = settings.statics.cutoff_angstrom
                             ? *settings.statics.cutoff_angstrom + region_margin
                             : std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        if (is_needed[i] != 0 || mobile.has_within(reach, table.positions[i]))
            region.atoms.push_back(i);
    }
    return region;
}

}  // namespace palpa
