// A picture of a structure as its file has it, before there is a world of it: the trace of each
// chain, and what is no chain as balls and sticks.
#pragma once
#include "molecule/atoms.h"
#include "render/frame_scene.h"

#include <cstdint>
#include <span>

namespace palpa {

// Leaves out waters and hydrogens; of several models or alternate locations it draws the first. The
// marked atoms are drawn as balls in the colour of what is in hand, whatever else they are. The
// caller sets the camera.
FrameScene build_preview(const Structure& structure, std::span<const std::uint32_t> marked = {});

}  // namespace palpa
