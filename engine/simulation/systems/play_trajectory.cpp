#include "simulation/systems/play_trajectory.h"

#include "core/load_error.h"
#include "formats/trajectory.h"
#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/playback.h"
#include "simulation/resources.h"
#include "simulation/systems/publish_contact.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace palpa {
namespace {

MoleculeDescription in_one_piece(MoleculeDescription molecule) {
    molecule.shape = Shape::Rigid;
    molecule.anchors.clear();
    if (molecule.motion == Motion::Free) molecule.motion = Motion::Fixed;
    return molecule;
}

void hold_whole(GrabDescription& grab, SceneDescription& scene) {
    grab.atom.clear();
    for (MoleculeDescription& molecule : scene.molecules) {
        if (molecule.name != grab.molecule) continue;
        const bool is_led =
            molecule.motion == Motion::AlongX || molecule.motion == Motion::WithHandle;
        if (!is_led) molecule.motion = Motion::Translate;
    }
}

// Which frame is due, and how far the next step goes on from there.
std::size_t move_on(Playback& playback, double period_s) {
    const auto last = static_cast<double>(playback.trajectory->frame_count() - 1);
    const auto due =
        static_cast<std::size_t>(std::clamp(std::floor(playback.at + 1e-9), 0.0, last));
    if (playback.is_paused) return due;
    playback.at += period_s * playback.frames_per_s;
    if (playback.at < last + 1) return due;
    playback.at = last;
    playback.is_paused = true;  // it ends with its last frame
    return due;
}

// The atoms stay, and it is not tried again at each step.
void stand_before(Playback& playback, std::size_t due, const std::string& what) {
    playback.damage =
        fmt::format("the trajectory stopped at frame {} of {}: {}",
                    playback.shown.value_or(due) + 1, playback.trajectory->frame_count(), what);
    playback.problem = playback.damage;
    playback.is_paused = true;
    playback.shown = due;
}

// From where the frame has it, as a piece of the shape that it has there.
void hold_in_frame(World& world, Entity hand) {
    Grip& grip = *world.write<Grip>(hand);
    const AtomTable& atoms = world.resource<AtomTable>();
    const Molecule& molecule = *world.find<Molecule>(grip.molecule);
    const Molecule& origin = *world.find<Molecule>(grip.measured_from);
    const Vec3 place = atoms.positions[molecule.reference_atom];
    set_shape(world, grip.molecule);
    grip.anchor = atoms.positions[origin.reference_atom];
    grip.pose = {place - grip.anchor, Quat::Identity()};
    grip.line_origin = grip.freedom == 1
                           ? Vec3(0, grip.pose.place_angstrom.y(), grip.pose.place_angstrom.z())
                           : grip.pose.place_angstrom;
    Contact& contact = *world.write<Contact>(hand);
    contact.near = {};  // other atoms may be around it
    ++contact.sent.model.grip_number;
}

void show(World& world, Playback& playback, std::size_t frame) {
    TrajectoryFrame read;
    playback.trajectory->read_frame(frame, read);
    AtomTable& atoms = world.write<AtomTable>();
    atoms.positions = std::move(read.positions);
    playback.shown = frame;
    playback.time_ps = read.time_ps;
    for (const Entity hand : find_hands(world)) {
        if (world.find<Grip>(hand)) hold_in_frame(world, hand);
    }
}

// Why no frame can be put into this world; empty where one can.
std::string find_obstacle(const World& world, const Playback& playback) {
    const std::size_t atoms = world.resource<AtomTable>().size();
    if (atoms != playback.trajectory->atom_count()) {
        return fmt::format(
            "the trajectory is stopped: it has {} atoms, but since an edit the scene has {}; undo "
            "the edit",
            playback.trajectory->atom_count(), atoms);
    }
    if (has_mobile(world))
        return "the trajectory is stopped while a spring holds an atom or a molecule moves by "
               "itself; let go first";
    return {};
}

}  // namespace

