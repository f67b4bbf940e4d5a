#include "molecule/measure.h"

#include "molecule/element.h"
#include "molecule/point_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

constexpr std::uint32_t of_no_residue = ~std::uint32_t{0};

std::vector<std::uint32_t> number_residues(const AtomTable& atoms,
                                           std::span<const AtomRange> residues) {
    std::vector<std::uint32_t> residue_of(atoms.size(), of_no_residue);
    for (std::uint32_t i = 0; i < residues.size(); ++i)
        std::fill_n(residue_of.begin() + residues[i].first, residues[i].count, i);
    return residue_of;
}

// Who is bonded to whom.
class BondLists {
public:
    explicit BondLists(const AtomTable& atoms)
        : first_(atoms.size() + 1, 0), neighbours_(2 * atoms.bonds.size()) {
        for (const auto& [a, b] : atoms.bonds) {
            ++first_[a];
            ++first_[b];
        }
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        for (const auto& [a, b] : atoms.bonds) {  // from the end of each list to its beginning
            neighbours_[--first_[a]] = b;
            neighbours_[--first_[b]] = a;
        }
    }

    bool are_within(std::uint32_t a, std::uint32_t b, int bonds) const {
        if (a == b) return true;
        if (bonds == 0) return false;
        const auto next = std::span(neighbours_).subspan(first_[a], first_[a + 1] - first_[a]);
        return std::ranges::any_of(
            next, [&](std::uint32_t atom) { return are_within(atom, b, bonds - 1); });
    }

private:
    // The neighbours of atom i are [first_[i], first_[i + 1]) of `neighbours_`.
    std::vector<std::uint32_t> first_, neighbours_;
};

// Around those of `of`, as far as any atom's sphere can reach theirs; empty where all may clash.
std::optional<Eigen::AlignedBox3d> find_reached(const AtomTable& atoms, double overlap,
                                                const std::vector<bool>& of) {
    if (of.empty()) return std::nullopt;
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < atoms.size(); ++i)
        if (of[i]) box.extend(atoms.positions[i]);
    if (box.isEmpty()) return box;
    const Vec3 reach = Vec3::Constant(std::max(2 * largest_van_der_waals_radius() - overlap, 0.0));
    return Eigen::AlignedBox3d(box.min() - reach, box.max() + reach);
}

// Radii of those atoms that may clash; 0 of all others.
std::vector<double> list_radii(const AtomTable& atoms, std::span<const std::uint32_t> residue_of,
                               const std::optional<Eigen::AlignedBox3d>& within) {
    std::vector<double> radii(atoms.size(), 0);
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        if (residue_of[i] == of_no_residue) continue;
        if (within && !within->contains(atoms.positions[i])) continue;
        const std::string element = find_element(atoms, i);
        if (element != "H" && element != "D") radii[i] = van_der_waals_radius(element);
    }
    return radii;
}

bool has_atom_called(const AtomTable& atoms, const AtomRange& residue, std::string_view name) {
    for (std::uint32_t i = residue.first; i < residue.first + residue.count; ++i)
        if (atoms.names[i].atom == name) return true;
    return false;
}

// The names of atoms that carry a residue's charge; none where it has none.
using ChargedNames = std::span<const std::string_view>;
constexpr auto lysine = std::to_array<std::string_view>({"NZ"});
constexpr auto arginine = std::to_array<std::string_view>({"NE", "NH1", "NH2"});
constexpr auto histidine = std::to_array<std::string_view>({"ND1", "NE2"});
constexpr auto aspartate = std::to_array<std::string_view>({"OD1", "OD2"});
constexpr auto glutamate = std::to_array<std::string_view>({"OE1", "OE2"});

ChargedNames find_positive(const AtomTable& atoms, const AtomRange& residue) {
    const std::string_view name = atoms.names[residue.first].residue;
    const auto has = [&](std::string_view atom) { return has_atom_called(atoms, residue, atom); };
    if (name == "LYS") return has("HZ1") && !has("HZ3") ? ChargedNames{} : ChargedNames(lysine);
    if (name == "ARG") return arginine;
    if (name == "HSP" || name == "HIP") return histidine;
    return name == "HIS" && has("HD1") && has("HE2") ? ChargedNames(histidine) : ChargedNames{};
}

