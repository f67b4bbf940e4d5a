// Converts a molecule's surface to a shape of a frame.
#pragma once
#include "molecule/surface/mesh.h"
#include "render/frame_scene.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace palpa {

// Each vertex has the colour and pick of its nearest atom: `colours` and `picks` have one entry per
// atom of the surface.
MeshShape shape_by_atom(const SurfaceMesh& mesh, std::span<const glm::vec3> colours,
                        std::span<const std::uint32_t> picks, float opacity = 1);

// Each vertex has the colour of its potential, kT/e (view/colour_scales.h); one value per vertex.
MeshShape shape_by_potential(const SurfaceMesh& mesh, std::span<const float> potentials,
                             std::span<const std::uint32_t> picks, float opacity = 1);

}  // namespace palpa
