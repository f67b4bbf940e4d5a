#include "session/reading.h"

namespace palpa {

Reading read_tick(const ServoTick& tick) noexcept {
    const TouchModel& touch = tick.touch;
    const double distance = touch.molecule.place_angstrom.norm();
    const auto component = [&](const Vec3& force) {
        if (touch.active_freedom > 1 || distance == 0) return force.norm();
        return force.dot(touch.molecule.place_angstrom) / distance;
    };
    return {tick.reading.time_s,
            distance,
            component(touch.force_newton) * 1e9,
            component(tick.sent_newton),
            touch.displacement_gain,
            touch.potential_kcal_per_mol};
}

}  // namespace palpa
