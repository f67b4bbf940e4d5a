#include "forces/minimise.h"

#include "core/assertion.h"
#include "forces/pair_list.h"
#include "math/minimiser.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

namespace palpa {
namespace {

using Vector = Eigen::VectorXd;

// Coordinates of all atoms, one after the other.
Eigen::Map<const Vector> flat(const std::vector<Vec3>& vectors) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    return {vectors.empty() ? nullptr : vectors.front().data(),
            3 * static_cast<Eigen::Index>(vectors.size())};
}

Vec3 of_atom(const Vector& vector, std::size_t atom) {
    return vector.segment<3>(3 * static_cast<Eigen::Index>(atom));
}

// A place, and what belongs to it.
struct Point {
    std::vector<Vec3> positions;
    std::vector<Vec3> forces;  // 0 on fixed atoms
    EnergyTerms terms;
    double restraint = 0;

    double energy() const noexcept { return terms.total() + restraint; }
};

// The energy that is lowered.
class EnergyFunction {
public:
    EnergyFunction(const Topology& topology, const MinimiseSettings& settings,
                   const Restraints& restraints)
        : topology_(topology), settings_(settings), restraints_(restraints) {}

    void evaluate(Point& point) {
        ++evaluations;
        point.forces.assign(point.positions.size(), Vec3::Zero());
        if (has_end(settings_.nonbonded)) {
            update_list(point.positions);
            point.terms = add_forces(topology_, settings_.nonbonded, list_, point.positions,
                                     point.forces, settings_.threads);
        } else {
            point.terms = add_forces(topology_, settings_.nonbonded, point.positions, point.forces);
        }
        point.restraint = 0;
        for (std::size_t i = 0; i < restraints_.k.size(); ++i) {
            const Vec3 away = point.positions[i] - restraints_.references[i];
            point.restraint += restraints_.k[i] * away.squaredNorm();
            point.forces[i] -= 2.0 * restraints_.k[i] * away;
        }
        for (std::size_t i = 0; i < restraints_.is_fixed.size(); ++i) {
            if (restraints_.is_fixed[i]) point.forces[i].setZero();
        }
    }

    std::size_t evaluations = 0, lists = 0;

private:
    void update_list(const std::vector<Vec3>& positions) {
        if (lists > 0 && !is_outdated(list_, positions)) return;
        ++lists;
        list_ = build_pair_list(topology_.exclusions, find_reach(settings_.nonbonded),
                                settings_.skin, positions, restraints_.is_fixed, std::move(list_));
    }

    const Topology& topology_;
    const MinimiseSettings& settings_;
    const Restraints& restraints_;
    PairList list_;
};

// About how much an atom can yield to a force (Å^2 mol/kcal), coordinate by coordinate: bonds are
// as stiff as they are, and repulsion as r^-12 is the stiffer the stronger it pushes. So all
// clashes part at once, however different they are.
Vector find_compliance(const std::vector<Vec3>& forces, double largest_step) {
    constexpr double bonds = 1000;  // kcal/mol/Å^2
    Vector compliance(3 * static_cast<Eigen::Index>(forces.size()));
    for (std::size_t i = 0; i < forces.size(); ++i) {
        compliance.segment<3>(3 * static_cast<Eigen::Index>(i))
            .setConstant(1.0 / (bonds + forces[i].norm() / largest_step));
    }
    return compliance;
}

// A direction along which no atom moves farther than the largest step. Each atom's part is cut on
// its own, so that one with far to go does not hold back the others; all are scaled alike where
// that points farther down.
Vector bound_direction(const Vector& direction, const std::vector<Vec3>& forces,
                       double largest_step) {
    Vector cut = direction;
    double scale = 1;
    for (Eigen::Index i = 0; i < cut.size(); i += 3) {
        const double length = cut.segment<3>(i).norm();
        if (!(length > largest_step)) continue;
        cut.segment<3>(i) *= largest_step / length;
        scale = std::min(scale, largest_step / length);
    }
    const double slope = scale * flat(forces).dot(direction);
    return flat(forces).dot(cut) >= slope ? cut : Vector(scale * direction);
}

// The energy over the coordinates of all atoms.
class Descent {
public:
    Descent(EnergyFunction& energy_function, const MinimiseSettings& settings,
            const Restraints& restraints, Point start)
        : energy_function_(energy_function),
          settings_(settings),
          is_fixed_(restraints.is_fixed),
          here_(std::move(start)),
          trial_(here_) {
        energy_function_.evaluate(here_);
        forces_ = flat(here_.forces);
    }

