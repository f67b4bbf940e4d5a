#include "tools/lab/experiments/water_dimer.h"

#include "core/units.h"
#include "field/pair_field.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace palpa {
namespace {

// O at `place`, the hydrogens at half the angle on both sides of `bisector` towards `across`.
std::vector<Vec3> build_water(const RigidWater& water, const Vec3& place, const Vec3& bisector,
                              const Vec3& across) {
    const double along = water.bond * std::cos(water.angle / 2);
    const double aside = water.bond * std::sin(water.angle / 2);
    return {place, place + along * bisector + aside * across,
            place + along * bisector - aside * across};
}

using Variables = Eigen::Vector3d;  // distance, acceptor's, donor's direction

double energy(const RigidWater& water, const Variables& v) {
    const std::vector<Vec3> fixed = place_acceptor(water, v(1)),
                            moved = place_donor(water, v(0), v(2));
    return evaluate_pair_field({moved, water.charge, water.sqrt_epsilon, water.half_rmin},
                               {fixed, water.charge, water.sqrt_epsilon, water.half_rmin},
                               {units::charmm_coulomb_constant})
        .energy();
}

Variables gradient(const RigidWater& water, const Variables& v) {
    constexpr double h = 1e-4;
    Variables slope;
    for (int i = 0; i < 3; ++i) {
        const Variables d = h * Variables::Unit(i);
        slope(i) = (8 * (energy(water, v + d) - energy(water, v - d)) -
                    (energy(water, v + 2 * d) - energy(water, v - 2 * d))) /
                   (12 * h);
    }
    return slope;
}

}  // namespace

RigidWater find_water(const ForceField& force_field) {
    RigidWater water;
    water.bond = force_field.bonds.at({"HT", "OT"}).value;
    water.angle = force_field.angles.at({"HT", "OT", "HT"}).value * std::numbers::pi / 180;
    for (const ResidueAtom& atom : force_field.residues.at("TIP3").atoms) {
        const NonbondedType& type = force_field.nonbonded.at(atom.type);
        water.charge.push_back(atom.charge);
        water.sqrt_epsilon.push_back(std::sqrt(type.epsilon));
        water.half_rmin.push_back(type.half_rmin);
    }
    return water;
}

std::vector<Vec3> place_acceptor(const RigidWater& water, double direction) {
    return build_water(water, Vec3::Zero(), {std::cos(direction), 0, std::sin(direction)},
                       Vec3::UnitY());
}

std::vector<Vec3> place_donor(const RigidWater& water, double distance, double direction) {
    return build_water(water, {distance, 0, 0}, {std::cos(direction), 0, std::sin(direction)},
                       {-std::sin(direction), 0, std::cos(direction)});
}

WaterDimer find_lowest_dimer(const RigidWater& water) {
    constexpr double degree = std::numbers::pi / 180;
    Variables best(2.8, 0, 0);
    for (int a = 0; a < 360; a += 4) {
        for (int b = 0; b < 360; b += 4) {
            const Variables v(2.8, a * degree, b * degree);
            if (energy(water, v) < energy(water, best)) best = v;
        }
    }
    for (int iteration = 0; iteration < 50; ++iteration) {
        constexpr double h = 1e-4;
        Eigen::Matrix3d curvature;
        for (int i = 0; i < 3; ++i) {
            const Variables d = h * Variables::Unit(i);
            curvature.col(i) = (gradient(water, best + d) - gradient(water, best - d)) / (2 * h);
        }
        Variables step = -curvature.inverse() * gradient(water, best);
        if (const double length = step.norm(); length > 0.05) step *= 0.05 / length;
        if (energy(water, best + step) > energy(water, best) + 1e-9) step *= 0.1;
        best += step;
        if (step.norm() < 1e-11) break;
    }
    return {best(0), best(1), best(2), energy(water, best)};
}

}  // namespace palpa
