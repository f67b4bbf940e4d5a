#include "app/live_frame.h"

#include "core/load_error.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/select_in_world.h"
#include "simulation/solver.h"
#include "view/first_view.h"
#include "view/legend.h"

#include <algorithm>
#include <string>

namespace palpa {
namespace {

LiveHand show_hand(const World& world, Entity hand, const AtomDirectory& atoms,
                   const LiveSettings& settings) {
    const bool holds = world.find<Grip>(hand) != nullptr;
    return {held_range(world, hand), holds ? held_place(world, hand) : Vec3(Vec3::Zero()),
            held_address(world, hand, atoms), contact_of(world, hand).sent.model, settings};
}

// Layers, labels and what is hidden that cannot be evaluated in this world.
void drop_wrong_selections(const World& world, ViewSettings& view) {
    const std::vector<SecondaryStructure> any(world.resource<AtomTable>().size());
    const auto is_wrong_selection = [&](const Selection& selection) {
        try {
            (void)select_in_world(world, selection, any);
            return false;
        } catch (const LoadError&) {
            return true;
        }
    };
    const auto is_wrong = [&](const std::string& text) {
        return !text.empty() && is_wrong_selection(parse_selection(text));
    };
    std::erase_if(view.layers, [&](const ViewLayer& layer) { return is_wrong(layer.of); });
    std::erase_if(view.labels, is_wrong);
    std::erase_if(view.hidden, is_wrong);
    std::erase_if(view.marks.measures, [&](const std::string& text) {
        const std::vector<Selection> selections = parse_measure(text, "view.measure");
        return std::ranges::any_of(selections, is_wrong_selection);
    });
}

}  // namespace

LiveFrameBuilder::LiveFrameBuilder(const SceneDescription& scene, const LiveSimulation& simulation,
                                   const ViewSettings& view)
    : view_(view),
      edition_(simulation.edition()),
      atoms_(list_atoms(simulation.world())),
      objects_(list_objects(simulation.world())),
      framed_(framed_atoms(scene.view, simulation.world())) {
    builder_.follow(simulation.world(), view_.marks);
}

LiveFrame LiveFrameBuilder::build(const LiveSimulation& simulation) {
    const World& world = simulation.world();
    if (edition_ != simulation.edition()) {
        edition_ = simulation.edition();
        atoms_ = list_atoms(world);
        objects_ = list_objects(world);
        edits_ = std::make_shared<const std::vector<EditDescription>>(simulation.list_edits());
    }
    LiveFrame frame{{}, {}, atoms_, {}, framed_, {}, {}, simulation.readout(), edits_, {}};
    const std::vector<Vec3>& positions = world.resource<AtomTable>().positions;
    frame.places.resize(positions.size());
    std::ranges::transform(positions, frame.places.begin(), as_float);
    std::vector<ContactModel> contacts;
    for (const Entity hand : find_hands(world)) {
        frame.hands.push_back(
            show_hand(world, hand, *atoms_, settings_of(simulation.scene(), frame.hands.size())));
        contacts.push_back(frame.hands.back().contact);
    }
    try {
        frame.picture = builder_.build(world, contacts, view_, &frame.labels);
    } catch (const LoadError&) {  // a layer names a molecule that an edit removed
        drop_wrong_selections(world, view_);
        frame.picture = builder_.build(world, contacts, view_, &frame.labels);
    }
    frame.legend = find_legend(world, view_);
    frame.readout.holds_something = frame.hands.front().held.count > 0;
    frame.readout.contact = contacts.front();
    for (const Entity hand : find_hands(world))
        frame.readout.error_pN = std::max(frame.readout.error_pN, find_error_estimate(world, hand));
    if (const AccuracyController* const accuracy = find_accuracy_controller(world)) {
        frame.readout.error_pN = accuracy->error();
        frame.readout.work_budget = accuracy->work_budget();
    }
    if (const std::optional<Snap> snap = find_last_snap(world))
        frame.readout.snap_step = snap->step;
    frame.readout.playback = find_playback(world);
    update_values(world, objects_);
    frame.objects = objects_;
    return frame;
}

}  // namespace palpa
