#include "simulation/exactness.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpa {
namespace {

constexpr std::size_t remembered = 10;  // audits
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

Exactness::Exactness(double tolerance_pN, const Effort& scene, std::size_t coordinates,
                     bool has_budget) noexcept
    : tolerance_pN_(tolerance_pN),
      coordinates_(std::max<std::size_t>(coordinates, 1)),
      scene_steps_(scene.steps),
      has_budget_(has_budget),
      effort_{std::min(scene.active, coordinates), scene.steps} {}

void Exactness::add_step(const Effort& used) noexcept {
    // Passes and what the hand moves are there without any joint (scenes/hiv/results.md).
    constexpr double least = 0.07;
    const double share = static_cast<double>(used.active) / static_cast<double>(coordinates_);
    const double work =
        static_cast<double>(used.steps) * (least + (1 - least) * std::min(1.0, share));
    constexpr double part = audit_share / (1 - audit_share), most_saved = 3 * (audit_steps + 1);
    since_audit_ += part * work;
    saved_ = std::min(most_saved, saved_ + part * work);
}

bool Exactness::is_due() const noexcept {
    return saved_ >= 0 && since_audit_ >= rareness_ * audit_work_;
}

void Exactness::add_audit(double error_pN, const Vec3& told_pN, std::size_t steps) {
    // No number is as wrong as can be.
    if (std::isnan(error_pN)) error_pN = std::numeric_limits<double>::infinity();
    audit_work_ = static_cast<double>(steps + 1);  // one sum more than steps
    saved_ -= audit_work_;
    since_audit_ = 0;
    last_error_pN_ = error_pN;
    if (audits_ == 0) told_pN_ = told_pN;
    largest_change_pN_ = std::max(largest_change_pN_, (told_pN - told_pN_).norm());
    if (errors_pN_.size() < remembered) {
        errors_pN_.push_back(error_pN);
    } else {
        errors_pN_[audits_ % remembered] = error_pN;
    }
    ++audits_;
    const Effort before = effort_;
    const double error = ninety_per_cent(errors_pN_);
    const double aim_pN = aimed_at * tolerance_pN_;
    if (error > aim_pN) {
        rareness_ = 0;
        Effort raised_from{};
        for (double left = error; left > aim_pN && raised_from != effort_; left /= 2) {
            raised_from = effort_;
            raise();
        }
    } else {
        rareness_ = std::max(1.0, rareness_);
        const bool is_proven = errors_pN_.size() >= enough && largest_change_pN_ > tolerance_pN_;
        if (error < 0.5 * aim_pN && is_proven) lower();
        if (effort_ == before && errors_pN_.size() >= enough)
            rareness_ = std::min(rarest, 2 * rareness_);
    }
    if (effort_ == before) return;
    if (rareness_ > 1) rareness_ = 1;
    errors_pN_.clear();
    audits_ = 0;
    largest_change_pN_ = 0;
}

std::optional<double> Exactness::error() const {
    if (!errors_pN_.empty()) return ninety_per_cent(errors_pN_);
    if (last_error_pN_ > 0) return last_error_pN_;
    return std::nullopt;
}

void Exactness::raise() noexcept {
    if (effort_.active < coordinates_) {
        effort_.active = std::min(coordinates_, effort_.active + (effort_.active + 1) / 2 + 1);
    } else if (!has_budget_) {
        effort_.steps =
            std::min(std::max(most_steps, scene_steps_), effort_.steps + (effort_.steps + 1) / 2);
    }
}

void Exactness::lower() noexcept {
    if (effort_.steps > scene_steps_) {
        effort_.steps = std::max(scene_steps_, effort_.steps - (effort_.steps + 4) / 5);
    } else if (effort_.active > least_active) {
        effort_.active = std::max(least_active, effort_.active - (effort_.active + 4) / 5);
    }
}

Vec3 find_force_on_held(const TorsionModel& model, const TorsionState& state,
                        std::uint32_t grabbed) noexcept {
    if (state.tether) {
        const Tether& tether = *state.tether;
        return tether.k * (find_tethered(model, tether, state.positions) - tether.place);
    }
    // What atoms of the molecule do to each other adds up to nothing.
    Vec3 force = Vec3::Zero();
    for (std::size_t i = 0; i < state.forces.size(); ++i) {
        if (model.tree.molecule_of[model.tree.bodies.body_of[i]] == grabbed)
            force += state.forces[i];
    }
    return force;
}

void start_audit(const TorsionModel& model, const QuasiStaticSettings& settings,
                 const TorsionState& state, double h, const Vec3& told, std::uint32_t grabbed,
                 Audit& audit) {
    if (audit.statics.trial.positions.empty()) audit.statics = build_quasi_statics(model);
    audit.state = state;
    audit.statics.h = h;
    // Positions go by clusters between two sums over everything; here they are the coordinates'.
    update_positions(model, audit.state);
    update_forces(model, settings.forces, audit.statics.memory, audit.state);
    audit.told = told;
    audit.found = find_force_on_held(model, audit.state, grabbed);
    audit.steps = audit.calm_steps = 0;
    audit.is_finite = std::isfinite(audit.state.energy());
    audit.is_under_way = audit.is_finite;
}

void step_audit(const TorsionModel& model, const QuasiStaticSettings& settings,
                std::uint32_t grabbed, const AuditLimits& limits, Audit& audit) {
    const QuasiStaticReport step = step_quasi_static(model, settings, audit.state, audit.statics);
    ++audit.steps;
    audit.is_finite = step.is_finite;
    const Vec3 before = audit.found;
    audit.found = find_force_on_held(model, audit.state, grabbed);
    constexpr std::size_t calm = 3, fewest = 10;
    if (step.is_taken)
        audit.calm_steps = (audit.found - before).norm() < limits.change ? audit.calm_steps + 1 : 0;
    audit.is_under_way = audit.is_finite && (audit.calm_steps < calm || audit.steps < fewest) &&
                         audit.steps < limits.steps;
}

}  // namespace palpa
