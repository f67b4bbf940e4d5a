// Colours of how joints answer.
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "simulation/step.h"
#include "statics/joint_answers.h"
#include "tests/support/paths.h"
#include "tests/support/step_once.h"
#include "view/atom_colours.h"
#include "view/colour_scales.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;

namespace {

// A peptide in its groove after the hand has gone by 0.12 Å.
World moved_peptide(const std::vector<std::string>& settings) {
    World world = load_world(read_scene(test::in_project("scenes/peptide"), settings));
    HandPose pose;
    pose.molecule = contact_at(world, 0).model.molecule;
    for (int k = 0; k < 6; ++k) {
        pose.molecule->place_angstrom += Vec3(0.02, 0, 0);
        (void)test::step_once(world, pose, contact_at(world, 0).model);
    }
    return world;
}

// 0 at 0.001° and below, 1 at 1° and above.
double share_of(double angle) {
    const double deg = std::abs(angle) * 180 / std::numbers::pi;
    return deg <= 0.001 ? 0 : deg >= 1 ? 1 : (std::log10(deg) + 3) / 3;
}

// Whether every atom has the colour of its joint's angle.
std::size_t count_alike(const World& world, const std::vector<glm::vec3>& colours,
                        const std::vector<double>& angles) {
    const std::vector<std::uint32_t>& body_of = model_of(world).tree.bodies.body_of;
    std::size_t alike = 0;
    for (std::uint32_t atom = 0; atom < body_of.size(); ++atom) {
        const glm::vec3 expected = sequential_colour(share_of(angles[body_of[atom]]));
        const glm::vec3 found = colours[model_atoms_of(world).number_in_table(atom)];
        alike += glm::length(found - expected) < 1e-4F ? 1 : 0;
    }
    return alike;
}

}  // namespace

TEST_CASE("joints have the colours of what they add to the linear answer, and of their errors",
          "[view][colours][second-order]") {
    const World world = moved_peptide({"statics.method=\"second-order\""});
    const SecondOrder& second = *find_solver<SecondOrder>(world);
    const TorsionModel& model = model_of(world);
    const std::size_t count = model.tree.bodies.body_of.size();

    const std::vector<double> beyond = find_beyond_first_order(model, second.statics);
    const std::vector<glm::vec3> by_answer = find_colours(world, Colouring::Activity, {}, {});
    CHECK(count_alike(world, by_answer, beyond) == count);
    const std::vector<double> errors = estimate_joint_errors(
        model, second.settings, world.resource<TorsionState>(), second.statics);
    const std::vector<glm::vec3> by_error = find_colours(world, Colouring::Error, {}, {});
    CHECK(count_alike(world, by_error, errors) == count);
    CHECK(by_answer != by_error);
    // Joints differ in them.
    CHECK(*std::ranges::max_element(beyond) > 1e-4);
    CHECK(*std::ranges::max_element(errors) > 0);
    CHECK_THAT(find_legend(world, Colouring::Activity).front().text,
               Contains("0.001°") && Contains("first order"));
    CHECK_THAT(find_legend(world, Colouring::Error).back().text, Contains("1°"));
}

TEST_CASE("where few joints are active these have another colour", "[view][colours][adaptive]") {
    const World world = moved_peptide({"statics.active=10"});
    const std::vector<std::uint8_t>& is_active =
        find_solver<PaperStep>(world)->statics.selection.is_active;
    const std::vector<std::uint32_t>& body_of = model_of(world).tree.bodies.body_of;
    const std::vector<glm::vec3> colours = find_colours(world, Colouring::Activity, {}, {});
    std::size_t active = 0;
    for (std::uint32_t atom = 0; atom < body_of.size(); ++atom) {
        const bool is_bright =
            colours[model_atoms_of(world).number_in_table(atom)] == sequential_colour(1);
        CHECK(is_bright == (is_active[body_of[atom]] != 0));
        active += is_bright ? 1 : 0;
    }
    CHECK(active > 0);
    CHECK(active < body_of.size() / 2);
    CHECK(find_legend(world, Colouring::Activity).size() == 2);
    CHECK_THAT(find_legend(world, Colouring::Error).front().text, Contains("no estimate"));
}
