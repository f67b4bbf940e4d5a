// Builds the picture of a simulation. Here, and only here, double precision becomes single.
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
    bool force_arrow = true;  // force on the held molecule; also its torque if it moves in space
    ShownBonds hydrogen_bonds = ShownBonds::InHand;
    std::vector<ViewLayer> layers{};    // drawn in addition
    std::vector<std::string> labels{};  // selections with labels
    ShownHydrogens hydrogens = ShownHydrogens::All;
    Shadows shadows = Shadows::None;
    bool occlusion = true;
    int outline = 1;                    // width of the outline, pixels
    std::vector<std::string> hidden{};  // selections that only layers draw
    ViewMarks marks{};
    glm::vec3 background{1};  // background into which older parts of trails fade

    friend bool operator==(const ViewSettings&, const ViewSettings&) = default;
};

// Builds frames and reuses what rarely changes: secondary structure, ribbons, surfaces and
// evaluated selections. Use one per view of a world; worlds may be changed.
class FrameBuilder {
public:
    FrameBuilder();
    FrameBuilder(FrameBuilder&&) noexcept;
    FrameBuilder& operator=(FrameBuilder&&) noexcept;
    ~FrameBuilder();

    // Atoms as spheres, bonds as sticks, ribbons and surfaces as meshes, in Å at their present
    // positions. Each molecule is drawn according to the settings or to its Appearance, plus the
    // settings' layers and the signs of view/signs.h for what hands hold, with the force of
    // `contacts` (in the order of hands). `labels` are texts beside these. The caller sets the
    // camera (view/orbit_camera.h). Throws LoadError for a malformed selection of a layer or label,
    // or one that names something missing.
    FrameScene build(const World& world, std::span<const ContactModel> contacts,
                     const ViewSettings& settings, std::vector<ViewLabel>* labels = nullptr);

    // Updates marks of the past between frames, if frames are rare. Call it as often as wanted, the
    // first time before anything has moved. `build` calls it as well.
    void follow(const World& world, const ViewMarks& marks);

private:
    struct Kept;
    std::unique_ptr<Kept> kept_;
};

// A single frame.
FrameScene build_frame(const World& world, std::span<const ContactModel> contacts,
                       const ViewSettings& settings, std::vector<ViewLabel>* labels = nullptr);
// The same with present forces; the pairs are summed again.
FrameScene build_frame(const World& world, const ViewSettings& settings,
                       std::vector<ViewLabel>* labels = nullptr);

// The contacts of all hands with present forces.
std::vector<ContactModel> find_contacts(const World& world);

// The spheres of a frame that show atoms of a range.
std::vector<SphereShape> shapes_of(const FrameScene& frame, const AtomRange& atoms);

}  // namespace palpa
