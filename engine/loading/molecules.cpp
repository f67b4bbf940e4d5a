#include "loading/molecules.h"

#include "charmm/assign.h"
#include "simulation/resources.h"
#include "simulation/solvent.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace palpa {
namespace {

std::vector<ReplacedPair> build_replaced_pairs(const ForceField& force_field,
                                               const std::vector<std::string>& types) {
    std::vector<ReplacedPair> pairs;
    for (std::uint32_t a = 0; a < types.size(); ++a) {
        for (std::uint32_t b = a; b < types.size(); ++b) {
            const auto found = force_field.nbfix.find(std::minmax(types[a], types[b]));
            if (found == force_field.nbfix.end()) continue;
            pairs.push_back({a, b, found->second.epsilon, found->second.rmin});
        }
    }
    return pairs;
}

template <class Value>
void erase(AtomRange range, SharedVector<Value>& shared) {
    std::vector<Value>& column = shared.write();
    const auto first = column.begin() + range.first;
    column.erase(first, first + range.count);
}

// Numbers types in the order of the atoms that have them, as loading does.
void renumber_types(AtomTable& atoms) {
    std::vector<std::string> names;
    for (std::uint32_t& type : atoms.type.write()) {
        const std::string& name = atoms.type_names[type];
        const auto found = std::ranges::find(names, name);
        type = static_cast<std::uint32_t>(found - names.begin());
        if (found == names.end()) names.push_back(name);
    }
    atoms.type_names = std::move(names);
}

}  // namespace

Entity create_molecule(World& world, Molecule molecule, Mobility mobility, Source source) {
    const Entity entity = world.create();
    world.set(entity, std::move(molecule));
    world.set(entity, mobility);
    world.set(entity, std::move(source));
    world.set_resource(AtomEdition{std::make_shared<int>()});
    return entity;
}

AtomRange add_segment_atoms(const ForceField& force_field, const Source& source, AtomTable& atoms) {
    if (!source.connectivity)
        return add_segment_atoms(force_field, *source.structure, source.segment, atoms);
    return add_segment_atoms(force_field, *source.connectivity, *source.structure, source.segment,
                             atoms);
}

void set_interactions(World& world) {
    const ForceFieldInUse& in_use = world.resource<ForceFieldInUse>();
    const ForceFieldDescription& description = in_use.description;
    Interactions interactions{.coulomb_constant = description.coulomb_constant,
                              .replaced_pairs = build_replaced_pairs(
                                  *in_use.force_field, world.resource<AtomTable>().type_names),
                              .smooth = {},
                              .precision = world.resource<MechanicsSettings>().statics.pairs};
    if (description.solvent != Solvent::None) {
        const PairRule rule = find_field_rule(solvent_settings(description)).value();
        interactions.coulomb_constant = rule.coulomb_constant;
        interactions.smooth = rule.smooth;
    }
    world.set_resource(std::move(interactions));
    set_solvation(world);
}

void set_start_places(World& world, Entity entity) {
    const AtomRange range = world.find<Molecule>(entity)->atoms;
    const auto first = world.resource<AtomTable>().positions.begin() + range.first;
    world.set(entity,
              StartPlaces{std::make_shared<const std::vector<Vec3>>(first, first + range.count)});
}

void remove_atoms(World& world, Entity entity) {
    const AtomRange gone = world.find<Molecule>(entity)->atoms;
    AtomTable& atoms = world.write<AtomTable>();
    world.set_resource(AtomEdition{std::make_shared<int>()});
    erase(gone, atoms.names);
    const auto first = atoms.positions.begin() + gone.first;
    atoms.positions.erase(first, first + gone.count);
    erase(gone, atoms.element);
    erase(gone, atoms.mass);
    erase(gone, atoms.charge);
    erase(gone, atoms.sqrt_epsilon);
    erase(gone, atoms.half_rmin);
    erase(gone, atoms.type);
    erase(gone, atoms.b_factor);
    std::vector<std::array<std::uint32_t, 2>>& bonds = atoms.bonds.write();
    std::erase_if(bonds, [&](const std::array<std::uint32_t, 2>& bond) {
        return has_atom(gone, bond[0]) || has_atom(gone, bond[1]);
    });
    for (auto& bond : bonds) {
        for (std::uint32_t& atom : bond) {
            if (atom >= gone.first) atom -= gone.count;
        }
    }
    renumber_types(atoms);
    world.destroy(entity);
    world.write_each<Molecule>([&](Entity, Molecule& molecule) {
        if (molecule.atoms.first < gone.first) return;
        molecule.atoms.first -= gone.count;
        molecule.reference_atom -= gone.count;
    });
}

}  // namespace palpa
