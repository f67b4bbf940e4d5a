// The simulation of a live session, one event after the other, without clock, thread or device. A
// live session runs it beside its servos, and a journal runs it again.
#pragma once
#include "core/stage.h"
#include "ecs/world.h"
#include "haptics/exchange.h"
#include "scene/description.h"
#include "session/commands.h"
#include "session/edit_player.h"
#include "session/lesson_meter.h"
#include "session/live_events.h"
#include "simulation/client_pull.h"
#include "simulation/edit.h"
#include "statics/renewal_worker.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// Where its answers go: to the servo of each hand.
class ServoLine {
public:
    ServoLine() = default;
    ServoLine(const ServoLine&) = delete;
    ServoLine& operator=(const ServoLine&) = delete;
    virtual ~ServoLine() = default;

    virtual void post(std::size_t slot, const LocalContactModel& contact, std::uint64_t number) = 0;
    virtual void post(std::size_t slot, const ServoOrder& order) = 0;
};

class LiveSimulation {
public:
    // Loads the scene and posts the first contact models and orders. `devices` are for the hands of
    // the world, in their order; hands beyond these stand still. Throws LoadError, EngineLost where
    // only a remote engine knows where atoms are and does not answer, and where a device must not
    // be run with the scene's period (check_period). `playback`: a trajectory of the scene's atoms
    // to play (simulation/playback.h); its scene is one by as_played. Throws LoadError as
    // start_playback does. `on_stage` hears how far loading is.
    LiveSimulation(const SceneDescription& scene, std::vector<HandDevice> devices, ServoLine& line,
                   const std::optional<PlaybackChoice>& playback = {},
                   const StageFunction& on_stage = {});
    LiveSimulation(const LiveSimulation&) = delete;
    LiveSimulation& operator=(const LiveSimulation&) = delete;
    // Lets a remote engine go.
    ~LiveSimulation();

    // `poses`: the newest of all hands.
    void play(const LiveEvent& event, std::span<const HandPose> poses);

    // Whether the edit takes so long in this world that a thread of its own is to make it: then it
    // is an event that is long, build_draft() by any one thread, and an AdoptEvent. One at a time.
    // Until then the world stands still; servos go on with the contact models they have.
    bool takes_long(const EditDescription& edit) const noexcept;
    void build_draft() noexcept;

    // A thread of its own makes the renewal of second order that a step has asked for; a StepEvent
    // then adopts it. Edits and resets wait for that thread.
    void start_renewal();
    bool has_renewal();  // one is made, and not yet adopted

    void order(const PlaybackOrder& order) { order_playback(world_, order); }

    const World& world() const noexcept { return world_; }
    const SceneDescription& scene() const noexcept { return scene_; }
    std::span<const HandDevice> devices() const noexcept { return devices_; }
    // Every device stands still while the session is paused.
    bool all_stand_still() const noexcept;
    // Of what happened to it; contact, error, work budget and times are left to others.
    const Readout& readout() const noexcept { return readout_; }
    // What a person made of the world and did not undo; without the scene's own edits.
    std::vector<EditDescription> list_edits() const;
    // Another number: molecules, or their names, are others than before.
    std::uint64_t edition() const noexcept { return edition_; }

private:
    void play(const PublishEvent& event);
    void play(const StepEvent& event);
    void play(const HoldEvent& event);
    void play(const CommandEvent& event);
    void play(const DeviceEvent& event);
    void play(const AdoptEvent& event);
    void obey(const LiveSettings& settings);
    void obey(const Pause& pause);
    void obey(const Reset& reset);
    void edit(const EditDescription& edit, bool settles);
    void refuse(const EditDescription& edit, std::string why);
    void publish_edit(bool settles);
    void take_hold_anew(std::span<const std::uint32_t> last_starts);
    std::vector<std::uint32_t> list_starts() const;
    void post(std::size_t slot, const LocalContactModel& contact);
    void post_order(std::size_t slot);
    void post_orders();

    SceneDescription scene_;
    std::vector<HandDevice> devices_;
    ServoLine& line_;
    World world_;
    RenewalWorker renewals_;  // of the world
    EditHistory history_;
    // A long edit, on its way.
    struct Draft {
        World before;
        EditDescription edit;
        std::optional<World> changed;  // as soon as it is built
        std::string refusal;           // or why it cannot be
    };
    std::optional<Draft> draft_;
    EditPlayer edits_;
    LessonMeter lesson_;
    std::optional<ClientPull> pull_;  // that acts in every step
    double time_s_ = 0;               // of the steps so far
    std::vector<HandPose> poses_;
    // By the hands now; what the last step answered is the simulation's.
    std::vector<ContactModel> felt_;
    std::vector<std::uint64_t> contacts_, orders_;  // posted so far
    std::uint32_t restarts_ = 0, revision_ = 0;
    std::uint64_t edition_ = 0;
    Readout readout_;
};

}  // namespace palpa
