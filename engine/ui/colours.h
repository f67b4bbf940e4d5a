// Colours of panels and of what is drawn over the picture, in a light and a dark theme.
#pragma once
#include <imgui.h>
#include <glm/vec3.hpp>

namespace palpa {

struct Colours {
    ImU32 hand, molecule, gain, energy;  // of what is plotted
    ImU32 now;                           // the present point of a plot
    ImU32 task, done, wrong;             // of a lesson, and of messages
    ImU32 ink, halo;                     // of text over the picture
    ImU32 ground;                        // behind such text
    ImU32 selection;                     // of a box that selects
    glm::vec3 background;                // of the picture, linear light
};

// The colours of the present theme.
const Colours& colours() noexcept;

bool is_dark_theme() noexcept;
// Chooses the theme, also of the overlay library if it has a context.
void choose_theme(bool is_dark);

// Sets the overlay library's colours for the present theme.
void set_theme_colours();

}  // namespace palpa
