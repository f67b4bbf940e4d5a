// palpa run --commands: lines of standard input drive the run, standard output has the answers.
#pragma once
#include "haptics/device.h"
#include "scene/description.h"
#include "session/scripted_run.h"

#include <memory>
#include <span>

namespace palpa {

// By the lines of standard input, over the devices of the scene's hands, which outlive it.
ScriptEnds standard_ends(std::span<const std::unique_ptr<Device>> devices, bool overwrites);

// Long enough for whatever is asked for: such a run ends where its input does.
SceneDescription without_end(SceneDescription scene);

// Where a line was refused.
inline constexpr int command_refused = 1;

}  // namespace palpa
