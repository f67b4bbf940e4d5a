#include "molecule/match_atoms.h"

#include "core/load_error.h"
#include "core/text.h"
#include "molecule/alternatives.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace palpa {
namespace {

constexpr std::size_t none = static_cast<std::size_t>(-1);
constexpr std::size_t most_named = 8;   // of anything that a message lists
constexpr std::size_t most_tried = 50;  // shifts of residue numbers
constexpr std::int64_t largest_number = 1'000'000'000;

std::string without_segment(const AtomName& name) {
    return name.residue + " " + name.number + " " + name.atom;
}

std::string without_residue(const AtomName& name) { return name.number + " " + name.atom; }

// What bears a name: an atom, and another one where there are several.
struct Bearer {
    std::size_t first, again = none;
};
using Index = std::unordered_map<std::string, Bearer>;

void add(Index& index, std::string name, std::size_t atom) {
    const auto [entry, is_new] = index.try_emplace(std::move(name), Bearer{atom});
    if (!is_new && entry->second.again == none) entry->second.again = atom;
}

// The one atom of this name.
std::optional<std::size_t> find_one(const Index& index, const std::string& name) {
    const auto found = index.find(name);
    if (found == index.end() || found->second.again != none) return std::nullopt;
    return found->second.first;
}

// A segment of the connectivity.
struct Segment {
    std::string name;
    std::vector<std::size_t> atoms;
    bool is_placed = false;
};

// The atoms of a structure that share a segment's or a chain's name.
struct Group {
    std::string name;
    std::vector<std::size_t> atoms;
    Index by_name;  // residue, number and atom
};

// Where all atoms of a segment are in a group.
struct Fit {
    const Group* group;
    std::vector<std::size_t> atoms;  // of the structure, in the segment's order
};

std::string shown(const std::string& name) { return name.empty() ? "(blank)" : name; }

// "PROA, PROB, TL3"
template <class Named>
std::string list_names(const std::vector<Named>& named) {
    std::vector<std::string> names;
    for (const auto& one : named) {
        if (names.size() < most_named) names.push_back(shown(one.name));
    }
    const std::size_t others = named.size() - names.size();
    return fmt::format("{}{}", fmt::join(names, ", "),
                       others > 0 ? fmt::format(" and {} more", others) : "");
}

// One after the other, in the order of first atoms.
template <class Named>
Named& find_or_add(std::vector<Named>& all, std::map<std::string, std::size_t>& index_of,
                   const std::string& name) {
    const auto [entry, is_new] = index_of.try_emplace(name, all.size());
    if (is_new) {
        all.emplace_back();
        all.back().name = name;
    }
    return all[entry->second];
}

std::vector<Segment> list_segments(const Connectivity& connectivity) {
    std::vector<Segment> segments;
    std::map<std::string, std::size_t> index_of;
    for (std::size_t i = 0; i < connectivity.names.size(); ++i) {
        find_or_add(segments, index_of, connectivity.names[i].segment).atoms.push_back(i);
    }
    return segments;
}

std::vector<Group> list_groups(const Structure& structure) {
    std::vector<Group> groups;
    const auto add_all = [&](const auto& name_of) {
        std::map<std::string, std::size_t> index_of;
        std::vector<Group> more;
        for (std::size_t i = 0; i < structure.names.size(); ++i) {
            Group& group = find_or_add(more, index_of, name_of(i));
            group.atoms.push_back(i);
            add(group.by_name, without_segment(structure.names[i]), i);
        }
        for (Group& group : more) groups.push_back(std::move(group));
    };
    add_all([&](std::size_t i) { return structure.names[i].segment; });
    const auto has_other_chain = [&](const AtomRecord& record) {
        const auto i = static_cast<std::size_t>(&record - structure.records.data());
        return record.chain != structure.names[i].segment;
    };
    if (std::any_of(structure.records.begin(), structure.records.end(), has_other_chain)) {
        add_all([&](std::size_t i) { return structure.records[i].chain; });
    }
    return groups;
}

// Says why atoms have no place.
class Diagnosis {
public:
    Diagnosis(const Connectivity& connectivity, const Structure& structure,
              const std::vector<Group>& groups)
        : connectivity_(connectivity), structure_(structure), groups_(groups) {}

    // "b.pdb:12"
    std::string place(std::size_t atom) const {
        return to_string(TextPlace{structure_.file, structure_.lines[atom], 0});
    }

    // Empty if nothing can be said.
    std::string explain(const Segment& segment) const {
        std::string text = find_shift(segment);
        return text.empty() ? find_renamed(segment) : text;
    }

private:
    using Residues = std::vector<std::pair<std::int64_t, std::string>>;  // number, name

