#include "prepare/segments.h"

#include "charmm/missing.h"
#include "core/text.h"
#include "molecule/residue_kinds.h"
#include "prepare/patch_fit.h"
#include "prepare/residues.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

namespace palpa {
namespace {

constexpr std::string_view segments_heading = "Chains and their ends";
constexpr std::string_view disulphide_heading = "Disulphides";
constexpr double longest_link = 2.5;  // Å, between atoms taken as bonded

// The atoms by which a residue is bonded to the next one: C and N of a peptide.
std::optional<std::pair<std::string, std::string>> find_link(const Residue& residue) {
    for (const auto& [a, b] : residue.bonds) {
        if (b.size() > 1 && b[0] == '+') return std::pair(a, b.substr(1));
        if (a.size() > 1 && a[0] == '+') return std::pair(b, a.substr(1));
    }
    return std::nullopt;
}

class Segmenter {
public:
    Segmenter(const ForceField& force_field, Structure& structure, const PrepareSettings& settings,
              Report& report)
        : force_field_(force_field),
          structure_(structure),
          settings_(settings),
          report_(report),
          residues_(find_residues(structure)) {}

    GenerateSettings split(const std::vector<ResiduePatch>& protonation,
                           std::span<const LinkPatch> links) {
        result_.disulphide_distance = 0;  // found here, to be reported
        for (const ResiduePatch& patch : protonation) residue_patches_.insert(patch.atom);
        for (std::size_t i = 0; i < residues_.size();) {
            const std::size_t end = find_end(i);
            if (end > i && !is_other_nucleoside(i, end)) {
                add_chain(i, end);
            } else {
                add_single(i);
            }
            i = std::max(end, i + 1);
        }
        check_end_choices();
        check_numbers();
        for (const ResiduePatch& patch : protonation) {
            result_.patches.push_back({patch.patch, {identity(patch.atom)}});
        }
        for (const LinkPatch& link : links) {
            PatchUse use{link.patch, {}};
            for (const std::size_t atom : link.atoms) use.residues.push_back(identity(atom));
            result_.patches.push_back(std::move(use));
        }
        for (const auto& [patch, residues] : chain_patches_) {
            PatchUse use{patch, {}};
            for (const std::size_t i : residues)
                use.residues.push_back(identity(residues_[i].first));
            result_.patches.push_back(std::move(use));
        }
        add_disulphides();
        missing_.throw_if_any();
        return std::move(result_);
    }

private:
    const Residue& residue_of(std::size_t index) const {
        return force_field_.residues.at(structure_.names[residues_[index].first].residue);
    }

    ResidueId identity(std::size_t atom) const {
        return {structure_.names[atom].segment, structure_.names[atom].number};
    }

    const std::string& chain(std::size_t index) const {
        return chain_of(structure_, residues_[index].first);
    }

    // One past the last residue of the chain that begins at `first`; `first` if that is no chain.
    std::size_t find_end(std::size_t first) const {
        if (!find_link(residue_of(first))) return first;
        std::size_t last = first;
        while (last + 1 < residues_.size() && is_linked(last)) ++last;
        return last + 1;
    }

    bool ends_by_record(std::size_t index) const {
        return std::binary_search(structure_.chain_ends.begin(), structure_.chain_ends.end(),
                                  residues_[index].end());
    }

    bool is_linked(std::size_t index) const {
        const auto link = find_link(residue_of(index));
        const auto next_link = find_link(residue_of(index + 1));
        if (!link || link != next_link || chain(index) != chain(index + 1)) return false;
        if (ends_by_record(index)) return false;
        const auto a = find_atom(structure_, residues_[index], link->first);
        const auto b = find_atom(structure_, residues_[index + 1], link->second);
        if (a && b) {
            return (structure_.positions[*a] - structure_.positions[*b]).norm() < longest_link;
        }
        if (structure_.records.empty()) return true;
        return structure_.records[residues_[index + 1].first].residue_number ==
               structure_.records[residues_[index].first].residue_number + 1;
    }

    // A PDB file has four columns for it; a number takes the place of letters where they are full.
    std::string unique_segment(const std::string& wanted) {
        constexpr std::size_t most = 4, most_segments = 9999;
        for (std::size_t count = 1; count <= most_segments; ++count) {
            const std::string number = count == 1 ? "" : fmt::format("{}", count);
            const std::string name = wanted.substr(0, most - number.size()) + number;
            if (segments_.insert(name).second) return name;
        }
        throw LoadError({structure_.file},
                        fmt::format("the structure has more than {} segments; expected fewer "
                                    "(leave molecules out with --without)",
                                    most_segments));
    }

