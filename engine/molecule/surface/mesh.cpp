#include "molecule/surface/mesh.h"

#include "math/vec.h"

#include <array>
#include <cstddef>

namespace palpa {
namespace {

// Calls visit(a, b, c) with the corners of every triangle, relative to the mesh's first vertex.
template <class Visit>
void visit_triangles(const SurfaceMesh& mesh, const Visit& visit) {
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        std::array<Vec3, 3> corner;
        for (std::size_t k = 0; k < 3; ++k)
            corner[k] = (mesh.places[mesh.indices[i + k]] - mesh.places[0]).cast<double>();
        visit(corner[0], corner[1], corner[2]);
    }
}

}  // namespace

double find_area(const SurfaceMesh& mesh) noexcept {
    double area = 0;
    visit_triangles(mesh, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        area += (b - a).cross(c - a).norm() / 2;
    });
    return area;
}

double find_volume(const SurfaceMesh& mesh) noexcept {
    double volume = 0;
    visit_triangles(mesh, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        volume += a.dot(b.cross(c)) / 6;
    });
    return volume;
}

}  // namespace palpa
