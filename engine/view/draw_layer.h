// One layer of a picture: some atoms in one representation each.
#pragma once
#include "ecs/world.h"
#include "molecule/secondary_structure.h"
#include "molecule/surface/surface_cache.h"
#include "render/frame_scene.h"
#include "scene/choices.h"
#include "view/cartoon.h"
#include "view/pocket.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// How an atom is drawn: as everything, as its molecule says, or as a layer does.
struct AtomLook {
    Representation representation = Representation::BallAndStick;
    Colouring colouring = Colouring::Chain;
    bool visible = true;
};

// What is the same for all layers of a frame.
struct FrameParts {
    const World& world;
    std::span<const ResidueSpan> residues;
    std::span<const SecondaryStructure> structure;  // one a residue
    std::span<const SecondaryStructure> structure_of_atoms;
    const std::vector<bool>& held;        // atoms that hands hold
    const std::vector<bool>& in_hand;     // with the whole molecule of the first hand
    const std::vector<bool>& takes_part;  // hydrogens of hydrogen bonds that are drawn
    const std::vector<bool>& bond_ends;   // side chains at which these end: sticks beside ribbons
    ShownHydrogens hydrogens = ShownHydrogens::All;
};

// The ribbons of a layer as they were last made.
struct KeptRibbons {
    std::vector<Vec3> places;        // of all atoms
    std::vector<glm::vec3> colours;  // of all atoms
    std::vector<std::size_t> shown_residues;
    CartoonParts parts;
    std::vector<MeshShape> meshes;
};

// The surface of a layer, by blocks.
struct KeptSurface {
    std::vector<std::uint32_t> atoms;  // that it is of
    std::optional<SurfaceCache> cache;
    std::map<BlockIndex, std::vector<float>> potentials;  // kT/e, where they are wanted
    std::vector<Vec3> charge_places;                      // that these are of
};

struct KeptLayer {
    KeptRibbons ribbons;
    KeptSurface surface;
};

// Adds what is visible. `looks` and `colours`: one an atom.
void draw_layer(const FrameParts& parts, std::span<const AtomLook> looks,
                std::span<const glm::vec3> colours, float opacity, KeptLayer& kept,
                FrameScene& frame);

}  // namespace palpa
