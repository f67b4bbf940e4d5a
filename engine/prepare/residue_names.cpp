#include "prepare/residue_names.h"

#include "charmm/missing.h"
#include "core/text.h"
#include "molecule/components.h"
#include "molecule/residue_kinds.h"
#include "prepare/asked_flips.h"
#include "prepare/choose_states.h"
#include "prepare/joined_residues.h"
#include "prepare/patch_fit.h"
#include "prepare/residues.h"
#include "prepare/template_fit.h"
#include "prepare/turned_sites.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

using Pair = std::pair<std::string_view, std::string_view>;

constexpr std::string_view heading = "Residue names";
constexpr std::string_view protonation_heading = "Protonation";

// What other programs and the PDB call residues that CHARMM has.
constexpr auto residue_aliases = std::to_array<Pair>({{"HID", "HSD"},
                                                      {"HIE", "HSE"},
                                                      {"HIP", "HSP"},
                                                      {"HISD", "HSD"},
                                                      {"HISE", "HSE"},
                                                      {"HISH", "HSP"},
                                                      {"CYX", "CYS"},
                                                      {"CYS2", "CYS"},
                                                      {"ASH", "ASP"},
                                                      {"ASPH", "ASP"},
                                                      {"GLH", "GLU"},
                                                      {"GLUH", "GLU"},
                                                      {"LYN", "LYS"},
                                                      {"LYSN", "LYS"},
                                                      {"LSN", "LYS"}});

// Names that say a protonation as well; the patch that CHARMM has for it.
constexpr auto protonated = std::to_array<Pair>({{"ASH", "ASPP"},
                                                 {"ASPH", "ASPP"},
                                                 {"GLH", "GLUP"},
                                                 {"GLUH", "GLUP"},
                                                 {"LYN", "LSN"},
                                                 {"LYSN", "LSN"},
                                                 {"LSN", "LSN"}});

// Modified amino acids that CHARMM36 lacks, and what they come from.
constexpr auto parents = std::to_array<Pair>({{"CSO", "CYS"},
                                              {"CSD", "CYS"},
                                              {"CAS", "CYS"},
                                              {"OCS", "CYS"},
                                              {"CME", "CYS"},
                                              {"SMC", "CYS"},
                                              {"SEC", "CYS"},
                                              {"ABA", "ALA"},
                                              {"SEP", "SER"},
                                              {"TPO", "THR"},
                                              {"PTR", "TYR"},
                                              {"MLY", "LYS"},
                                              {"M3L", "LYS"},
                                              {"KCX", "LYS"},
                                              {"HYP", "PRO"},
                                              {"PCA", "GLU"},
                                              {"NLE", "LEU"},
                                              {"DAL", "ALA"},
                                              {"UNK", "ALA"}});

// A nucleotide's atoms in old files and in new ones; CHARMM's.
constexpr auto nucleotide_atoms = std::to_array<Pair>(
    {{"OP1", "O1P"}, {"OP2", "O2P"}, {"OP3", "O5T"}, {"O3P", "O5T"}, {"C7", "C5M"}});

std::optional<std::string_view> look_up(std::span<const Pair> pairs, std::string_view name) {
    const auto found = std::find_if(pairs.begin(), pairs.end(),
                                    [&](const Pair& pair) { return pair.first == name; });
    if (found == pairs.end()) return std::nullopt;
    return found->second;
}

class ResidueNamer {
public:
    ResidueNamer(const ForceField& force_field, Structure structure,
                 const PrepareSettings& settings, Report& report, std::span<const Vec3> waters)
        : force_field_(force_field),
          structure_(std::move(structure)),
          settings_(settings),
          report_(report),
          waters_(waters) {}

    NamedResidues name() {
        const StatedLinks stated = find_stated_links(structure_);
        join_caps(structure_, report_);
        join_components(force_field_, stated, structure_, report_);
        leave_out_unknown();
        const std::vector<ResidueLink> bonds = find_residue_links(force_field_, structure_, stated);
        find_states(bonds);
        choose_states();
        std::vector<LinkPatch> links = patch_links(force_field_, structure_, bonds, report_);
        for (const auto& [what, count] : renamed_) {
            report_.add(heading,
                        fmt::format("{} ({} residue{})", what, count, count == 1 ? "" : "s"));
        }
        return {std::move(structure_), std::move(patches_), std::move(links), std::move(unknown_),
                std::move(missing_)};
    }

private:
    std::string& name_of(const ResidueRange& residue) {
        return structure_.names[residue.first].residue;
    }

