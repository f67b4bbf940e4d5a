#include "charmm/missing.h"

#include "core/text.h"

#include <fmt/format.h>
#include <cmath>
#include <utility>

namespace palpa {

void Missing::add(const TextPlace& place, std::string what) {
    if (!seen_.insert(what).second) return;
    if (problems_.empty()) {
        place_ = place;
    } else {
        what = fmt::format("{}: {}", to_string(place), what);
    }
    problems_.push_back(std::move(what));
}

void Missing::throw_if_any() const {
    if (!problems_.empty()) throw LoadError(place_, fmt::format("{}", fmt::join(problems_, "; ")));
}

const Residue* find_residue(const ForceField& force_field, const std::string& name,
                            const TextPlace& place, Missing& missing) {
    const auto found = force_field.residues.find(name);
    if (found == force_field.residues.end()) {
        missing.add(place,
                    fmt::format("no residue '{}' in {}{}", name, fmt::join(force_field.files, ", "),
                                near_name_hint(name, keys(force_field.residues))));
        return nullptr;
    }
    const Residue& residue = found->second;
    if (residue.lone_pair_line != 0) {
        missing.add({residue.place.file, residue.lone_pair_line, 0},
                    fmt::format("residue '{}' has a lone pair, which is not supported", name));
        return nullptr;
    }
    // A template whose atoms do not add up to its own charge has a slip in one of them.
    double sum = 0;
    for (const ResidueAtom& atom : residue.atoms) sum += atom.charge;
    if (std::abs(sum - residue.charge) > 1e-3) {
        missing.add(residue.place,
                    fmt::format("residue '{}' is given {} e, but its atoms add up to {:.4f} e",
                                name, residue.charge, sum));
    }
    return &residue;
}

const std::pair<const std::string, AtomType>* find_type(const ForceField& force_field,
                                                        const std::string& name,
                                                        const TextPlace& place, Missing& missing) {
    const auto type = find_type(force_field, name);
    if (type != force_field.types.end()) return &*type;
    missing.add(place, fmt::format("unknown atom type '{}': no MASS line{}", name,
                                   near_name_hint(name, keys(force_field.types))));
    return nullptr;
}

}  // namespace palpa