    static Residues list_residues(const std::vector<AtomName>& names,
                                  const std::vector<std::size_t>& atoms) {
        Residues residues;
        for (const std::size_t atom : atoms) {
            const std::optional<std::int64_t> number = find_integer(names[atom].number);
            // With an insertion code, or so large that differences would overflow.
            if (!number || *number < -largest_number || *number > largest_number) continue;
            if (residues.empty() || residues.back().first != *number ||
                residues.back().second != names[atom].residue) {
                residues.emplace_back(*number, names[atom].residue);
            }
        }
        std::sort(residues.begin(), residues.end());
        residues.erase(std::unique(residues.begin(), residues.end()), residues.end());
        return residues;
    }

    // By how much all residues of `ours` are numbered higher in `theirs`.
    static std::optional<std::int64_t> find_shift(const Residues& ours, const Residues& theirs) {
        std::size_t tried = 0;
        for (const auto& [number, name] : theirs) {
            if (ours.empty() || name != ours[0].second || number == ours[0].first) continue;
            if (++tried > most_tried) break;
            const std::int64_t shift = number - ours[0].first;
            const bool all = std::all_of(ours.begin(), ours.end(), [&](const auto& residue) {
                return std::binary_search(theirs.begin(), theirs.end(),
                                          std::pair(residue.first + shift, residue.second));
            });
            if (all) return shift;
        }
        return std::nullopt;
    }

    std::string find_shift(const Segment& segment) const {
        const Residues ours = list_residues(connectivity_.names, segment.atoms);
        std::vector<std::string> shifts;
        for (const Group& group : groups_) {
            const auto shift = find_shift(ours, list_residues(structure_.names, group.atoms));
            if (!shift || shifts.size() == most_named) continue;
            shifts.push_back(fmt::format("{} {} in {} ({})", std::abs(*shift),
                                         *shift < 0 ? "lower" : "higher", shown(group.name),
                                         place(group.atoms[0])));
        }
        if (shifts.empty()) return {};
        return fmt::format("; residues of {} have numbers {}; expected the same numbers",
                           shown(segment.name), fmt::join(shifts, ", "));
    }

    // Of the group that has most of the segment's atoms, whatever their residues are called.
    std::string find_renamed(const Segment& segment) const {
        std::vector<std::string> renamed;
        std::size_t most = segment.atoms.size() / 2;
        for (const Group& group : groups_) {
            Index index;
            for (const std::size_t atom : group.atoms) {
                add(index, without_residue(structure_.names[atom]), atom);
            }
            std::size_t found = 0;
            std::vector<std::string> differences;
            const AtomName* last = nullptr;
            for (const std::size_t atom : segment.atoms) {
                const AtomName& name = connectivity_.names[atom];
                const auto there = index.find(without_residue(name));
                if (there == index.end()) continue;
                ++found;
                const std::size_t other = there->second.first;
                const bool same = structure_.names[other].residue == name.residue;
                if (same || (last && last->number == name.number)) continue;
                last = &name;
                differences.push_back(fmt::format("{} {} is {} in {}", name.residue, name.number,
                                                  structure_.names[other].residue, place(other)));
            }
            if (found <= most) continue;
            most = found;
            renamed = std::move(differences);
        }
        if (renamed.empty()) return {};
        const std::size_t others = renamed.size() > most_named ? renamed.size() - most_named : 0;
        renamed.resize(renamed.size() - others);
        return fmt::format("; residue {}{}; expected the same names", fmt::join(renamed, ", "),
                           others > 0 ? fmt::format(" and {} more", others) : "");
    }

    const Connectivity& connectivity_;
    const Structure& structure_;
    const std::vector<Group>& groups_;
};

class Matcher {
public:
    Matcher(const Connectivity& connectivity, const Structure& structure)
        : connectivity_(connectivity),
          structure_(structure),
          segments_(list_segments(connectivity)),
          groups_(list_groups(structure)),
          place_(connectivity.names.size(), none),
          is_taken_(structure.names.size(), false) {}

    std::vector<Vec3> match() {
        for (Segment& segment : segments_) place_in_its_own(segment);
        // What one segment takes is no other's, so that one more may have only one left.
        while (place_where_one_fits(false) || place_where_one_fits(true)) {
        }
        place_single_atoms();
        throw_if_missing();
        std::vector<Vec3> positions;
        positions.reserve(place_.size());
        for (const std::size_t atom : place_) positions.push_back(structure_.positions[atom]);
        return positions;
    }

private:
    std::optional<Fit> find_fit(const Segment& segment, const Group& group) const {
        Fit fit{&group, {}};
        for (const std::size_t atom : segment.atoms) {
            const auto found = group.by_name.find(without_segment(connectivity_.names[atom]));
            if (found == group.by_name.end() || is_taken_[found->second.first]) return std::nullopt;
            fit.atoms.push_back(found->second.first);
        }
        return fit;
    }

