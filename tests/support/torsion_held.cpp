#include "tests/support/torsion_held.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

namespace palpa::test {

Held all_free(const TorsionCase& c) {
    return {std::vector<std::uint8_t>(c.bodies.bodies.size(), 1),
            std::vector<GuidedBase>(c.bodies.molecules())};
}

Held some_held(const TorsionCase& c, std::uint32_t seed, double share) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    Held held = all_free(c);
    for (std::uint8_t& is_active : held.is_active) is_active = uniform(random) > share ? 1 : 0;
    for (GuidedBase& base : held.guides) {
        const double which = uniform(random);
        if (which < 0.3) base.guide = BaseGuide::Whole;
        if (which > 0.6) base.guide = BaseGuide::Point;
        if (which > 0.8) base.point = c.positions[0] + Vec3(which, 1, -2);
        if (uniform(random) > 0.7) continue;
        for (int i = 0; i < 6; ++i) base.acceleration[i] = uniform(random) - 0.5;
    }
    return held;
}

double rms_of(const std::vector<double>& values) {
    double sum = 0, count = 0;
    for (const double value : values) {
        sum += value * value;
        count += value != 0 ? 1 : 0;
    }
    return std::sqrt(sum / std::max(count, 1.0));
}

double worst_difference(const AssemblyState& state, const TorsionAccelerations& expected) {
    const double rms = rms_of(expected.joints), scale = rms > 0 ? rms : 1;
    double worst = 0;
    for (std::size_t b = 0; b < expected.joints.size(); ++b) {
        const double difference = std::abs(state.joint_acceleration[b] - expected.joints[b]);
        worst = std::max(worst, difference / scale);
    }
    for (std::size_t m = 0; m < expected.bases.size(); ++m) {
        const double difference = (state.base_acceleration[m] - expected.bases[m]).norm();
        worst = std::max(worst, difference / std::max(scale, expected.bases[m].norm()));
    }
    return worst;
}

}  // namespace palpa::test
