#include "statics/fast_second_derivatives.h"

#include "field/processor.h"
#include "statics/relax_joints.h"
#include "tests/support/second_differences.h"
#include "tests/support/torsion_case.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

using namespace palpa;
using test::TorsionShape;

namespace {

struct BothForms {
    SecondDerivatives fast, reference;
    bool was_fast = false;
};

BothForms both_forms(const TorsionModel& model, const TorsionState& state,
                     const std::vector<HandHold>& hands, const NonbondedSettings& settings) {
    const LocalCoordinates coordinates = build_local_coordinates(model, hands);
    const FastSecondDerivatives fast = build_fast_second_derivatives(model, coordinates);
    BothForms both;
    SecondDerivativesMemory memory;
    both.was_fast = update_fast_second_derivatives(model, coordinates, fast, settings, state,
                                                   memory, both.fast);
    update_second_derivatives(model, coordinates, fast.paths, settings, state, both.reference);
    return both;
}

// The largest difference of an entry, against the largest of all.
double worst_difference(const BothForms& both) {
    return (both.fast.all - both.reference.all).cwiseAbs().maxCoeff() /
           both.reference.all.cwiseAbs().maxCoeff();
}

NonbondedSettings switched(double cutoff) {
    NonbondedSettings settings;
    settings.electrostatics = ElectrostaticCutoff::ForceSwitch;
    settings.van_der_waals = VanDerWaalsCutoff::ForceSwitch;
    settings.cutoff = cutoff;
    settings.switch_from = cutoff - 2;
    return settings;
}

Eigen::VectorXd eigenvalues_of(const SecondDerivatives& derivatives) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(derivatives.of_mobile(),
                                                          Eigen::EigenvaluesOnly)
        .eigenvalues();
}

Eigen::MatrixXd stiffness_of(const SecondDerivatives& d) {
    return d.of_hands() -
           d.mixed().transpose() * d.of_mobile().ldlt().solve(Eigen::MatrixXd(d.mixed()));
}

// Made-up bodies with charges and wells; two atoms of one bond are at rest with each other.
TorsionModel charged_bodies(std::uint32_t seed, std::size_t bodies, TorsionShape shape) {
    const test::TorsionCase c = test::torsion_case(seed, bodies, shape);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Topology topology;
    for (std::size_t i = 0; i < c.masses.size(); ++i) {
        topology.charge.push_back(uniform(random));
        topology.type.push_back(i % 2 == 0 ? 0 : 1);
    }
    topology.lennard_jones =
        build_lennard_jones_table(std::vector<LennardJonesType>{{0.1, 0.6}, {0.02, 0.9}}, {});
    topology.lennard_jones14 = topology.lennard_jones;
    // What is nearer than that is bonded, as it were.
    std::vector<Bond> bonds;
    for (std::uint32_t i = 0; i < c.masses.size(); ++i) {
        for (std::uint32_t j = i + 1; j < c.masses.size(); ++j) {
            if ((c.positions[i] - c.positions[j]).norm() < 1.2) bonds.push_back({i, j, 0, 1});
        }
    }
    topology.exclusions = build_exclusions(bonds, c.masses.size());
    topology.exclusions.pairs14.clear();
    return build_torsion_model(
        c.bodies, c.masses, c.positions, topology,
        std::vector<MoleculeBase>(c.bodies.molecules(), {BaseFreedom::Free, 0}));
}

}  // namespace

TEST_CASE("fast second derivatives are those of the double sums", "[statics][hessian][fast]") {
    using enum BaseFreedom;
    const NonbondedSettings settings = GENERATE(NonbondedSettings{}, switched(9));
    const std::vector<std::string> kinds = list_processor_kinds();
    const std::string kind = kinds[GENERATE(range(0, 4)) % kinds.size()];
    INFO(kind);
    const TorsionModel model = test::model_of(test::with_copy(test::tetrapeptide(), {14, 9, -6}),
                                              {Turning, Free}, test::all_joints);
    REQUIRE(!model.fast.atoms.replaced().empty());
    TorsionState state = test::state_after(model, 0.03, 21);
    state.springs.push_back({.atoms = {70, 82, 64}, .k = 15, .place = {1, -2, 20}});

    use_processor_kind(kind);
    const BothForms both =
        both_forms(model, state, {{.molecule = 0}, {.molecule = 1, .spring = 0}}, settings);
    use_processor_kind(kinds.front());

    CHECK(both.was_fast);
    CHECK(worst_difference(both) < 1e-6);
    CHECK(both.fast.all == both.fast.all.transpose());
}

