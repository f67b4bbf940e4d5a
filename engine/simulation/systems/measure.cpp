#include "simulation/systems/measure.h"

#include "math/angles.h"
#include "molecule/measure.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"

#include <cstddef>
#include <vector>

namespace palpa {
namespace {

double find_value(const World& world, const Mark& mark) {
    std::vector<Vec3> p;
    for (const AtomsOf& atoms : mark.atoms) p.push_back(middle_of(world, atoms));
    if (p.size() == 2) return (p[1] - p[0]).norm();
    if (p.size() == 3) return degrees_per_radian * find_angle(p[0], p[1], p[2]);
    if (p.size() == 4) return degrees_per_radian * find_dihedral(p[0], p[1], p[2], p[3]);
    return 0;
}

}  // namespace

void measure(World& world, const StepInput& /*input*/) {
    ++world.write<Clock>().steps;
    StepReport& report = world.write<StepReport>();
    world.each<Contact>([&](Entity, const Contact& contact) {
        report.finite = report.finite && contact.sent.model.force_newton.allFinite();
    });
    world.write_each<Mark>([&](Entity, Mark& mark) { mark.value = find_value(world, mark); });
}

}  // namespace palpa