    void set_segment(std::size_t index, const std::string& segment) {
        for (std::size_t i = residues_[index].first; i < residues_[index].end(); ++i) {
            structure_.names[i].segment = segment;
        }
    }

    bool has_atom(std::size_t index, std::string_view name) const {
        return find_atom(structure_, residues_[index], name).has_value();
    }

    void add_chain(std::size_t first, std::size_t end) {
        const std::size_t last = end - 1;
        const std::string chain_name = chain(first).empty() ? "P" : chain(first);
        const bool is_nucleic = is_nucleotide(first);
        const auto chain_key = std::pair(chain_name, is_nucleic);
        const auto before = last_of_chain_.find(chain_key);
        const bool is_behind_gap =
            before != last_of_chain_.end() && !ends_by_record(before->second);
        const std::string segment = unique_segment(chain_name);
        SegmentSettings settings;
        settings.segment = segment;
        const bool is_before_gap = goes_on_behind(last);
        if (is_nucleic) {
            choose_nucleic_ends(first, settings);
            patch_deoxyriboses(first, end);
        } else if (is_closed(first, last)) {
            close_chain(first, last, settings);
        } else {
            choose_ends(first, last, is_behind_gap, is_before_gap, settings);
        }
        if (is_behind_gap) {
            report_.warn(
                fmt::format("chain {} has a gap between {} and {}, closed by {} (for other "
                            "patches: --last, --first)",
                            chain_name, residue_label(structure_, residues_[before->second]),
                            residue_label(structure_, residues_[first]),
                            is_nucleic ? "a hydroxyl and a phosphate" : "neutral caps"));
        }
        last_of_chain_[chain_key] = last;
        // A chain's name means its real ends, not those at gaps.
        const std::string end_name = is_before_gap && segment == chain_name ? "" : segment;
        choose_as_asked(settings_.first, {segment, is_behind_gap ? segment : chain_name}, first,
                        settings.first, used_first_);
        choose_as_asked(settings_.last, {end_name, is_before_gap ? end_name : chain_name}, last,
                        settings.last, used_last_);
        report_.add(segments_heading,
                    fmt::format("segment {}: {} to {}, {} residues; first {}, last {}", segment,
                                residue_label(structure_, residues_[first]),
                                residue_label(structure_, residues_[last]), end - first,
                                shown(settings.first, residue_of(first).first_patch),
                                shown(settings.last, residue_of(last).last_patch)));
        for (std::size_t i = first; i < end; ++i) set_segment(i, segment);
        result_.segments.push_back(std::move(settings));
    }

    static const std::string& shown(const std::string& patch, const std::string& by_template) {
        return patch.empty() ? by_template : patch;
    }

    // Whether the same chain has more residues of chains behind this one, before TER.
    bool goes_on_behind(std::size_t last) const {
        if (ends_by_record(last)) return false;
        for (std::size_t i = last + 1; i < residues_.size(); ++i) {
            if (chain(i) != chain(last)) return false;
            if (find_link(residue_of(i)) == find_link(residue_of(last))) return true;
        }
        return false;
    }

    void choose_ends(std::size_t first, std::size_t last, bool is_behind_gap, bool is_before_gap,
                     SegmentSettings& settings) {
        const bool is_proline = structure_.names[residues_[first].first].residue == "PRO";
        const bool has_end = has_atom(last, "OXT") || has_atom(last, "OT2");
        if (is_behind_gap || has_atom(first, "CAY")) settings.first = is_proline ? "ACP" : "ACE";
        if (has_atom(last, "NT")) settings.last = "CT2";
        if (has_atom(last, "CAT") || (is_before_gap && !has_end)) settings.last = "CT3";
        if (first != last || settings.last != "CT3") return;
        // One residue with both: CHARMM has ACE in another form for it; NTER does not go with CT3,
        // whose hydrogens have the same names.
        if (!settings.first.empty()) {
            settings.first += "D";
        } else if (!has_atom(last, "CAT")) {
            settings.last.clear();
            report_.warn(
                fmt::format("{} is a single residue before a gap and is charged at both ends; to "
                            "leave it out: --without {}:{}",
                            residue_label(structure_, residues_[last]), chain(last),
                            structure_.names[residues_[last].first].number));
        }
    }

    bool is_nucleotide(std::size_t index) const {
        const auto link = find_link(residue_of(index));
        return link && link->first == "O3'" && link->second == "P";
    }

    // A nucleoside alone, with a patch that makes another molecule of it: S-adenosylhomocysteine.
    bool is_other_nucleoside(std::size_t first, std::size_t end) const {
        return end == first + 1 && is_nucleotide(first) &&
               residue_patches_.contains(residues_[first].first);
    }

    void choose_nucleic_ends(std::size_t first, SegmentSettings& settings) {
        settings.first = has_atom(first, "P") ? "5PHO" : "5TER";
        settings.last = "3TER";
    }

