#include "tools/lab/bench/second_derivatives.h"

#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/solver.h"
#include "statics/fast_second_derivatives.h"
#include "statics/hessian_product.h"
#include "statics/relax_joints.h"
#include "statics/response_factor.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr int runs = 21;

// What is mobile, at rest, and what the first hand holds of it.
struct AtRest {
    TorsionModel model;
    TorsionState state;
    LocalCoordinates coordinates;
};

AtRest find_rest(const World& start) {
    AtRest rest{model_of(start), start.resource<TorsionState>(), {}};
    RelaxSettings settings;
    settings.step.forces = build_step_settings(start).forces;
    settings.force_tolerance = 0.1;
    QuasiStatics statics = build_quasi_statics(rest.model);
    (void)relax_joints(rest.model, settings, rest.state, statics);
    const HeldPart held = held_part(start);
    HandHold hand{.molecule = held.base};
    if (held.spring) hand.spring = 0;  // those of hands come first
    rest.coordinates = build_local_coordinates(rest.model, std::vector<HandHold>{hand});
    return rest;
}

NonbondedSettings switched_at(double cutoff) {
    NonbondedSettings settings;
    settings.electrostatics = ElectrostaticCutoff::ForceSwitch;
    settings.van_der_waals = VanDerWaalsCutoff::ForceSwitch;
    settings.cutoff = cutoff;
    settings.switch_from = cutoff - 2;
    return settings;
}

double lowest_eigenvalue(const SecondDerivatives& derivatives) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(derivatives.of_mobile(),
                                                          Eigen::EigenvaluesOnly)
        .eigenvalues()[0];
}

std::optional<Eigen::MatrixXd> relaxed_stiffness(const AtRest& rest,
                                                 const SecondDerivatives& derivatives) {
    AtomMetric metric;
    ResponseFactor factor;
    update_atom_metric(rest.model, rest.coordinates, rest.state, metric);
    if (!update_response_factor(derivatives, metric, {}, factor)) return std::nullopt;
    return find_relaxed_stiffness(derivatives, factor);
}

// What of them matters: the softest direction, and the stiffness that the hand feels.
double error_of(const AtRest& rest, const SecondDerivatives& fast,
                const SecondDerivatives& reference) {
    const double lowest = lowest_eigenvalue(reference);
    const double softest = std::abs(lowest_eigenvalue(fast) - lowest) / std::abs(lowest);
    const auto K = relaxed_stiffness(rest, reference), own = relaxed_stiffness(rest, fast);
    if (!K || !own) return softest;
    return std::max(softest, (*own - *K).norm() / K->norm());
}

// All pairs and 9.5 Å, or implicit solvent where the model has it; with the suffix of its row.
std::vector<std::pair<std::string, NonbondedSettings>> list_laws(const AtRest& rest) {
    if (rest.model.topology.solvation) return {{"", eef1_settings()}};
    return {{"", {}}, {"/9.5", switched_at(9.5)}};
}

void bench_matrices(const std::string& name, const AtRest& rest, std::vector<BenchRow>& rows) {
    const FastSecondDerivatives fast = build_fast_second_derivatives(rest.model, rest.coordinates);
    SecondDerivativesMemory memory;
    for (const auto& [suffix, settings] : list_laws(rest)) {
        SecondDerivatives reference, own;
        const auto of_reference = sample(1, 1e3, [&] {
            update_second_derivatives(rest.model, rest.coordinates, fast.paths, settings,
                                      rest.state, reference);
        });
        const std::string prefix = "second-derivatives/" + name;
        if (suffix.empty())
            rows.push_back({prefix + "/double",
                            of_reference,
                            "ms",
                            {},
                            "",
                            fmt::format("{} coordinates", rest.coordinates.mobile)});
        const auto of_fast = sample(runs, 1e3, [&] {
            (void)update_fast_second_derivatives(rest.model, rest.coordinates, fast, settings,
                                                 rest.state, memory, own);
        });
        rows.push_back({prefix + "/fast" + suffix, of_fast, "ms", error_of(rest, own, reference),
                        "relative", "softest direction and felt stiffness, double"});
    }
}

void bench_factor(const std::string& name, const AtRest& rest, std::vector<BenchRow>& rows) {
    const FastSecondDerivatives fast = build_fast_second_derivatives(rest.model, rest.coordinates);
    SecondDerivativesMemory memory;
    SecondDerivatives derivatives;
    AtomMetric metric;
    ResponseFactor factor;
    Eigen::MatrixXd response;
    (void)update_fast_second_derivatives(rest.model, rest.coordinates, fast, {}, rest.state, memory,
                                         derivatives);
    BenchRow row{"factorise/" + name, {}, "ms"};
    row.samples = sample(runs, 1e3, [&] {
        update_atom_metric(rest.model, rest.coordinates, rest.state, metric);
        (void)update_response_factor(derivatives, metric, {}, factor);
    });
    BenchRow solve{"solve/" + name, {}, "ms"};
    const Eigen::MatrixXd mixed = derivatives.mixed();
    solve.samples = sample(runs, 1e3, [&] { response = find_response(factor, mixed); });
    Eigen::MatrixXd left = derivatives.of_mobile() * response - mixed;
    for (const AtomMetric::Entry& entry : metric.entries) {
        left.row(entry.row) += factor.shift * entry.value * response.row(entry.column);
        if (entry.row != entry.column)
            left.row(entry.column) += factor.shift * entry.value * response.row(entry.row);
    }
    row.error = solve.error = left.norm() / mixed.norm();
    row.error_unit = solve.error_unit = "relative";
    row.reference =
        fmt::format("residual, {} tries, shift {:.2g} kcal/mol/Å^2", factor.tries, factor.shift);
    solve.reference = fmt::format("residual, {} columns", mixed.cols());
    rows.push_back(row);
    rows.push_back(solve);
}

void bench_product(const std::string& name, const AtRest& rest, std::vector<BenchRow>& rows) {
    SecondDerivatives derivatives;
    update_second_derivatives(rest.model, rest.coordinates, build_model_paths(rest.model), {},
                              rest.state, derivatives);
    HessianProductSettings settings;
    settings.forces.fast = true;
    TorsionState trial = rest.state;
    ForceMemory memory;
    rows.push_back(
        {"forces/" + name + "/fast",
         sample(runs, 1e3, [&] { update_forces(rest.model, settings.forces, memory, trial); }),
         "ms"});
    const Eigen::VectorXd direction = Eigen::VectorXd::LinSpaced(rest.coordinates.size(), -1, 1);
    const Eigen::VectorXd expected = derivatives.all * direction;
    Eigen::VectorXd product;
    BenchRow row{"second-derivatives/" + name + "/product",
                 {},
                 "ms",
                 {},
                 "relative",
                 "double, of the largest entry"};
    row.samples = sample(runs, 1e3, [&] {
        product = find_hessian_product(rest.model, rest.coordinates, settings, memory, rest.state,
                                       direction, trial);
    });
    row.error = (product - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
    rows.push_back(row);
}

}  // namespace

void bench_second_derivatives(const std::string& scene_name, const World& start,
                              std::vector<BenchRow>& rows) {
    const AtRest rest = find_rest(start);
    bench_matrices(scene_name, rest, rows);
    bench_factor(scene_name, rest, rows);
    bench_product(scene_name, rest, rows);
}

}  // namespace palpa
