// Biological assemblies of Protein Data Bank files: REMARK 350.
#pragma once
#include "molecule/atoms.h"

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Gathers the assemblies of one file from its lines, as the format 3.3 writes them:
//   REMARK 350 BIOMOLECULE: 1
//   REMARK 350 APPLY THE FOLLOWING TO CHAINS: A, B,
//   REMARK 350                    AND CHAINS: C
//   REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000
// and BIOMT2, BIOMT3, the rows of the operator 1. Everything else is prose. Every call throws
// LoadError with the line of what is wrong.
class Remark350 {
public:
    explicit Remark350(const std::string& file) : file_(file) {}

    // Adds a line that begins with "REMARK 350", with its number.
    void add_line(std::string_view line, std::size_t number);

    // Call after the last line.
    void move_into(Structure& structure);

private:
    [[noreturn]] void fail(std::size_t line, const std::string& what) const;
    void check_complete() const;
    void begin_assembly(std::string_view name, std::size_t line);
    void begin_part(std::string_view chains, std::size_t line);
    void add_chains(std::string_view chains, std::size_t line);
    void add_row(const std::vector<std::string_view>& words, std::size_t line);

    const std::string& file_;
    std::vector<SymmetryOperator> operators_;
    std::vector<Assembly> assemblies_;
    std::set<std::string> names_;
    std::size_t part_line_ = 0;  // line of the open part
    std::size_t rows_ = 0;       // number of rows of the last operator
};

}  // namespace palpa