    std::pair<std::string, std::string> identity(const ResidueRange& residue) const {
        return {chain_of(structure_, residue.first), structure_.names[residue.first].number};
    }

    bool is_known(std::string_view name) const { return force_field_.residues.contains(name); }

    void leave_out_unknown() {
        std::map<std::string, std::vector<ResidueRange>> unknown;
        std::vector<bool> kept(structure_.names.size(), true);
        for (const ResidueRange& residue : find_residues(structure_)) {
            const std::string before = name_of(residue);
            rename(residue);
            const std::string& name = name_of(residue);
            const bool is_histidine =
                name == "HIS" && is_known("HSD") && is_known("HSE") && is_known("HSP");
            if (is_histidine || (is_known(name) && fits(residue, before))) {
                if (is_taken_as_another(residue)) leave_out_surplus(residue, kept);
                continue;
            }
            unknown[name].push_back(residue);
            std::fill_n(kept.begin() + static_cast<std::ptrdiff_t>(residue.first), residue.count,
                        false);
        }
        for (const auto& [name, residues] : unknown) report_unknown(name, residues);
        for (const auto& [from, to] : settings_.residue_names) {
            const auto known = [&](const std::string& name) {
                return std::any_of(structure_.names.begin(), structure_.names.end(),
                                   [&](const AtomName& atom) { return atom.residue == name; });
            };
            if (!renamed_.contains(taken_as(from, to)) && !known(from)) {
                missing_.add({structure_.file},
                             fmt::format("--as {}={}: no residue '{}' here", from, to, from));
            }
        }
        keep(kept);
    }

    // Patches and choices go with their residues, or away with them.
    void keep(const std::vector<bool>& kept) {
        std::vector<std::size_t> now(kept.size());
        std::size_t count = 0;
        for (std::size_t i = 0; i < kept.size(); ++i) {
            now[i] = count;
            if (kept[i]) ++count;
        }
        std::erase_if(patches_, [&](const ResiduePatch& patch) { return !kept[patch.atom]; });
        for (ResiduePatch& patch : patches_) patch.atom = now[patch.atom];
        structure_ = keep_atoms(structure_, kept);
    }

    bool is_taken_as_another(const ResidueRange& residue) const {
        return std::binary_search(taken_as_another_.begin(), taken_as_another_.end(),
                                  residue.first);
    }

