// What palpa run says of a scene and of a run.
#pragma once
#include "ecs/world.h"
#include "scene/description.h"
#include "session/statistics.h"
#include "tools/commands/progress.h"

#include <span>
#include <string>

namespace palpa {

// What the molecule will meet on its line, found by looking along it; what moves by itself.
// Shows on `progress` where it looks, which takes minutes in a large rigid scene.
void print_line(const SceneDescription& scene, const World& world, ProgressLine& progress);

// "warning: " and each, on standard error.
void print_warnings(std::span<const std::string> warnings);

void print_summary(const SceneDescription& scene, const Summary& summary);

}  // namespace palpa
