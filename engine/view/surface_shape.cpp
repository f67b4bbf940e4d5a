#include "view/surface_shape.h"

#include "view/colour_scales.h"

#include <cstddef>

namespace palpa {
namespace {

glm::vec3 vector_of(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

// colour_of(vertex)
template <class Colour>
MeshShape shape_of(const SurfaceMesh& mesh, std::span<const std::uint32_t> picks, float opacity,
                   const Colour& colour_of) {
    MeshShape shape;
    shape.opacity = opacity;
    shape.indices = mesh.indices;
    shape.vertices.reserve(mesh.places.size());
    for (std::size_t i = 0; i < mesh.places.size(); ++i) {
        shape.vertices.push_back({.place = vector_of(mesh.places[i]),
                                  .normal = vector_of(mesh.normals[i]),
                                  .colour = colour_of(i),
                                  .pick = picks[mesh.atoms[i]]});
    }
    return shape;
}

}  // namespace

MeshShape shape_by_atom(const SurfaceMesh& mesh, std::span<const glm::vec3> colours,
                        std::span<const std::uint32_t> picks, float opacity) {
    return shape_of(mesh, picks, opacity, [&](std::size_t i) { return colours[mesh.atoms[i]]; });
}

MeshShape shape_by_potential(const SurfaceMesh& mesh, std::span<const float> potentials,
                             std::span<const std::uint32_t> picks, float opacity) {
    return shape_of(mesh, picks, opacity, [&](std::size_t i) {
        return potential_colour(static_cast<double>(potentials[i]));
    });
}

}  // namespace palpa
