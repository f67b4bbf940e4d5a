// The part of field/frozen_field.cpp that is compiled for each instruction set.
#pragma once
#include "field/frozen_field.h"

#include <limits>
#include <span>

namespace palpa {

struct FrozenJobSum {
    FrozenSum sum;                                            // torque about the field's origin
    float nearest2 = std::numeric_limits<float>::infinity();  // Å^2
};

struct EnergyJobSum {
    FrozenJobSum of_pairs;
    double van_der_waals = 0, electrostatic = 0, solvation = 0;  // kcal/mol
};

struct FollowingJobSum {
    FrozenJobSum of_pairs;
    Vec3 along = Vec3::Zero();
    Mat3 slope = Mat3::Zero();
};

}  // namespace palpa