TEST_CASE("fast second derivatives keep the soft directions and the stiffness of a hand",
          "[statics][hessian][fast]") {
    const TorsionModel model =
        test::model_of(test::tetrapeptide(), {BaseFreedom::Held}, test::all_joints);
    TorsionState state = build_torsion_state(model);
    state.springs.push_back({.atoms = {50, 55, 58}, .k = 5, .place = state.positions[55]});
    RelaxSettings relax;
    relax.force_tolerance = 1e-3;
    QuasiStatics statics = build_quasi_statics(model);
    CHECK(relax_joints(model, relax, state, statics).end == RelaxEnd::Converged);

    const BothForms both = both_forms(model, state, {{.molecule = 0, .spring = 0}}, {});

    CHECK(both.was_fast);
    const Eigen::VectorXd fast = eigenvalues_of(both.fast),
                          reference = eigenvalues_of(both.reference);
    CHECK(reference[0] > 0);
    CHECK(std::abs(fast[0] - reference[0]) < 5e-4 * reference[0]);
    const Eigen::MatrixXd K = stiffness_of(both.reference);
    CHECK((stiffness_of(both.fast) - K).norm() < 5e-4 * K.norm());
}

TEST_CASE("fast second derivatives of any tree of bodies are those of the double sums",
          "[statics][hessian][fast]") {
    const TorsionShape shape =
        GENERATE(TorsionShape::Tree, TorsionShape::Chain, TorsionShape::Comb, TorsionShape::Star);
    for (const std::size_t bodies : {1, 2, 17, 60}) {
        INFO("bodies " << bodies);
        const TorsionModel model =
            charged_bodies(static_cast<std::uint32_t>(bodies), bodies, shape);
        const TorsionState state = build_torsion_state(model);

        const BothForms both = both_forms(model, state, {}, {});

        CHECK(both.was_fast);
        CHECK((both.fast.all - both.reference.all).cwiseAbs().maxCoeff() <
              3e-6 * std::max(1.0, both.reference.all.cwiseAbs().maxCoeff()));
    }
}

TEST_CASE("where the kernel cannot do it, the double sums do", "[statics][hessian][fast]") {
    const TorsionModel model =
        test::model_of(test::alanine_dipeptide(), {BaseFreedom::Held}, test::all_joints);
    TorsionState state = build_torsion_state(model);

    SECTION("a cutoff that no scene has") {
        NonbondedSettings settings = switched(9);
        settings.electrostatics = ElectrostaticCutoff::Shift;
        const BothForms both = both_forms(model, state, {}, settings);
        CHECK(!both.was_fast);
        CHECK(both.fast.all == both.reference.all);
    }
    SECTION("two atoms at one place") {
        // Two that are not left out.
        const auto& bodies = model.tree.bodies;
        const auto excluded = [&](std::uint32_t i, std::uint32_t j) {
            const auto of_i = model.topology.exclusions.of(i);
            return std::ranges::find(of_i, j) != of_i.end();
        };
        for (std::uint32_t j = 1; j < state.positions.size(); ++j) {
            if (excluded(0, j) || bodies.body_of[0] == bodies.body_of[j]) continue;
            state.positions[0] = state.positions[j];
            break;
        }
        const BothForms both = both_forms(model, state, {}, {});
        CHECK(!both.was_fast);
        CHECK(both.fast.all.allFinite());
        CHECK(both.fast.all == both.reference.all);
    }
}
