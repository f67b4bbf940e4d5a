#include "prepare/hydrogen_bonds.h"

#include "molecule/element.h"
#include "molecule/point_grid.h"
#include "molecule/residue_kinds.h"
#include "prepare/match_by_bonds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

using std::numbers::pi;

constexpr double fade = 50 * pi / 180;             // rad, beyond half_angle
constexpr double ring_half_angle = 30 * pi / 180;  // of an atom between two others
constexpr double end_half_angle = 65 * pi / 180;   // of one at an end: lone pairs, hydrogens about

bool is_among(std::string_view name, std::span<const std::string_view> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

struct Named {
    HydrogenRole role;
    bool is_charged = false;
};

constexpr auto amino_acids_of_roles = std::to_array<std::string_view>(
    {"ALA", "ARG", "ASN", "ASP", "CYS", "GLN", "GLU", "GLY", "HIS", "HSD", "HSE", "HSP",
     "ILE", "LEU", "LYS", "MET", "PHE", "PRO", "SER", "THR", "TRP", "TYR", "VAL"});

// Amides' ends and rings of histidine have no role here.
Named role_in_amino_acid(std::string_view residue, std::string_view atom) {
    constexpr auto carboxylates =
        std::to_array<std::string_view>({"OD1", "OD2", "OE1", "OE2", "OXT", "OT1", "OT2"});
    constexpr auto ammoniums = std::to_array<std::string_view>({"NZ", "NE", "NH1", "NH2"});
    constexpr auto hydroxyls = std::to_array<std::string_view>({"OG", "OG1", "OH"});
    if (atom == "N") return {residue == "PRO" ? HydrogenRole::None : HydrogenRole::Giver};
    if (atom == "O") return {HydrogenRole::Taker};
    if (residue == "ASN" || residue == "GLN") {
        return is_among(atom, std::array<std::string_view, 3>{"OXT", "OT1", "OT2"})
                   ? Named{HydrogenRole::Taker, true}
                   : Named{HydrogenRole::None};
    }
    if (is_among(atom, carboxylates)) return {HydrogenRole::Taker, true};
    if (is_among(atom, ammoniums)) return {HydrogenRole::Giver, true};
    if (is_among(atom, hydroxyls)) return {HydrogenRole::Both};
    if (atom == "NE1") return {HydrogenRole::Giver};
    return {HydrogenRole::None};
}

bool is_of_metal(std::string_view element) {
    constexpr auto metals = std::to_array<std::string_view>(
        {"ZN", "FE", "CU", "NI", "CO", "MN", "MG", "CA", "CD", "HG"});
    return is_among(element, metals);
}

class SiteFinder {
public:
    SiteFinder(const Structure& structure, const std::vector<ResidueRange>& residues)
        : structure_(structure), residues_(residues), grid_(structure.positions) {}

    std::vector<HydrogenSite> find() {
        for (const ResidueRange& residue : residues_) {
            const std::string& name = structure_.names[residue.first].residue;
            const bool is_amino_acid = is_among(name, amino_acids_of_roles);
            for (std::size_t i = residue.first; i < residue.end(); ++i) {
                const std::string element = element_of(structure_, i);
                if (element == "H" || element == "C") continue;
                if (is_amino_acid) {
                    add(i, role_in_amino_acid(name, structure_.names[i].atom));
                } else {
                    add(i, role_elsewhere(residue, i, element));
                }
            }
        }
        return std::move(sites_);
    }

private:
    // Heavy atoms bonded to this one, of any residue.
    std::vector<std::size_t> neighbours(std::size_t atom) const {
        constexpr double longest = 2.1;  // Å
        std::vector<std::size_t> found;
        const std::string own = element_of(structure_, atom);
        grid_.visit_near(structure_.positions[atom], longest, [&](std::uint32_t other) {
            const std::string element = element_of(structure_, other);
            if (other == atom || element == "H" || is_of_metal(element)) return;
            const double reach = covalent_radius(own) + covalent_radius(element) + 0.3;
            const double d = (structure_.positions[other] - structure_.positions[atom]).norm();
            if (d < reach) found.push_back(other);
        });
        std::sort(found.begin(), found.end());
        return found;
    }

    Named role_elsewhere(const ResidueRange& residue, std::size_t atom,
                         std::string_view element) const {
        if (is_of_metal(element) && residue.count == 1) return {HydrogenRole::Metal};
        if (is_water(structure_.names[atom].residue)) return {HydrogenRole::Both};
        if (element == "N") return {HydrogenRole::Both};
        if (element != "O") return {HydrogenRole::None};
        const std::vector<std::size_t> bonded = neighbours(atom);
        if (bonded.size() != 1) return {bonded.empty() ? HydrogenRole::Both : HydrogenRole::Taker};
        constexpr double longest_double_bond = 1.32;  // Å
        const std::string other = element_of(structure_, bonded[0]);
        const double length = (structure_.positions[bonded[0]] - structure_.positions[atom]).norm();
        const bool is_acid = other == "P" || other == "S";
        if (is_acid) return {HydrogenRole::Taker, true};
        return {length < longest_double_bond ? HydrogenRole::Taker : HydrogenRole::Both};
    }

    void add(std::size_t atom, const Named& named) {
        if (named.role == HydrogenRole::None) return;
        HydrogenSite site;
        site.place = structure_.positions[atom];
        site.role = named.role;
        site.is_charged = named.is_charged;
        site.atom = atom;
        Vec3 sum = Vec3::Zero();
        const std::vector<std::size_t> bonded = neighbours(atom);
        for (const std::size_t other : bonded) {
            const Vec3 away = site.place - structure_.positions[other];
            if (away.norm() > 0) sum += away.normalized();
        }
        if (sum.norm() > 0.1 && named.role != HydrogenRole::Metal) {
            site.outward = {sum.normalized()};
            site.half_angle = bonded.size() == 1 ? end_half_angle : ring_half_angle;
        }
        sites_.push_back(std::move(site));
    }

    const Structure& structure_;
    const std::vector<ResidueRange>& residues_;
    PointGrid grid_;
    std::vector<HydrogenSite> sites_;
};

// How well a site looks at a place, 0 to 1.
double facing(const HydrogenSite& site, const Vec3& direction) noexcept {
    if (site.outward.empty()) return 1;
    double best = 0;
    for (const Vec3& outward : site.outward) {
        const double angle = std::acos(std::clamp(outward.dot(direction), -1.0, 1.0));
        best = std::max(best, std::clamp(1 - (angle - site.half_angle) / fade, 0.0, 1.0));
    }
    return best;
}

double role_score(HydrogenRole a, HydrogenRole b) noexcept {
    using enum HydrogenRole;
    if (a > b) std::swap(a, b);
    if (a == None) return 0;
    if (b == Metal) {
        if (a == Taker) return 1.5;
        if (a == Both) return 0.5;
        return a == Metal ? 0 : a == Carbon ? -1 : -2;
    }
    if (b == Carbon) {
        if (a == Giver) return -0.25;
        return a == Taker ? 0.25 : 0;
    }
    if (a == Both || b == Both) return a == b ? 0.6 : 0.8;
    return a == b ? -1 : 1;
}

}  // namespace

std::vector<HydrogenSite> find_hydrogen_sites(const Structure& structure,
                                              const std::vector<ResidueRange>& residues) {
    return SiteFinder(structure, residues).find();
}

double score_contact(const HydrogenSite& a, const HydrogenSite& b) noexcept {
    const double roles = role_score(a.role, b.role);
    if (roles == 0) return 0;
    const Vec3 between = b.place - a.place;
    const double distance = between.norm();
    const bool has_metal = a.role == HydrogenRole::Metal || b.role == HydrogenRole::Metal;
    const double full = has_metal ? 2.6 : 3.1, none = has_metal ? 3.2 : hydrogen_bond_reach;  // Å
    if (!(distance < none) || !(distance > 0)) return 0;
    const double near = std::min(1.0, (none - distance) / (none - full));
    const double faces = facing(a, between / distance) * facing(b, -between / distance);
    const double charged = roles > 0 && (a.is_charged || b.is_charged) ? 1.25 : 1;
    return roles * near * faces * charged;
}

}  // namespace palpa
