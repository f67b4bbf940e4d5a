#include "view/hydrogen_bonds.h"

#include "molecule/element.h"
#include "simulation/resources.h"
#include "view/elements.h"
#include "view/in_hand.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>
#include <tuple>

namespace palpa {
namespace {

constexpr double longest = 2.5;          // Å
constexpr double cosine_of_bend = -0.5;  // of 120°, the least angle at the hydrogen
constexpr std::uint32_t no_donor = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t bonds_without_pair = 4;  // of a nitrogen: nothing left to accept with

// What an atom has to do with hydrogen bonds.
struct Role {
    std::uint32_t donor = no_donor;  // of a hydrogen that can be given
    bool accepts = false;
};

// Of those that are asked for.
std::vector<Role> find_roles(const AtomTable& atoms, const std::vector<bool>& is_asked) {
    std::vector<Role> roles(atoms.size());
    std::vector<std::size_t> bonds(atoms.size(), 0);
    for (const auto& [a, b] : atoms.bonds) {
        if (!is_asked[a] && !is_asked[b]) continue;
        ++bonds[a];
        ++bonds[b];
        if (element_of(atoms, a) == "H" && is_polar(element_of(atoms, b))) roles[a].donor = b;
        if (element_of(atoms, b) == "H" && is_polar(element_of(atoms, a))) roles[b].donor = a;
    }
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        if (!is_asked[i]) continue;
        const std::string_view element = element_of(atoms, i);
        roles[i].accepts = is_polar(element) && !(element == "N" && bonds[i] >= bonds_without_pair);
    }
    return roles;
}

// Their length (Å) where three atoms bond.
std::optional<double> find_length(const AtomTable& atoms, std::uint32_t donor,
                                  std::uint32_t hydrogen, std::uint32_t acceptor) {
    const Vec3 to_acceptor = atoms.positions[acceptor] - atoms.positions[hydrogen];
    const Vec3 to_donor = atoms.positions[donor] - atoms.positions[hydrogen];
    const double length = to_acceptor.norm();
    if (!(length < longest)) return {};
    if (to_acceptor.dot(to_donor) > cosine_of_bend * length * to_donor.norm()) return {};
    return length;
}

// What may take part in hydrogen bonds of what is held: that, and all that is near enough.
std::vector<bool> find_near(const AtomTable& atoms, const std::vector<bool>& held) {
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < atoms.size(); ++i)
        if (held[i]) box.extend(atoms.positions[i]);
    std::vector<bool> near(atoms.size());
    for (std::size_t i = 0; i < atoms.size(); ++i)
        near[i] = box.squaredExteriorDistance(atoms.positions[i]) <= longest * longest;
    return near;
}

}  // namespace

std::vector<HydrogenBond> find_hydrogen_bonds(const World& world, ShownBonds which) {
    if (which == ShownBonds::None) return {};
    const bool all = which == ShownBonds::All;
    const AtomTable& atoms = world.resource<AtomTable>();
    const std::vector<bool> held = find_in_hand(world);
    const std::vector<Role> roles =
        find_roles(atoms, all ? std::vector<bool>(atoms.size(), true) : find_near(atoms, held));
    const auto takes_part = [&](std::size_t i) {
        return roles[i].accepts || roles[i].donor != no_donor;
    };
    // From each of one side, those of the other are sought; where all count, from each hydrogen.
    const auto is_sought_from = [&](std::size_t i) {
        return all ? roles[i].donor != no_donor : held[i] && takes_part(i);
    };
    Eigen::AlignedBox3d box;  // of what is sought from
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        if (is_sought_from(i)) box.extend(atoms.positions[i]);
    }
    // Those around, along x: only a slice of them can be near enough.
    std::vector<std::uint32_t> around;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const bool is_other = all ? roles[i].accepts : !held[i] && takes_part(i);
        if (is_other && box.squaredExteriorDistance(atoms.positions[i]) < longest * longest)
            around.push_back(static_cast<std::uint32_t>(i));
    }
    const auto x_of = [&](std::uint32_t i) { return atoms.positions[i].x(); };
    std::ranges::sort(around, {}, x_of);

    std::vector<HydrogenBond> found;
    const auto try_bond = [&](std::uint32_t hydrogen, std::uint32_t acceptor) {
        if (roles[hydrogen].donor == no_donor || !roles[acceptor].accepts) return;
        const std::uint32_t donor = roles[hydrogen].donor;
        const std::optional<double> length = find_length(atoms, donor, hydrogen, acceptor);
        if (length) found.push_back({hydrogen, acceptor, *length, donor});
    };
    for (std::uint32_t i = 0; i < atoms.size(); ++i) {
        if (!is_sought_from(i)) continue;
        auto other = std::ranges::lower_bound(around, x_of(i) - longest, {}, x_of);
        for (; other != around.end() && x_of(*other) < x_of(i) + longest; ++other) {
            try_bond(i, *other);
            if (!all) try_bond(*other, i);
        }
    }
    std::ranges::sort(found, {}, [](const HydrogenBond& bond) {
        return std::tuple(bond.length, bond.hydrogen, bond.acceptor);
    });
    return found;
}

BondSites find_bond_sites(const AtomTable& atoms, const std::vector<bool>& chosen) {
    BondSites sites;
    const std::vector<Role> roles = find_roles(atoms, std::vector<bool>(atoms.size(), true));
    for (std::uint32_t i = 0; i < roles.size(); ++i) {
        const std::uint32_t donor = roles[i].donor;
        if (donor != no_donor && chosen[donor]) sites.hydrogens.emplace_back(i, donor);
        if (roles[i].accepts && chosen[i]) sites.acceptors.push_back(i);
    }
    return sites;
}

std::size_t count_hydrogen_bonds(const AtomTable& atoms, const BondSites& one,
                                 const BondSites& other) {
    std::size_t count = 0;
    for (const auto& [hydrogen, donor] : one.hydrogens) {
        for (const std::uint32_t acceptor : other.acceptors)
            if (find_length(atoms, donor, hydrogen, acceptor)) ++count;
    }
    for (const std::pair<std::uint32_t, std::uint32_t>& given : other.hydrogens) {
        const bool both_give = std::ranges::binary_search(one.hydrogens, given);
        for (const std::uint32_t acceptor : one.acceptors) {
            if (both_give && std::ranges::binary_search(other.acceptors, acceptor)) continue;
            if (find_length(atoms, given.second, given.first, acceptor)) ++count;
        }
    }
    return count;
}

}  // namespace palpa
