// What a person reads of a servo tick: how far the molecules are, what they do to each other, and
// what the hand feels of it.
#pragma once
#include "haptics/servo.h"

#include <span>
#include <string>

namespace palpa {

struct Reading {
    double time_s = 0;             // of the servo
    double distance_angstrom = 0;  // of the reference atoms
    double molecular_nN = 0;       // on the molecule in hand
    double hand_N = 0;             // sent to the device
    double displacement_gain = 0;  // A_d
    double potential_kcal_per_mol = 0;
};

// On one axis a force is + where it repels, drives the molecules apart, and - where it attracts; in
// three dimensions it is a norm.
Reading read_tick(const ServoTick& tick) noexcept;

// As CSV with a header of names and units.
std::string format_readings(std::span<const Reading> readings);

}  // namespace palpa
