// Three lines about a prepared structure for whoever opens it.
#pragma once
#include "prepare/prepare.h"

#include <string>

namespace palpa {

struct PreparedSummary {
    std::string is;          // "2 x chain of 99 residues, MK1, 127 waters; 3236 atoms"
    std::string added;       // "1624 hydrogens, 12 other atoms"; "nothing"
    std::string look_first;  // the first warning; "nothing that needs a look"
};

PreparedSummary summarise(const PreparedSystem& system);

}  // namespace palpa
