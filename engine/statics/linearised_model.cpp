#include "statics/linearised_model.h"

#include "statics/pair_derivatives.h"
#include "statics/response_span.h"

#include <algorithm>
#include <utility>

namespace palpa {
namespace {

// Of near pairs alone, at the positions of the state. `at` and the gradient: of all coordinates.
void evaluate_near(const TorsionModel& model, const ForceSettings& settings,
                   const LinearisedModel& linear, const Eigen::VectorXd& at, NearPairs& near,
                   TorsionState& state, ModelValue& value) {
    std::ranges::fill(state.forces, Vec3::Zero());
    value.energy = add_near_forces(model, settings, near, state.positions, state.forces);
    value.gradient = find_gradient(model, linear.coordinates, linear.at, at, state);
    // Springs belong to the rest.
    for (const LocalCoordinates::SpringEnd& end : linear.coordinates.ends)
        value.gradient.segment<3>(end.column).setZero();
}

void update_derivatives(const TorsionModel& model, const ForceSettings& settings,
                        const TorsionState& state, Lineariser& lineariser) {
    if (is_fast(settings)) {
        update_fast_second_derivatives(model, lineariser.coordinates, lineariser.fast,
                                       settings.nonbonded, state, lineariser.memory,
                                       lineariser.all);
    } else {
        update_second_derivatives(model, lineariser.coordinates, lineariser.fast.paths,
                                  settings.nonbonded, state, lineariser.all);
    }
}

// Energy, gradient and second derivatives of all but the near pairs.
void separate_rest(const TorsionModel& model, const ForceSettings& settings, Lineariser& lineariser,
                   LinearisedModel& linear) {
    const Eigen::VectorXd origin = Eigen::VectorXd::Zero(linear.coordinates.size());
    TorsionState scratch = linear.at;
    linear.gradient = find_gradient(model, linear.coordinates, linear.at, origin, scratch);
    ModelValue near;
    evaluate_near(model, settings, linear, origin, linear.near, scratch, near);
    linear.rest_energy = linear.at.energy() - near.energy;
    linear.rest_gradient = linear.gradient - near.gradient;
    update_pair_derivatives(model, linear.coordinates, linear.near.all, linear.near.solvated,
                            settings.nonbonded, linear.at, lineariser.near);
    lineariser.rest = lineariser.all.all - lineariser.near.all;
    linear.rest = lineariser.rest.cast<float>();
}

}  // namespace

Lineariser build_lineariser(const TorsionModel& model, HeldParts held) {
    Lineariser lineariser;
    lineariser.coordinates = build_local_coordinates(model, held.hands);
    lineariser.fast = build_fast_second_derivatives(model, lineariser.coordinates);
    lineariser.held = std::move(held);
    return lineariser;
}

Eigen::VectorXd ResponseSpan::reduce(const Eigen::VectorXd& gradient) const {
    const Eigen::Index hands = gradient.size() - basis.rows();
    Eigen::VectorXd reduced(basis.cols() + hands);
    reduced << basis.transpose() * gradient.head(basis.rows()), gradient.tail(hands);
    return reduced;
}

Eigen::VectorXd ResponseSpan::expand(const Eigen::VectorXd& at) const {
    const Eigen::Index hands = at.size() - basis.cols();
    Eigen::VectorXd all(basis.rows() + hands);
    all << basis * at.head(basis.cols()), at.tail(hands);
    return all;
}

Eigen::VectorXd LinearisedModel::balance(const Eigen::VectorXd& forces) const {
    return span ? forces : Eigen::VectorXd(find_response(factor, forces));
}

void place_by(const TorsionModel& model, const LinearisedModel& linear, const Eigen::VectorXd& at,
              TorsionState& state) {
    if (linear.span) {
        place_about(model, linear.coordinates, linear.at, linear.span->expand(at), state);
    } else {
        place_about(model, linear.coordinates, linear.at, at, state);
    }
}

bool linearise(const TorsionModel& model, const LineariseSettings& settings,
               const TorsionState& state, Lineariser& lineariser, LinearisedModel& linear) {
    const double reach = settings.near_reach;
    linear.at = state;
    linear.coordinates = lineariser.coordinates;
    linear.near = build_near_pairs(model, state.positions, lineariser.held.atoms, reach);
    // Å: farther atoms, of which each goes half an ångström at most, do not come too close.
    constexpr double close_reach = 4.5;
    linear.close =
        build_close_pairs(model, state.positions, lineariser.held.atoms, reach, close_reach);
    update_derivatives(model, settings.forces, state, lineariser);
    const SecondDerivatives& all = lineariser.all;
    separate_rest(model, settings.forces, lineariser, linear);

    update_atom_metric(model, linear.coordinates, state, lineariser.metric);
    linear.factor.shift = lineariser.shift;
    if (!update_response_factor(all, lineariser.metric, {}, linear.factor)) return false;
    lineariser.shift = linear.factor.shift;
    linear.factor.shifted.resize(0, 0);
    linear.response = -find_response(linear.factor, all.mixed());
    linear.frozen_stiffness = all.of_hands();
    linear.relaxed_stiffness = all.of_hands() + all.mixed().transpose() * linear.response;
    if (settings.responses) {
        linear.span = build_response_span(model, settings.forces, linear, lineariser.held.hands,
                                          all.mixed(), *settings.responses);
        reduce_to_span(lineariser.rest, linear);
    }
    return true;
}

std::vector<Mat3> find_atom_responses(const TorsionModel& model, const LinearisedModel& linear,
                                      const TorsionState& state, Eigen::Index first,
                                      std::span<const std::uint32_t> atoms) {
    std::vector<CoordinateMotion> motions;
    update_motions(model, linear.coordinates, state, motions);
    Eigen::MatrixXd moves = Eigen::MatrixXd::Zero(linear.coordinates.size(), 3);
    moves.topRows(linear.response.rows()) = linear.response.middleCols(first, 3);
    moves.middleRows(linear.response.rows() + first, 3).setIdentity();
    const std::vector<Body>& bodies = model.tree.bodies.bodies;
    std::vector<std::uint8_t> is_needed(bodies.size(), 0);
    for (const std::uint32_t atom : atoms) is_needed[model.tree.bodies.body_of[atom]] = 1;
    for (std::size_t b = bodies.size(); b-- > 0;) {
        if (is_needed[b] != 0 && bodies[b].parent != no_body) is_needed[bodies[b].parent] = 1;
    }
    // Turn and velocity at the origin of each body, for each displacement.
    using Screws = Eigen::Matrix<double, 6, 3>;
    std::vector<Screws> screws(bodies.size(), Screws::Zero());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (is_needed[b] == 0) continue;
        if (bodies[b].parent != no_body) screws[b] = screws[bodies[b].parent];
        for (const CarriedCoordinate& carried : linear.coordinates.of(b)) {
            const CoordinateMotion& motion = motions[static_cast<std::size_t>(carried.column)];
            screws[b] += motion.screw_at(Vec3::Zero()) * moves.row(carried.column);
        }
    }
    std::vector<Mat3> responses;
    responses.reserve(atoms.size());
    for (const std::uint32_t atom : atoms) {
        const Screws& screw = screws[model.tree.bodies.body_of[atom]];
        responses.emplace_back(screw.bottomRows<3>() -
                               cross_matrix(state.positions[atom]) * screw.topRows<3>());
    }
    return responses;
}

void evaluate_model(const TorsionModel& model, const ForceSettings& settings,
                    const LinearisedModel& linear, const Eigen::VectorXd& at, NearPairs& near,
                    TorsionState& state, ModelValue& value) {
    place_by(model, linear, at, state);
    evaluate_placed(model, settings, linear, at, near, state, value);
}

void evaluate_placed(const TorsionModel& model, const ForceSettings& settings,
                     const LinearisedModel& linear, const Eigen::VectorXd& at, NearPairs& near,
                     TorsionState& state, ModelValue& value) {
    const Eigen::VectorXd all = linear.span ? linear.span->expand(at) : at;
    evaluate_near(model, settings, linear, all, near, state, value);
    if (linear.span) value.gradient = linear.span->reduce(value.gradient);
    const Eigen::VectorXd curved = (linear.rest * at.cast<float>()).cast<double>();
    value.energy += linear.rest_energy + at.dot(linear.rest_gradient + 0.5 * curved);
    value.gradient += linear.rest_gradient + curved;
}

}  // namespace palpa
