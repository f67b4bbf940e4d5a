// The element of an atom.
#pragma once
#include "molecule/atoms.h"

#include <cstddef>
#include <string_view>

namespace palpa {

// From the force field, or else from the first letter of the atom's name.
inline std::string_view element_of(const AtomTable& atoms, std::size_t i) {
    if (!atoms.element[i].empty()) return atoms.element[i];
    const std::string_view name = atoms.names[i].atom;
    const std::size_t letter = name.find_first_not_of("0123456789");
    return letter == std::string_view::npos ? name : name.substr(letter, 1);
}

}  // namespace palpa
