// A molecule's surface as a frame's shape.
#pragma once
#include "molecule/surface/mesh.h"
#include "render/frame_scene.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace palpa {

// Each vertex in the colour of its nearest atom and picked as that: `colours` and `picks` have an
// entry for each atom that the surface is made from.
MeshShape shape_by_atom(const SurfaceMesh& mesh, std::span<const glm::vec3> colours,
                        std::span<const std::uint32_t> picks, float opacity = 1);

// Each vertex in the colour of its potential, kT/e (view/colour_scales.h), one for each vertex.
MeshShape shape_by_potential(const SurfaceMesh& mesh, std::span<const float> potentials,
                             std::span<const std::uint32_t> picks, float opacity = 1);

}  // namespace palpa
