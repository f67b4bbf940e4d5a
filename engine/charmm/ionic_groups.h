// Ionic groups of proteins, and the charges by which EEF1 makes each of them neutral.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Known by the names of all of its atoms and the types of those that carry the charge, whatever
// the residue is called: ARG LYS ASP GLU HSP, and at the ends of chains NTER GLYP PROP CTER.
struct IonicGroup {
    std::string_view kind;             // "ARG", "NTER"
    std::vector<std::uint32_t> atoms;  // rising
    double charge = 0;                 // e, sum over its atoms
    double full_charge = 0;            // charge in vacuum: 1 or -1 e
    bool has_neutral_charges = false;  // every atom has EEF1-SB's charge, to 0.01 e

    bool is_neutral() const noexcept;  // the sum is 0, to 0.01 e
    bool is_full() const noexcept;
};

// Finds the ionic groups in the order of the residues; arrays have one entry per atom. Atoms of a
// residue must stand together.
std::vector<IonicGroup> find_ionic_groups(std::span<const AtomName> names,
                                          std::span<const std::string_view> types,
                                          std::span<const double> charge);

// The force field that EEF1-SB goes with, of CHARMM36's or CHARMM36m's. In templates and patches
// that have an ionic group, full or neutral, its charges are EEF1-SB's (PROP: EEF1.1's), it is one
// charge group, and the charge that the template states is what comes of it. Asp's CB is of type
// CT2, and the dihedral CT1 CT2 CC OC has the terms of CT1 CT2A CC OC unless it has some of its
// own. The NBFIX of NC2 and OC is gone. All else stays, the backbone too.
ForceField neutralise_ionic_groups(ForceField force_field);

// Model and source of the charges, for titles of files, as lines.
inline constexpr std::string_view neutral_charges_origin =
    "Charges: EEF1-SB, every ionic group neutral; S. Bottaro, K. Lindorff-\n"
    "Larsen, R. B. Best, J. Chem. Theory Comput. 9, 5641 (2013). PROP: EEF1.1.";

// EEF1-SB's term of the backbone, Cβ-Cα-C-N: its k (kcal/mol) in these parameters, 0 where they
// are without, as CHARMM36 and CHARMM36m are.
double find_backbone_term(const ForceField& force_field);

// The reasons why a solvent model with neutral ionic groups cannot be used, as sentences without a
// full stop: groups that are not neutral, residues that are not neutral (0.001 e), the total
// charge. Of many similar ones the first are named.
std::vector<std::string> find_charged(std::span<const AtomName> names,
                                      std::span<const std::string_view> types,
                                      std::span<const double> charge);

}  // namespace palpa
