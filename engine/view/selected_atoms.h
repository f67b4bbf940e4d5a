// What a person selects in a picture: by an expression (molecule/select.h), or by a box. And how it
// is shown.
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

// One entry an atom. With helices and strands, as pictures show them. Throws LoadError, with the
// column, as parse_selection and select_atoms do.
std::vector<bool> select_as_seen(const World& world, const std::string& expression);

// "12 residues, 180 atoms". Here and below atoms beyond the end of `chosen` are not chosen.
std::string describe_count(const AtomDirectory& directory, const std::vector<bool>& chosen);

// An expression that selects the residues with a chosen atom; or, where they are of one residue
// alone, these atoms. "none" where there are none.
std::string expression_of(const AtomDirectory& directory, const std::vector<bool>& chosen);

// One that selects this atom.
std::string expression_of(const AtomDirectory& directory, std::uint32_t atom);

// Whether an expression is one, and names no molecule but these.
bool names_only(const std::string& expression, std::span<const std::string> molecules);

// A rectangle of the picture, pixels from the upper left, by two of its corners.
struct PictureBox {
    glm::vec2 one{0}, other{0};
};

// The atoms that the frame shows and whose middles are seen in the box, behind others too: of a
// ribbon those that stand for their residues. `places`: of all atoms.
std::vector<bool> find_in_box(const FrameScene& frame, std::span<const glm::vec3> places,
                              const PictureBox& box, std::uint32_t width, std::uint32_t height);

// Tints what the frame shows of these atoms, and makes it thicker; of ribbons and surfaces tints
// the residues that have some. Those of residues that are not shown become dots.
void highlight(const AtomDirectory& directory, std::span<const glm::vec3> places,
               const std::vector<bool>& chosen, FrameScene& frame);

}  // namespace palpa
