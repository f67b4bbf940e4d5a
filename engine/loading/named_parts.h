// Parts of a world by the addresses of scene files and edits (scene/edits.h), and back.
#pragma once
#include "core/load_error.h"
#include "ecs/world.h"
#include "scene/edits.h"
#include "simulation/components.h"

#include <string>
#include <string_view>

namespace palpa {

// Throws LoadError that says what is wrong and what would be right; name_place adds where.
[[noreturn]] void refuse(const std::string& what);

// Calls `function`; where it refuses something, the LoadError names `place`.
template <class Function>
void name_place(const TextPlace& place, const Function& function) {
    try {
        function();
    } catch (const LoadError& error) {
        std::string what = error.what();
        constexpr std::string_view unplaced = "edit: ";
        if (what.starts_with(unplaced)) what.erase(0, unplaced.size());
        throw LoadError(place, what);
    }
}

// The following functions refuse what the world does not have.

Entity find_molecule(const World& world, std::string_view name);

// "molecule", "molecule:25", "molecule:25 CA", "molecule:#17". No atoms: the whole molecule.
AtomsOf find_atoms(const World& world, const std::string& address);

Spring build_spring(const World& world, const RestraintEdit& restraint);
Mark build_mark(const World& world, const PinEdit& pin);

// The name of atoms within their molecule, "25", "25 CA" or "#17", by which atoms_called finds
// exactly these. Refuses others than one atom or a residue.
std::string name_within(const World& world, const AtomsOf& atoms);

// The inverse of build_spring and build_mark.
RestraintEdit describe(const World& world, const Spring& spring);
PinEdit describe(const World& world, const Mark& mark);

}  // namespace palpa
