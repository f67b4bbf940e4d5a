// Tables of EEF1's numbers by atom type: files of comma-separated values.
#pragma once
#include "core/load_error.h"

#include <map>
#include <string>
#include <string_view>

namespace palpa {

// The row of a heavy atom type.
struct SolvationRow {
    double volume = 0;         // Å^3, >= 0
    double dg_ref = 0;         // kcal/mol
    double dg_free = 0;        // kcal/mol
    double lambda = 0;         // Å, > 0
    double radius = 0;         // Å, > 0, in the force field of the row
    std::string source;        // source of the numbers
    bool is_assigned = false;  // assigned by analogy, not published by the authors
    TextPlace place;
};

struct SolvationTable {
    std::string file;
    std::map<std::string, SolvationRow, std::less<>> types;
};

// Lines that begin with '#' and empty ones are passed over; the first other line must be
// "type,volume_A3,dG_ref,dG_free,dH_ref,dCp_ref,lambda_A,R_min_half_A,source", each line behind it
// one type with these fields, the last in quotes or not. Enthalpies and heat capacities must be
// numbers and are not kept: one temperature, 298.15 K. A
// source that begins with ASSIGNED means no published row. Throws LoadError with the line of what
// is wrong: fields that are missing or too many, no number, a volume below 0, a lambda or radius
// that is not above 0, a type that comes twice, no type at all.
SolvationTable parse_solvation_table(std::string_view text, const std::string& file);

// The built-in table, EEF1-SB.
const SolvationTable& eef1sb_table();
std::string_view eef1sb_csv() noexcept;

}  // namespace palpa