    // CHARMM's nucleotides are RNA. The one at the 5' end keeps its phosphorus as that end has it.
    void patch_deoxyriboses(std::size_t first, std::size_t end) {
        std::size_t count = 0;
        for (std::size_t i = first; i < end; ++i) {
            if (has_atom(i, "O2'")) continue;
            chain_patches_.emplace_back(i == first ? "DEO5" : "DEOX", std::vector{i});
            ++count;
        }
        if (count == 0) return;
        report_.add(
            segments_heading,
            fmt::format("{} to {}: {} of {} sugars have no O2', so they were taken as deoxyribose",
                        residue_label(structure_, residues_[first]),
                        residue_label(structure_, residues_[end - 1]), count, end - first));
    }

    // A peptide whose last C is bonded to its first N.
    bool is_closed(std::size_t first, std::size_t last) const {
        constexpr double longest_peptide_bond = 1.8;  // Å
        if (last < first + 3 || !force_field_.patches.contains("LIG1")) return false;
        const auto n = find_atom(structure_, residues_[first], "N");
        const auto c = find_atom(structure_, residues_[last], "C");
        return n && c &&
               (structure_.positions[*n] - structure_.positions[*c]).norm() < longest_peptide_bond;
    }

    void close_chain(std::size_t first, std::size_t last, SegmentSettings& settings) {
        settings.first = settings.last = "NONE";
        chain_patches_.emplace_back("LIG1", std::vector{last - 1, last, first, first + 1});
        report_.add(segments_heading,
                    fmt::format("{} and {}: the chain is closed, C is bonded to N",
                                residue_label(structure_, residues_[last]),
                                residue_label(structure_, residues_[first])));
    }

    void choose_as_asked(const std::vector<std::pair<std::string, std::string>>& choices,
                         const std::array<std::string, 2>& names, std::size_t residue,
                         std::string& patch, std::set<std::string>& used) {
        for (const auto& [where, name] : choices) {
            if (where != names[0] && where != names[1]) continue;
            used.insert(where);
            if (name != "NONE" && !force_field_.patches.contains(name)) {
                missing_.add({structure_.file},
                             fmt::format("no patch '{}' for the ends of {}{}", name, where,
                                         near_name_hint(name, keys(force_field_.patches))));
                continue;
            }
            const std::string misfit =
                name == "NONE" ? std::string()
                               : find_misfit(residue_of(residue), force_field_.patches.at(name));
            if (!misfit.empty()) {
                missing_.add({structure_.file, structure_.lines[residues_[residue].first], 0},
                             fmt::format("patch {} is not for {}, which has no '{}'", name,
                                         residue_label(structure_, residues_[residue]), misfit));
                continue;
            }
            patch = name;
        }
    }

    void check_end_choices() {
        const auto check = [&](const auto& choices, const std::set<std::string>& used,
                               std::string_view option) {
            for (const auto& [where, name] : choices) {
                if (used.contains(where)) continue;
                missing_.add({structure_.file},
                             fmt::format("{} {}={}: no chain or segment '{}' (only {})", option,
                                         where, name, where, fmt::join(segments_, ", ")));
            }
        };
        check(settings_.first, used_first_, "--first");
        check(settings_.last, used_last_, "--last");
    }

    void add_single(std::size_t index) {
        const AtomName& name = structure_.names[residues_[index].first];
        const bool is_water_here = is_water(name.residue);
        if (is_water_here || residue_of(index).atoms.size() == 1) {
            const std::string key = (is_water_here ? "W" : "I") + chain(index);
            auto [found, is_new] = gathered_.try_emplace(key);
            if (is_new) {
                found->second = unique_segment(key);
                report_.add(segments_heading, fmt::format("segment {}: {}", found->second,
                                                          is_water_here ? "waters" : "ions"));
                result_.segments.push_back({found->second, "NONE", "NONE", !is_water_here});
            }
            set_segment(index, found->second);
            return;
        }
        const std::string segment = unique_segment(name.residue.substr(0, 4));
        report_.add(segments_heading, fmt::format("segment {}: {}", segment,
                                                  residue_label(structure_, residues_[index])));
        result_.segments.push_back({segment, {}, {}});
        set_segment(index, segment);
    }

    void check_numbers() {
        std::map<std::pair<std::string, std::string>, std::size_t> seen;
        for (const ResidueRange& residue : residues_) {
            const AtomName& name = structure_.names[residue.first];
            const auto [before, is_new] =
                seen.try_emplace({name.segment, name.number}, residue.first);
            if (is_new) continue;
            const std::size_t line = structure_.lines[before->second];
            missing_.add({structure_.file, structure_.lines[residue.first], 0},
                         fmt::format("{} has the same number as {} (line {}); expected different "
                                     "numbers or insertion codes, or --without one of them",
                                     residue_label(structure_, residue),
                                     structure_.names[before->second].residue, line));
        }
    }

