// What one picture of a simulation shows. The only place where doubles become floats.
#pragma once
#include "render/frame_scene.h"
#include "simulation/simulation.h"

#include <array>
#include <cstdint>
#include <string_view>

namespace palpa {

enum class Representation { BallAndStick, SpaceFilling, Licorice };
inline constexpr std::array<std::string_view, 3> representation_names{"ball-and-stick",
                                                                      "space-filling", "licorice"};

struct ViewSettings {
    Representation representation = Representation::BallAndStick;
    bool force_arrow = true;  // on the grabbed molecule, 5 Å for 1 nN, at most 3 Å
};

// Atoms and bonds are picked by the index of the atom (of its first atom); the arrow by this.
inline constexpr std::uint32_t arrow_pick = UINT32_MAX - 1;

// Atoms as spheres in their elements' colours, bonds as sticks. The camera looks along -z at all
// shapes, from as far as it takes to see them in a picture of that aspect (width over height).
FrameScene build_frame(const Simulation& simulation, const ViewSettings& settings, float aspect);

}  // namespace palpa
