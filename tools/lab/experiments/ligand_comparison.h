// Measures the quality of approximate ligands: residues of the force field are compared with the
// approximation that is made when their own entry is hidden.
#pragma once
#include "charmm/force_field.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace palpa {

struct WaterPose {
    std::string atom;        // atom of the residue next to the water
    double own = 0;          // interaction energy with the residue's own parameters, kcal/mol
    double approximate = 0;  // and with approximate parameters
};

struct LigandComparison {
    std::string residue;
    std::size_t atoms = 0, right_types = 0;
    std::size_t heavy = 0, right_heavy = 0;
    double charge_rms = 0;  // error of partial charges over all atoms, e
    std::size_t analogies = 0;
    double highest_penalty = 0;
    // Atom, own type and approximate type where they differ.
    std::vector<std::array<std::string, 3>> wrong;
    std::vector<WaterPose> poses;

    double pose_rms() const noexcept;  // rms error, kcal/mol; 0 without poses
};

// `count` of the force field's model compounds (ligands/model_compounds.h) without lone pairs, of 6
// heavy atoms at least, evenly over their names. Fewer if there are not as many.
std::vector<std::string> choose_compounds(const ForceField& force_field, std::size_t count);

// All of them are withheld at once: neither their types nor their charges are learnt from. The
// water, TIP3 of the force field, gives a hydrogen bond of 1.9 Å to each hydrogen on N, O or S, and
// takes one from each N, O, S and halogen of at most two neighbours (O to O and N 2.8, others 3.3
// Å), along the bond or away from the neighbours; places with a contact below 1.6 Å are left out.
// The molecule is as its own bonded terms and charges relax it. Throws LoadError for a residue that
// is no model compound, and where the force field has no TIP3.
std::vector<LigandComparison> compare_ligands(const ForceField& force_field,
                                              const std::vector<std::string>& residues);

}  // namespace palpa
