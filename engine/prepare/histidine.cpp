#include "prepare/histidine.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace palpa {
namespace {

enum class Neighbour { None, Acceptor, Giver };

// Oxygens that carry no hydrogen, nitrogens and metals that take none.
Neighbour classify(const Structure& structure, std::size_t atom) {
    const AtomName& name = structure.names[atom];
    constexpr auto acceptors =
        std::to_array<std::string_view>({"O", "OXT", "OT1", "OT2", "OD1", "OD2", "OE1", "OE2"});
    constexpr auto givers = std::to_array<std::string_view>(
        {"N", "NZ", "NE", "NH1", "NH2", "NE1", "ND2"});  // NE2 of Gln: below
    const auto is_one_of = [&](const auto& names) {
        return std::find(names.begin(), names.end(), name.atom) != names.end();
    };
    const std::string element = element_of(structure, atom);
    if (element == "O") return is_one_of(acceptors) ? Neighbour::Acceptor : Neighbour::None;
    if (element == "N") {
        const bool gives = (is_one_of(givers) && !(name.atom == "N" && name.residue == "PRO")) ||
                           (name.atom == "NE2" && name.residue == "GLN");
        return gives ? Neighbour::Giver : Neighbour::None;
    }
    constexpr auto metals = std::to_array<std::string_view>({"ZN", "FE", "CU", "NI", "CO", "MN"});
    const bool is_metal = std::find(metals.begin(), metals.end(), element) != metals.end();
    return is_metal ? Neighbour::Giver : Neighbour::None;
}

struct Site {
    int wish = 0;  // +1: a hydrogen, -1: none
    std::string because;
};

// What the surroundings of one nitrogen of the ring ask for.
Site look_around(const Structure& structure, const ResidueRange& residue, std::size_t nitrogen,
                 const Vec3& outward) {
    constexpr double reach = 3.4, metal_reach = 2.6;  // Å
    Site site;
    double nearest = reach;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        if (i >= residue.first && i < residue.end()) continue;
        const Vec3 away = structure.positions[i] - structure.positions[nitrogen];
        const double distance = away.norm();
        if (!(distance < nearest) || away.dot(outward) < 0.5 * distance) continue;
        const Neighbour kind = classify(structure, i);
        const std::string element = element_of(structure, i);
        const bool is_metal = kind == Neighbour::Giver && element != "N";
        if (kind == Neighbour::None || (is_metal && distance > metal_reach)) continue;
        nearest = distance;
        site.wish = kind == Neighbour::Acceptor ? 1 : -1;
        site.because =
            fmt::format("{} {} {:.1f} Å from {}", structure.names[i].residue,
                        structure.names[i].atom, distance, structure.names[nitrogen].atom);
    }
    return site;
}

// The unit vector from a ring atom away from its two neighbours.
Vec3 outward(const Structure& structure, std::size_t atom, std::size_t a, std::size_t b) {
    const Vec3& at = structure.positions[atom];
    const Vec3 direction = 2 * at - structure.positions[a] - structure.positions[b];
    const double length = direction.norm();
    return length > 0 ? Vec3(direction / length) : Vec3::Zero();
}

}  // namespace

HistidineChoice choose_histidine(const Structure& structure, const ResidueRange& residue) {
    std::array<std::optional<std::size_t>, 5> found;
    constexpr std::array<std::string_view, 5> ring{"CG", "ND1", "CE1", "NE2", "CD2"};
    for (std::size_t i = 0; i < ring.size(); ++i) {
        found[i] = find_atom(structure, residue, ring[i]);
        if (!found[i]) return {"HSE", "its ring is not complete in the file"};
    }
    std::array<std::size_t, 5> atom{};
    for (std::size_t i = 0; i < ring.size(); ++i) atom[i] = found[i].value_or(0);
    const bool has_delta = !hydrogens_on(structure, residue, atom[1]).empty();
    const bool has_epsilon = !hydrogens_on(structure, residue, atom[3]).empty();
    if (has_delta && has_epsilon) return {"HSP", "the file has hydrogens on ND1 and NE2"};
    if (has_delta) return {"HSD", "the file has a hydrogen on ND1"};
    if (has_epsilon) return {"HSE", "the file has a hydrogen on NE2"};

    const Site delta =
        look_around(structure, residue, atom[1], outward(structure, atom[1], atom[0], atom[2]));
    const Site epsilon =
        look_around(structure, residue, atom[3], outward(structure, atom[3], atom[2], atom[4]));
    const std::string because =
        fmt::format("{}{}{}", delta.because,
                    delta.because.empty() || epsilon.because.empty() ? "" : ", ", epsilon.because);
    const bool both = delta.wish > 0 && epsilon.wish > 0;
    if (delta.wish > epsilon.wish) return {"HSD", because};
    if (epsilon.wish > delta.wish) return {"HSE", because};
    return {"HSE", because.empty() ? "nothing near decides, the more frequent tautomer" : because,
            both};
}

}  // namespace palpa
