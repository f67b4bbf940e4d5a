// What one picture of a simulation shows. The only place where doubles become floats.
#pragma once
#include "ecs/world.h"
#include "haptics/exchange.h"
#include "render/frame_scene.h"
#include "scene/description.h"
#include "view/place.h"
#include "view/signs.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace palpa {

struct ViewSettings {
    Representation representation = Representation::BallAndStick;
    Colouring colouring = Colouring::Chain;
    bool force_arrow = true;  // on the grabbed molecule; and its torque where it moves in space
    ShownBonds hydrogen_bonds = ShownBonds::InHand;
    std::vector<ViewLayer> layers{};    // drawn besides
    std::vector<std::string> labels{};  // selections that are named
    ShownHydrogens hydrogens = ShownHydrogens::All;
    Shadows shadows = Shadows::None;
    bool occlusion = true;
    int outline = 1;                    // pixels
    std::vector<std::string> hidden{};  // selections that layers alone draw
    ViewMarks marks{};
    glm::vec3 background{1};  // into which what is older fades

    friend bool operator==(const ViewSettings&, const ViewSettings&) = default;
};

// Builds one frame after another, and keeps what hardly changes between them: secondary structure,
// ribbons, surfaces, and what selections mean. One for each view of a world; any world may follow
// another.
class FrameBuilder {
public:
    FrameBuilder();
    FrameBuilder(FrameBuilder&&) noexcept;
    FrameBuilder& operator=(FrameBuilder&&) noexcept;
    ~FrameBuilder();

    // Atoms as spheres, bonds as sticks, ribbons and surfaces as meshes, in Å as they stand, each
    // molecule as the settings say or as its Appearance does, the settings' layers besides, and the
    // signs of view/signs.h for what hands hold, with the force of `contacts`, of the hands in
    // their order; `labels` are the words beside these, for whoever can write. The camera is the
    // caller's (view/orbit_camera.h). Throws LoadError for a layer's or label's selection that is
    // none, or names what is not there.
    FrameScene build(const World& world, std::span<const ContactModel> contacts,
                     const ViewSettings& settings, std::vector<ViewLabel>* labels = nullptr);

    // Between frames, as often as wanted, the first time before anything has moved: for marks of
    // what was before, where frames are few. `build` does it as well.
    void follow(const World& world, const ViewMarks& marks);

private:
    struct Kept;
    std::unique_ptr<Kept> kept_;
};

// A frame alone.
FrameScene build_frame(const World& world, std::span<const ContactModel> contacts,
                       const ViewSettings& settings, std::vector<ViewLabel>* labels = nullptr);
// The same with the forces as they are now, for which the pairs are summed again.
FrameScene build_frame(const World& world, const ViewSettings& settings,
                       std::vector<ViewLabel>* labels = nullptr);

// The contacts of all hands, with the forces as they are now.
std::vector<ContactModel> find_contacts(const World& world);

// The atoms of a range among a frame's spheres.
std::vector<SphereShape> shapes_of(const FrameScene& frame, const AtomRange& atoms);

}  // namespace palpa
