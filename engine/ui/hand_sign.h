// Draws the force on a hand and the force on its molecule beside the ring that marks where the hand
// wants the molecule.
#pragma once
#include "render/frame_scene.h"
#include "ui/layout.h"

#include <glm/vec3.hpp>
#include <string>

namespace palpa {

struct HandSign {
    glm::vec3 place{0};      // of the ring, Å
    double newton = 0;       // force on the hand
    double most_newton = 3;  // the force that fills its bar
    double molecule_nN = 0;  // force on the molecule
    double most_nN = 1;      // the force that fills its bar
    std::string reason{};    // why the molecule does not follow, in two words; empty: it does
};

// Call between begin and end of the overlay library's frame. Draws two bars above the ring, with
// the forces and the reason, below all panels, within the area.
void draw_hand_sign(const HandSign& sign, const FrameCamera& camera, const ScreenArea& area);

}  // namespace palpa
