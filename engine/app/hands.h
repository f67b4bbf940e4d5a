// The hands of the window: led by mouse and keys, and the signs of where they want their molecules.
#pragma once
#include "ecs/world.h"
#include "window/window.h"

#include <cstddef>

namespace palpa {

// Moves hands by mouse and arrow keys; call once a frame. `types`: the keys go into a text field.
void lead_hands(World& app, const Input& input, bool types);

// The hand takes hold of the molecule where the handle is.
void engage(World& app, std::size_t slot);
// The molecule stays where it is, and the handle goes back to its middle.
void clutch(World& app, std::size_t slot);
// Hands that mouse or keys lead stay where their handles are: they pull at nothing.
void rest_hands(World& app);
// Gives the mouse to the other hand.
void exchange_hands(World& app);
// "first", in the window's language.
const char* name_of_hand(std::size_t hand);

// Adds the rings and threads of the hands to the shown picture.
void show_hand_targets(World& app);
// Draws the force on each hand, and why its molecule does not follow, beside the ring.
void draw_hand_signs(World& app);

}  // namespace palpa
