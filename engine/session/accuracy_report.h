// Reports whether a run met the scene's requirements for force range and accuracy.
#pragma once
#include "haptics/servo.h"
#include "scene/description.h"
#include "simulation/resources.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct AccuracyReport {
    // Required range (pN), and forces that the law gives at both ends (N).
    std::optional<std::array<double, 2>> range_pN;
    std::array<double, 2> ends_newton{};
    double stiffest_share = 0;     // largest stiffness felt as a share of the cap
    double largest_cap_ratio = 1;  // largest cap ratio, A_d over its law
    double thermal_share = 0;      // share of the time at the thermal limit

    std::optional<double> within_pN;  // required error limit
    // What error estimates found: the rendered force less that of all joints; where nothing
    // moves by itself, less that of all pairs in double. Each stands for the steps since the one
    // before, so that it counts for longer where error estimates are rare.
    std::uint64_t estimates = 0;
    // Median and 90 % quantile of the error, and share of the time within the limit; of no meaning
    // without estimates.
    double median_pN = 0, ninety_pN = 0, within_share = 1;
    double active = 0, steps = 0;  // mean active degrees of freedom, and steps per period

    double period_share = 0;  // median time of a step as a share of the declared period
};

// In words, each with its factor: the tolerance, the period, the reach of the handle, the motors.
struct UnmetRequirements {
    std::string tolerance, period, reach, motors;  // empty: met

    std::vector<std::string> all() const;
};
UnmetRequirements find_unmet(const AccuracyReport& report);

// Gathers the report tick by tick and step by step, in a bounded memory.
class AccuracyLog {
public:
    // Creates the log of one hand, by its number from 0. There is no report if its coupling
    // requires neither a range nor an error limit.
    AccuracyLog(const SceneDescription& scene, std::size_t hand, const ServoSettings& servo);

    void add(const ServoTick& tick) noexcept;
    // `error_pN`: the last estimate for this hand, which counts if one ended in this step.
    void add_step(const RelaxStepReport& relaxed, std::optional<double> error_pN);
    // For a scene in which nothing moves by itself: adds the contact model of the pose of the last
    // tick, which the servo rendered from the model before. Every hundredth counts as an error
    // estimate.
    void add_model(const ContactModel& model);

    std::optional<AccuracyReport> report(double step_median_us) const;

private:
    void add_error(double error_pN);
    void merge_neighbours();

    AccuracyReport report_;
    bool is_asked_;
    double cap_N_per_m_ = 0, period_us_;
    Vec3 rendered_newton_ = Vec3::Zero();  // force of the last tick
    std::uint64_t steps_ = 0, ticks_ = 0, thermal_ticks_ = 0;

    struct Found {
        double error_pN;
        std::uint64_t steps;  // steps since the previous error estimate
    };
    // Exact up to so many; then every two neighbours by size become one, with the larger error.
    static constexpr std::size_t most_found = 1 << 16;
    std::vector<Found> found_;
    std::uint64_t estimates_ = 0;
    std::uint64_t last_estimate_ = 0;  // its step
};

}  // namespace palpa
