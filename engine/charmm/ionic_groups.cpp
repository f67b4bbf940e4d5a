#include "charmm/ionic_groups.h"

#include "charmm/find_parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

namespace palpa {
namespace {

struct NeutralCharge {
    std::string_view atom;
    double charge;                // e
    std::string_view needs = {};  // type by which the group is known
    std::string_view type = {};   // that it has from there on; empty: as before
};

struct NeutralGroup {
    std::string_view kind;
    double full_charge;
    std::vector<NeutralCharge> atoms;
};

// EEF1-SB's top_all36_prot_eef1sb.rtf where it differs from CHARMM36, and PROP, which it leaves at
// +1, of EEF1.1's top_all36_prot_lipid_eef1.1.rtf.
const std::vector<NeutralGroup>& neutral_groups() {
    static const std::vector<NeutralGroup> groups{
        {"ARG",
         1,
         {{"CD", -0.30},
          {"HD1", 0.05},
          {"HD2", 0.05},
          {"NE", -0.28, "NC2"},
          {"HE", 0.12},
          {"CZ", -0.20},
          {"NH1", -0.121, "NC2"},
          {"HH11", 0.2005},
          {"HH12", 0.2005},
          {"NH2", -0.121, "NC2"},
          {"HH21", 0.2005},
          {"HH22", 0.2005}}},
        {"LYS",
         1,
         {{"CE", 0},
          {"HE1", 0},
          {"HE2", 0},
          {"NZ", -0.90, "NH3"},
          {"HZ1", 0.30},
          {"HZ2", 0.30},
          {"HZ3", 0.30}}},
        {"ASP",
         -1,
         {{"CB", -0.28, "", "CT2"},
          {"HB1", 0.14},
          {"HB2", 0.14},
          {"CG", 1.00},
          {"OD1", -0.50, "OC"},
          {"OD2", -0.50, "OC"}}},
        {"GLU",
         -1,
         {{"CG", -0.28},
          {"HG1", 0.14},
          {"HG2", 0.14},
          {"CD", 1.00},
          {"OE1", -0.50, "OC"},
          {"OE2", -0.50, "OC"}}},
        {"HSP",
         1,
         {{"CB", -0.10},
          {"HB1", 0.05},
          {"HB2", 0.05},
          {"CD2", 0.05},
          {"HD2", 0},
          {"CG", 0.05},
          {"NE2", -0.55, "NR3"},
          {"HE2", 0.45},
          {"ND1", -0.55, "NR3"},
          {"HD1", 0.45},
          {"CE1", 0.10},
          {"HE1", 0}}},
        {"NTER",
         1,
         {{"N", -0.90, "NH3"}, {"HT1", 0.30}, {"HT2", 0.30}, {"HT3", 0.30}, {"CA", 0}, {"HA", 0}}},
        {"GLYP",
         1,
         {{"N", -0.90, "NH3"},
          {"HT1", 0.20},
          {"HT2", 0.20},
          {"HT3", 0.20},
          {"CA", 0.20},
          {"HA1", 0.05},
          {"HA2", 0.05}}},
        {"PROP",
         1,
         {{"N", -0.90, "NP"},
          {"HN1", 0.16},
          {"HN2", 0.16},
          {"CD", 0.16},
          {"HD1", 0.09},
          {"HD2", 0.09},
          {"CA", 0.15},
          {"HA", 0.09}}},
        {"CTER", -1, {{"C", 1.00}, {"OT1", -0.50, "OC"}, {"OT2", -0.50, "OC"}}}};
    return groups;
}

bool is_about(double charge, double expected) noexcept {
    constexpr double rounding = 0.01;  // e
    return std::abs(charge - expected) < rounding;
}

// The indices of a group's atoms among those of a residue, in the group's order.
template <class NameOf, class TypeOf>
std::optional<std::vector<std::size_t>> match(const NeutralGroup& group, std::size_t count,
                                              const NameOf& name_of, const TypeOf& type_of) {
    std::vector<std::size_t> found;
    for (const NeutralCharge& wanted : group.atoms) {
        std::size_t i = 0;
        while (i < count && name_of(i) != wanted.atom) ++i;
        if (i == count || (!wanted.needs.empty() && type_of(i) != wanted.needs))
            return std::nullopt;
        found.push_back(i);
    }
    return found;
}

void neutralise(Residue& residue) {
    std::vector<ResidueAtom>& atoms = residue.atoms;
    for (const NeutralGroup& group : neutral_groups()) {
        const auto found = match(
            group, atoms.size(), [&](std::size_t i) -> std::string_view { return atoms[i].name; },
            [&](std::size_t i) -> std::string_view { return atoms[i].type; });
        if (!found) continue;
        double before = 0, after = 0;
        for (const std::size_t i : *found) before += atoms[i].charge;
        if (!is_about(before, group.full_charge) && !is_about(before, 0)) continue;
        for (std::size_t k = 0; k < found->size(); ++k) {
            ResidueAtom& atom = atoms[(*found)[k]];
            const NeutralCharge& neutral = group.atoms[k];
            atom.charge = neutral.charge;
            atom.group = atoms[found->front()].group;  // CHARMM36 has HSP's ring in two
            after += neutral.charge;
            if (!neutral.type.empty()) atom.type = neutral.type;
        }
        residue.charge += after - before;
    }
}

void rename_asp_dihedral(ForceField& force_field) {
    const std::array<std::string, 4> now = in_order({"CT1", "CT2", "CC", "OC"});
    const auto before = force_field.dihedrals.find(in_order({"CT1", "CT2A", "CC", "OC"}));
    if (before == force_field.dihedrals.end()) return;
    const std::vector<DihedralTerm> terms = before->second;
    force_field.dihedrals.emplace(now, terms);
}

// "a, b, c and 4 more"
std::string join_first(const std::vector<std::string>& words) {
    constexpr std::size_t most = 6;
    const std::size_t named = std::min(words.size(), most);
    std::string text = fmt::format(
        "{}", fmt::join(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(named), ", "));
    if (words.size() > named) text += fmt::format(" and {} more", words.size() - named);
    return text;
}

std::string residue_text(const AtomName& name) {
    return fmt::format("{} {} {}", name.segment, name.residue, name.number);
}

// Calls use(first, next) for each residue's atoms.
template <class Use>
void each_residue(std::span<const AtomName> names, const Use& use) {
    for (std::size_t first = 0, next = 0; first < names.size(); first = next) {
        while (next < names.size() && is_same_residue(names[first], names[next])) ++next;
        use(first, next);
    }
}

}  // namespace

bool IonicGroup::is_neutral() const noexcept { return is_about(charge, 0); }
bool IonicGroup::is_full() const noexcept { return is_about(charge, full_charge); }

std::vector<IonicGroup> find_ionic_groups(std::span<const AtomName> names,
                                          std::span<const std::string_view> types,
                                          std::span<const double> charge) {
    std::vector<IonicGroup> groups;
    each_residue(names, [&](std::size_t first, std::size_t next) {
        for (const NeutralGroup& known : neutral_groups()) {
            const auto found = match(
                known, next - first,
                [&](std::size_t i) -> std::string_view { return names[first + i].atom; },
                [&](std::size_t i) { return types[first + i]; });
            if (!found) continue;
            IonicGroup group{known.kind, {}, 0, known.full_charge, true};
            for (std::size_t k = 0; k < found->size(); ++k) {
                const std::size_t i = first + (*found)[k];
                group.atoms.push_back(static_cast<std::uint32_t>(i));
                group.charge += charge[i];
                if (!is_about(charge[i], known.atoms[k].charge)) group.has_neutral_charges = false;
            }
            std::ranges::sort(group.atoms);
            groups.push_back(std::move(group));
        }
    });
    return groups;
}

ForceField neutralise_ionic_groups(ForceField force_field) {
    for (auto& [name, residue] : force_field.residues) neutralise(residue);
    for (auto& [name, patch] : force_field.patches) neutralise(patch);
    rename_asp_dihedral(force_field);
    force_field.nbfix.erase(in_order("NC2", "OC"));
    return force_field;
}

double find_backbone_term(const ForceField& force_field) {
    const auto* const terms = find_dihedral(force_field, {"CT1", "CT1", "C", "NH1"});
    if (!terms) return 0;
    double k = 0;
    for (const DihedralTerm& term : *terms) {
        if (term.multiplicity == 1 && is_about(term.phase_deg, -103)) k = term.k;
    }
    return k;
}

std::vector<std::string> find_charged(std::span<const AtomName> names,
                                      std::span<const std::string_view> types,
                                      std::span<const double> charge) {
    constexpr double rounding = 1e-3;  // e
    std::vector<std::string> problems, groups, residues;
    for (const IonicGroup& group : find_ionic_groups(names, types, charge)) {
        if (group.is_neutral()) continue;
        groups.push_back(fmt::format("{} of {} ({:+.2f} e)", group.kind,
                                     residue_text(names[group.atoms.front()]), group.charge));
    }
    double total = 0;
    each_residue(names, [&](std::size_t first, std::size_t next) {
        double sum = 0;
        for (std::size_t i = first; i < next; ++i) sum += charge[i];
        total += sum;
        if (std::abs(sum) < rounding) return;
        residues.push_back(fmt::format("{} ({:+.2f} e)", residue_text(names[first]), sum));
    });
    if (!groups.empty())
        problems.push_back(fmt::format("ionic groups are not neutral: {}", join_first(groups)));
    if (!residues.empty())
        problems.push_back(fmt::format("residues have a charge: {}", join_first(residues)));
    if (std::abs(total) >= rounding)
        problems.push_back(fmt::format("the total charge is {:+.2f} e, not 0", total));
    return problems;
}

}  // namespace palpa
