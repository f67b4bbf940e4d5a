// What one picture of a simulation shows. The only place where doubles become floats.
#pragma once
#include "haptics/exchange.h"
#include "render/frame_scene.h"
#include "simulation/simulation.h"

#include <array>
#include <cstdint>
#include <string_view>

namespace palpa {

// In hand: the grabbed molecule as balls and sticks, all others as thin sticks without hydrogens.
enum class Representation { BallAndStick, SpaceFilling, Licorice, InHand };
inline constexpr std::array<std::string_view, 4> representation_names{
    "ball-and-stick", "space-filling", "licorice", "in-hand"};

// By chain: carbons in a colour of their chain, everything else as by element. Carbons of the
// grabbed molecule have a colour of their own either way.
enum class Colouring { Element, Chain };
inline constexpr std::array<std::string_view, 2> colouring_names{"element", "chain"};

struct ViewSettings {
    Representation representation = Representation::BallAndStick;
    Colouring colouring = Colouring::Chain;
    bool force_arrow = true;  // on the grabbed molecule, 5 Å for 1 nN, at most 3 Å
};

// Atoms and bonds are picked by the index of the atom (of its first atom); the arrow and the wish
// of a hand by these.
inline constexpr std::uint32_t arrow_pick = UINT32_MAX - 1, wish_pick = UINT32_MAX - 2;

// Atoms as spheres, bonds as sticks, in Å as they stand, and the force of `touch` as an arrow. The
// camera is the caller's (view/orbit_camera.h).
FrameScene build_frame(const Simulation& simulation, const TouchModel& touch,
                       const ViewSettings& settings);
// The same with the force as it is now, for which the pairs are summed again.
FrameScene build_frame(const Simulation& simulation, const ViewSettings& settings);

// Whither the hand wants what it has at `place` (Å): a faint dot there and a thread to it, whose
// length tells of the force. Nothing where they are closer than 0.1 Å.
void add_wish(const Vec3& place, const Vec3& wish, FrameScene& frame);

// A place as pictures have it.
glm::vec3 as_float(const Vec3& v);

// What shows a scene best: balls and sticks, but `in-hand` where others would hide the molecule.
ViewSettings default_view(const Simulation& simulation);

}  // namespace palpa
