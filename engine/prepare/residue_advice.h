// What a user can do about a residue that the force field lacks.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace palpa {

// A kind of residue that the force field lacks.
struct UnknownResidue {
    std::string name;                // "TES"
    std::string meaning;             // in words, from the file or from our tables; may be empty
    std::vector<std::string> where;  // all residues of this kind, "A:325"
    std::size_t atoms = 0;           // number of atoms of the first one
    std::string similar;             // a known residue that can take its place, "CYS"; may be empty
    std::string files;               // names of CHARMM's files that define it; may be empty
    bool can_be_approximated = true;  // false: approximation was tried already
};

enum class AdviceFor : std::uint8_t { CommandLine, Window };

// All remedies in one sentence: lower case, no full stop. In brackets stands how to choose each:
// an option of `palpa prepare`, or a key of the window. In the language in use (core/translate.h).
std::string advise(const UnknownResidue& residue, AdviceFor reader);

}  // namespace palpa
