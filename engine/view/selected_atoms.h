// Selections in a picture: by an expression (molecule/select.h) or by a box; and their display.
#pragma once
#include "ecs/world.h"
#include "render/frame_scene.h"
#include "simulation/atom_directory.h"

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// One entry per atom. Uses the secondary structure that pictures show. Throws LoadError with the
// column, as parse_selection and select_atoms do.
std::vector<bool> select_as_seen(const World& world, const std::string& expression);

// "12 residues, 180 atoms". Here and below atoms beyond the end of `chosen` count as not chosen.
std::string describe_count(const AtomDirectory& directory, const std::vector<bool>& chosen);

// An expression for the residues with a chosen atom; for the chosen atoms themselves if they are
// all in one residue. "none" if none is chosen.
std::string expression_of(const AtomDirectory& directory, const std::vector<bool>& chosen);

// An expression for this atom.
std::string expression_of(const AtomDirectory& directory, std::uint32_t atom);

// A rectangle of the picture by two corners, pixels from the upper left corner.
struct PictureBox {
    glm::vec2 one{0}, other{0};
};

// Atoms in the frame whose centres lie in the box, including hidden ones; the atoms of ribbons
// stand for their residues. `places`: of all atoms.
std::vector<bool> find_in_box(const FrameScene& frame, std::span<const glm::vec3> places,
                              const PictureBox& box, std::uint32_t width, std::uint32_t height);

// Tints these atoms in the frame and draws them thicker; on ribbons and surfaces tints the residues
// that contain some. Atoms of residues that are not shown become dots.
void highlight(const AtomDirectory& directory, std::span<const glm::vec3> places,
               const std::vector<bool>& chosen, FrameScene& frame);

}  // namespace palpa
