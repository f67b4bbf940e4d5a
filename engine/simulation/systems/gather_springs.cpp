#include "simulation/systems/gather_springs.h"

#include "simulation/grip_queries.h"
#include "simulation/solver.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace palpa {
namespace {

// Atom numbers of the model; none if it lacks one of the atoms.
std::vector<std::uint32_t> find_model_numbers(const World& world, const ModelAtoms& atoms,
                                              const AtomsOf& of) {
    std::vector<std::uint32_t> numbers = numbers_of(world, of);
    for (std::uint32_t& number : numbers) {
        const std::optional<std::uint32_t> in_model = atoms.in_model(number);
        if (!in_model) return {};
        number = *in_model;
    }
    return numbers;
}

}  // namespace

std::optional<ModelSpring> find_model_spring(const World& world, const ModelAtoms& atoms,
                                             const Spring& spring) {
    ModelSpring found;
    found.atoms = find_model_numbers(world, atoms, spring.ends.front());
    if (found.atoms.empty()) return {};
    if (spring.ends.size() > 1) {
        found.other_atoms = find_model_numbers(world, atoms, spring.ends.back());
        if (found.other_atoms.empty()) return {};
    }
    found.k = spring.k;
    found.place = spring.place;
    found.length = spring.length;
    return found;
}

void gather_springs(World& world, const StepInput& /*input*/) {
    std::vector<ModelSpring>& springs = world.write<TorsionState>().springs;
    std::vector<Entity>& entities = world.write<GatheredSprings>().entities;
    springs.clear();
    entities.clear();
    if (!has_mobile(world) && places_atoms(world)) return;
    world.each<Spring>([&](Entity entity, const Spring& spring) {
        std::optional<ModelSpring> found = find_model_spring(world, model_atoms_of(world), spring);
        if (!found) return;
        springs.push_back(std::move(*found));
        entities.push_back(entity);
    });
}

void return_ends(World& world) {
    const std::vector<ModelSpring>& springs = world.resource<TorsionState>().springs;
    const std::vector<Entity>& entities = world.resource<GatheredSprings>().entities;
    for (std::size_t i = 0; i < std::min(springs.size(), entities.size()); ++i) {
        const Spring* const spring = world.find<Spring>(entities[i]);
        if (spring && spring->ends.size() == 1 && spring->place != springs[i].place)
            world.write<Spring>(entities[i])->place = springs[i].place;
    }
}

std::optional<std::size_t> find_spring_index(const World& world, Entity entity) noexcept {
    const std::vector<Entity>& entities = world.resource<GatheredSprings>().entities;
    const auto found = std::ranges::lower_bound(entities, entity);
    if (found == entities.end() || *found != entity) return {};
    return static_cast<std::size_t>(found - entities.begin());
}

std::vector<Entity> find_springs(const World& world, Entity owner) {
    std::vector<Entity> found;
    world.each<Spring>([&](Entity entity, const Spring& spring) {
        if (spring.owner == owner) found.push_back(entity);
    });
    return found;
}

double find_spring_energy(const World& world, Entity owner) noexcept {
    const TorsionState& state = world.resource<TorsionState>();
    double energy = 0;
    world.each<Spring>([&](Entity entity, const Spring& spring) {
        if (spring.owner != owner) return;
        if (const std::optional<std::size_t> index = find_spring_index(world, entity))
            energy +=
                find_spring_pull(model_of(world), state.springs[*index], state.positions).energy;
    });
    return energy;
}

}  // namespace palpa
