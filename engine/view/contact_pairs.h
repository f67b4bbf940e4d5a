// Contacts, clashes and salt bridges, drawn between the atoms.
#pragma once
#include "ecs/world.h"
#include "molecule/measure.h"
#include "render/frame_scene.h"
#include "scene/choices.h"
#include "view/pocket.h"
#include "view/signs.h"

#include <span>
#include <vector>

namespace palpa {

// No pair is of two kinds: what is a salt bridge or a hydrogen bond is no contact, and a clash only
// where it overlaps by 0.4 Å more than others must, as hydrogen bonds are that much shorter (UCSF
// Chimera allows as much).
struct ContactPairs {
    std::vector<AtomPair> contacts, salt_bridges;  // molecule/measure.h; by rising atoms
    std::vector<AtomPair> clashes;                 // the most overlap first
};

// In hand: of what hands hold with all the rest.
ContactPairs find_contact_pairs(const World& world, ShownBonds which,
                                std::span<const ResidueSpan> residues);

// Contacts: thin lines; clashes: thick ones with a disc in their middle, and the overlap of the
// worst in words; salt bridges: wide dashes, with the lengths of up to four. From atom to atom as
// drawn.
void add_contact_pairs(const AtomTable& atoms, const ContactPairs& pairs, FrameScene& frame,
                       std::vector<ViewLabel>& labels);

}  // namespace palpa
