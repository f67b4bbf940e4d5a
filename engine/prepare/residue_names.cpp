#include "prepare/residue_names.h"

#include "charmm/missing.h"
#include "core/text.h"
#include "prepare/choose.h"
#include "prepare/histidine.h"
#include "prepare/patch_fit.h"
#include "prepare/residues.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

using Pair = std::pair<std::string_view, std::string_view>;

constexpr std::string_view heading = "Residue names";
constexpr std::string_view protonation_heading = "Protonation";

// What other programs and the PDB call residues that CHARMM has.
constexpr auto residue_aliases = std::to_array<Pair>(
    {{"HID", "HSD"},  {"HIE", "HSE"},  {"HIP", "HSP"},  {"HISD", "HSD"}, {"HISE", "HSE"},
     {"HISH", "HSP"}, {"CYX", "CYS"},  {"CYS2", "CYS"}, {"ASH", "ASP"},  {"ASPH", "ASP"},
     {"GLH", "GLU"},  {"GLUH", "GLU"}, {"LYN", "LYS"},  {"LYSN", "LYS"}, {"LSN", "LYS"},
     {"NA", "SOD"},   {"K", "POT"},    {"CL", "CLA"},   {"CA", "CAL"},   {"LI", "LIT"},
     {"RB", "RUB"},   {"CS", "CES"},   {"BA", "BAR"},   {"ZN", "ZN2"},   {"CD", "CD2"}});

// Names that say a protonation as well; the patch that CHARMM has for it.
constexpr auto protonated = std::to_array<Pair>({{"ASH", "ASPP"},
                                                 {"ASPH", "ASPP"},
                                                 {"GLH", "GLUP"},
                                                 {"GLUH", "GLUP"},
                                                 {"LYN", "LSN"},
                                                 {"LYSN", "LSN"},
                                                 {"LSN", "LSN"}});

