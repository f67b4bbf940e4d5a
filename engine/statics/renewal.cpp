#include "statics/renewal.h"

#include "statics/joint_answers.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace palpa {
namespace {

std::uint32_t find_farthest(std::span<const Vec3> before, std::span<const Vec3> after) {
    std::uint32_t farthest = 0;
    double most = 0;
    for (std::uint32_t atom = 0; atom < before.size(); ++atom) {
        const double way = (after[atom] - before[atom]).squaredNorm();
        if (way > most) std::tie(farthest, most) = std::tuple(atom, way);
    }
    return farthest;
}

constexpr double arm =
    5;  // Å: turns and torques of a hand count as at an atom so far from the axis

// The longest of the hands' displacements or forces; turns and torques are multiplied by `of_turn`.
double find_longest(std::span<const HandHold> hands, const Eigen::VectorXd& values,
                    double of_turn) {
    double longest = 0;
    Eigen::Index next = 0;
    for (const HandHold& hand : hands) {
        if (hand.turns) {
            longest = std::max(longest, of_turn * values.segment<3>(next).norm());
            next += 3;
        }
        longest = std::max(longest, values.segment<3>(next).norm());
        next += 3;
    }
    return longest;
}

// Relaxes on the whole energy while hands stay.
JointRelaxReport relax_fully(const TorsionModel& model, const SecondOrderSettings& settings,
                             TorsionState& state, RenewalMemory& memory) {
    RelaxSettings relax;
    relax.step.forces = settings.forces;
    relax.largest_move = settings.relax_move;
    relax.force_tolerance = settings.rest;
    if (const auto& last = memory.last) {
        relax.precondition = [&](const Coordinates& v) -> Coordinates {
            return find_response(last->factor, v);
        };
    }
    const std::size_t before = memory.full.memory.evaluations;
    return relax_joints(model, relax, state, memory.full, [&](const RelaxProgress& progress) {
        const std::size_t used = memory.full.memory.evaluations - before;
        if (used >= settings.most_relaxation) return false;
        return used < settings.least_relaxation || progress.rms_force > settings.relaxed;
    });
}

}  // namespace

double find_farthest_way(std::span<const HandHold> hands, const Eigen::VectorXd& coordinates) {
    return find_longest(hands, coordinates, arm);
}

double find_largest_force(std::span<const HandHold> hands, const Eigen::VectorXd& gradient) {
    return find_longest(hands, gradient, 1 / arm);
}

Renewal make_renewal(const TorsionModel& model, const SecondOrderSettings& settings,
                     RenewalRequest request, RenewalMemory& memory) {
    Renewal renewal;
    const std::vector<Vec3> before = request.state.positions;
    const std::vector<double> angles = request.state.angles;
    renewal.relaxed = relax_fully(model, settings, request.state, memory);
    renewal.farthest_atom = find_farthest(before, request.state.positions);
    if (renewal.relaxed.end == RelaxEnd::NotFinite || !std::isfinite(request.state.energy()))
        return renewal;
    auto linear = std::make_shared<LinearisedModel>();
    LineariseSettings linearise_settings = settings;
    if (request.near_reach > 0) linearise_settings.near_reach = request.near_reach;
    if (!linearise(model, linearise_settings, request.state, memory.lineariser, *linear))
        return renewal;
    if (request.felt.size() == linear->hands()) {
        renewal.error = find_largest_force(memory.lineariser.held.hands,
                                           request.felt - linear->gradient.tail(linear->hands()));
        renewal.model_error = find_largest_force(
            memory.lineariser.held.hands, request.at_rest - linear->gradient.tail(linear->hands()));
        renewal.error_age = request.age;
        std::vector<double> left;
        if (request.old) left = find_unrelaxed_turns(model, *request.old, request.old_gradient);
        for (std::size_t i = 0; i < left.size(); ++i)
            renewal.joint_errors.push_back(request.state.angles[i] - angles[i] - left[i]);
    }
    memory.last = linear;
    renewal.linear = std::move(linear);
    return renewal;
}

}  // namespace palpa
