#include "app/scene_objects.h"

#include "core/load_error.h"
#include "loading/named_parts.h"
#include "simulation/mechanics.h"

namespace palpa {

SceneObjects list_objects(const World& world) {
    SceneObjects objects;
    objects.can_relax = needs_mechanics(world);
    const AtomTable& atoms = world.resource<AtomTable>();
    world.each<Molecule, Mobility>(
        [&](Entity entity, const Molecule& molecule, const Mobility& mobility) {
            SceneMolecule shown{molecule.name, molecule.atoms.count, 0, 0, mobility, {}};
            for (std::uint32_t i = 0; i < molecule.atoms.count; ++i) {
                shown.mass += atoms.mass[molecule.atoms.first + i];
                shown.charge += atoms.charge[molecule.atoms.first + i];
            }
            if (const Appearance* const look = world.find<Appearance>(entity))
                shown.appearance = *look;
            objects.molecules.push_back(std::move(shown));
        });
    world.each<Spring>([&](Entity, const Spring& spring) {
        if (spring.owner != Entity{}) return;
        try {
            objects.restraints.push_back(describe(world, spring));
        } catch (const LoadError&) {  // neither an atom nor a residue
        }
    });
    world.each<Mark>([&](Entity, const Mark& mark) {
        objects.marks.push_back({{}, mark.value});
        try {
            objects.marks.back().atoms = describe(world, mark);
        } catch (const LoadError&) {
        }
    });
    return objects;
}

void update_values(const World& world, SceneObjects& objects) {
    std::size_t next = 0;
    world.each<Mark>([&](Entity, const Mark& mark) {
        if (next < objects.marks.size()) objects.marks[next++].value = mark.value;
    });
}

}  // namespace palpa
