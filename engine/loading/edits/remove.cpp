#include "loading/edits/changes.h"
#include "loading/molecules.h"
#include "scene/edits.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"

#include <fmt/format.h>
#include <algorithm>
#include <span>
#include <vector>

namespace palpa {
namespace {

bool names(std::span<const AtomsOf> atoms, Entity molecule) {
    return std::ranges::find(atoms, molecule, &AtomsOf::molecule) != atoms.end();
}

// Removes what names a molecule that goes.
void forget(World& world, Entity molecule) {
    std::vector<Entity> gone;
    world.each<Spring>([&](Entity entity, const Spring& spring) {
        if (names(spring.ends, molecule)) gone.push_back(entity);
    });
    world.each<Mark>([&](Entity entity, const Mark& mark) {
        if (names(mark.atoms, molecule)) gone.push_back(entity);
    });
    for (const Entity entity : gone) world.destroy(entity);
    world.write_each<Grip>([&](Entity, Grip& grip) {
        if (grip.measured_from == molecule) grip.measured_from = grip.molecule;
    });
}

}  // namespace

void RemoveEdit::apply(World& world, std::size_t /*hand*/) const {
    edit_whole(world, [&](World& changed) {
        const Entity removed = find_molecule(changed, molecule);
        std::size_t count = 0;
        changed.each<Molecule>([&](Entity, const Molecule&) { ++count; });
        if (count == 1)
            refuse(fmt::format("'{}' is the last molecule and cannot be removed", molecule));
        for (const Entity hand : find_hands(changed)) {
            const Grip* const grip = changed.find<Grip>(hand);
            if (grip && grip->molecule == removed) release(changed, hand);
        }
        forget(changed, removed);
        remove_atoms(changed, removed);
        set_interactions(changed);
        changed.set_resource(BondedTerms{});
    });
}

}  // namespace palpa