    // What the residue that it is taken as does not have: the hydroxyl of Hyp as Pro.
    void leave_out_surplus(const ResidueRange& residue, std::vector<bool>& kept) {
        const Residue& wanted = force_field_.residues.at(name_of(residue));
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            const std::string& name = structure_.names[i].atom;
            const bool is_wanted =
                std::any_of(wanted.atoms.begin(), wanted.atoms.end(),
                            [&](const ResidueAtom& atom) { return atom.name == name; });
            if (is_wanted || name == "OXT" || element_of(structure_, i) == "H") continue;
            kept[i] = false;
            report_.add(heading,
                        fmt::format("{}: left out {}, which {} does not have",
                                    residue_label(structure_, residue), name, name_of(residue)));
        }
    }

    // Amides and histidines, but for those that a user has chosen and glycans hold.
    void find_states(const std::vector<ResidueLink>& bonds) {
        std::vector<std::size_t> given;
        for (const ResidueRange& residue : find_residues(structure_)) {
            const auto [chain, number] = identity(residue);
            const bool is_chosen = std::ranges::any_of(settings_.protonation, [&](const auto& one) {
                return one.first.chain == chain && one.first.number == number;
            });
            const bool is_bonded = std::ranges::any_of(bonds, [&](const ResidueLink& bond) {
                return std::ranges::any_of(bond.atoms, [&](std::size_t atom) {
                    return name_of(residue) == "ASN" && atom >= residue.first &&
                           atom < residue.end();
                });
            });
            if (is_chosen || is_bonded) given.push_back(residue.first);
        }
        const std::vector<std::size_t> held =
            turn_as_asked(settings_.turned_over, bonds, structure_, report_, missing_);
        for (ChosenState& state :
             palpa::choose_states(structure_, {settings_.flips, waters_, given, held})) {
            const std::size_t residue = state.residue;
            states_.emplace(residue, std::move(state));
        }
    }

    void choose_states() {
        std::vector<bool> is_used(settings_.protonation.size());
        for (const ResidueRange& residue : find_residues(structure_)) {
            const auto [chain, number] = identity(residue);
            bool is_chosen = false;
            for (std::size_t i = 0; i < settings_.protonation.size(); ++i) {
                const auto& [choice, state] = settings_.protonation[i];
                if (choice.chain != chain || choice.number != number) continue;
                is_used[i] = true;
                if (is_chosen) {
                    missing_.add({structure_.file},
                                 fmt::format("--protonation: two states for {}",
                                             residue_label(structure_, residue)));
                    continue;
                }
                is_chosen = true;
                choose_state(residue, state);
            }
            if (!is_chosen) find_state(residue);
        }
        for (std::size_t i = 0; i < is_used.size(); ++i) {
            if (is_used[i]) continue;
            const ResidueChoice& choice = settings_.protonation[i].first;
            missing_.add({structure_.file}, fmt::format("--protonation: no residue {}:{} here",
                                                        choice.chain, choice.number));
        }
    }

    static std::string taken_as(const std::string& from, const std::string& to) {
        return fmt::format("{} taken as {}, as requested", from, to);
    }

    // One atom is an ion, whatever else has its name in the force field.
    bool is_named_like_an_ion(const ResidueRange& residue, const std::string& name) const {
        return residue.count == 1 && force_field_.residues.at(name).atoms.size() > 1;
    }

    void rename(const ResidueRange& residue) {
        const std::string before = name_of(residue);
        for (const auto& [from, to] : settings_.residue_names) {
            if (from != before) continue;
            rename_residue(structure_, residue, to);
            if (to == "MET" && from == "MSE") rename_selenium(residue);
            taken_as_another_.push_back(residue.first);
            ++renamed_[taken_as(from, to)];
            return;
        }
        if (before == "HIS") return;
        if (is_water(before)) return rename_as(residue, "TIP3", "water");
        if (residue.count == 1) return rename_ion(residue);
        if (rename_component(residue)) return;
        const auto alias = look_up(residue_aliases, before);
        if (!alias || !is_known(*alias) ||
            (is_known(before) && has_elements_of(force_field_, before, structure_, residue))) {
            return;
        }
        rename_as(residue, *alias, {});
        if (const auto patch = look_up(protonated, before)) add_patch(residue, *patch);
    }

    void rename_as(const ResidueRange& residue, std::string_view name, std::string_view meaning) {
        const std::string before = name_of(residue);
        if (before == name || !is_known(name)) return;
        rename_residue(structure_, residue, name);
        ++renamed_[meaning.empty() ? fmt::format("{} is CHARMM's {}", before, name)
                                   : fmt::format("{}, {}, is CHARMM's {}", before, meaning, name)];
    }

    // "NA", "NA+", "CL-", "MG2"; or one atom of a larger residue, which is named as such.
    void rename_ion(const ResidueRange& residue) {
        const std::string before = name_of(residue);
        const std::string plain = before.substr(0, before.find_first_of("+-"));
        const std::string letters = plain.substr(0, plain.find_last_not_of("0123456789") + 1);
        for (const std::string& name : {before, plain, letters}) {
            const auto found = find_component(name);
            if (found && found->table->kind == "an ion" && is_known(found->component->charmm)) {
                return rename_as(residue, found->component->charmm, found->component->meaning);
            }
        }
        if (!is_known(before) && is_known(letters) && !is_named_like_an_ion(residue, letters)) {
            rename_as(residue, letters, {});
        }
    }

    // As the tables have it; false where they or the force field do not.
    bool rename_component(const ResidueRange& residue) {
        const auto found = find_component(name_of(residue));
        if (!found || found->table->kind == "an ion") return false;
        const bool is_nucleotide = found->table->kind == "a nucleotide";
        if (is_nucleotide && !has_ribose(residue)) return false;
        const Component& component = *found->component;
        const bool has_patch =
            component.patch.empty() || force_field_.patches.contains(std::string(component.patch));
        if (component.charmm.empty() || !is_known(component.charmm) || !has_patch) return false;
        if (is_nucleotide) name_nucleotide(residue);
        if (component.name == "MSE") rename_selenium(residue);
        std::string meaning(component.meaning);
        if (!component.patch.empty()) meaning += fmt::format(" (patch {})", component.patch);
        rename_as(residue, component.charmm, meaning);
        if (!component.patch.empty()) add_patch(residue, component.patch);
        return true;
    }

    bool has_ribose(const ResidueRange& residue) const {
        const auto has = [&](std::string_view name, std::string_view old_name) {
            return find_atom(structure_, residue, name) || find_atom(structure_, residue, old_name);
        };
        return has("C1'", "C1*") && has("C3'", "C3*") && has("C4'", "C4*");
    }

    // Before chains are looked for, which the names of O3' and P tell.
    void name_nucleotide(const ResidueRange& residue) {
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            std::string& name = structure_.names[i].atom;
            if (element_of(structure_, i) == "H") continue;
            std::replace(name.begin(), name.end(), '*', '\'');
            const auto charmm = look_up(nucleotide_atoms, name);
            if (charmm && !find_atom(structure_, residue, *charmm)) name = *charmm;
        }
    }

    // Whether the force field's residue of that name is this one.
    bool fits(const ResidueRange& residue, const std::string& before) const {
        const std::string& name = structure_.names[residue.first].residue;
        const bool is_patched = std::ranges::any_of(
            patches_, [&](const ResiduePatch& patch) { return patch.atom == residue.first; });
        if (is_patched || is_taken_as_another(residue)) return true;
        const bool is_vouched = before != name || find_component(before).has_value();
        return is_template_of(force_field_, name, structure_, residue, is_vouched);
    }

    void rename_selenium(const ResidueRange& residue) {
        if (const auto selenium = find_atom(structure_, residue, "SE")) {
            structure_.names[*selenium].atom = "SD";
            if (!structure_.records.empty()) structure_.records[*selenium].element = "S";
        }
    }

    void add_patch(const ResidueRange& residue, std::string_view patch) {
        patches_.push_back({residue.first, std::string(patch)});
    }

    // What --protonation says of a residue: another residue, a patch, or its usual state.
    void choose_state(const ResidueRange& residue, const std::string& state) {
        const std::string label = residue_label(structure_, residue);
        const auto patch = look_up(protonated, state);
        const auto other = look_up(residue_aliases, state);
        const std::string residue_name(other ? *other : state);
        const std::string patch_name(patch ? *patch : state);
        if (force_field_.patches.contains(patch_name)) {
            choose_patch(residue, patch_name);
        } else if (is_known(residue_name)) {
            rename_residue(structure_, residue, residue_name);
        } else {
            std::vector<std::string_view> names = keys(force_field_.patches);
            for (const auto& entry : force_field_.residues) names.emplace_back(entry.first);
            missing_.add({structure_.file},
                         fmt::format("--protonation {}: no residue and no patch '{}'{}", label,
                                     state, near_name_hint(state, names)));
            find_state(residue);
            return;
        }
        report_.add(protonation_heading, fmt::format("{}: {}, as requested", label, state));
    }

    void choose_patch(const ResidueRange& residue, const std::string& patch) {
        const std::string name = name_of(residue);
        const auto known = force_field_.residues.find(name);
        const std::string misfit = known == force_field_.residues.end()
                                       ? std::string("one of its atoms")
                                       : find_misfit(known->second, force_field_.patches.at(patch));
        if (misfit.empty()) {
            add_patch(residue, patch);
            return;
        }
        missing_.add({structure_.file, structure_.lines[residue.first], 0},
                     fmt::format("--protonation: patch {} is not for {}, which has no '{}'", patch,
                                 residue_label(structure_, residue), misfit));
        find_state(residue);
    }

    std::size_t hydrogens_at(const ResidueRange& residue, std::string_view heavy) const {
        const auto atom = find_atom(structure_, residue, heavy);
        return atom ? hydrogens_on(structure_, residue, *atom).size() : 0;
    }

    bool has_hydrogens(const ResidueRange& residue) const {
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            if (element_of(structure_, i) == "H") return true;
        }
        return false;
    }

    void find_state(const ResidueRange& residue) {
        const std::string name = name_of(residue);
        if (const auto chosen = states_.find(residue.first); chosen != states_.end()) {
            take_state(residue, chosen->second);
            return;
        }
        // What was asked for it is refused; others may be so too.
        if (name == "HIS" && !is_known(name)) rename_residue(structure_, residue, "HSE");
        if (!has_hydrogens(residue)) return;
        if (name == "ASP") find_acid(residue, "OD1", "OD2", "ASPP");
        if (name == "GLU") find_acid(residue, "OE1", "OE2", "GLUP");
        if (name == "LYS" && hydrogens_at(residue, "NZ") == 2) {
            add_patch(residue, "LSN");
            report_.add(protonation_heading,
                        fmt::format("{}: neutral, the file has two hydrogens on NZ",
                                    residue_label(structure_, residue)));
        }
    }

    void take_state(const ResidueRange& residue, const ChosenState& state) {
        const std::string label = residue_label(structure_, residue);
        if (state.is_flipped) {
            flip(structure_, residue);
            report_.add(turned_heading,
                        fmt::format("{}: flipped, {:.1f} hydrogen bonds gained ({})", label,
                                    state.gain, state.reason));
        }
        if (state.histidine.empty() || is_known("HIS")) return;
        rename_residue(structure_, residue, state.histidine);
        report_.add(protonation_heading,
                    fmt::format("{}: {} ({})", label, state.histidine, state.reason));
        if (state.might_be_charged) {
            report_.warn(
                fmt::format("{} has acceptors at both ring nitrogens, so it may be charged; to "
                            "charge it: --protonation {}:{}=HSP",
                            label, identity(residue).first, identity(residue).second));
        }
    }

    // CHARMM's patches have the proton on the second oxygen.
    void find_acid(const ResidueRange& residue, std::string_view first, std::string_view second,
                   std::string_view patch) {
        const bool on_first = hydrogens_at(residue, first) > 0;
        if (!on_first && hydrogens_at(residue, second) == 0) return;
        for (const ResiduePatch& known : patches_) {
            if (known.atom == residue.first) return;
        }
        const auto a = find_atom(structure_, residue, first);
        const auto b = find_atom(structure_, residue, second);
        if (on_first && a && b) std::swap(structure_.names[*a].atom, structure_.names[*b].atom);
        add_patch(residue, patch);
        report_.add(
            protonation_heading,
            fmt::format("{}: protonated ({}), the file has a hydrogen on {}",
                        residue_label(structure_, residue), patch, on_first ? first : second));
    }

    void report_unknown(const std::string& name, const std::vector<ResidueRange>& residues) {
        UnknownResidue unknown = describe_unknown(name);
        unknown.atoms = residues[0].count;
        for (const ResidueRange& residue : residues) {
            const auto [chain, number] = identity(residue);
            unknown.where.push_back(fmt::format("{}:{}", chain, number));
        }
        std::string where = fmt::format(
            "{}",
            fmt::join(unknown.where.begin(),
                      unknown.where.begin() + static_cast<std::ptrdiff_t>(
                                                  std::min<std::size_t>(unknown.where.size(), 4)),
                      ", "));
        if (residues.size() > 4) where += fmt::format(" and {} more", residues.size() - 4);
        missing_.add({structure_.file, structure_.lines[residues[0].first], 0},
                     fmt::format("no topology for residue '{}'{}{} ({}; {} atoms): {}", name,
                                 unknown.meaning.empty() ? "" : ", ", unknown.meaning, where,
                                 unknown.atoms, advise(unknown, AdviceFor::CommandLine)));
        unknown_.push_back(std::move(unknown));
    }

    std::string meaning_of(const std::string& name) const {
        if (const auto found = find_component(name)) return std::string(found->component->meaning);
        if (const auto only = crystal_only(name); !only.empty()) return std::string(only);
        const auto named = structure_.component_names.find(name);
        return named == structure_.component_names.end() ? std::string() : printable(named->second);
    }

    UnknownResidue describe_unknown(const std::string& name) const {
        UnknownResidue unknown;
        unknown.name = name;
        unknown.meaning = meaning_of(name);
        if (const auto parent = look_up(parents, name)) unknown.similar = *parent;
        const auto found = find_component(name);
        if (found && !found->component->charmm.empty()) unknown.files = found->table->files;
        unknown.can_be_approximated = !settings_.approximates_ligands;
        return unknown;
    }

    const ForceField& force_field_;
    Structure structure_;
    const PrepareSettings& settings_;
    Report& report_;
    std::span<const Vec3> waters_;
    std::map<std::size_t, ChosenState> states_;  // by first atom of the residue
    Missing missing_;
    std::vector<ResiduePatch> patches_;
    std::vector<UnknownResidue> unknown_;
    std::map<std::string, std::size_t> renamed_;
    std::vector<std::size_t> taken_as_another_;  // first atoms of residues, rising
};

}  // namespace

NamedResidues name_residues(const ForceField& force_field, const Structure& structure,
                            const PrepareSettings& settings, Report& report,
                            std::span<const Vec3> waters) {
    return ResidueNamer(force_field, structure, settings, report, waters).name();
}

}  // namespace palpa
