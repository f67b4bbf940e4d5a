// What one picture of a simulation shows. The only place where doubles become floats.
#pragma once
#include "haptics/exchange.h"
#include "render/frame_scene.h"
#include "scene/description.h"
#include "simulation/simulation.h"
#include "view/signs.h"

#include <vector>

namespace palpa {

struct ViewSettings {
    Representation representation = Representation::BallAndStick;
    Colouring colouring = Colouring::Chain;
    bool force_arrow = true;     // on the grabbed molecule; and its torque where it moves in space
    bool hydrogen_bonds = true;  // of the grabbed molecule with others

    friend bool operator==(const ViewSettings&, const ViewSettings&) = default;
};

// Atoms as spheres, bonds as sticks, in Å as they stand, and the signs of view/signs.h; `labels`
// are the words beside these, for whoever can write. The camera is the caller's
// (view/orbit_camera.h).
FrameScene build_frame(const Simulation& simulation, const TouchModel& touch,
                       const ViewSettings& settings, std::vector<ViewLabel>* labels = nullptr);
// The same with the force as it is now, for which the pairs are summed again.
FrameScene build_frame(const Simulation& simulation, const ViewSettings& settings);

// The atoms of a range among a frame's spheres.
std::vector<SphereShape> shapes_of(const FrameScene& frame, const AtomRange& atoms);

// A place as pictures have it.
glm::vec3 as_float(const Vec3& v);

}  // namespace palpa
