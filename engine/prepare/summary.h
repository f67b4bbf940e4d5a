// Three lines about a prepared structure for whoever opens it.
#pragma once
#include "prepare/prepare.h"

#include <string>

namespace palpa {

struct PreparedSummary {
    std::string is;          // "2 chains of 99 residues, MK1, 127 waters; 3,236 atoms"
    std::string added;       // "1,624 hydrogens and 12 other atoms"; "nothing"
    std::string look_first;  // the first warning; "nothing that needs a look"
};

PreparedSummary summarise(const PreparedSystem& system);

}  // namespace palpa
