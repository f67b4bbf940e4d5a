// Plays a journal again: the same ticks, to the bit.
#pragma once
#include "scene/description.h"
#include "session/journal.h"
#include "session/live_events.h"
#include "session/live_simulation.h"
#include "session/run_headless.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>

namespace palpa {

// Gets the simulation after each step.
using StepsFunction = std::function<void(const LiveSimulation&)>;

// Plays a session from its first moment, tick by tick. The journal must outlive it.
class JournalPlayer {
public:
    // Loads the scene. Throws LoadError where it cannot be loaded, or where the journal is not one
    // of it.
    // `on_step`: called after every step of the simulation.
    JournalPlayer(const SceneDescription& scene, const Journal& journal,
                  const StageFunction& on_stage = {}, const StepsFunction& on_step = {});
    JournalPlayer(JournalPlayer&&) noexcept;
    JournalPlayer& operator=(JournalPlayer&&) noexcept;
    ~JournalPlayer();

    std::size_t next_tick() const noexcept { return next_; }  // from 0
    bool is_over() const noexcept;

    // One tick of all hands, with what the simulation did before it. Throws LoadError where the
    // journal uses what was never posted, or begins from what was never read.
    std::span<const LiveTick> play_tick();

    const LiveSimulation& simulation() const noexcept;

private:
    class Player;

    std::unique_ptr<Player> player_;
    std::size_t next_ = 0;
};

// Gets every tick of all hands that the recording holds.
using LiveTicksFunction = std::function<void(std::span<const LiveTick>)>;

// Plays the session from its first moment; `on_ticks` gets the ticks of all hands from the
// beginning of the recording, and `on_step` the steps from there. Throws LoadError if the scene
// cannot be loaded, or if the journal does not belong to it, that is, uses contact models, orders
// or poses that do not exist.
void play_journal(const SceneDescription& scene, const Journal& journal,
                  const LiveTicksFunction& on_ticks, const ProgressFunction& progress = {},
                  const StepsFunction& on_step = {});

}  // namespace palpa
