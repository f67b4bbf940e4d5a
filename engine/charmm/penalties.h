// How far the CGenFF program had to go for a ligand's parameters, as its stream files say.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// The highest of a residue. The program's authors: below 10 the analogy is fair, from 10 to 50
// basic validation is wanted, above 50 parameters are poor (K. Vanommeslaeghe, E. P. Raman,
// A. D. MacKerell, J. Chem. Inf. Model. 52, 3155 (2012)).
struct CgenffPenalties {
    std::string residue;
    double parameters = 0, charges = 0;
};
inline constexpr double fair_penalty = 10, poor_penalty = 50;

// Of lines "RESI NAME CHARGE ! param penalty= X ; charge penalty= Y"; residues without are not
// listed.
std::vector<CgenffPenalties> find_penalties(std::string_view stream);

}  // namespace palpa