    // A segment and a chain of the same atoms count once.
    std::vector<Fit> list_fits(const Segment& segment) const {
        std::vector<Fit> fits;
        for (const Group& group : groups_) {
            std::optional<Fit> fit = find_fit(segment, group);
            if (!fit) continue;
            const bool is_known = std::any_of(fits.begin(), fits.end(), [&](const Fit& other) {
                return other.atoms == fit->atoms;
            });
            if (!is_known) fits.push_back(std::move(*fit));
        }
        return fits;
    }

    void take(std::size_t atom, const Bearer& there) {
        if (there.again != none) refuse_alternative(structure_, there.first, there.again);
        place_[atom] = there.first;
        is_taken_[there.first] = true;
    }

    void take(Segment& segment, const Group& group) {
        for (const std::size_t atom : segment.atoms) {
            take(atom, group.by_name.at(without_segment(connectivity_.names[atom])));
        }
        segment.is_placed = true;
    }

    void place_in_its_own(Segment& segment) {
        for (const Group& group : groups_) {
            if (group.name != segment.name || !find_fit(segment, group)) continue;
            take(segment, group);
            return;
        }
    }

    // Places one segment; false if there is none that can be.
    bool place_where_one_fits(bool by_name) {
        for (Segment& segment : segments_) {
            if (segment.is_placed) continue;
            std::vector<Fit> fits = list_fits(segment);
            if (by_name) {
                std::erase_if(fits, [&](const Fit& fit) {
                    return fit.group->name.empty() || !segment.name.ends_with(fit.group->name);
                });
            }
            if (fits.size() != 1) continue;
            take(segment, *fits[0].group);
            return true;
        }
        return false;
    }

    // Of segments that are spread over several groups.
    void place_single_atoms() {
        Index exact, loose, wanted;
        for (std::size_t i = 0; i < structure_.names.size(); ++i) {
            add(exact, to_string(structure_.names[i]), i);
            add(loose, without_segment(structure_.names[i]), i);
        }
        for (std::size_t i = 0; i < connectivity_.names.size(); ++i) {
            add(wanted, without_segment(connectivity_.names[i]), i);
        }
        for (std::size_t i = 0; i < place_.size(); ++i) {
            if (place_[i] != none) continue;
            const AtomName& name = connectivity_.names[i];
            const auto found = exact.find(to_string(name));
            if (found != exact.end() && !is_taken_[found->second.first]) {
                take(i, found->second);
            } else if (find_one(wanted, without_segment(name))) {
                const auto only = find_one(loose, without_segment(name));
                if (only && !is_taken_[*only]) take(i, Bearer{*only});
            }
        }
    }

    // Which groups a segment fits alike, or else what is different.
    std::string explain(const Segment& segment) const {
        const Diagnosis diagnosis(connectivity_, structure_, groups_);
        std::vector<std::string> alike;
        for (const Fit& fit : list_fits(segment)) {
            alike.push_back(
                fmt::format("{} ({})", shown(fit.group->name), diagnosis.place(fit.atoms[0])));
        }
        if (alike.empty()) return diagnosis.explain(segment);
        return fmt::format(
            "; segment {} matches {} equally well; expected one match, or one named like the "
            "segment or its end",
            shown(segment.name), fmt::join(alike, " and "));
    }

    void throw_if_missing() const {
        std::vector<std::size_t> missing;
        for (std::size_t i = 0; i < place_.size(); ++i) {
            if (place_[i] == none) missing.push_back(i);
        }
        if (missing.empty()) return;
        std::vector<std::string> names;
        for (const std::size_t atom : missing) {
            if (names.size() < most_named) names.push_back(to_string(connectivity_.names[atom]));
        }
        const std::size_t others = missing.size() - names.size();
        std::string text = fmt::format(
            "{} of its {} atoms are not in {}: {}{}; segments of this file: {}; segments or chains "
            "of the other: {}",
            missing.size(), place_.size(), structure_.file, fmt::join(names, ", "),
            others > 0 ? fmt::format(" and {} more", others) : "", list_names(segments_),
            list_names(groups_));
        std::size_t explained = 0;
        for (const Segment& segment : segments_) {
            const bool is_whole =
                std::all_of(segment.atoms.begin(), segment.atoms.end(),
                            [this](std::size_t atom) { return place_[atom] != none; });
            if (!is_whole && explained++ < most_named) text += explain(segment);
        }
        throw LoadError({connectivity_.file, connectivity_.lines[missing[0]], 0}, text);
    }

    const Connectivity& connectivity_;
    const Structure& structure_;
    std::vector<Segment> segments_;
    const std::vector<Group> groups_;
    std::vector<std::size_t> place_;  // of each atom, in the structure; `none` yet
    std::vector<bool> is_taken_;      // of the structure's atoms
};

}  // namespace

std::vector<Vec3> match_positions(const Connectivity& connectivity, const Structure& structure) {
    return Matcher(connectivity, structure).match();
}

}  // namespace palpa
