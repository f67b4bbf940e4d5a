#include "view/contact_pairs.h"

#include "molecule/element.h"
#include "view/in_hand.h"
#include "view/lines.h"
#include "view/palette.h"
#include "view/place.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <utility>

namespace palpa {
namespace {

constexpr double bonded_allowance = 0.4;  // Å

double overlap_of(const AtomTable& atoms, const AtomPair& pair) {
    return van_der_waals_radius(find_element(atoms, pair.a)) +
           van_der_waals_radius(find_element(atoms, pair.b)) - pair.distance;
}

std::vector<AtomRange> as_ranges(std::span<const ResidueSpan> residues) {
    std::vector<AtomRange> ranges;
    for (const ResidueSpan& residue : residues)
        ranges.push_back({static_cast<std::uint32_t>(residue.first),
                          static_cast<std::uint32_t>(residue.end - residue.first)});
    return ranges;
}

// Heavy atoms of hydrogen bonds and salt bridges, the lower number first.
class JoinedAtoms {
public:
    JoinedAtoms(std::span<const HydrogenBond> bonds, std::span<const AtomPair> salt_bridges) {
        for (const HydrogenBond& bond : bonds)
            pairs_.push_back(std::minmax({bond.donor, bond.acceptor}));
        for (const AtomPair& bridge : salt_bridges)
            pairs_.push_back(std::minmax({bridge.a, bridge.b}));
        std::ranges::sort(pairs_);
    }

    bool has(const AtomPair& pair) const {
        return std::ranges::binary_search(pairs_, std::pair(pair.a, pair.b));
    }

private:
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
};

// The line between two atoms outside of their spheres, as they are drawn.
class DrawnAtoms {
public:
    DrawnAtoms(const AtomTable& atoms, const FrameScene& frame)
        : atoms_(atoms), radii_(find_drawn_radii(frame, atoms.size())) {}

    struct Line {
        glm::vec3 a{0}, b{0};
    };
    // Where spheres leave less than `least` (Å) between them, of that length about the middle.
    Line between(const AtomPair& pair, float least) const {
        const glm::vec3 a = as_float(atoms_.positions[pair.a]);
        const glm::vec3 b = as_float(atoms_.positions[pair.b]);
        const float length = glm::distance(a, b);
        if (!(length > 0)) return {a, b};
        const glm::vec3 along = (b - a) / length;
        if (length - radii_[pair.a] - radii_[pair.b] < least) {
            const glm::vec3 middle = a + 0.5F * (length + radii_[pair.a] - radii_[pair.b]) * along;
            return {middle - 0.5F * least * along, middle + 0.5F * least * along};
        }
        return {a + radii_[pair.a] * along, b - radii_[pair.b] * along};
    }

private:
    const AtomTable& atoms_;
    std::vector<float> radii_;
};

}  // namespace

ContactPairs find_contact_pairs(const World& world, ShownBonds which,
                                std::span<const ResidueSpan> residues,
                                std::span<const HydrogenBond> bonds) {
    ContactPairs found;
    if (which == ShownBonds::None) return found;
    const AtomTable& atoms = world.resource<AtomTable>();
    const std::vector<AtomRange> ranges = as_ranges(residues);
    const std::vector<bool> of =
        which == ShownBonds::InHand ? find_in_hand(world) : std::vector<bool>();
    found.salt_bridges = find_salt_bridges(atoms, ranges);
    std::erase_if(found.salt_bridges, [&](const AtomPair& bridge) {
        return !of.empty() && of[bridge.a] == of[bridge.b];
    });
    const JoinedAtoms joined(bonds, found.salt_bridges);
    for (const AtomPair& pair : find_overlaps(atoms, ranges, contact_overlap, of)) {
        const bool is_joined = joined.has(pair);
        const double excess = overlap_of(atoms, pair) - (is_joined ? bonded_allowance : 0);
        if (excess > clash_overlap) {
            found.clashes.push_back({pair, excess});
        } else if (!is_joined) {
            found.contacts.push_back(pair);
        }
    }
    std::ranges::stable_sort(found.clashes, std::greater(), &Clash::excess);
    return found;
}

void add_contact_pairs(const AtomTable& atoms, const ContactPairs& pairs, FrameScene& frame,
                       std::vector<ViewLabel>& labels) {
    constexpr LineLook contact{0.03F, contact_colour, contact_pick};
    constexpr LineLook clash{0.06F, clash_colour, clash_pick};
    constexpr LineLook plate{0.28F, clash_colour, clash_pick};
    constexpr LineLook bridge{0.07F, salt_bridge_colour, salt_bridge_pick};
    constexpr float least = 0.3F, dash = 0.3F;  // Å
    constexpr std::size_t most_labels = 4;
    if (pairs.contacts.empty() && pairs.clashes.empty() && pairs.salt_bridges.empty()) return;
    const DrawnAtoms drawn(atoms, frame);
    for (const AtomPair& pair : pairs.contacts) {
        const auto [a, b] = drawn.between(pair, least);
        add_stick(a, b, contact, frame);
    }
    for (const Clash& each : pairs.clashes) {
        const auto [a, b] = drawn.between(each.pair, least);
        const glm::vec3 middle = 0.5F * (a + b);
        if (a == b) continue;
        add_stick(a, b, clash, frame);
        add_disc(middle, glm::normalize(b - a), plate, frame);
        if (&each == pairs.clashes.data())
            labels.push_back({middle, fmt::format("{:.1f} Å overlap", each.excess)});
    }
    for (const AtomPair& pair : pairs.salt_bridges) {
        const auto [a, b] = drawn.between(pair, least);
        add_dashes(a, b, dash, bridge, frame);
        if (pairs.salt_bridges.size() <= most_labels)
            labels.push_back({0.5F * (a + b), fmt::format("{:.2f} Å", pair.distance)});
    }
}

}  // namespace palpa
