#include "molecule/atoms.h"

namespace palpa {

std::string to_string(const AtomName& name) {
    return name.segment + " " + name.residue + " " + name.number + " " + name.atom;
}

}  // namespace palpa
