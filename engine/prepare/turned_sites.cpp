#include "prepare/turned_sites.h"

#include <Eigen/Geometry>
#include <numbers>
#include <string_view>
#include <vector>

namespace palpa {
namespace {

constexpr double lone_pairs = 65 * std::numbers::pi / 180;  // rad, about the axis of C=O
constexpr double hydrogen = 30 * std::numbers::pi / 180;    // about N-H

Vec3 half_turn(const Vec3& place, const Vec3& on_axis, const Vec3& axis) {
    const Vec3 from = place - on_axis;
    return on_axis + 2 * axis * axis.dot(from) - from;
}

class TurnedSites {
public:
    TurnedSites(const Structure& structure, const ResidueRange& residue, bool is_flipped)
        : structure_(structure), residue_(residue), is_flipped_(is_flipped) {}

    Vec3 place_of(std::string_view atom) const {
        const std::size_t index = find_atom(structure_, residue_, atom).value_or(residue_.first);
        const Vec3& place = structure_.positions[index];
        if (!is_flipped_) return place;
        const TurnedAtoms turned = turned_atoms_of(structure_.names[residue_.first].residue);
        const auto on = [&](std::string_view name) -> const Vec3& {
            return structure_
                .positions[find_atom(structure_, residue_, name).value_or(residue_.first)];
        };
        const Vec3 axis = on(turned.axis[1]) - on(turned.axis[0]);
        return axis.norm() > 0 ? half_turn(place, on(turned.axis[1]), axis.normalized()) : place;
    }

    std::vector<HydrogenSite> amide_sites() const {
        const TurnedAtoms turned = turned_atoms_of(structure_.names[residue_.first].residue);
        const auto place = [&](std::string_view atom) { return place_of(atom); };
        const Vec3 c = place(turned.axis[1]), o = place(turned.atoms[0]),
                   n = place(turned.atoms[1]);
        const auto atom = [&](std::string_view name) {
            return find_atom(structure_, residue_, name).value_or(residue_.first);
        };
        HydrogenSite taker{o, HydrogenRole::Taker, false, {}, lone_pairs, atom(turned.atoms[0])};
        HydrogenSite giver{n, HydrogenRole::Giver, false, {}, hydrogen, atom(turned.atoms[1])};
        const Vec3 to_o = o - c, to_n = n - c;
        const Vec3 normal = to_o.cross(to_n);
        if (to_o.norm() > 0) taker.outward = {to_o.normalized()};
        if (normal.norm() > 0) {
            // Both hydrogens are in the plane, 60 degrees to either side of the bond.
            for (const double angle : {std::numbers::pi / 3, -std::numbers::pi / 3}) {
                giver.outward.push_back(Eigen::AngleAxisd(angle, normal.normalized()) *
                                        to_n.normalized());
            }
        }
        return {taker, giver};
    }

    std::vector<HydrogenSite> ring_sites(std::string_view state) const {
        constexpr std::array<std::array<std::string_view, 3>, 4> corners{{{"ND1", "CG", "CE1"},
                                                                          {"CE1", "ND1", "NE2"},
                                                                          {"NE2", "CE1", "CD2"},
                                                                          {"CD2", "NE2", "CG"}}};
        std::vector<HydrogenSite> sites;
        for (const auto& [name, one, other] : corners) {
            HydrogenSite site;
            site.place = place_of(name);
            site.atom = find_atom(structure_, residue_, name).value_or(residue_.first);
            site.half_angle = hydrogen;
            const Vec3 outward = 2 * site.place - place_of(one) - place_of(other);
            if (outward.norm() > 0) site.outward = {outward.normalized()};
            const bool has_hydrogen =
                state == "HSP" || (name == "ND1" ? state == "HSD" : state == "HSE");
            site.role = name[0] == 'C' ? HydrogenRole::Carbon
                        : has_hydrogen ? HydrogenRole::Giver
                                       : HydrogenRole::Taker;
            sites.push_back(std::move(site));
        }
        return sites;
    }

    const Structure& structure_;
    const ResidueRange& residue_;
    bool is_flipped_;
};

}  // namespace

TurnedAtoms turned_atoms_of(std::string_view residue) {
    if (residue == "ASN") return {{"CB", "CG"}, {"OD1", "ND2"}};
    if (residue == "GLN") return {{"CG", "CD"}, {"OE1", "NE2"}};
    return {{"CB", "CG"}, {"ND1", "CD2", "CE1", "NE2"}};
}

std::vector<HydrogenSite> find_turned_sites(const Structure& structure, const ResidueRange& residue,
                                            bool is_flipped, std::string_view histidine) {
    const TurnedSites sites(structure, residue, is_flipped);
    return histidine.empty() ? sites.amide_sites() : sites.ring_sites(histidine);
}

void flip(Structure& structure, const ResidueRange& residue) {
    const TurnedAtoms turned = turned_atoms_of(structure.names[residue.first].residue);
    const auto one = find_atom(structure, residue, turned.axis[0]);
    const auto other = find_atom(structure, residue, turned.axis[1]);
    if (!one || !other) return;
    const Vec3 axis = structure.positions[*other] - structure.positions[*one];
    if (!(axis.norm() > 0)) return;
    std::vector<std::size_t> moved;
    for (const std::string_view name : turned.atoms) {
        const auto atom = find_atom(structure, residue, name);
        if (!atom) continue;
        const std::vector<std::size_t> hydrogens = hydrogens_on(structure, residue, *atom);
        moved.push_back(*atom);
        moved.insert(moved.end(), hydrogens.begin(), hydrogens.end());
    }
    for (const std::size_t atom : moved) {
        structure.positions[atom] =
            half_turn(structure.positions[atom], structure.positions[*other], axis.normalized());
    }
}

}  // namespace palpa
