// Forces on atoms from outside the program, for example from an IMD client.
#pragma once
#include "core/units.h"
#include "math/vec.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpa {

// Largest force on one atom, kcal/mol/Å: 10 nN, more than any bond bears. And the largest number of
// atoms with a force.
inline constexpr double strongest_client_pull = 1e4 / units::piconewton_per_kcal_per_mol_angstrom;
inline constexpr std::size_t most_client_pulls = 1000;

// A component of the entity that owns the springs of clients.
struct Clients {};

// A resource of the world; without it no client applies a force.
struct ClientPull {
    std::vector<std::uint32_t> atoms;  // indices into the atom table, each once
    std::vector<Vec3> forces;          // kcal/mol/Å, one per atom, within the bounds above
    std::size_t of = 0;  // number of atoms of the table; ignored if the table has another number

    friend bool operator==(const ClientPull&, const ClientPull&) = default;
};

}  // namespace palpa
