#include "charmm/missing.h"

#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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

void Missing::add(const LoadError& error) {
    problems_.emplace_back(error.what());
    problems_.insert(problems_.end(), error.further().begin(), error.further().end());
}

void Missing::advise(std::string what) {
    if (seen_.insert(what).second) advice_.push_back(std::move(what));
}

void Missing::throw_if_any() const {
    if (problems_.empty()) return;
    throw join_problems(place_, problems_, advice_);
}

namespace {

// Residues of other programs' names, and what CHARMM has for them.
constexpr std::array other_names = std::to_array<std::pair<std::string_view, std::string_view>>(
    {{"HIS", "HSD, HSE or HSP (by its hydrogens)"},
     {"HID", "HSD"},
     {"HIE", "HSE"},
     {"HIP", "HSP"},
     {"CYX", "CYS (disulphides are found by distance)"},
     {"HOH", "TIP3"},
     {"WAT", "TIP3"},
     {"SOL", "TIP3"},
     {"ACE", "patch ACE on the residue after it"},
     {"NME", "patch CT3 on the residue before it"},
     {"NMA", "patch CT3 on the residue before it"},
     {"CT3", "patch CT3 on the residue before it"}});

std::string residue_hint(const ForceField& force_field, std::string_view name) {
    const auto* const other = std::find_if(other_names.begin(), other_names.end(),
                                           [&](const auto& pair) { return pair.first == name; });
    if (other != other_names.end()) return fmt::format("; expected {}", other->second);
    return near_name_hint(name, keys(force_field.residues));
}

}  // namespace

const Residue* find_residue(const ForceField& force_field, const std::string& name,
                            const TextPlace& place, Missing& missing) {
    const auto found = force_field.residues.find(name);
    if (found == force_field.residues.end()) {
        const std::string files = fmt::format("{}", fmt::join(force_field.files, ", "));
        if (force_field.residues.empty()) {
            missing.add(place, fmt::format("no residues in {}; expected a topology file (.rtf) "
                                           "beside the parameters",
                                           files));
        } else {
            missing.add(place, fmt::format("no residue '{}' in {}{}", name, files,
                                           residue_hint(force_field, name)));
        }
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
        missing.add(residue.place, fmt::format("residue '{}' is declared with {} e, but the "
                                               "charges of its atoms add up to {:.4f} e",
                                               name, residue.charge, sum));
    }
    return &residue;
}

const std::pair<const std::string, AtomType>* find_type(const ForceField& force_field,
                                                        const std::string& name,
                                                        const TextPlace& place, Missing& missing) {
    const auto type = find_type(force_field, name);
    if (type != force_field.types.end()) return &*type;
    if (force_field.types.empty()) {
        missing.add(place, fmt::format("no atom types in {}; expected a file with MASS lines",
                                       fmt::join(force_field.files, ", ")));
    } else if (find_integer(name) &&
               std::all_of(force_field.types.begin(), force_field.types.end(),
                           [](const auto& entry) { return entry.second.number < 1; })) {
        missing.add(place,
                    fmt::format("atom types are given as numbers, but no MASS line in {} has a "
                                "number; expected the topology file that numbers the types",
                                fmt::join(force_field.files, ", ")));
    } else if (find_integer(name)) {
        missing.add(place, fmt::format("no atom type has the number {}; expected a topology file "
                                       "whose MASS lines number the types",
                                       name));
    } else {
        missing.add(place, fmt::format("unknown atom type '{}': no MASS line{}", name,
                                       near_name_hint(name, keys(force_field.types))));
    }
    return nullptr;
}

const NonbondedType* find_nonbonded(const ForceField& force_field, const std::string& type,
                                    const TextPlace& place, Missing& missing) {
    const auto found = force_field.nonbonded.find(type);
    if (found != force_field.nonbonded.end()) return &found->second;
    const std::string files = fmt::format("{}", fmt::join(force_field.files, ", "));
    if (force_field.nonbonded.empty()) {
        missing.add(place, fmt::format("no NONBONDED parameters in {}; expected a parameter file "
                                       "(.prm) beside the topology",
                                       files));
    } else {
        missing.add(place,
                    fmt::format("atom type '{}' has no NONBONDED parameters in {}", type, files));
    }
    return nullptr;
}

}  // namespace palpa
