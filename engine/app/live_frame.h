// What a window shows of a running session, all of one moment between two steps.
#pragma once
#include "app/scene_objects.h"
#include "math/vec.h"
#include "render/frame_scene.h"
#include "scene/description.h"
#include "session/commands.h"
#include "session/live_simulation.h"
#include "simulation/atom_directory.h"
#include "view/atom_colours.h"
#include "view/build_frame.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace palpa {

struct LiveHand {
    AtomRange held{};                      // atoms in hand, as they are picked; none: it is empty
    Vec3 grabbed_angstrom = Vec3::Zero();  // the reference atom in hand, in the world
    std::string held_address{};            // as an edit takes it; empty: nothing is held
    ContactModel contact{};
    LiveSettings settings{};
};

struct LiveFrame {
    FrameScene picture;  // its camera is the window's business
    std::vector<LiveHand> hands;
    std::shared_ptr<const AtomDirectory> atoms;  // what picks mean
    std::vector<glm::vec3> places;               // Å, of all atoms, drawn or not
    AtomRange framed;                            // what the first view frames; none: everything
    std::vector<ViewLabel> labels;               // of the picture
    std::vector<LegendEntry> legend;             // of its colours
    Readout readout;                             // its contact is the first hand's
    // What a person made of the world and did not undo.
    std::shared_ptr<const std::vector<EditDescription>> edits{};
    SceneObjects objects{};  // the entities of the scene
};

// Of one simulation, by the thread that plays it.
class LiveFrameBuilder {
public:
    LiveFrameBuilder(const SceneDescription& scene, const LiveSimulation& simulation,
                     const ViewSettings& view);

    void show_as(const ViewSettings& view) { view_ = view; }

    LiveFrame build(const LiveSimulation& simulation);

private:
    ViewSettings view_;
    FrameBuilder builder_;
    std::uint64_t edition_;
    std::shared_ptr<const AtomDirectory> atoms_;
    SceneObjects objects_;
    std::shared_ptr<const std::vector<EditDescription>> edits_ =
        std::make_shared<std::vector<EditDescription>>();
    AtomRange framed_;
};

}  // namespace palpa
