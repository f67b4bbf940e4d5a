#include "tests/simulation/failing_step/write_anything.h"

#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/solver.h"

#include <cstddef>
#include <functional>

namespace palpa {
namespace {

std::vector<Entity> list_tagged(const World& world) {
    std::vector<Entity> tagged;
    world.each<Tag>([&](Entity entity, const Tag&) { tagged.push_back(entity); });
    return tagged;
}

Entity choose(const World& world, std::mt19937& random) {
    const std::vector<Entity> tagged = list_tagged(world);
    return tagged[random() % tagged.size()];
}

using Write = void (*)(World&, std::mt19937&);

constexpr Write writes[] = {
    [](World& world, std::mt19937& random) {
        AtomTable& atoms = world.write<AtomTable>();
        const std::size_t atom = random() % atoms.size();
        atoms.positions[atom] += Vec3::Ones();
        atoms.charge.write()[atom] += 1;
        atoms.names.write()[atom].residue = "ALA";
    },
    [](World& world, std::mt19937& random) {
        TorsionState& state = world.write<TorsionState>();
        if (state.angles.empty()) return;
        state.angles[random() % state.angles.size()] += 1;
        state.positions[random() % state.positions.size()] += Vec3::Ones();
    },
    [](World& world, std::mt19937&) { world.remove_resource<Solver>(); },
    [](World& world, std::mt19937&) {
        if (SecondOrder* const second = write_solver<SecondOrder>(world))
            second->statics.linear = nullptr;
        if (PaperStep* const paper = write_solver<PaperStep>(world)) paper->statics.h = 5;
    },
    [](World& world, std::mt19937&) { world.set_resource(Clock{1, 2, 3}); },
    [](World& world, std::mt19937&) {
        world.write<Coupling>(hand_at(world, 0))->pairs_per_tick = 1;
    },
    [](World& world, std::mt19937&) { world.write<Interactions>().replaced_pairs.push_back({}); },
    [](World& world, std::mt19937&) {
        world.write_each<RigidShape>([](Entity, RigidShape& shape) { shape.atoms.clear(); });
    },
    [](World& world, std::mt19937&) {
        world.write_each<Molecule>([](Entity, Molecule& molecule) { molecule.name += "X"; });
    },
    [](World& world, std::mt19937&) {
        world.write<Grip>(hand_at(world, 0))->pose.place_angstrom += Vec3::Ones();
    },
    [](World& world, std::mt19937&) { world.write<Contact>(hand_at(world, 0))->sent = {}; },
    [](World& world, std::mt19937&) { world.set(world.create(), Spring{}); },
    [](World& world, std::mt19937& random) {
        world.set(world.create(), Tag{1, {double(random())}});
    },
    [](World& world, std::mt19937& random) { world.destroy(choose(world, random)); },
    [](World& world, std::mt19937& random) {
        Tag& tag = *world.write<Tag>(choose(world, random));
        tag.number = -1;
        tag.values.push_back(1);
    },
    [](World& world, std::mt19937& random) { world.remove<Tag>(choose(world, random)); },
};

}  // namespace

void write_anything(World& world, const StepInput& /*input*/) {
    if (!world.resource<Scribbler>().is_active) return;
    std::mt19937 random = world.resource<Scribbler>().random;
    for (int i = 0; i < 8; ++i) writes[random() % std::size(writes)](world, random);
    world.write<Scribbler>().is_active = false;
    world.write<StepReport>().finite = false;
}

}  // namespace palpa
