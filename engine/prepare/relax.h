// Relaxes clashes of a system whose missing atoms have just been built.
#pragma once
#include "charmm/topology.h"
#include "forces/force_field.h"
#include "math/vec.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// Two atoms more than three bonds apart, or in different molecules.
struct AtomContact {
    std::uint32_t a = 0, b = 0;
    double distance = 0;  // Å
};

// The result of the relaxation.
struct ClashReport {
    EnergyTerms before, after;  // kcal/mol, dielectric 4 r, to 9 Å
    std::size_t steps = 0;
    double rms_force = 0;  // final rms force, kcal/mol/Å
    std::optional<AtomContact> closest_before, closest_after;
    AtomContact largest_move;  // largest move of a given heavy atom, a; b unused
};

// First the built atoms alone, then all of them, the given heavy atoms held by 5 kcal/mol/Å^2 to
// where the file has them. Energies fall from step to step (forces/minimise.h). `is_built`: an
// entry per atom. Steps are limited by size: up to 300 each for systems below 27,000 atoms, 50 at
// least.
ClashReport relax(const Topology& topology, std::span<const std::uint8_t> is_built,
                  std::span<const std::uint8_t> is_hydrogen, std::vector<Vec3>& positions,
                  const std::function<void(double share)>& progress);

// The closest of all pairs that interact, but for those three bonds apart, within 4 Å.
std::optional<AtomContact> find_closest_contact(const Topology& topology,
                                                std::span<const Vec3> positions);

}  // namespace palpa