    std::optional<std::size_t> find_residue_of(const ResidueChoice& choice) {
        for (std::size_t i = 0; i < residues_.size(); ++i) {
            if (chain(i) == choice.chain &&
                structure_.names[residues_[i].first].number == choice.number) {
                return i;
            }
        }
        missing_.add({structure_.file}, fmt::format("--disulphide: no residue {}:{} here",
                                                    choice.chain, choice.number));
        return std::nullopt;
    }

    void add_disulphide(std::size_t a, std::size_t b, std::string_view why) {
        result_.patches.push_back(
            {"DISU", {identity(residues_[a].first), identity(residues_[b].first)}});
        report_.add(disulphide_heading,
                    fmt::format("{} and {}: {}", residue_label(structure_, residues_[a]),
                                residue_label(structure_, residues_[b]), why));
    }

    bool has_sulphur(std::size_t index) const {
        return structure_.names[residues_[index].first].residue == "CYS" && has_atom(index, "SG");
    }

    void add_disulphides() {
        std::set<std::size_t> taken;
        for (const auto& [one, other] : settings_.disulphides) {
            const auto a = find_residue_of(one);
            const auto b = find_residue_of(other);
            if (!a || !b) continue;
            const bool are_cysteines = *a != *b && has_sulphur(*a) && has_sulphur(*b);
            if (!are_cysteines) {
                missing_.add({structure_.file},
                             fmt::format("--disulphide {}:{}-{}:{}: expected two CYS that have SG",
                                         one.chain, one.number, other.chain, other.number));
                continue;
            }
            add_disulphide(*a, *b, "as requested");
            taken.insert(*a);
            taken.insert(*b);
        }
        if (!settings_.finds_disulphides) return;
        for (const auto& [distance, a, b] : find_sulphur_pairs()) {
            if (taken.contains(a) || taken.contains(b)) continue;
            if (distance > longest_link) {
                report_.add(
                    disulphide_heading,
                    fmt::format(
                        "{} and {}: not bonded, SG {:.2f} Å apart (to bond them: --disulphide)",
                        residue_label(structure_, residues_[a]),
                        residue_label(structure_, residues_[b]), distance));
                continue;
            }
            taken.insert(a);
            taken.insert(b);
            add_disulphide(a, b, fmt::format("SG {:.2f} Å apart", distance));
        }
    }

    std::vector<std::tuple<double, std::size_t, std::size_t>> find_sulphur_pairs() const {
        std::vector<std::pair<std::size_t, std::size_t>> sulphurs;  // residue, its SG
        for (std::size_t i = 0; i < residues_.size(); ++i) {
            if (structure_.names[residues_[i].first].residue != "CYS") continue;
            if (const auto atom = find_atom(structure_, residues_[i], "SG")) {
                sulphurs.emplace_back(i, *atom);
            }
        }
        std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
        for (std::size_t i = 0; i < sulphurs.size(); ++i) {
            for (std::size_t j = i + 1; j < sulphurs.size(); ++j) {
                const double distance = (structure_.positions[sulphurs[i].second] -
                                         structure_.positions[sulphurs[j].second])
                                            .norm();
                constexpr double worth_telling = 3;  // Å
                if (distance < worth_telling) {
                    pairs.emplace_back(distance, sulphurs[i].first, sulphurs[j].first);
                }
            }
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

    const ForceField& force_field_;
    Structure& structure_;
    const PrepareSettings& settings_;
    Report& report_;
    const std::vector<ResidueRange> residues_;
    Missing missing_;
    GenerateSettings result_;
    std::set<std::string> segments_;
    // By chain, proteins and nucleic acids apart: the residue that its last segment ends with.
    std::map<std::pair<std::string, bool>, std::size_t> last_of_chain_;
    std::set<std::string> used_first_, used_last_;
    std::set<std::size_t> residue_patches_;  // first atoms of residues with a patch of their own
    // Patches that follow from a chain, and its residues.
    std::vector<std::pair<std::string, std::vector<std::size_t>>> chain_patches_;
    std::map<std::string, std::string> gathered_;  // waters and ions of a chain: their segment
};

}  // namespace

GenerateSettings split_segments(const ForceField& force_field, Structure& structure,
                                const std::vector<ResiduePatch>& protonation,
                                const PrepareSettings& settings, Report& report,
                                std::span<const LinkPatch> links) {
    return Segmenter(force_field, structure, settings, report).split(protonation, links);
}

}  // namespace palpa
