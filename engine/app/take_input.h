// Keys, mouse and devices of the window.
#pragma once
#include "ecs/world.h"

namespace palpa {

// Polls the window's events and acts on them; call once a frame.
void take_input(World& app);

}  // namespace palpa
