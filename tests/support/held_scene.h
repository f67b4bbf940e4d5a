// Scenes with the molecule in the hand first, in the middle or last: nothing may depend on that.
#pragma once
#include "ecs/world.h"
#include "loading/load.h"
#include "scene/description.h"
#include "scene/read_scene.h"
#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa::test {

// Of the scene's molecules the one in the hand becomes the one with that number.
inline SceneDescription with_held_at(std::size_t number, SceneDescription scene) {
    std::vector<MoleculeDescription>& all = scene.molecules;
    const auto found =
        std::ranges::find(all, scene.hands.front().grab.molecule, &MoleculeDescription::name);
    MoleculeDescription held = *found;
    all.erase(found);
    all.insert(all.begin() + static_cast<std::ptrdiff_t>(number), std::move(held));
    return scene;
}

// HIV protease with its inhibitor, as in scenes/hiv.
inline World protease_world() {
    return load_world(read_scene(in_project("scenes/hiv"), std::vector<std::string>()));
}

inline AtomRange range_called(const World& world, std::string_view name) {
    return world.find<Molecule>(molecule_called(world, name))->atoms;
}

// All atoms but those of the molecule in the hand.
inline std::vector<std::uint32_t> atoms_around(const World& world) {
    std::vector<std::uint32_t> atoms;
    for (const AtomRange& range : environment_of(world, hand_at(world, 0))) {
        for (std::uint32_t i = 0; i < range.count; ++i) atoms.push_back(range.first + i);
    }
    return atoms;
}

// The water scene with a third water, called "third", by so much (Å) beside the fixed one.
inline World three_waters(std::size_t held, const Vec3& beside,
                          const std::vector<std::string>& settings = {}) {
    SceneDescription scene = water_scene(settings);
    MoleculeDescription third = scene.molecules.front();
    third.name = "third";
    scene.molecules.push_back(std::move(third));
    World world = load_world(with_held_at(held, std::move(scene)));
    const AtomRange atoms = range_called(world, "third");
    for (std::uint32_t i = 0; i < atoms.count; ++i)
        world.write<AtomTable>().positions[atoms.first + i] += beside;
    return world;
}

}  // namespace palpa::test
