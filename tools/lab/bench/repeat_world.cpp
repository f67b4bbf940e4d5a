#include "tools/lab/bench/repeat_world.h"

#include "molecule/atoms.h"
#include "simulation/components.h"
#include "simulation/resources.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// Calls `use` with every array of the table that has one entry per atom, but positions.
template <class Use>
void each_column(AtomTable& atoms, const Use& use) {
    use(atoms.names);
    use(atoms.element);
    use(atoms.mass);
    use(atoms.charge);
    use(atoms.sqrt_epsilon);
    use(atoms.half_rmin);
    use(atoms.type);
    use(atoms.b_factor);
}

// One more of everything up to `count`; there is room for it.
template <class Value>
void append(SharedVector<Value>& column, std::size_t count) {
    std::vector<Value>& values = column.write();
    for (std::size_t i = 0; i < count; ++i) values.push_back(Value(values[i]));
}

void append_copy(AtomTable& atoms, std::size_t count, std::size_t bonds, const Vec3& by) {
    const auto first = static_cast<std::uint32_t>(atoms.size());
    each_column(atoms, [&](auto& column) { append(column, std::min(count, column.size())); });
    for (std::size_t i = 0; i < count; ++i)
        atoms.positions.push_back(Vec3(atoms.positions[i] + by));
    for (std::size_t i = 0; i < bonds; ++i)
        atoms.bonds.push_back({atoms.bonds[i][0] + first, atoms.bonds[i][1] + first});
}

}  // namespace

World repeat_world(World world, std::size_t atoms) {
    AtomTable& table = world.write<AtomTable>();
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
    each_column(table, [&](auto& column) { column.write().reserve(copies * column.size()); });
    table.positions.reserve(copies * count);
    table.bonds.write().reserve(copies * bonds);
    world.set_resource(AtomEdition{std::make_shared<int>()});
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
