// The bond graph of a topology, with bond lengths and angles of the parameters.
#pragma once
#include "charmm/topology.h"
#include "molecule/connectivity.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// A list of numbers for each atom, in the order in which they were given.
class Lists {
public:
    Lists() = default;
    // From pairs of atom and number.
    Lists(std::span<const std::array<std::uint32_t, 2>> entries, std::size_t atoms);

    std::span<const std::uint32_t> of(std::size_t atom) const noexcept {
        return std::span(numbers_).subspan(first_[atom], first_[atom + 1] - first_[atom]);
    }

private:
    std::vector<std::uint32_t> first_, numbers_;
};

// Hydrogens are known by their mass. A bond between two of them, which three-site waters have, is
// none here. The topology must outlive it.
class BondGraph {
public:
    BondGraph(const Connectivity& connectivity, const Topology& topology);

    bool is_hydrogen(std::uint32_t atom) const noexcept { return mass_[atom] < 3.5; }
    // By the mass of its element, rounded.
    bool has_mass(std::uint32_t atom, int mass) const noexcept {
        return mass_[atom] > mass - 0.5 && mass_[atom] < mass + 0.5;
    }

    std::span<const std::uint32_t> neighbours(std::uint32_t atom) const noexcept {
        return neighbours_.of(atom);
    }

    // Equilibrium length of the bond of two atoms, Å.
    double bond_length(std::uint32_t a, std::uint32_t b) const noexcept;

    // Equilibrium angle, rad; unset if the parameters have none.
    std::optional<double> find_angle(std::uint32_t a, std::uint32_t centre,
                                     std::uint32_t c) const noexcept;

    // Of three bonds whose angles in the parameters sum up to 350 degree or more; one that they
    // lack counts as 120 degree.
    bool is_planar(std::uint32_t atom) const noexcept;

private:
    std::span<const double> mass_;
    const Topology* topology_;
    Lists neighbours_, bonds_;  // in one order
    Lists angles_;              // by their middle
};

}  // namespace palpa
