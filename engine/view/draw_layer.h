// Draws one layer of a picture: each of its atoms in one representation.
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

// How an atom is drawn: by the settings, its molecule or a layer.
struct AtomLook {
    Representation representation = Representation::BallAndStick;
    Colouring colouring = Colouring::Chain;
    bool visible = true;
};

// What all layers of a frame share.
struct FrameParts {
    const World& world;
    std::span<const ResidueSpan> residues;
    std::span<const SecondaryStructure> structure;  // one entry per residue
    std::span<const SecondaryStructure> structure_of_atoms;
    const std::vector<bool>& held;        // atoms that hands hold
    const std::vector<bool>& in_hand;     // held atoms with the whole molecule of the first hand
    const std::vector<bool>& takes_part;  // hydrogens of drawn hydrogen bonds
    const std::vector<bool>&
        bond_ends;  // side chains with drawn hydrogen bonds: sticks beside ribbons
    ShownHydrogens hydrogens = ShownHydrogens::All;
};

// The ribbons of a layer, reused while unchanged.
struct KeptRibbons {
    std::vector<Vec3> places;        // of all atoms
    std::vector<glm::vec3> colours;  // of all atoms
    std::vector<std::size_t> shown_residues;
    CartoonParts parts;
    std::vector<MeshShape> meshes;
};

// The surface of a layer, stored by blocks.
struct KeptSurface {
    std::vector<std::uint32_t> atoms;  // atoms of the surface
    std::optional<SurfaceCache> cache;
    std::map<BlockIndex, std::vector<float>> potentials;  // kT/e, if requested
    std::vector<Vec3> charge_places;  // positions of the charges for these potentials
};

struct KeptLayer {
    KeptRibbons ribbons;
    KeptSurface surface;
};

// Adds what is visible. `looks` and `colours`: one entry per atom.
void draw_layer(const FrameParts& parts, std::span<const AtomLook> looks,
                std::span<const glm::vec3> colours, float opacity, KeptLayer& kept,
                FrameScene& frame);

}  // namespace palpa
