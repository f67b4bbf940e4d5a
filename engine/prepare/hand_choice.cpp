#include "prepare/hand_choice.h"

#include "core/load_error.h"
#include "core/translate.h"
#include "prepare/residues.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>

namespace palpa {
namespace {

constexpr double neighbourhood = 10;  // Å

bool is_heavy(const Structure& structure, std::uint32_t atom) {
    return element_of(structure, atom) != "H";
}

std::vector<std::uint32_t> find_heavy(const Structure& structure) {
    std::vector<std::uint32_t> heavy;
    for (std::uint32_t i = 0; i < structure.names.size(); ++i) {
        if (is_heavy(structure, i)) heavy.push_back(i);
    }
    return heavy;
}

// Runs of atoms of one residue.
std::vector<std::vector<std::uint32_t>> split_residues(const Structure& structure,
                                                       std::span<const std::uint32_t> atoms) {
    std::vector<std::vector<std::uint32_t>> residues;
    for (const std::uint32_t atom : atoms) {
        if (residues.empty() ||
            !is_same_residue(structure.names[residues.back().back()], structure.names[atom])) {
            residues.emplace_back();
        }
        residues.back().push_back(atom);
    }
    return residues;
}

// Of `heavy`, those around these atoms that are none of them.
std::size_t count_neighbours(const Structure& structure, std::span<const std::uint32_t> heavy,
                             std::span<const std::uint32_t> atoms) {
    const Vec3 middle = middle_of(structure, atoms);
    return static_cast<std::size_t>(std::ranges::count_if(heavy, [&](std::uint32_t other) {
        const double distance2 = (structure.positions[other] - middle).squaredNorm();
        return distance2 < neighbourhood * neighbourhood &&
               !std::ranges::binary_search(atoms, other);
    }));
}

std::string say(const Structure& structure, const HandChoice& choice, bool translates) {
    const auto write = [&](const char* text, const auto&... values) {
        return fmt::format(fmt::runtime(translates ? translated(text) : text), values...);
    };
    if (choice.atom.empty()) return write(for_translation("the whole molecule {}"), choice.segment);
    const AtomName& name = structure.names[choice.held.front()];
    if (choice.atom == name.number)
        return write(for_translation("residue {} {} of {}, on a spring"), name.residue, name.number,
                     choice.segment);
    return write(for_translation("atom {} of {} {} {}, on a spring"), name.atom, name.residue,
                 name.number, choice.segment);
}

HandChoice hold(const Structure& structure, const SystemSegment& segment, std::string atom,
                std::vector<std::uint32_t> held, std::string reason) {
    HandChoice choice{segment.name, std::move(atom), std::move(held), {}, std::move(reason)};
    choice.words = say(structure, choice, false);
    return choice;
}

HandChoice hold_residue(const Structure& structure, const SystemSegment& segment,
                        std::vector<std::uint32_t> residue, std::string reason) {
    std::string number = structure.names[residue.front()].number;
    return hold(structure, segment, std::move(number), std::move(residue), std::move(reason));
}

HandChoice hold_all(const Structure& structure, const SystemSegment& segment, std::string reason) {
    return hold(structure, segment, {}, segment.atoms, std::move(reason));
}

// Of a molecule without residues to choose from.
HandChoice hold_atom(const Structure& structure, const SystemSegment& segment,
                     std::span<const std::uint32_t> heavy) {
    std::optional<std::uint32_t> best;
    std::size_t fewest = 0;
    for (const std::uint32_t atom : segment.atoms) {
        if (!is_heavy(structure, atom)) continue;
        const std::size_t count = count_neighbours(structure, heavy, std::span(&atom, 1));
        if (best && count >= fewest) continue;
        best = atom;
        fewest = count;
    }
    const std::uint32_t atom = best.value_or(segment.atoms.front());
    const AtomName& name = structure.names[atom];
    return hold(structure, segment, fmt::format("{} {}", name.number, name.atom), {atom},
                "the molecule has only one residue");
}

HandChoice hold_most_exposed(const Structure& structure, const SystemSegment& segment) {
    const std::vector<std::uint32_t> heavy = find_heavy(structure);
    std::vector<std::vector<std::uint32_t>> residues = split_residues(structure, segment.atoms);
    if (residues.size() == 1) return hold_atom(structure, segment, heavy);
    std::size_t best = 0, fewest = heavy.size() + 1;
    for (std::size_t i = 0; i < residues.size(); ++i) {
        const std::size_t count = count_neighbours(structure, heavy, residues[i]);
        if (count >= fewest) continue;
        best = i;
        fewest = count;
    }
    return hold_residue(
        structure, segment, std::move(residues[best]),
        fmt::format(
            "it has the fewest heavy atoms within {} Å of this chain ({}), so it moves most easily",
            neighbourhood, fewest));
}

const SystemSegment& find_largest(const Structure& structure,
                                  std::span<const SystemSegment> segments) {
    const SystemSegment* largest = nullptr;
    for (const SystemSegment& segment : segments) {
        if (segment.kind != SegmentKind::Molecule) continue;
        if (!largest || segment.atoms.size() > largest->atoms.size()) largest = &segment;
    }
    if (largest) return *largest;
    throw LoadError({structure.file},
                    "there is no molecule to hold: only water, ions and fragments");
}

constexpr std::size_t most_in_hand = 2000;  // atoms

HandChoice choose_by_size(const Structure& structure, std::span<const SystemSegment> segments) {
    const SystemSegment& largest = find_largest(structure, segments);
    const SystemSegment* smallest = &largest;
    for (const SystemSegment& segment : segments) {
        if (segment.kind != SegmentKind::Molecule) continue;
        if (segment.atoms.size() <= smallest->atoms.size()) smallest = &segment;
    }
    if (smallest != &largest && smallest->atoms.size() <= most_in_hand) {
        const bool is_alone = smallest->atoms.size() < largest.atoms.size();
        return hold_all(
            structure, *smallest,
            is_alone ? "it is the smallest molecule" : "it is the last of several equal molecules");
    }
    return hold_most_exposed(structure, largest);
}

HandChoice choose_by_name(const Structure& structure, std::span<const SystemSegment> segments,
                          std::string_view grab) {
    constexpr std::string_view reason = "as requested";
    for (const SystemSegment& segment : segments) {
        if (segment.name == grab && segments.size() > 1) {
            return hold_all(structure, segment, std::string(reason));
        }
        const bool is_here = grab.starts_with(segment.name + ":");
        for (std::vector<std::uint32_t>& residue : split_residues(structure, segment.atoms)) {
            // Of a segment that was joined to this one, the number is "SEGMENT:RESIDUE" itself.
            const std::string& number = structure.names[residue.front()].number;
            if (number != grab && !(is_here && number == grab.substr(segment.name.size() + 1)))
                continue;
            return hold_residue(structure, segment, std::move(residue), std::string(reason));
        }
    }
    std::vector<std::string> names;
    for (const SystemSegment& segment : segments) names.push_back(segment.name);
    throw LoadError({structure.file},
                    fmt::format("--grab {}: no such segment or residue; expected SEGMENT:RESIDUE, "
                                "or one of several segments (here: {})",
                                grab, fmt::join(names, ", ")));
}

// Evenly over the sphere.
std::vector<Vec3> spread_directions(int count) {
    std::vector<Vec3> directions;
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count, across = std::sqrt(1 - z * z);
        directions.emplace_back(across * std::cos(golden * i), across * std::sin(golden * i), z);
    }
    return directions;
}

// Whether one of the places, going along the direction, comes near to the obstacle.
bool is_met(std::span<const Vec3> places, const Vec3& obstacle, const Vec3& direction) {
    constexpr double reach = 12, near2 = 9;  // Å, Å^2
    return std::ranges::any_of(places, [&](const Vec3& place) {
        const Vec3 way = obstacle - place;
        const double along = way.dot(direction);
        return along > 0 && along < reach && way.squaredNorm() - along * along < near2;
    });
}

}  // namespace

