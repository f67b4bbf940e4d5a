// The traits of a kind of edit, beside its fields.
#pragma once
#include <string_view>

namespace palpa {

struct EditKind {
    std::string_view key;         // in a scene file
    bool with_engine = false;     // also where a remote engine places the atoms
    bool is_quick = false;        // takes no time in a world of any size
    bool sets_coupling = false;   // changes the coupling
    bool is_of_molecules = true;  // false for what is in hand, the coupling, and where atoms are
};

}  // namespace palpa
