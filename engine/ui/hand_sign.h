// Draws the force on a hand beside the ring that marks where the hand wants its molecule.
#pragma once
#include "render/frame_scene.h"
#include "ui/layout.h"

#include <glm/vec3.hpp>
#include <string>

namespace palpa {

struct HandSign {
    glm::vec3 place{0};      // of the ring, Å
    double newton = 0;       // force on the hand
    double most_newton = 3;  // the force that fills the bar
    std::string reason{};    // why the molecule does not follow, in two words; empty: it does
};

// Call between begin and end of the overlay library's frame. Draws a bar above the ring, the force
// in newtons and the reason, below all panels, within the area.
void draw_hand_sign(const HandSign& sign, const FrameCamera& camera, const ScreenArea& area);

}  // namespace palpa
