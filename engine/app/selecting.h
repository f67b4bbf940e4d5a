// Atoms that a person selects, by an expression or by a box, and labels.
#pragma once
#include "ecs/world.h"
#include "window/window.h"

#include <cstdint>
#include <string>

namespace palpa {

// Selects these atoms; none if the expression is empty. A wrong expression changes nothing, and
// SelectionState::problem says why.
void select_atoms_by(World& app, const std::string& expression);
// Evaluates the expression again once molecules were added or removed; call once a frame.
void select_anew(World& app);
// False if nothing is selected.
bool end_selection(World& app);

// Draws a box with the mouse while Ctrl is held, and selects the atoms in it; true meanwhile.
bool drag_box(World& app, const Input& input);
// Draws the box that is under way over the picture.
void draw_box(const World& app);

// Labels an atom, or removes its label.
void label_atom(World& app, std::uint32_t atom);

}  // namespace palpa
