// The first view of a scene: from its [view], with suitable defaults.
#pragma once
#include "ecs/world.h"
#include "molecule/atoms.h"
#include "scene/description.h"
#include "view/build_frame.h"
#include "view/orbit_camera.h"

#include <array>

namespace palpa {

// Defaults: balls and sticks, but `pocket` if other atoms would hide the molecule.
ViewSettings first_settings(const ViewDescription& view, const World& world);

// The atoms to be framed: a molecule's, or an empty range for everything.
AtomRange framed_atoms(const ViewDescription& view, const World& world);

// A camera that frames these atoms, or everything, as the scene says.
OrbitCamera first_camera(const ViewDescription& view, const FrameScene& frame,
                         const AtomRange& framed, const Room& room);

// The `camera` of a [view] for this camera, without its shift: to 0.1 degree and 0.01 of the zoom,
// within the key's limits.
std::array<double, 3> describe_camera(const OrbitCamera& camera, const ViewDescription& view,
                                      const FrameScene& frame, const AtomRange& framed,
                                      const Room& room);

}  // namespace palpa
