// Plays a journal again: the same ticks, to the bit.
#pragma once
#include "scene/description.h"
#include "session/journal.h"
#include "session/live_events.h"
#include "session/run_headless.h"

#include <functional>
#include <span>

namespace palpa {

// Called for every recorded tick, with all hands.
using LiveTicksFunction = std::function<void(std::span<const LiveTick>)>;

// Plays the session from its first moment; `on_ticks` gets the ticks of all hands from the
// beginning of the recording. Throws LoadError if the scene cannot be loaded, or if the journal
// does not belong to it, that is, uses contact models, orders or poses that do not exist.
void play_journal(const SceneDescription& scene, const Journal& journal,
                  const LiveTicksFunction& on_ticks, const ProgressFunction& progress = {});

}  // namespace palpa
