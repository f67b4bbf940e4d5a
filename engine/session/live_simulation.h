// The simulation of a live session as a sequence of events, without clock, thread or device. A live
// session runs it beside its servos; a journal plays it again.
#pragma once
#include "core/stage.h"
#include "ecs/world.h"
#include "haptics/exchange.h"
#include "scene/description.h"
#include "session/commands.h"
#include "session/edit_player.h"
#include "session/lesson_meter.h"
#include "session/live_events.h"
#include "session/unbinding_path.h"
#include "session/undo_history.h"
#include "simulation/client_pull.h"
#include "statics/renewal_worker.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// Receives what the simulation sends to the servo of each hand.
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
    // Loads the scene and posts the first contact models and orders. `devices` belong to the hands
    // of the world, in the same order; hands without a device stand still. `playback`: a trajectory
    // of the scene's atoms to play (simulation/playback.h); the scene then comes from as_played.
    // `on_stage` hears how far loading is.
    // Throws LoadError for a scene that cannot be used, for a device that must not run with the
    // scene's period (check_period), and as start_playback does. Throws EngineLost if the positions
    // come from a remote engine alone and it does not answer.
    LiveSimulation(const SceneDescription& scene, std::vector<HandDevice> devices, ServoLine& line,
                   const std::optional<PlaybackChoice>& playback = {},
                   const StageFunction& on_stage = {});
    LiveSimulation(const LiveSimulation&) = delete;
    LiveSimulation& operator=(const LiveSimulation&) = delete;
    // Ends the connection to a remote engine.
    ~LiveSimulation();

    // Carries out one event. `poses`: the newest poses of all hands.
    void play(const LiveEvent& event, std::span<const HandPose> poses);

    // True if the edit takes so long in this world that another thread has to make it. Then it is
    // played as a long event, built by build_draft() on any one thread, and taken over by an
    // AdoptEvent; one at a time. The world stands still meanwhile; servos keep their contact
    // models.
    bool takes_long(const EditDescription& edit) const noexcept;
    void build_draft() noexcept;

    // Makes the second-order renewal that a step has asked for in another thread; a StepEvent
    // adopts it. Edits and resets wait for that thread.
    void start_renewal();
    bool has_renewal();  // a finished renewal waits to be adopted

    void order(const PlaybackOrder& order) { order_playback(world_, order); }

    const World& world() const noexcept { return world_; }
    const SceneDescription& scene() const noexcept { return scene_; }
    std::span<const HandDevice> devices() const noexcept { return devices_; }
    // True if every device stands still while the session is paused.
    bool all_stand_still() const noexcept;
    // What the simulation reports. Contact, error, work budget and times are filled in by others.
    const Readout& readout() const noexcept { return readout_; }
    // Keeps pulls, settings and the picture out of the history: for journals of before 2.2.
    void undo_edits_alone() { undoes_edits_alone_ = true; }

    // The edits that a person made and did not undo, without the scene's own.
    std::vector<EditDescription> list_edits() const;
    // The path of what the first hand holds, since it was first held; nothing if no molecule moves
    // by itself.
    std::optional<UnbindingPath> unbinding() const;
    // A number that changes when molecules or their names change.
    std::uint64_t edition() const noexcept { return edition_; }

private:
    void play(const PublishEvent& event);
    void play(const StepEvent& event);
    void play(const HoldEvent& event);
    void play(const CommandEvent& event);
    void play(const DeviceEvent& event);
    void play(const AdoptEvent& event);
    void apply(const LiveSettings& settings);
    void set(const LiveSettings& settings);
    void apply(const Pause& pause);
    void apply(const Reset& reset);
    void edit(const EditDescription& edit, bool settles);
    void refuse(const EditDescription& edit, std::string why);
    void publish_edit(bool settles);
    void begin_pulls();
    void note_pulls();
    void publish_history();
    PersonChoices choices() const;
    void follow_unbinding();
    void begin_new_grips(std::span<const std::uint32_t> last_grip_numbers);
    std::vector<std::uint32_t> list_grip_numbers() const;
    void post(std::size_t slot, const LocalContactModel& contact);
    void post_order(std::size_t slot);
    void post_orders();

    SceneDescription scene_;
    std::vector<HandDevice> devices_;
    ServoLine& line_;
    World world_;
    RenewalWorker renewals_;  // of the world
    UndoHistory history_;
    ViewAdditions additions_;
    bool undoes_edits_alone_ = false;
    // A hold of a hand, since it began or since it last rested.
    struct HeldSince {
        World before;  // then, for the history
        Vec3 place;    // Å, of what is held
        Quat turn;
        Vec3 travel_m;          // of the handle
        Vec3 last;              // Å, where it was when it last moved
        double moved_s = 0;     // time of that
        bool is_noted = false;  // it is in the history as a pull
    };
    std::vector<std::optional<HeldSince>> held_since_;  // of each hand
    std::vector<bool> leads_;                           // a person leads the hand by mouse or keys
    // A long edit that is being built.
    struct Draft {
        World before;
        EditDescription edit;
        std::optional<World> changed;  // set once it is built
        std::string refusal;           // or the reason why it is refused
    };
    std::optional<Draft> draft_;
    EditPlayer edits_;
    LessonMeter lesson_;
    std::optional<UnbindingLog> unbinding_;
    std::uint64_t unbinding_edition_ = 0;  // at its last step
    std::optional<ClientPull> pull_;       // that acts in every step
    double time_s_ = 0;                    // of the steps so far
    std::vector<HandPose> poses_;
    // The contact models that the hands feel now; the last step's answer is in the simulation.
    std::vector<ContactModel> felt_;
    std::vector<std::uint64_t> contacts_, orders_;  // numbers of those posted last
    std::uint32_t restarts_ = 0, revision_ = 0;
    std::uint64_t edition_ = 0;
    Readout readout_;
};

}  // namespace palpa
