// Finds and draws contacts, clashes and salt bridges between atoms.
#pragma once
#include "ecs/world.h"
#include "molecule/measure.h"
#include "render/frame_scene.h"
#include "scene/choices.h"
#include "view/hydrogen_bonds.h"
#include "view/pocket.h"
#include "view/signs.h"

#include <span>
#include <vector>

namespace palpa {

// A pair whose van der Waals spheres overlap too much.
struct Clash {
    AtomPair pair;
    double excess = 0;  // Å of overlap; of a hydrogen bond or salt bridge 0.4 less
};

// Each pair has one kind. A salt bridge or hydrogen bond is never a contact. It is a clash only if
// it overlaps by 0.4 Å more than other pairs may, because hydrogen bonds are that much shorter
// (UCSF Chimera has the same allowance).
struct ContactPairs {
    std::vector<AtomPair> contacts, salt_bridges;  // molecule/measure.h; sorted by a, then b
    std::vector<Clash> clashes;                    // the largest excess first
};

// Finds the pairs of a world. ShownBonds::InHand: only pairs of an atom that is in hand and one
// that is not. `bonds`: the hydrogen bonds of the same choice, or all.
ContactPairs find_contact_pairs(const World& world, ShownBonds which,
                                std::span<const ResidueSpan> residues,
                                std::span<const HydrogenBond> bonds);

// Draws contacts as thin lines, clashes as thick lines with a disc in the middle, and salt bridges
// as wide dashes. Lines end at the spheres as drawn. Labels: the excess of the worst clash, and the
// lengths of salt bridges where there are at most four.
void add_contact_pairs(const AtomTable& atoms, const ContactPairs& pairs, FrameScene& frame,
                       std::vector<ViewLabel>& labels);

}  // namespace palpa
