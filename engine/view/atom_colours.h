// The colour of every atom, by what a person wants to see of it.
#pragma once
#include "ecs/world.h"
#include "molecule/secondary_structure.h"
#include "scene/choices.h"
#include "view/pocket.h"

#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// One an atom of the table. `structure`: one a residue.
//   element, chain: as choices.h has it
//   residue: acidic, basic, polar, aromatic, other amino acids; bases
//   structure: helices, strands, the rest; what is no protein by element
//   charge: of the residue, from -1 e (red) to 1 e (blue)
//   b-factor: from the lowest to the highest of the table
//   force: what each atom does to what is in the first hand, from 1 pN to 1 nN, logarithmic
//   activity: where everything follows by second order, by how much its joint differs from the
//     linear answer to the hands' move since the last linearisation, from 0.001° to 1°,
//     logarithmic; where few joints are active, whether its joint or base is; else by how much its
//     joint has turned since the scene's files, from 0 to 30°
//   error: by second order, of its joint's angle against complete relaxation, as estimated
//     (statics/joint_answers.h), from 0.001° to 1°, logarithmic; grey without an estimate
//   potential: on surfaces (view/surface_shape.h), all else as by chain
//   hydrophobicity: of the residue (molecule/hydropathy.h)
// The atoms in hands have their elements' colours, but for charge, activity and error.
std::vector<glm::vec3> find_colours(const World& world, Colouring colouring,
                                    std::span<const ResidueSpan> residues,
                                    std::span<const SecondaryStructure> structure);

// The meaning of the colours, a few words each; empty if self-evident.
struct LegendEntry {
    glm::vec3 colour{1};
    std::string text;
};
std::vector<LegendEntry> find_legend(const World& world, Colouring colouring);

// The force (kcal/mol/Å) of each atom on what the first hand holds: pairs within 12 Å; 0 for held
// atoms and atoms within three bonds of these.
std::vector<double> find_pushes(const World& world);

}  // namespace palpa