ChargedNames find_negative(const AtomTable& atoms, const AtomRange& residue) {
    const std::string_view name = atoms.names[residue.first].residue;
    const auto has = [&](std::string_view atom) { return has_atom_called(atoms, residue, atom); };
    if (name == "ASP") return has("HD1") || has("HD2") ? ChargedNames{} : ChargedNames(aspartate);
    if (name == "GLU") return has("HE1") || has("HE2") ? ChargedNames{} : ChargedNames(glutamate);
    return {};
}

// Atoms that carry charge of one sign.
template <class Names>
std::vector<std::uint32_t> list_charged(const AtomTable& atoms, std::span<const AtomRange> residues,
                                        const Names& names_of) {
    std::vector<std::uint32_t> charged;
    for (const AtomRange& residue : residues) {
        const ChargedNames names = names_of(atoms, residue);
        for (std::uint32_t i = residue.first; i < residue.first + residue.count; ++i)
            if (std::ranges::find(names, atoms.names[i].atom) != names.end()) charged.push_back(i);
    }
    return charged;
}

std::vector<Vec3> places_of(const AtomTable& atoms, std::span<const std::uint32_t> numbers) {
    std::vector<Vec3> places;
    places.reserve(numbers.size());
    for (const std::uint32_t atom : numbers) places.push_back(atoms.positions[atom]);
    return places;
}

void sort_pairs(std::vector<AtomPair>& pairs) {
    std::ranges::sort(pairs, {}, [](const AtomPair& pair) { return std::pair(pair.a, pair.b); });
}

}  // namespace

double find_angle(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
    const Vec3 first = a - b, second = c - b;
    return std::atan2(first.cross(second).norm(), first.dot(second));
}

double find_dihedral(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept {
    const Vec3 first = b - a, axis = c - b, last = d - c;
    const Vec3 before = first.cross(axis), after = axis.cross(last);
    return std::atan2(axis.norm() * first.dot(after), before.dot(after));
}

std::vector<AtomPair> find_overlaps(const AtomTable& atoms, std::span<const AtomRange> residues,
                                    double overlap, const std::vector<bool>& of) {
    constexpr int fewest_bonds = 4;
    const std::vector<std::uint32_t> residue_of = number_residues(atoms, residues);
    const std::vector<double> radii =
        list_radii(atoms, residue_of, find_reached(atoms, overlap, of));
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < radii.size(); ++i)
        if (radii[i] > 0) numbers.push_back(i);
    if (numbers.empty()) return {};
    const double largest = *std::ranges::max_element(radii);
    const PointGrid grid(places_of(atoms, numbers));
    const BondLists bonds(atoms);
    std::vector<AtomPair> pairs;
    for (const std::uint32_t from : numbers) {
        const double reach = radii[from] + largest - overlap;
        if (reach <= 0 || (!of.empty() && !of[from])) continue;
        grid.visit_near(atoms.positions[from], reach, [&](std::uint32_t point) {
            const std::uint32_t to = numbers[point];
            if (of.empty() ? to <= from : of[to]) return;
            const auto [a, b] = std::minmax(from, to);
            if (residue_of[a] == residue_of[b]) return;
            const double distance = (atoms.positions[a] - atoms.positions[b]).norm();
            if (distance >= radii[a] + radii[b] - overlap) return;
            if (!bonds.are_within(a, b, fewest_bonds - 1)) pairs.push_back({a, b, distance});
        });
    }
    sort_pairs(pairs);
    return pairs;
}

std::vector<AtomPair> find_salt_bridges(const AtomTable& atoms, std::span<const AtomRange> residues,
                                        double distance) {
    const std::vector<std::uint32_t> residue_of = number_residues(atoms, residues);
    const std::vector<std::uint32_t> positive = list_charged(atoms, residues, find_positive);
    const std::vector<std::uint32_t> negative = list_charged(atoms, residues, find_negative);
    const PointGrid grid(places_of(atoms, negative));
    std::map<std::pair<std::uint32_t, std::uint32_t>, AtomPair> nearest;  // by residues
    for (const std::uint32_t a : positive) {
        grid.visit_near(atoms.positions[a], distance, [&](std::uint32_t point) {
            const std::uint32_t b = negative[point];
            const AtomPair pair{a, b, (atoms.positions[a] - atoms.positions[b]).norm()};
            const auto [known, is_new] = nearest.try_emplace({residue_of[a], residue_of[b]}, pair);
            if (!is_new && pair.distance < known->second.distance) known->second = pair;
        });
    }
    std::vector<AtomPair> bridges;
    for (const auto& [key, pair] : nearest) bridges.push_back(pair);
    sort_pairs(bridges);
    return bridges;
}

}  // namespace palpa