    const Point& here() const noexcept { return here_; }

    double value() const noexcept { return here_.energy(); }
    const Vector& forces() const noexcept { return forces_; }
    const Vector& trial_forces() const noexcept { return trial_forces_; }

    Vector precondition(const Vector& forces) const { return compliance_.array() * forces.array(); }
    Vector limit(const Vector& direction) const {
        return bound_direction(direction, here_.forces, settings_.largest_step);
    }

    double try_move(const Vector& direction, double length) {
        for (std::size_t i = 0; i < here_.positions.size(); ++i) {
            const bool stays = !is_fixed_.empty() && is_fixed_[i];
            trial_.positions[i] = here_.positions[i];
            if (!stays) trial_.positions[i] += length * of_atom(direction, i);
        }
        energy_function_.evaluate(trial_);
        trial_forces_ = flat(trial_.forces);
        return trial_.energy();
    }

    Vector trial_move() const { return flat(trial_.positions) - flat(here_.positions); }

    bool accepts(double value, double linear_change) const {
        return is_sufficient(here_.energy(), value, linear_change);
    }

    void accept() {
        std::swap(here_, trial_);
        std::swap(forces_, trial_forces_);
    }

    // Whether there was a step that lowers the energy.
    bool step(CurvaturePairs& pairs) {
        constexpr LineSearch search{.tries = 30};
        compliance_ = find_compliance(here_.forces, settings_.largest_step);
        return step_downhill(*this, pairs, search);
    }

private:
    EnergyFunction& energy_function_;
    const MinimiseSettings& settings_;
    std::span<const std::uint8_t> is_fixed_;
    Point here_, trial_;
    Vector forces_, trial_forces_, compliance_;
};

void measure_forces(const Point& point, const Restraints& restraints, MinimiseReport& report) {
    double sum2 = 0, largest2 = 0;
    for (const Vec3& force : point.forces) {
        sum2 += force.squaredNorm();
        largest2 = std::max(largest2, force.squaredNorm());
    }
    const auto fixed = std::count_if(restraints.is_fixed.begin(), restraints.is_fixed.end(),
                                     [](std::uint8_t is_fixed) { return is_fixed != 0; });
    const double free = static_cast<double>(point.forces.size()) - static_cast<double>(fixed);
    report.rms_force = free > 0 ? std::sqrt(sum2 / (3.0 * free)) : 0;
    report.largest_force = std::sqrt(largest2);
}

}  // namespace

MinimiseReport minimise(const Topology& topology, const MinimiseSettings& settings,
                        const Restraints& restraints, std::vector<Vec3>& positions,
                        const std::function<void(std::size_t step, double energy)>& on_step) {
    PALPA_ASSERT(positions.size() == topology.size());
    PALPA_ASSERT(restraints.references.size() == restraints.k.size());
    PALPA_ASSERT(restraints.k.empty() || restraints.k.size() == positions.size());
    PALPA_ASSERT(restraints.is_fixed.empty() || restraints.is_fixed.size() == positions.size());
    PALPA_ASSERT(settings.largest_step > 0);
    EnergyFunction energy_function(topology, settings, restraints);
    Descent descent(energy_function, settings, restraints, {positions, {}, {}, 0});
    MinimiseReport report;
    report.before = descent.here().terms;
    report.restraint_before = descent.here().restraint;
    if (on_step) on_step(0, descent.here().energy());

    CurvaturePairs pairs;
    measure_forces(descent.here(), restraints, report);
    while (report.rms_force > settings.force_tolerance && report.steps < settings.steps) {
        if (!descent.step(pairs)) {
            report.end = MinimiseEnd::Stuck;
            break;
        }
        ++report.steps;
        measure_forces(descent.here(), restraints, report);
        if (on_step) on_step(report.steps, descent.here().energy());
    }
    if (report.rms_force <= settings.force_tolerance) report.end = MinimiseEnd::Converged;
    report.after = descent.here().terms;
    report.restraint_after = descent.here().restraint;
    report.evaluations = energy_function.evaluations;
    report.lists = energy_function.lists;
    positions = descent.here().positions;
    return report;
}

}  // namespace palpa
