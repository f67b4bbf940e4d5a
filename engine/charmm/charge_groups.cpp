#include "charmm/charge_groups.h"

#include "charmm/missing.h"
#include "charmm/residue_instances.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace palpa {
namespace {

// Sets of atoms that are united step by step.
class AtomSets {
public:
    explicit AtomSets(std::size_t atoms) : parent_(atoms) {
        std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
    }
    std::uint32_t set_of(std::uint32_t atom) {
        while (parent_[atom] != atom) atom = parent_[atom] = parent_[parent_[atom]];
        return atom;
    }
    void unite(std::uint32_t a, std::uint32_t b) {
        const auto [low, high] = std::minmax({set_of(a), set_of(b)});
        parent_[high] = low;
    }

private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> find_charge_groups(const ForceField& force_field,
                                                           const Structure& structure,
                                                           const GenerateSettings& settings) {
    Missing missing;
    const ResidueInstances residues =
        build_residue_instances(force_field, structure, settings, missing);
    missing.throw_if_any();
    AtomSets sets(structure.names.size());
    for (const TemplateUse& use : residues.uses) {
        std::map<int, std::uint32_t> first_of_group;
        for (const ResidueAtom& atom : use.residue->atoms) {
            const std::optional<std::uint32_t> index = find_atom(residues, use, atom.name);
            if (!index) continue;
            sets.unite(first_of_group.try_emplace(atom.group, *index).first->second, *index);
        }
    }
    std::map<std::uint32_t, std::vector<std::uint32_t>> atoms_of;
    for (std::uint32_t i = 0; i < structure.names.size(); ++i)
        atoms_of[sets.set_of(i)].push_back(i);
    std::vector<std::vector<std::uint32_t>> groups;
    for (auto& [first, atoms] : atoms_of) groups.push_back(std::move(atoms));
    return groups;
}

std::vector<std::string> find_charged_groups(
    const Connectivity& connectivity, const std::vector<std::vector<std::uint32_t>>& groups) {
    constexpr double rounding = 1e-3;  // e
    std::vector<std::string> charged;
    for (const std::vector<std::uint32_t>& group : groups) {
        double sum = 0;
        std::string atoms;
        for (const std::uint32_t atom : group) {
            sum += connectivity.charge[atom];
            atoms += " " + connectivity.names[atom].atom;
        }
        if (std::abs(sum) < rounding) continue;
        const AtomName& name = connectivity.names[group.front()];
        charged.push_back(fmt::format("{} {} {},{}: {:+.2f} e", name.segment, name.residue,
                                      name.number, atoms, sum));
    }
    return charged;
}

}  // namespace palpa
