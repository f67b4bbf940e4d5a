// The device in the hand, chosen while a scene runs, and its force as a tone.
#pragma once
#include "ecs/world.h"

#include <string>

namespace palpa {

bool can_choose_device(const World& app);
// Takes the device that is wanted as soon as it is connected; call once a frame.
void look_for_devices(World& app);
// Returns false, after a message, if it cannot be used.
bool choose_device(World& app, const std::string& name);
// Takes the next connected device that can be used; a message names those that cannot.
void choose_next_device(World& app);

// False if the tone stays off.
bool switch_sound(World& app, bool is_on);
void choose_sound(World& app);
// Plays the force of this moment; call once a frame.
void play_force(World& app);

}  // namespace palpa