Vec3 middle_of(const Structure& structure, std::span<const std::uint32_t> atoms) {
    Vec3 heavy = Vec3::Zero(), all = Vec3::Zero();
    double count = 0;
    for (const std::uint32_t atom : atoms) {
        all += structure.positions[atom];
        if (!is_heavy(structure, atom)) continue;
        heavy += structure.positions[atom];
        ++count;
    }
    return count > 0 ? Vec3(heavy / count) : Vec3(all / static_cast<double>(atoms.size()));
}

HandChoice choose_hand(const Structure& structure, std::span<const SystemSegment> segments,
                       std::string_view grab) {
    return grab.empty() ? choose_by_size(structure, segments)
                        : choose_by_name(structure, segments, grab);
}

std::string translated_words(const Structure& structure, const HandChoice& choice) {
    return say(structure, choice, true);
}

std::string grab_of(const HandChoice& choice) {
    return choice.atom.empty() ? choice.segment : choice.segment + ":" + choice.atom;
}

std::vector<HandChoice> list_hand_choices(const Structure& structure,
                                          std::span<const SystemSegment> segments,
                                          std::size_t most) {
    std::vector<const SystemSegment*> molecules;
    for (const SystemSegment& segment : segments)
        if (segment.kind == SegmentKind::Molecule) molecules.push_back(&segment);
    if (molecules.empty()) return {};
    std::ranges::stable_sort(molecules, {},
                             [](const SystemSegment* segment) { return segment->atoms.size(); });
    std::vector<HandChoice> choices{choose_by_size(structure, segments)};
    const auto add = [&](HandChoice choice) {
        const std::string grab = grab_of(choice);
        const bool is_known = std::ranges::count(choices, grab, grab_of) > 0;
        if (!is_known && choices.size() < most) choices.push_back(std::move(choice));
    };
    for (const SystemSegment* const segment : molecules)
        if (segments.size() > 1 && segment->atoms.size() <= most_in_hand)
            add(hold_all(structure, *segment, "a molecule of its own"));
    for (const SystemSegment* const segment : molecules) {
        if (choices.size() >= most) break;
        const bool has_residues = split_residues(structure, segment->atoms).size() > 1;
        if (has_residues) add(hold_most_exposed(structure, *segment));
    }
    return choices;
}

