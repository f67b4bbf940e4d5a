// Proteins and nucleic acids as ribbons: helices wide and oval, strands flat with arrowheads that
// point to the C terminus, the rest as tubes; bases as plates.
#pragma once
#include "ecs/world.h"
#include "molecule/atoms.h"
#include "molecule/secondary_structure.h"
#include "render/frame_scene.h"
#include "view/pocket.h"

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace palpa {

// The resolution of the drawing.
struct CartoonDetail {
    int pieces = 8;  // segments per residue, at least 2
    int sides = 12;  // sides of tubes and helices, at least 4
};

// Coarser for large systems.
CartoonDetail cartoon_detail(std::size_t residues) noexcept;

// What was drawn.
struct CartoonParts {
    std::size_t helices = 0, strands = 0, arrowheads = 0;
    std::size_t base_plates = 0;  // two for a purine, one for each ring
    std::vector<bool>
        shown;  // one entry per residue; residues that are not shown need another representation
};

// Adds one mesh of closed bodies. `structure` is one a residue (ResidueStructure of
// view/residue_structure.h finds it), `colours` one an atom. A residue has the colour of its CA, of
// a nucleotide that of its C3', and is picked as this atom.
//
// The path goes through atoms CA, of strands through their mean with the neighbours' (1:2:1),
// twice; of nucleic acids from P to P, at the ends C5' and C3'. It ends where residues are missing:
// CA more than 4.5 Å apart, O3' and P more than 2.5 Å. Helices of fewer than three residues and
// strands of one are drawn as tubes. Not shown are residues without neighbours in the chain, and
// all that are no amino acids or nucleotides.
CartoonParts add_cartoon(const AtomTable& atoms, std::span<const ResidueSpan> residues,
                         std::span<const SecondaryStructure> structure,
                         std::span<const glm::vec3> colours, const CartoonDetail& detail,
                         FrameScene& frame);

// The same for the atoms of a world, with a resolution that suits the number of residues. As in
// const std::vector<ResidueSpan> residues = find_residues(world); add_cartoon(world, residues,
// residue_structure.update(atoms, residues), colours, frame);
CartoonParts add_cartoon(const World& world, std::span<const ResidueSpan> residues,
                         std::span<const SecondaryStructure> structure,
                         std::span<const glm::vec3> colours, FrameScene& frame);

}  // namespace palpa
