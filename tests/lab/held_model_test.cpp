#include "tools/lab/bench/held_model.h"

#include "charmm/build_topology.h"
#include "formats/psf.h"
#include "formats/structure.h"
#include "molecule/match_atoms.h"
#include "statics/torsion_state.h"
#include "tests/support/paths.h"
#include "tests/support/torsion_case.h"
#include "tools/lab/bench/cut_sphere.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <random>
#include <set>
#include <vector>

using namespace palpa;

namespace {

// A ball of HIV protease about Asp 25 of chain A.
CutSystem cut_of_hiv(std::size_t most_atoms) {
    const std::filesystem::path folder = test::in_project("scenes/hiv");
    const Connectivity connectivity = read_psf(folder / "system.psf");
    const std::vector<Vec3> positions =
        match_positions(connectivity, read_structure(folder / "system.crd"));
    const std::vector<std::filesystem::path> files{folder / "system.prm"};
    const Topology topology = build_topology(connectivity, read_force_field(files));
    const auto centre = std::ranges::find(connectivity.names, "A ASP 25 CG",
                                          [](const AtomName& name) { return to_string(name); });
    return cut_sphere(connectivity, topology, positions,
                      static_cast<std::uint32_t>(centre - connectivity.names.begin()), most_atoms);
}

// How many pieces the bonds make, by joining sets until nothing changes.
std::size_t count_pieces(const Connectivity& connectivity) {
    std::vector<std::size_t> piece(connectivity.mass.size());
    for (std::size_t i = 0; i < piece.size(); ++i) piece[i] = i;
    for (bool changes = true; changes;) {
        changes = false;
        for (const auto& [a, b] : connectivity.bonds) {
            const std::size_t least = std::min(piece[a], piece[b]);
            changes = changes || piece[a] != piece[b];
            piece[a] = piece[b] = least;
        }
    }
    return std::set<std::size_t>(piece.begin(), piece.end()).size();
}

}  // namespace

TEST_CASE("pieces of chain in a sphere are molecules, held by their bases", "[statics][sphere]") {
    const CutSystem sphere = cut_of_hiv(1000);

    const TorsionModel model =
        build_held_model(sphere.connectivity, sphere.topology, sphere.positions);

    CHECK(model.bases.size() == count_pieces(sphere.connectivity));
    CHECK(model.bases.size() > 10);
    CHECK(model.coordinates == static_cast<Eigen::Index>(model.tree.bodies.joints()));
    CHECK(model.coordinates > 200);
    for (std::size_t molecule = 0; molecule < model.bases.size(); ++molecule) {
        CHECK(model.bases[molecule].freedom == BaseFreedom::Held);
        CHECK(model.tree.bodies.body_of[model.bases[molecule].pivot] == model.tree.bases[molecule]);
    }
}

TEST_CASE("whatever turns in a sphere, its bases stay", "[statics][sphere]") {
    const CutSystem sphere = cut_of_hiv(500);
    const TorsionModel model =
        build_held_model(sphere.connectivity, sphere.topology, sphere.positions);
    TorsionState state = build_torsion_state(model);
    std::mt19937 random(5);

    add_move(model, test::random_move(model, 1, random), state);

    std::size_t moved = 0;
    for (std::size_t i = 0; i < sphere.positions.size(); ++i) {
        const double by = (state.positions[i] - sphere.positions[i]).norm();
        if (model.tree.bodies.is_base(model.tree.bodies.body_of[i])) CHECK(by == 0);
        moved += by > 0.01 ? 1 : 0;
    }
    CHECK(moved > sphere.positions.size() / 2);
}
