// Menu bar, toolbar and status bar, made from the list of actions; and signs over the picture.
#pragma once
#include "ecs/world.h"

namespace palpa {

// Each describes a bar to the overlay library and returns its height, pixels; `top`: its place.
float draw_menu_bar(World& app);
float draw_toolbar(World& app, float top);
float draw_status_bar(World& app);

// Draws warnings, the legend of colours and the mark of a recording over the picture.
void draw_warnings_and_legend(World& app);

}  // namespace palpa
