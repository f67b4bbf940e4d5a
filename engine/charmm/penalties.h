// Reads the CGenFF program's penalties from stream files of ligands.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// The highest penalties of a residue. By the authors of the program: below 10 the analogy is fair,
// from 10 to 50 some validation is required, above 50 the parameters are poor (K. Vanommeslaeghe,
// E. P. Raman, A. D. MacKerell, J. Chem. Inf. Model. 52, 3155 (2012)).
struct CgenffPenalties {
    std::string residue;
    double parameters = 0, charges = 0;
};
inline constexpr double fair_penalty = 10, poor_penalty = 50;

// Reads lines "RESI NAME CHARGE ! param penalty= X ; charge penalty= Y"; residues without penalties
// are not listed.
std::vector<CgenffPenalties> find_penalties(std::string_view stream);

}  // namespace palpa
