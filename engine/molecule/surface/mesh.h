// A molecular surface as a triangle mesh.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace palpa {

// Arrays up to `atoms` have one entry per vertex.
struct SurfaceMesh {
    std::vector<Eigen::Vector3f> places;   // Å
    std::vector<Eigen::Vector3f> normals;  // unit vectors, outward
    // Whose sphere of its radius is nearest; index into the arrays that the surface is made from.
    std::vector<std::uint32_t> atoms;
    // Three to a triangle, counter-clockwise as seen from outside.
    std::vector<std::uint32_t> indices;
};

// Å^2
double find_area(const SurfaceMesh& mesh) noexcept;

// The volume of a closed mesh, Å^3; cavities count as outside.
double find_volume(const SurfaceMesh& mesh) noexcept;

}  // namespace palpa
