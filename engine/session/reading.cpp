#include "session/reading.h"

#include <fmt/format.h>

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

std::string format_readings(std::span<const Reading> readings) {
    std::string text =
        "time_s,distance_angstrom,molecular_nN,hand_N,displacement_gain,potential_kcal_per_mol\n";
    for (const Reading& one : readings) {
        text +=
            fmt::format("{},{},{},{},{},{}\n", one.time_s, one.distance_angstrom, one.molecular_nN,
                        one.hand_N, one.displacement_gain, one.potential_kcal_per_mol);
    }
    return text;
}

}  // namespace palpa
