// Signs in the picture: the force and torque on the held molecule, the target of the hand, hydrogen
// bonds and snaps, with their labels. All except the bonds are drawn on top of atoms.
#pragma once
#include "molecule/atoms.h"
#include "render/frame_scene.h"
#include "view/hydrogen_bonds.h"
#include "view/picks.h"

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// A label at a point of the picture; a tick's label may be omitted if there is no room.
struct ViewLabel {
    glm::vec3 place{0};
    std::string text;
    bool is_tick = false;
};

// The range of the logarithmic arrow: one decade's length for every decade above the lower limit.
inline constexpr double least_shown_nN = 1e-3, most_shown_nN = 1e3;
// The arc of a torque is 60° longer for every decade above this, up to 330°.
inline constexpr double least_shown_angstrom_nN = 1e-3;

// The held molecule with a force on it: spheres are picked by the indices of its atoms.
struct HeldMolecule {
    AtomRange atoms;
    glm::vec3 place{0};   // Å, position of the hand
    glm::vec3 centre{0};  // Å, centre of mass
};

// Length of an arrow per decade of force (Å): larger for molecules seen from farther away.
float decade_of(const HeldMolecule& held, const FrameScene& frame);

// Length of the arrow for a force, Å; 0 if it is not shown.
float arrow_length(double force_nN, float decade);

// A shaft and a head in the colour of forces, with a thickness that suits the decade.
void add_arrow(const glm::vec3& tail, const glm::vec3& tip, float decade, std::uint32_t pick,
               FrameScene& frame);

// "210 pN", "1.25 nN".
std::string force_in_words(double force_nN);

// An arrow along the force on the line through the hand's position, outside of the atoms: ahead of
// the molecule if there is room, else behind it with its head at the molecule. A ring for each
// decade: 0.01, 0.1, 1, 10 nN.
void add_force(const glm::vec3& force_nN, const HeldMolecule& held, FrameScene& frame,
               std::vector<ViewLabel>& labels);

// An arc with a head about the axis of the torque, right-handed, at the point where the axis leaves
// the molecule.
void add_torque(const glm::vec3& torque_angstrom_nN, const HeldMolecule& held, FrameScene& frame,
                std::vector<ViewLabel>& labels);

// The drawn radius (Å) of each atom of the frame; 0 without a sphere.
std::vector<float> find_drawn_radii(const FrameScene& frame, std::size_t atoms);

// Dashes from the hydrogen to the acceptor between the drawn spheres. Up to four bonds have their
// lengths as labels, more only the shortest.
void add_hydrogen_bonds(const AtomTable& atoms, std::span<const HydrogenBond> bonds,
                        FrameScene& frame, std::vector<ViewLabel>& labels);

// Two dashed rings about the atom that moved farthest in a snap, with the released energy,
// kcal/mol.
void add_snap(const glm::vec3& place, double released, FrameScene& frame,
              std::vector<ViewLabel>& labels);

// The target of the hand for what is at `place`: a dashed line, whose length shows the force, to a
// ring that faces the eye. Nothing if they are closer than 0.1 Å.
void add_wish(const glm::vec3& place, const glm::vec3& wish, const glm::vec3& towards_eye,
              FrameScene& frame);

}  // namespace palpa
