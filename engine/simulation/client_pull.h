// Forces that somebody outside puts on atoms, such as a client of IMD.
#pragma once
#include "core/units.h"
#include "math/vec.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpa {

// Of one atom, kcal/mol/Å: 10 nN, what no bond bears. And atoms that are pulled at one time.
inline constexpr double strongest_client_pull = 1e4 / units::piconewton_per_kcal_per_mol_angstrom;
inline constexpr std::size_t most_client_pulls = 1000;

// A resource of the world; without it no client pulls.
struct ClientPull {
    std::vector<std::uint32_t> atoms;  // of the table, each once
    std::vector<Vec3> forces;          // kcal/mol/Å, one per atom, within the bounds above
    std::size_t of = 0;                // atoms of that table; of one with others nothing is pulled

    friend bool operator==(const ClientPull&, const ClientPull&) = default;
};

}  // namespace palpa
