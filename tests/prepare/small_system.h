// A force field of a few residues, and structures written atom by atom.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"
#include "tests/support/force_field_of.h"

#include <string>
#include <string_view>
#include <vector>

namespace palpa::test {

// Backbone without hydrogens but for HN; ALA, ASP (with ASPP), CYS (DISU), GLN, HSD, HSE, HSP,
// TIP3, SOD, a ligand LIG of three atoms; NTER, CTER, ACE, ACED, CT3.
inline constexpr std::string_view small_topology = R"(read rtf
MASS -1 C 12.0 C
MASS -1 N 14.0 N
MASS -1 O 16.0 O
MASS -1 S 32.0 S
MASS -1 H 1.0 H
MASS -1 SOD 23.0 NA
DEFA FIRS NTER LAST CTER
AUTO ANGLES DIHE PATCH
RESI ALA 0.0
ATOM N N 0.0
ATOM HN H 0.0
ATOM CA C 0.0
ATOM CB C 0.0
ATOM HB1 H 0.0
ATOM HB2 H 0.0
ATOM HB3 H 0.0
ATOM C C 0.0
ATOM O O 0.0
BOND N HN N CA CA CB CB HB1 CB HB2 CB HB3 CA C C O C +N
RESI ASP 0.0
ATOM N N 0.0
ATOM HN H 0.0
ATOM CA C 0.0
ATOM CB C 0.0
ATOM HB1 H 0.0
ATOM HB2 H 0.0
ATOM CG C 0.0
ATOM OD1 O 0.0
ATOM OD2 O 0.0
ATOM C C 0.0
ATOM O O 0.0
BOND N HN N CA CA CB CB HB1 CB HB2 CB CG CG OD1 CG OD2 CA C C O C +N
IC CG CA *CB HB1 0.0 0.0 119.0 0.0 0.0
IC HB1 CA *CB HB2 0.0 0.0 119.0 0.0 0.0
RESI CYS 0.0
ATOM N N 0.0
ATOM HN H 0.0
ATOM CA C 0.0
ATOM SG S 0.0
ATOM HG1 H 0.0
ATOM C C 0.0
ATOM O O 0.0
BOND N HN N CA CA SG SG HG1 CA C C O C +N
RESI GLN 0.0
ATOM N N 0.0
ATOM CA C 0.0
ATOM CG C 0.0
ATOM CD C 0.0
ATOM OE1 O 0.0
ATOM NE2 N 0.0
ATOM HE21 H 0.0
ATOM HE22 H 0.0
ATOM C C 0.0
ATOM O O 0.0
BOND N CA CA CG CG CD CD OE1 CD NE2 NE2 HE21 NE2 HE22 CA C C O C +N
RESI HSD 0.0
ATOM N N 0.0
ATOM CA C 0.0
ATOM CG C 0.0
ATOM ND1 N 0.0
ATOM HD1 H 0.0
ATOM CE1 C 0.0
ATOM NE2 N 0.0
ATOM CD2 C 0.0
ATOM C C 0.0
ATOM O O 0.0
BOND N CA CA CG CG ND1 ND1 HD1 ND1 CE1 CE1 NE2 NE2 CD2 CD2 CG CA C C O C +N
RESI HSE 0.0
ATOM N N 0.0
ATOM CA C 0.0
ATOM CG C 0.0
ATOM ND1 N 0.0
ATOM CE1 C 0.0
ATOM NE2 N 0.0
ATOM HE2 H 0.0
ATOM CD2 C 0.0
ATOM C C 0.0
ATOM O O 0.0
BOND N CA CA CG CG ND1 NE2 HE2 ND1 CE1 CE1 NE2 NE2 CD2 CD2 CG CA C C O C +N
RESI HSP 0.0
ATOM N N 0.0
ATOM CA C 0.0
ATOM C C 0.0
BOND N CA CA C C +N
RESI TIP3 0.0 NOANG NODIH
ATOM OH2 O 0.0
ATOM H1 H 0.0
ATOM H2 H 0.0
BOND OH2 H1 OH2 H2
PATCHING FIRS NONE LAST NONE
RESI SOD 0.0
ATOM SOD SOD 0.0
PATCHING FIRS NONE LAST NONE
RESI LIG 0.0
ATOM C1 C 0.0
ATOM C2 C 0.0
ATOM C3 C 0.0
BOND C1 C2 C2 C3
PATCHING FIRS NONE LAST NONE
PRES NTER 0.0
ATOM HT1 H 0.0
ATOM HT2 H 0.0
DELETE ATOM HN
BOND HT1 N HT2 N
PRES CTER 0.0
ATOM OT1 O 0.0
ATOM OT2 O 0.0
DELETE ATOM O
BOND C OT1 C OT2
PRES ACE 0.0
ATOM CAY C 0.0
ATOM CY C 0.0
ATOM OY O 0.0
BOND CAY CY CY OY CY N
PRES ACED 0.0
ATOM CAY C 0.0
ATOM CY C 0.0
ATOM OY O 0.0
BOND CAY CY CY OY CY N
PRES CT3 0.0
ATOM NT N 0.0
ATOM HNT H 0.0
ATOM CAT C 0.0
BOND C NT NT HNT NT CAT
PRES ASPP 0.0
ATOM HD2 H 0.0
BOND OD2 HD2
PRES DISU 0.0
DELETE ATOM 1HG1
DELETE ATOM 2HG1
BOND 1SG 2SG
end
)";

inline ForceField small_force_field() { return force_field_of(small_topology, "small.str"); }

// Atoms in the order in which they are written, one line each.
class StructureWriter {
public:
    StructureWriter() { structure_.file = "small.pdb"; }

    StructureWriter& atom(const std::string& residue, const std::string& chain, int number,
                          const std::string& name, const Vec3& position, const std::string& element,
                          char alternate = ' ', double occupancy = 1) {
        structure_.names.push_back({chain, residue, std::to_string(number), name});
        structure_.positions.push_back(position);
        structure_.lines.push_back(structure_.names.size());
        AtomRecord record;
        record.residue_number = number;
        record.chain = chain;
        record.element = element;
        record.alternate = alternate;
        record.occupancy = occupancy;
        record.model = model;
        structure_.records.push_back(record);
        return *this;
    }

    // N, CA, C, O of a residue along x, 3.8 Å behind `at`; a peptide bond of 1.33 Å between
    // neighbours that stand 3.8 Å apart.
    StructureWriter& backbone(const std::string& residue, const std::string& chain, int number,
                              double at) {
        return atom(residue, chain, number, "N", {at, 0, 0}, "N")
            .atom(residue, chain, number, "CA", {at + 1.2, 0.8, 0}, "C")
            .atom(residue, chain, number, "C", {at + 2.47, 0, 0}, "C")
            .atom(residue, chain, number, "O", {at + 2.47, -1.23, 0}, "O");
    }

    StructureWriter& end_chain() {
        structure_.chain_ends.push_back(structure_.names.size());
        return *this;
    }

    const Structure& structure() const { return structure_; }

    int model = 1;

private:
    Structure structure_;
};

inline std::string joined_names(const Structure& structure) {
    std::string text;
    for (const AtomName& name : structure.names) text += name.atom + " ";
    return text;
}

}  // namespace palpa::test
