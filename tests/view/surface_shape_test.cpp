#include "view/surface_shape.h"

#include "view/colour_scales.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

using namespace palpa;

TEST_CASE("a surface's vertices have the colour and the pick of their atoms", "[view][surface]") {
    const SurfaceMesh mesh{.places = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}},
                           .normals = {{0, 0, 1}, {0, 0, 1}, {0, 1, 0}},
                           .atoms = {1, 0, 1},
                           .indices = {0, 1, 2}};
    const std::vector<glm::vec3> colours{{1, 0, 0}, {0, 0, 1}};
    const std::vector<std::uint32_t> picks{70, 80};

    const MeshShape shape = shape_by_atom(mesh, colours, picks, 0.5F);
    const MeshShape charged = shape_by_potential(mesh, std::vector<float>{-5, 0, 5}, picks);

    REQUIRE(shape.vertices.size() == 3);
    CHECK(shape.vertices[2].place == glm::vec3(0, 2, 0));
    CHECK(shape.vertices[2].normal == glm::vec3(0, 1, 0));
    CHECK(shape.vertices[0].colour == colours[1]);
    CHECK(shape.vertices[1].colour == colours[0]);
    CHECK(shape.vertices[0].pick == 80);
    CHECK(shape.vertices[1].pick == 70);
    CHECK(shape.indices == mesh.indices);
    CHECK(shape.opacity == 0.5F);
    CHECK(charged.vertices[0].colour == potential_colour(-5));
    CHECK(charged.vertices[2].colour == potential_colour(5));
    CHECK(charged.vertices[2].pick == 80);
    CHECK(charged.opacity == 1);
}
