#include "simulation/systems/measure.h"

#include "simulation/held.h"
#include "simulation/resources.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace palpa {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

double find_angle(const Vec3& a, const Vec3& b) noexcept {
    return degrees * std::atan2(a.cross(b).norm(), a.dot(b));
}

// By the right-hand rule about b, as IUPAC has it.
double find_dihedral(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
    const Vec3 first = a.cross(b), second = b.cross(c);
    return degrees * std::atan2(b.norm() * a.dot(second), first.dot(second));
}

double find_value(const World& world, const Mark& mark) {
    std::vector<Vec3> p;
    for (const AtomsOf& atoms : mark.atoms) p.push_back(middle_of(world, atoms));
    if (p.size() == 2) return (p[1] - p[0]).norm();
    if (p.size() == 3) return find_angle(p[0] - p[1], p[2] - p[1]);
    if (p.size() == 4) return find_dihedral(p[1] - p[0], p[2] - p[1], p[3] - p[2]);
    return 0;
}

}  // namespace

void measure(World& world, const StepInput& /*input*/) {
    ++world.resource<Clock>().steps;
    StepReport& report = world.resource<StepReport>();
    world.each<Contact>([&](Entity, const Contact& contact) {
        report.finite = report.finite && contact.answer.model.force_newton.allFinite();
    });
    world.each<Mark>([&](Entity, Mark& mark) { mark.value = find_value(world, mark); });
}

}  // namespace palpa
