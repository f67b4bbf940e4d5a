#include "statics/accuracy_controller.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpa {
namespace {

constexpr std::size_t remembered = 10;  // error estimates
constexpr std::size_t enough = 5;       // to do with less
constexpr double rarest = 8;
constexpr double aimed_at = 0.7;  // of the tolerance

// What nine of ten are at most.
double ninety_per_cent(std::vector<double> values) {
    const auto rank = static_cast<std::ptrdiff_t>((9 * values.size() + 9) / 10 - 1);
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

}  // namespace

AccuracyController::AccuracyController(double tolerance_pN, const WorkBudget& scene,
                                       std::size_t coordinates, bool has_budget) noexcept
    : tolerance_pN_(tolerance_pN),
      coordinates_(std::max<std::size_t>(coordinates, 1)),
      scene_steps_(scene.steps),
      has_budget_(has_budget),
      work_budget_{std::min(scene.active, coordinates), scene.steps} {}

void AccuracyController::add_step(const WorkBudget& used) noexcept {
    // Passes and what the hand moves are there without any joint (scenes/hiv/few-joints.md).
    constexpr double least = 0.07;
    const double share = static_cast<double>(used.active) / static_cast<double>(coordinates_);
    const double work =
        static_cast<double>(used.steps) * (least + (1 - least) * std::min(1.0, share));
    constexpr double part = estimate_share / (1 - estimate_share),
                     most_saved = 3 * (estimate_steps + 1);
    since_estimate_ += part * work;
    saved_ = std::min(most_saved, saved_ + part * work);
}

bool AccuracyController::is_due() const noexcept {
    return saved_ >= 0 && since_estimate_ >= rareness_ * estimate_work_;
}

void AccuracyController::add_estimate(double error_pN, std::span<const Vec3> rendered_pN,
                                      std::size_t steps) {
    // No number is as wrong as can be.
    if (std::isnan(error_pN)) error_pN = std::numeric_limits<double>::infinity();
    estimate_work_ = static_cast<double>(steps + 1);  // one sum more than steps
    saved_ -= estimate_work_;
    since_estimate_ = 0;
    last_error_pN_ = error_pN;
    if (estimates_ == 0) rendered_pN_.assign(rendered_pN.begin(), rendered_pN.end());
    for (std::size_t i = 0; i < rendered_pN_.size() && i < rendered_pN.size(); ++i)
        largest_change_pN_ =
            std::max(largest_change_pN_, (rendered_pN[i] - rendered_pN_[i]).norm());
    if (errors_pN_.size() < remembered) {
        errors_pN_.push_back(error_pN);
    } else {
        errors_pN_[estimates_ % remembered] = error_pN;
    }
    ++estimates_;
    const WorkBudget before = work_budget_;
    const double error = ninety_per_cent(errors_pN_);
    const double aim_pN = aimed_at * tolerance_pN_;
    if (error > aim_pN) {
        rareness_ = 0;
        WorkBudget raised_from{};
        for (double left = error; left > aim_pN && raised_from != work_budget_; left /= 2) {
            raised_from = work_budget_;
            raise();
        }
    } else {
        rareness_ = std::max(1.0, rareness_);
        const bool is_proven = errors_pN_.size() >= enough && largest_change_pN_ > tolerance_pN_;
        if (error < 0.5 * aim_pN && is_proven) lower();
        if (work_budget_ == before && errors_pN_.size() >= enough)
            rareness_ = std::min(rarest, 2 * rareness_);
    }
    if (work_budget_ == before) return;
    if (rareness_ > 1) rareness_ = 1;
    errors_pN_.clear();
    estimates_ = 0;
    largest_change_pN_ = 0;
}

std::optional<double> AccuracyController::error() const {
    if (!errors_pN_.empty()) return ninety_per_cent(errors_pN_);
    if (last_error_pN_ > 0) return last_error_pN_;
    return std::nullopt;
}

void AccuracyController::raise() noexcept {
    if (work_budget_.active < coordinates_) {
        work_budget_.active =
            std::min(coordinates_, work_budget_.active + (work_budget_.active + 1) / 2 + 1);
    } else if (!has_budget_) {
        work_budget_.steps = std::min(std::max(most_steps, scene_steps_),
                                      work_budget_.steps + (work_budget_.steps + 1) / 2);
    }
}

void AccuracyController::lower() noexcept {
    if (work_budget_.steps > scene_steps_) {
        work_budget_.steps =
            std::max(scene_steps_, work_budget_.steps - (work_budget_.steps + 4) / 5);
    } else if (work_budget_.active > least_active) {
        work_budget_.active =
            std::max(least_active, work_budget_.active - (work_budget_.active + 4) / 5);
    }
}

}  // namespace palpa
