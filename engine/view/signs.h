// Shapes that are no atoms: the force and the torque on the molecule in hand, where the hand wants
// it, its hydrogen bonds, and snaps; and the words beside them. All but the bonds are drawn on top
// of atoms.
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

// A few words beside a place of the picture; a tick's may be left out where there is no room.
struct ViewLabel {
    glm::vec3 place{0};
    std::string text;
    bool is_tick = false;
};

// The arrow of a force is longer by a decade's length for every decade above this.
inline constexpr double least_shown_nN = 1e-3, most_shown_nN = 1e3;
// The arc of a torque is 60° longer for every decade above this, up to 330°.
inline constexpr double least_shown_angstrom_nN = 1e-3;

// What is in the hand and pulled at: spheres are picked by the numbers of its atoms.
struct HeldMolecule {
    AtomRange atoms;
    glm::vec3 place{0};   // Å, where the hand has it
    glm::vec3 centre{0};  // Å, of its mass
};

// The length of an arrow for a decade of force (Å): more for molecules that are seen from farther
// away.
float decade_of(const HeldMolecule& held, const FrameScene& frame);

// Of the arrow of such a force, Å; 0 for one that is not shown.
float arrow_length(double force_nN, float decade);

// A shaft and a head in the colour of forces; as thick as it has to be for that decade.
void add_arrow(const glm::vec3& tail, const glm::vec3& tip, float decade, std::uint32_t pick,
               FrameScene& frame);

// "210 pN", "1.25 nN".
std::string force_in_words(double force_nN);

// An arrow along the force. It stands on the line through the hand's place, outside of the atoms:
// ahead of the molecule if there is room, else it comes from behind, its head at the molecule. A
// ring for each decade: 0.01, 0.1, 1, 10 nN.
void add_force(const glm::vec3& force_nN, const HeldMolecule& held, FrameScene& frame,
               std::vector<ViewLabel>& labels);

// An arc with a head about the axis of the torque, right-handed, where that axis leaves the
// molecule on the side to which it points.
void add_torque(const glm::vec3& torque_angstrom_nN, const HeldMolecule& held, FrameScene& frame,
                std::vector<ViewLabel>& labels);

// The radius (Å) of each of so many atoms as the frame draws it; 0 where it has no sphere.
std::vector<float> find_drawn_radii(const FrameScene& frame, std::size_t atoms);

// Dashes from the hydrogen to the acceptor, where the atoms as drawn leave room. The lengths of up
// to four are written beside them, of more only the shortest's.
void add_hydrogen_bonds(const AtomTable& atoms, std::span<const HydrogenBond> bonds,
                        FrameScene& frame, std::vector<ViewLabel>& labels);

// Two dashed rings about an atom that went far where a minimum had vanished, and the energy that
// was set free, kcal/mol.
void add_snap(const glm::vec3& place, double released, FrameScene& frame,
              std::vector<ViewLabel>& labels);

// Where the hand wants what it has at `place`: a dashed thread to a ring that faces the eye, whose
// length tells of the force. Nothing where they are closer than 0.1 Å.
void add_wish(const glm::vec3& place, const glm::vec3& wish, const glm::vec3& towards_eye,
              FrameScene& frame);

}  // namespace palpa