void play_trajectory(World& world, const StepInput& /*input*/) {
    Playback* const playback = world.write_if<Playback>();
    if (!playback) return;
    playback->problem = find_obstacle(world, *playback);
    if (!playback->problem.empty()) {
        playback->shown.reset();  // whatever moved meanwhile
        return;
    }
    playback->problem = playback->damage;
    const std::size_t due = move_on(*playback, world.resource<Clock>().period_s);
    if (playback->shown == due) return;
    try {
        show(world, *playback, due);
    } catch (const LoadError& error) {
        stand_before(*playback, due, error.what());
    }
}

SceneDescription as_played(SceneDescription scene) {
    if (scene.engine) {
        throw LoadError(scene.place_of("engine"),
                        "a trajectory cannot be played: a remote engine moves the atoms; expected "
                        "a scene without [engine]");
    }
    for (MoleculeDescription& molecule : scene.molecules) {
        molecule = in_one_piece(std::move(molecule));
        const bool is_held = std::ranges::any_of(scene.hands, [&](const HandDescription& hand) {
            return hand.grab.molecule == molecule.name;
        });
        if (!is_held) molecule.motion = Motion::Fixed;
    }
    for (HandDescription& hand : scene.hands) hold_whole(hand.grab, scene);
    return scene;
}

void start_playback(World& world, const std::filesystem::path& file, const PlaybackOrder& order) {
    Playback playback{.trajectory = open_trajectory(file)};
    const std::size_t atoms = world.resource<AtomTable>().size();
    if (playback.trajectory->atom_count() != atoms) {
        throw LoadError({file.string()},
                        fmt::format("has {} atoms in a frame, but the scene has {}; expected a "
                                    "trajectory of the scene's atoms in the same order",
                                    playback.trajectory->atom_count(), atoms));
    }
    const std::size_t frame = order.frame.value_or(0);
    check_frame(file.string(), frame, playback.trajectory->frame_count());
    show(world, playback, frame);
    world.set_resource(std::move(playback));
    order_playback(world, order);
    for (const Entity hand : find_hands(world)) {
        if (world.find<Grip>(hand)) update_contact(world, hand, {});
    }
}

void order_playback(World& world, const PlaybackOrder& order) {
    Playback* const playback = world.write_if<Playback>();
    if (!playback) return;
    const std::size_t last = playback->trajectory->frame_count() - 1;
    if (order.frame || order.paused == false) playback->damage.clear();
    if (order.frame) playback->at = static_cast<double>(std::min(*order.frame, last));
    if (order.frames_per_s) playback->frames_per_s = std::max(*order.frames_per_s, 0.0);
    if (!order.paused) return;
    playback->is_paused = *order.paused;
    // On from its end means from its beginning.
    if (!order.frame && !playback->is_paused && playback->at >= static_cast<double>(last))
        playback->at = 0;
}

std::optional<PlaybackState> find_playback(const World& world) {
    const Playback* const playback = world.find_resource<Playback>();
    if (!playback) return std::nullopt;
    return PlaybackState{playback->shown.value_or(static_cast<std::size_t>(playback->at)),
                         playback->trajectory->frame_count(),
                         playback->frames_per_s,
                         playback->is_paused,
                         playback->time_ps,
                         playback->problem};
}

std::vector<std::string> list_playback_notes(const World& world) {
    std::vector<std::string> notes;
    const Playback* const playback = world.find_resource<Playback>();
    if (!playback) return notes;
    for (const std::string& note : playback->trajectory->notes())
        notes.push_back(fmt::format("the trajectory has {} complete frames: the file {}",
                                    playback->trajectory->frame_count(), note));
    return notes;
}

void carry_playback(const World& world, World& other) {
    const Playback* const playback = world.find_resource<Playback>();
    if (!playback) return;
    other.set_resource(*playback);
    other.write<Playback>().shown.reset();
}

}  // namespace palpa
