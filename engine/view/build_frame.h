// What one picture of a simulation shows. The only place where doubles become floats.
#pragma once
#include "ecs/world.h"
#include "haptics/exchange.h"
#include "render/frame_scene.h"
#include "scene/description.h"
#include "view/signs.h"

#include <span>
#include <vector>

namespace palpa {

struct ViewSettings {
    Representation representation = Representation::BallAndStick;
    Colouring colouring = Colouring::Chain;
    bool force_arrow = true;  // on the grabbed molecule; and its torque where it moves in space
    ShownBonds hydrogen_bonds = ShownBonds::InHand;

    friend bool operator==(const ViewSettings&, const ViewSettings&) = default;
};

// Atoms as spheres, bonds as sticks, in Å as they stand, each molecule as the settings say or as
// its Appearance does, and the signs of view/signs.h for what hands hold, with the
// force of `contacts`, of the hands in their order; `labels` are
// the words beside these, for whoever can write. The camera is the caller's (view/orbit_camera.h).
FrameScene build_frame(const World& world, std::span<const ContactModel> contacts,
                       const ViewSettings& settings, std::vector<ViewLabel>* labels = nullptr);
// The same with the forces as they are now, for which the pairs are summed again.
FrameScene build_frame(const World& world, const ViewSettings& settings);

// The atoms of a range among a frame's spheres.
std::vector<SphereShape> shapes_of(const FrameScene& frame, const AtomRange& atoms);

// A place as pictures have it.
glm::vec3 as_float(const Vec3& v);

}  // namespace palpa
