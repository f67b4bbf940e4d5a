// Small systems that tests of a run's input write down.
#pragma once
#include "inputs/run_system.h"

#include <cmath>
#include <numbers>
#include <string>

namespace palpa::test {

// An atom of type `type`, "T0" or another letter, alone in its residue.
inline void add_atom(RunSystem& system, const std::string& name, double mass, std::uint32_t type,
                     const Vec3& position) {
    Connectivity& c = system.connectivity;
    c.names.push_back({"S", "MOL", std::to_string(c.names.size() + 1), name});
    c.type.push_back("ABCDEFGH"[type] + std::string("Y"));
    c.charge.push_back(0);
    c.mass.push_back(mass);
    c.lines.push_back(c.names.size());
    system.topology.charge.push_back(0);
    system.topology.type.push_back(type);
    system.positions.push_back(position);
}

// Tables and exclusions, once all atoms and bonds are there.
inline void finish(RunSystem& system, std::vector<LennardJonesType> types,
                   std::vector<Nbfix> nbfix = {}) {
    system.topology.lennard_jones = build_lennard_jones_table(types, nbfix);
    system.topology.lennard_jones14 = build_lennard_jones_table(types, {});
    system.topology.exclusions = build_exclusions(system.topology.bonds, system.positions.size());
    system.connectivity.file = "small.psf";
    system.title = "small";
}

// Four atoms in a row, three bonds, none of the other terms.
inline RunSystem four_in_a_row() {
    RunSystem system;
    for (int i = 0; i < 4; ++i) add_atom(system, "C" + std::to_string(i), 12, 0, Vec3(i, i % 2, 0));
    for (std::uint32_t i = 0; i < 3; ++i) system.topology.bonds.push_back({i, i + 1, 300, 1.5});
    finish(system, {{0.1, 2}});
    return system;
}

// Hydrogen, hydrogen, oxygen of one water and oxygen, hydrogen, hydrogen of another, mixed.
inline RunSystem mixed_waters() {
    RunSystem system;
    const double half = 0.5 * 104.52 * std::numbers::pi / 180;
    const Vec3 h1(0.9572 * std::sin(half), 0.9572 * std::cos(half), 0), h2(-h1.x(), h1.y(), 0),
        away(4, 0, 0);
    add_atom(system, "OH2", 15.9994, 0, Vec3::Zero());
    add_atom(system, "OH2", 15.9994, 0, away);
    add_atom(system, "H1", 1.008, 1, h1);
    add_atom(system, "H1", 1.008, 1, away + h1);
    add_atom(system, "H2", 1.008, 1, h2);
    add_atom(system, "H2", 1.008, 1, away + h2);
    for (std::uint32_t water = 0; water < 2; ++water) {
        system.topology.bonds.push_back({water, water + 2, 450, 0.9572});
        system.topology.bonds.push_back({water, water + 4, 450, 0.9572});
        system.topology.angles.push_back({water + 2, water, water + 4, 55, 2 * half});
        // Where residues tell, as in a file, they are the waters.
        for (const std::uint32_t atom : {water, water + 2, water + 4})
            system.connectivity.names[atom] = {"W", "TIP3", std::to_string(water + 1),
                                               system.connectivity.names[atom].atom};
    }
    finish(system, {{0.1521, 1.7682}, {0.046, 0.2245}});
    return system;
}

}  // namespace palpa::test
