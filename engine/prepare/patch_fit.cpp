#include "prepare/patch_fit.h"

#include <algorithm>
#include <set>
#include <string_view>

namespace palpa {

std::string find_misfit(const Residue& residue, const Residue& patch) {
    std::set<std::string_view> there, bonded;
    for (const ResidueAtom& atom : residue.atoms) there.insert(atom.name);
    for (const auto& bond : patch.bonds) bonded.insert(bond.begin(), bond.end());
    const auto deleted = std::find_if(patch.deleted_atoms.begin(), patch.deleted_atoms.end(),
                                      [&](const auto& name) { return !there.contains(name); });
    if (deleted != patch.deleted_atoms.end()) return *deleted;
    const auto changed =
        std::find_if(patch.atoms.begin(), patch.atoms.end(), [&](const auto& atom) {
            return !there.contains(atom.name) && !bonded.contains(atom.name);
        });
    return changed == patch.atoms.end() ? std::string() : changed->name;
}

}  // namespace palpa
