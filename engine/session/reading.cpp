#include "session/reading.h"

namespace palpa {

Reading read_tick(const ServoTick& tick) noexcept {
    const ContactModel& contact = tick.contact;
    const double distance = contact.molecule.place_angstrom.norm();
    const auto component = [&](const Vec3& force) {
        if (contact.active_freedom > 1 || distance == 0) return force.norm();
        return force.dot(contact.molecule.place_angstrom) / distance;
    };
    return {tick.reading.time_s,
            distance,
            component(contact.force_newton) * 1e9,
            component(tick.sent_newton),
            contact.displacement_gain,
            contact.potential_kcal_per_mol};
}

}  // namespace palpa
