#include "assembly/region_bodies.h"

#include "assembly/bridges.h"
#include "core/assertion.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace palpa {
namespace {

using BondAtoms = std::array<std::uint32_t, 2>;

constexpr std::uint32_t no_number = std::numeric_limits<std::uint32_t>::max();

// Of each atom inside, by a number for each.
std::vector<std::uint32_t> find_pieces(const Connectivity& connectivity,
                                       std::span<const std::uint8_t> is_inside,
                                       const std::vector<std::uint8_t>& is_cut) {
    const Neighbours neighbours(is_inside.size(), connectivity.bonds, is_cut);
    std::vector<std::uint32_t> piece_of(is_inside.size(), no_number), reached;
    std::uint32_t pieces = 0;
    for (std::uint32_t first = 0; first < is_inside.size(); ++first) {
        if (is_inside[first] == 0 || piece_of[first] != no_number) continue;
        piece_of[first] = pieces;
        reached.assign(1, first);
        while (!reached.empty()) {
            const std::uint32_t atom = reached.back();
            reached.pop_back();
            for (const Neighbour to : neighbours.of(atom)) {
                if (is_inside[to.atom] == 0 || piece_of[to.atom] != no_number) continue;
                piece_of[to.atom] = pieces;
                reached.push_back(to.atom);
            }
        }
        ++pieces;
    }
    return piece_of;
}

}  // namespace

std::vector<BondAtoms> find_region_cuts(const Connectivity& connectivity,
                                        std::span<const std::uint8_t> is_inside,
                                        std::span<const BondAtoms> springs) {
    PALPA_ASSERT(is_inside.size() == connectivity.mass.size());
    std::vector<BondAtoms> cut_before(springs.begin(), springs.end());
    std::ranges::sort(cut_before);
    std::vector<std::uint8_t> is_cut;
    for (const auto& [a, b] : connectivity.bonds) {
        is_cut.push_back(
            std::ranges::binary_search(cut_before, BondAtoms{std::min(a, b), std::max(a, b)}) ? 1
                                                                                              : 0);
    }
    const std::vector<std::uint32_t> piece_of = find_pieces(connectivity, is_inside, is_cut);
    struct WayOut {
        BondAtoms bond;
        std::uint32_t piece, outside;
    };
    std::vector<WayOut> ways;
    std::vector<std::uint32_t> lowest;  // atom outside, of each piece
    for (std::size_t i = 0; i < is_cut.size(); ++i) {
        const auto [a, b] = connectivity.bonds[i];
        if (is_cut[i] != 0 || is_inside[a] == is_inside[b]) continue;
        const auto [inside, outside] = is_inside[a] != 0 ? BondAtoms{a, b} : BondAtoms{b, a};
        const std::uint32_t piece = piece_of[inside];
        if (lowest.size() <= piece) lowest.resize(piece + 1, no_number);
        lowest[piece] = std::min(lowest[piece], outside);
        ways.push_back({{std::min(a, b), std::max(a, b)}, piece, outside});
    }
    std::vector<BondAtoms> cuts;
    std::vector<std::uint8_t> hangs(lowest.size(), 0);
    for (const WayOut& way : ways) {
        if (way.outside == lowest[way.piece] && hangs[way.piece] == 0) {
            hangs[way.piece] = 1;
        } else {
            cuts.push_back(way.bond);
        }
    }
    return cuts;
}

CutBodies cut_bodies(const TorsionBodies& whole, std::span<const std::uint32_t> atoms) {
    PALPA_ASSERT(std::ranges::is_sorted(atoms));
    std::vector<std::uint32_t> new_atom(whole.body_of.size(), no_number);
    std::vector<std::uint32_t> new_body(whole.bodies.size(), no_number);
    for (std::uint32_t i = 0; i < atoms.size(); ++i) {
        new_atom[atoms[i]] = i;
        new_body[whole.body_of[atoms[i]]] = 0;
    }
    CutBodies cut;
    std::uint32_t molecule = 0;
    for (std::size_t b = 0; b < whole.bodies.size(); ++b) {
        const bool is_base = whole.is_base(b);
        if (is_base) ++molecule;
        if (new_body[b] == no_number) {
            PALPA_ASSERT(is_base);
            continue;
        }
        if (is_base) cut.molecules.push_back(molecule - 1);
        new_body[b] = static_cast<std::uint32_t>(cut.bodies.bodies.size());
        Body body = whole.bodies[b];
        if (!is_base) {
            body.parent = new_body[body.parent];
            for (std::uint32_t& atom : body.axis) atom = new_atom[atom];
            PALPA_ASSERT(body.parent != no_number && std::ranges::max(body.axis) != no_number);
        }
        cut.bodies.bodies.push_back(body);
    }
    for (const std::uint32_t atom : atoms)
        cut.bodies.body_of.push_back(new_body[whole.body_of[atom]]);
    for (const auto& [a, b] : whole.springs) {
        if (new_atom[a] != no_number && new_atom[b] != no_number)
            cut.bodies.springs.push_back({new_atom[a], new_atom[b]});
    }
    return cut;
}

}  // namespace palpa
