// The topology part of CHARMM's files: MASS, RESI, PRES and the lines that belong to them.
#pragma once
#include "charmm/force_field.h"
#include "charmm/statements.h"

#include <cstddef>
#include <map>
#include <string>

namespace palpa {

class ResidueReader {
public:
    ResidueReader(const Statements& statements, ForceField& into)
        : statements_(statements), into_(into) {}

    // Reads the present statement into the force field.
    void read();

    // The open residue or patch, or null.
    const Residue* open_residue() const noexcept { return residue_; }

    // Ends the residue and forgets the defaults of chain ends.
    void end_part();

private:
    void start_residue(bool is_patch);
    void check_extra_words() const;
    void read_atom();
    void read_delete();
    void read_internal_coordinate();
    void read_chain_ends(std::string& first, std::string& last) const;
    void read_autogenerate();
    template <std::size_t Size, class Tuples>
    void read_tuples(Tuples& tuples, std::size_t from = 1) const;

    const Statements& statements_;
    ForceField& into_;
    Residue* residue_ = nullptr;                  // the open residue, if any
    int group_ = 0;                               // GROUP of the next atom
    std::map<std::string, std::size_t> at_line_;  // lines of its atoms, by name
    std::string first_patch_ = "NONE",
                last_patch_ = "NONE";  // defaults for residues without their own
};

// MASS number type mass [element]; the number is -1, or what old structure files call the type.
void read_mass(const Statements& statements, ForceField& into);

// Notes that the present statement defines something again.
void note_replaced(ForceField& into, const Statements& statements, std::string what,
                   const TextPlace& earlier);

}  // namespace palpa