// Modified amino acids, and what they come from.
constexpr auto parents = std::to_array<Pair>({{"CSO", "CYS"},
                                              {"CSD", "CYS"},
                                              {"OCS", "CYS"},
                                              {"CME", "CYS"},
                                              {"SMC", "CYS"},
                                              {"ABA", "ALA"},
                                              {"MSE", "MET"},
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

std::optional<std::string_view> look_up(std::span<const Pair> pairs, std::string_view name) {
    const auto found = std::find_if(pairs.begin(), pairs.end(),
                                    [&](const Pair& pair) { return pair.first == name; });
    if (found == pairs.end()) return std::nullopt;
    return found->second;
}

void rename_residue(Structure& structure, const ResidueRange& residue, std::string_view name) {
    for (std::size_t i = residue.first; i < residue.end(); ++i) structure.names[i].residue = name;
}

// Makes the atoms part of the residue that `of` is in.
void join_residue(Structure& structure, const ResidueRange& cap, std::size_t of) {
    for (std::size_t i = cap.first; i < cap.end(); ++i) {
        structure.names[i].segment = structure.names[of].segment;
        structure.names[i].residue = structure.names[of].residue;
        structure.names[i].number = structure.names[of].number;
        if (structure.records.empty()) continue;
        structure.records[i].residue_number = structure.records[of].residue_number;
        structure.records[i].insertion_code = structure.records[of].insertion_code;
        structure.records[i].chain = structure.records[of].chain;
    }
}

struct Cap {
    std::string_view residue;
    bool is_first;
    std::span<const Pair> atoms;  // heavy ones: as files name them, as CHARMM's patches do
};

constexpr auto acetyl = std::to_array<Pair>({{"CH3", "CAY"}, {"C", "CY"}, {"O", "OY"}});
constexpr auto methylamide = std::to_array<Pair>({{"N", "NT"}, {"CH3", "CAT"}, {"C", "CAT"}});
constexpr auto amide = std::to_array<Pair>({{"N", "NT"}});

constexpr std::array caps{Cap{"ACE", true, acetyl}, Cap{"NME", false, methylamide},
                          Cap{"NMA", false, methylamide}, Cap{"NH2", false, amide}};

void join_caps(Structure& structure, Report& report) {
    const std::vector<ResidueRange> residues = find_residues(structure);
    for (std::size_t i = 0; i < residues.size(); ++i) {
        const std::string& name = structure.names[residues[i].first].residue;
        const auto cap =
            std::find_if(caps.begin(), caps.end(), [&](const Cap& c) { return c.residue == name; });
        if (cap == caps.end()) continue;
        if (cap->is_first ? i + 1 == residues.size() : i == 0) continue;
        const ResidueRange& host = residues[cap->is_first ? i + 1 : i - 1];
        if (!find_atom(structure, host, "CA")) continue;
        const std::string label = residue_label(structure, residues[i]);
        for (std::size_t atom = residues[i].first; atom < residues[i].end(); ++atom) {
            if (const auto charmm = look_up(cap->atoms, structure.names[atom].atom)) {
                structure.names[atom].atom = *charmm;
            }
        }
        join_residue(structure, residues[i], host.first);
        report.add(heading,
                   fmt::format("{}: a cap, now part of {}", label, residue_label(structure, host)));
    }
}

class ResidueNamer {
public:
    ResidueNamer(const ForceField& force_field, Structure structure,
                 const PrepareSettings& settings, Report& report)
        : force_field_(force_field),
          structure_(std::move(structure)),
          settings_(settings),
          report_(report) {}

    NamedResidues name() {
        join_caps(structure_, report_);
        leave_out_unknown();
        choose_states();
        for (const auto& [what, count] : renamed_) {
            report_.add(heading,
                        fmt::format("{} ({} residue{})", what, count, count == 1 ? "" : "s"));
        }
        return {std::move(structure_), std::move(patches_), std::move(missing_)};
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
            rename(residue);
            const std::string& name = name_of(residue);
            const bool is_histidine =
                name == "HIS" && is_known("HSD") && is_known("HSE") && is_known("HSP");
            if (is_known(name) || is_histidine) {
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
        return fmt::format("{} taken as {}, as asked", from, to);
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
        if (is_known(before) && !is_named_like_an_ion(residue, before)) return;
        // "NA+", "CL-", "MG2"
        const std::string plain =
            residue.count == 1 ? before.substr(0, before.find_first_of("+-0123456789")) : before;
        auto alias = is_water(before) ? std::optional<std::string_view>("TIP3")
                                      : look_up(residue_aliases, plain);
        if (!alias && is_known(plain)) alias = plain;
        if (alias == before) return;
        if (!alias || !is_known(*alias)) return;
        rename_residue(structure_, residue, *alias);
        if (const auto patch = look_up(protonated, before)) add_patch(residue, *patch);
        ++renamed_[fmt::format("{} is CHARMM's {}", before, *alias)];
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
        report_.add(protonation_heading, fmt::format("{}: {}, as asked", label, state));
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
        if (name == "HIS" && !is_known("HIS")) {
            const std::string label = residue_label(structure_, residue);
            const HistidineChoice choice = choose_histidine(structure_, residue);
            rename_residue(structure_, residue, choice.residue);
            report_.add(protonation_heading,
                        fmt::format("{}: {} ({})", label, choice.residue, choice.reason));
            if (choice.might_be_charged) {
                report_.warn(
                    fmt::format("{} has an acceptor at both nitrogens and may be charged: "
                                "--protonation {}:{}=HSP",
                                label, identity(residue).first, identity(residue).second));
            }
            return;
        }
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
        std::string where;
        for (std::size_t i = 0; i < std::min<std::size_t>(residues.size(), 4); ++i) {
            const auto [chain, number] = identity(residues[i]);
            where += fmt::format("{}{}:{}", i == 0 ? "" : ", ", chain, number);
        }
        if (residues.size() > 4) where += fmt::format(" and {} more", residues.size() - 4);
        const auto parent = look_up(parents, name);
        const std::string as =
            parent ? fmt::format("take it as {} with --as {}={}, ", *parent, name, *parent)
                   : std::string();
        missing_.add({structure_.file, structure_.lines[residues[0].first], 0},
                     fmt::format("no topology for residue '{}' ({}; {} atoms){}: {}give the file "
                                 "that has it with --toppar, leave it out with --without {}, or "
                                 "take a ligand approximately with --approximate-ligands",
                                 name, where, residues[0].count,
                                 near_name_hint(name, keys(force_field_.residues)), as, name));
    }

    const ForceField& force_field_;
    Structure structure_;
    const PrepareSettings& settings_;
    Report& report_;
    Missing missing_;
    std::vector<ResiduePatch> patches_;
    std::map<std::string, std::size_t> renamed_;
    std::vector<std::size_t> taken_as_another_;  // first atoms of residues, rising
};

}  // namespace

NamedResidues name_residues(const ForceField& force_field, const Structure& structure,
                            const PrepareSettings& settings, Report& report) {
    return ResidueNamer(force_field, structure, settings, report).name();
}

}  // namespace palpa
