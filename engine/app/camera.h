// The camera of the window: what it looks at, and the part of the window that panels leave free.
#pragma once
#include "ecs/world.h"
#include "scene/description.h"
#include "ui/layout.h"
#include "view/orbit_camera.h"

#include <glm/vec2.hpp>

namespace palpa {

// The area that no panel covers, pixels.
ScreenArea free_area(const World& app);
// The place of the camera's target in it: to the right and up, in halves of the window; in pixels.
glm::vec2 free_centre(const World& app);
glm::vec2 target_pixel(const World& app);
Room free_room(const World& app);

// Ends whatever moves the camera by itself.
void take_camera(World& app);
void fly_to(World& app, const OrbitCamera& camera);
// Moves the camera along its flight; call once a frame.
void fly(World& app);

// Shows the scene as it was when the window opened, but molecules where they are now, and what was
// added.
void show_first_view(World& app);
void look_at_all(World& app);
// Shows only the molecule in hand, or all again.
void look_at_held_or_all(World& app);
void look_at_selected_or_ligand(World& app);
// Centres the atom at this pixel; nothing without one.
void look_at_pixel(World& app, double x, double y);

// Draws molecules by the next representation, or colours.
void choose_next_representation(World& app);
void choose_next_colouring(World& app);

// Sends the settings of the picture to the session if they have changed; call once a frame.
void send_view(World& app);
// The present view, for a scene's file.
ViewDescription describe_view(const World& app);

}  // namespace palpa
