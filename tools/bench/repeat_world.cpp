#include "tools/bench/repeat_world.h"

#include "molecule/atoms.h"
#include "simulation/components.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// One more of everything up to `count`.
template <class Value>
void append(std::vector<Value>& values, std::size_t count) {
    values.reserve(values.size() + count);
    for (std::size_t i = 0; i < count; ++i) values.push_back(Value(values[i]));
}

void append_copy(AtomTable& atoms, std::size_t count, std::size_t bonds, const Vec3& by) {
    const auto first = static_cast<std::uint32_t>(atoms.size());
    append(atoms.names, count);
    append(atoms.element, count);
    append(atoms.mass, count);
    append(atoms.charge, count);
    append(atoms.sqrt_epsilon, count);
    append(atoms.half_rmin, count);
    append(atoms.type, count);
    append(atoms.b_factor, count);
    for (std::size_t i = 0; i < count; ++i)
        atoms.positions.push_back(Vec3(atoms.positions[i] + by));
    for (std::size_t i = 0; i < bonds; ++i)
        atoms.bonds.push_back({atoms.bonds[i][0] + first, atoms.bonds[i][1] + first});
}

}  // namespace

World repeat_world(World world, std::size_t atoms) {
    AtomTable& table = world.resource<AtomTable>();
    table.solvation = {};
    const std::size_t count = table.size(), bonds = table.bonds.size();
    std::vector<Molecule> molecules;
    world.each<Molecule>([&](Entity, const Molecule& molecule) { molecules.push_back(molecule); });
    Eigen::AlignedBox3d box;
    for (const Vec3& place : table.positions) box.extend(place);
    constexpr double gap = 4;  // Å
    const Vec3 edges = box.sizes() + Vec3::Constant(gap);
    const std::size_t copies = (atoms + count - 1) / count;
    auto side = static_cast<std::size_t>(std::cbrt(static_cast<double>(copies)));
    while (side * side * side < copies) ++side;
    for (std::size_t copy = 1; copy < copies; ++copy) {
        const Vec3 cell(static_cast<double>(copy % side), static_cast<double>(copy / side % side),
                        static_cast<double>(copy / side / side));
        const auto first = static_cast<std::uint32_t>(table.size());
        append_copy(table, count, bonds, cell.cwiseProduct(edges));
        for (Molecule molecule : molecules) {
            molecule.name = fmt::format("{} {}", molecule.name, copy);
            molecule.atoms.first += first;
            molecule.reference_atom += first;
            world.set(world.create(), std::move(molecule));
        }
    }
    return world;
}

}  // namespace palpa
