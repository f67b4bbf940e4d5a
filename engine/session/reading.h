// The quantities of a servo tick that a person reads: the distance, the force between the molecules
// and the force at the hand.
#pragma once
#include "haptics/servo.h"

#include <span>
#include <string>

namespace palpa {

struct Reading {
    double time_s = 0;             // servo clock
    double distance_angstrom = 0;  // between the reference atoms
    double molecular_nN = 0;       // force on the held molecule
    double hand_N = 0;             // force sent to the device
    double displacement_gain = 0;  // A_d
    double potential_kcal_per_mol = 0;
};

// On one axis a repulsive force is positive and an attractive one negative; in three dimensions
// forces are norms.
Reading read_tick(const ServoTick& tick) noexcept;

// Formats readings as CSV with a header of names and units.
std::string format_readings(std::span<const Reading> readings);

}  // namespace palpa
