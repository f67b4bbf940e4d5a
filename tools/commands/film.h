// The film of palpa render --film: the scene under the emulated hand, second by second.
#pragma once
#include "ecs/world.h"
#include "scene/description.h"
#include "tools/commands/progress.h"
#include "tools/commands/render.h"
#include "view/build_frame.h"

namespace palpa {

// Of a world as loaded, seen as the first picture frames it. Prints what became of it. Throws
// LoadError or GpuError. Returns the exit code.
int make_film(SceneDescription scene, World& world, const ViewSettings& view,
              const RenderOptions& options, ProgressLine& progress);

}  // namespace palpa
