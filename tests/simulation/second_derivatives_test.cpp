// Second derivatives of TL-3 in HIV-1 protease as the flexible scene has them.
#include "statics/fast_second_derivatives.h"

#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/resources.h"
#include "statics/relax_joints.h"
#include "tests/support/paths.h"
#include "tests/support/second_differences.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace palpa;

namespace {

struct Pocket {
    TorsionModel model;
    TorsionState state;
    std::vector<HandHold> hands{{.molecule = 2}};
};

// At rest: no rms force above this, kcal/mol per rad and Å.
Pocket pocket_at_rest(double rms) {
    const World world = load_world(read_scene(test::in_project("scenes/hiv/flexible.toml")));
    Pocket pocket{*world.resource<Mechanics>().model, world.resource<TorsionState>()};
    RelaxSettings settings;
    settings.step.forces.fast = true;
    settings.force_tolerance = rms;
    QuasiStatics statics = build_quasi_statics(pocket.model);
    const JointRelaxReport report = relax_joints(pocket.model, settings, pocket.state, statics);
    CHECK(report.rms_force <= rms);
    return pocket;
}

SecondDerivatives derivatives_of(const Pocket& pocket, const LocalCoordinates& coordinates) {
    SecondDerivatives derivatives;
    update_second_derivatives(pocket.model, coordinates, build_model_paths(pocket.model), {},
                              pocket.state, derivatives);
    return derivatives;
}

}  // namespace

TEST_CASE("second derivatives of the pocket are the differences of its gradient",
          "[simulation][hessian][slow]") {
    Pocket pocket = pocket_at_rest(0.1);
    const LocalCoordinates coordinates = build_local_coordinates(pocket.model, pocket.hands);
    REQUIRE(coordinates.mobile == 807);
    const std::vector<Eigen::Index> columns = test::every(90, coordinates.size());
    const auto check = [&] {
        const SecondDerivatives derivatives = derivatives_of(pocket, coordinates);
        const Eigen::MatrixXd differences =
            test::difference_columns(pocket.model, coordinates, {}, pocket.state, columns);
        CHECK(test::worst_of_row(derivatives.all, differences, columns) < 1e-6);
        CHECK(test::worst_asymmetry(derivatives.all) < 1e-12);
    };

    check();

    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-0.3, 0.3);
    Coordinates move(pocket.model.coordinates);
    for (double& value : move) value = uniform(random);
    const TorsionState from = pocket.state;
    place_within(pocket.model, from, 0.3, move, pocket.state);
    check();
}

TEST_CASE("single precision keeps the pocket's softest direction and the stiffness that is felt",
          "[simulation][hessian][slow]") {
    const Pocket pocket = pocket_at_rest(0.1);
    const LocalCoordinates coordinates = build_local_coordinates(pocket.model, pocket.hands);
    const SecondDerivatives reference = derivatives_of(pocket, coordinates);
    SecondDerivatives fast;
    SecondDerivativesMemory memory;

    const bool was_fast = update_fast_second_derivatives(
        pocket.model, coordinates, build_fast_second_derivatives(pocket.model, coordinates), {},
        pocket.state, memory, fast);

    CHECK(was_fast);
    const auto lowest = [](const SecondDerivatives& d) {
        return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(d.of_mobile(), Eigen::EigenvaluesOnly)
            .eigenvalues()[0];
    };
    CHECK(lowest(reference) > 0.1);
    CHECK(std::abs(lowest(fast) - lowest(reference)) < 5e-4 * lowest(reference));
    const auto stiffness = [](const SecondDerivatives& d) -> Mat3 {
        return d.of_hands() -
               d.mixed().transpose() * d.of_mobile().llt().solve(Eigen::MatrixXd(d.mixed()));
    };
    const Mat3 K = stiffness(reference);
    CHECK((stiffness(fast) - K).norm() < 5e-4 * K.norm());
}