HandChoice choose_residue(const Structure& structure, std::span<const SystemSegment> segments) {
    return hold_most_exposed(structure, find_largest(structure, segments));
}

Vec3 find_way_out(const Structure& structure, std::span<const std::uint32_t> held) {
    std::vector<Vec3> places, obstacles;
    for (const std::uint32_t atom : held) {
        if (is_heavy(structure, atom)) places.push_back(structure.positions[atom]);
    }
    const Vec3 middle = middle_of(structure, held);
    double radius = 0;
    for (const Vec3& place : places) radius = std::max(radius, (place - middle).norm());
    Vec3 away = Vec3::Zero();
    for (const std::uint32_t other : find_heavy(structure)) {
        if (std::ranges::binary_search(held, other)) continue;
        const Vec3 from = middle - structure.positions[other];
        if (from.norm() < radius + 15) obstacles.push_back(structure.positions[other]);
        if (from.norm() < radius + neighbourhood) away += from.normalized();
    }
    std::optional<std::pair<std::size_t, double>> least;
    Vec3 best = Vec3::UnitX();
    for (const Vec3& direction : spread_directions(256)) {
        const auto met = static_cast<std::size_t>(std::ranges::count_if(
            obstacles, [&](const Vec3& obstacle) { return is_met(places, obstacle, direction); }));
        const std::pair rank(met, -direction.dot(away));
        if (least && rank >= *least) continue;
        least = rank;
        best = direction;
    }
    return best;
}

}  // namespace palpa
