// A journal played again: the same ticks, to the bit.
#pragma once
#include "scene/description.h"
#include "session/journal.h"
#include "session/live_events.h"
#include "session/run_headless.h"

#include <functional>
#include <span>

namespace palpa {

// Gets every tick of all hands that the recording holds.
using LiveTicksFunction = std::function<void(std::span<const LiveTick>)>;

// Plays the session from its first moment; `on_ticks` gets all hands' ticks from where the
// recording begins. Throws LoadError where the scene cannot be loaded, or where the journal is not
// one of it: it uses what was never posted, or begins from what was never read.
void play_journal(const SceneDescription& scene, const Journal& journal,
                  const LiveTicksFunction& on_ticks, const ProgressFunction& progress = {});

}  // namespace palpa
