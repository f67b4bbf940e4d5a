#include "statics/joint_answers.h"

#include "core/repeatable.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpa {
namespace {

// Of every body's joint, from coordinates that a model answers in.
std::vector<double> turns_of(const TorsionModel& model, const LinearisedModel& linear,
                             const Eigen::VectorXd& answer) {
    const Eigen::VectorXd all = linear.span ? Eigen::VectorXd(linear.span->basis * answer) : answer;
    std::vector<double> turns(model.coordinate_of_body.size(), 0);
    for (std::size_t body = 0; body < turns.size(); ++body) {
        const Eigen::Index coordinate = model.coordinate_of_body[body];
        if (coordinate >= 0) turns[body] = all[coordinate];
    }
    return turns;
}

std::vector<double> beyond_now(const TorsionModel& model, const SecondOrderStatics& statics) {
    const LinearisedModel& linear = *statics.linear;
    return turns_of(
        model, linear,
        statics.at.head(linear.mobile()) - linear.answer() * statics.at.tail(linear.hands()));
}

}  // namespace

std::vector<double> find_beyond_first_order(const TorsionModel& model,
                                            const SecondOrderStatics& statics) {
    if (!statics.linear) return std::vector<double>(model.coordinate_of_body.size(), 0);
    std::vector<double> beyond = beyond_now(model, statics);
    const std::vector<double>& before = statics.beyond_before;
    for (std::size_t i = 0; i < before.size(); ++i)
        if (std::abs(before[i]) > std::abs(beyond[i])) beyond[i] = before[i];
    return beyond;
}

std::vector<double> estimate_joint_errors(const TorsionModel& model,
                                          const SecondOrderSettings& settings,
                                          const TorsionState& state,
                                          const SecondOrderStatics& statics) {
    if (!statics.linear) return std::vector<double>(model.coordinate_of_body.size(), 0);
    const double age = find_relative_age(model, settings, state, statics);
    const LinearisedModel& linear = *statics.linear;
    std::vector<double> errors =
        find_unrelaxed_turns(model, linear, statics.value.gradient.head(linear.mobile()));
    const std::vector<double>& growth = statics.joint_error_growth;
    for (std::size_t i = 0; i < errors.size(); ++i)
        errors[i] = repeatable::hypot(errors[i], i < growth.size() ? growth[i] * age * age : 0);
    return errors;
}

std::vector<double> find_unrelaxed_turns(const TorsionModel& model, const LinearisedModel& linear,
                                         const Eigen::VectorXd& gradient) {
    return turns_of(model, linear, linear.balance(-gradient));
}

void note_joint_answers(const TorsionModel& model, const SecondOrderSettings& settings,
                        const Renewal& renewal, SecondOrderStatics& statics) {
    if (!statics.linear) return;
    constexpr double moved = 0.01;  // of a stride: less is no move
    const Eigen::VectorXd way = statics.at.tail(statics.linear->hands());
    if (find_farthest_way(statics.renewals.lineariser.held.hands, way) > moved * settings.stride)
        statics.beyond_before = beyond_now(model, statics);
    if (renewal.joint_errors.empty()) return;
    const double age = std::max(renewal.error_age, least_error_age);
    std::vector<double>& growth = statics.joint_error_growth;
    const bool is_first = growth.empty();
    growth.resize(renewal.joint_errors.size(), 0);
    for (std::size_t i = 0; i < growth.size(); ++i) {
        const double found = std::abs(renewal.joint_errors[i]) / (age * age);
        growth[i] = is_first ? found : 0.5 * (growth[i] + found);
    }
}

}  // namespace palpa
