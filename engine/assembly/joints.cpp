#include "assembly/joints.h"

#include "assembly/bridges.h"
#include "core/load_error.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace palpa {
namespace {

// A ring of more atoms than this is opened at its disulphide; lipoic acid's of five stays rigid.
constexpr std::size_t largest_rigid_ring = 8;

enum Element : std::uint8_t { Hydrogen, Carbon, Nitrogen, Oxygen, Sulphur, Other };

Element element_of_mass(double mass) {
    if (mass < 3.5) return Hydrogen;
    if (std::abs(mass - 12) < 0.5) return Carbon;
    if (std::abs(mass - 14) < 0.5) return Nitrogen;
    if (std::abs(mass - 16) < 0.5) return Oxygen;
    return std::abs(mass - 32) < 0.5 ? Sulphur : Other;
}

// What the rules ask about atoms; all of it from elements and neighbours.
class Chemistry {
public:
    Chemistry(const Connectivity& connectivity)
        : neighbours_(connectivity.mass.size(), connectivity.bonds) {
        for (const double mass : connectivity.mass) element_.push_back(element_of_mass(mass));
    }

    bool is(std::uint32_t atom, Element element) const { return element_[atom] == element; }
    std::size_t degree(std::uint32_t atom) const { return neighbours_.of(atom).size(); }
    const Neighbours& neighbours() const { return neighbours_; }

    bool is_planar_carbon(std::uint32_t atom) const {
        return is(atom, Carbon) && degree(atom) == 3;
    }

    // All of its neighbours but `other` are hydrogens, and there is one.
    bool ends_in_hydrogens(std::uint32_t atom, std::uint32_t other) const {
        return degree(atom) > 1 && std::ranges::all_of(neighbours_.of(atom), [&](Neighbour to) {
                   return to.atom == other || is(to.atom, Hydrogen);
               });
    }

    // C=O or C=S, acids and their anions too.
    bool is_carbonyl(std::uint32_t atom) const {
        return is_planar_carbon(atom) &&
               std::ranges::any_of(neighbours_.of(atom), [&](Neighbour to) {
                   return degree(to.atom) == 1 && (is(to.atom, Oxygen) || is(to.atom, Sulphur));
               });
    }

    // The carbon of a guanidinium or amidinium, whose double bond is shared by its nitrogens.
    bool is_amidinium(std::uint32_t atom) const {
        if (!is_planar_carbon(atom)) return false;
        std::size_t nitrogens = 0;
        for (const Neighbour to : neighbours_.of(atom)) {
            if (!is(to.atom, Nitrogen)) continue;
            if (degree(to.atom) != 3) return false;
            ++nitrogens;
        }
        return nitrogens >= 2;
    }

    // In line with both its neighbours.
    bool is_linear(std::uint32_t atom) const { return is(atom, Carbon) && degree(atom) == 2; }

    // Whether the bridge between two atoms is a double bond. Every atom that wants a partner for
    // one has it among its neighbours, so those on one side of the bridge are even in number,
    // unless one of them has its partner across.
    bool is_double(std::uint32_t a, std::uint32_t b) const {
        if (!wants_partner(a) || !wants_partner(b)) return false;
        std::vector<std::uint32_t> side{b};
        std::vector<std::uint8_t> is_known(element_.size(), 0);
        is_known[a] = is_known[b] = 1;
        for (std::size_t i = 0; i < side.size(); ++i) {
            for (const Neighbour to : neighbours_.of(side[i])) {
                if (is_known[to.atom] != 0 || !wants_partner(to.atom)) continue;
                is_known[to.atom] = 1;
                side.push_back(to.atom);
            }
        }
        return side.size() % 2 == 1;
    }

private:
    bool wants_partner(std::uint32_t atom) const {
        if (is(atom, Nitrogen)) return degree(atom) == 2;
        return is_planar_carbon(atom) && !is_carbonyl(atom) && !is_amidinium(atom);
    }

    std::vector<Element> element_;
    Neighbours neighbours_;
};

// What `end` makes of the bond to `other`, if it carries nothing but hydrogens.
std::optional<JointKind> find_rotor_kind(const Chemistry& chemistry, std::uint32_t end,
                                         std::uint32_t other) {
    if (!chemistry.ends_in_hydrogens(end, other)) return std::nullopt;
    const std::size_t degree = chemistry.degree(end);
    if (chemistry.is(end, Oxygen)) return JointKind::Hydroxyl;
    if (chemistry.is(end, Sulphur)) return JointKind::Thiol;
    if (chemistry.is(end, Carbon) && degree == 4) return JointKind::Methyl;
    if (!chemistry.is(end, Nitrogen) || degree < 3) return std::nullopt;
    if (degree == 4 || !chemistry.is_planar_carbon(other)) return JointKind::Ammonium;
    return chemistry.is_amidinium(other) ? JointKind::GuanidiniumNH2 : JointKind::AmideNH2;
}

bool is_amide(const Chemistry& chemistry, std::uint32_t carbon, std::uint32_t nitrogen) {
    return chemistry.is_carbonyl(carbon) && chemistry.is(nitrogen, Nitrogen) &&
           chemistry.degree(nitrogen) <= 3;
}

JointKind kind_of(const Chemistry& chemistry, std::uint32_t a, std::uint32_t b) {
    if (chemistry.is_linear(a) || chemistry.is_linear(b)) return JointKind::DoubleOrLinear;
    const std::optional<JointKind> of_a = find_rotor_kind(chemistry, a, b);
    const std::optional<JointKind> of_b = find_rotor_kind(chemistry, b, a);
    // Methanol has a hydroxyl, rather than a methyl.
    if (of_a && of_a != JointKind::Methyl) return *of_a;
    if (of_b) return *of_b;
    if (of_a) return *of_a;
    if (is_amide(chemistry, a, b) || is_amide(chemistry, b, a)) return JointKind::Amide;
    return chemistry.is_double(a, b) ? JointKind::DoubleOrLinear : JointKind::Torsion;
}

bool turns(JointKind kind, const JointRules& rules) {
    switch (kind) {
        case JointKind::Torsion:
            return true;
        case JointKind::Hydroxyl:
            return rules.hydroxyl;
        case JointKind::Thiol:
            return rules.thiol;
        case JointKind::Ammonium:
            return rules.ammonium;
        case JointKind::Methyl:
            return rules.methyl;
        case JointKind::Amide:
            return rules.amide;
        case JointKind::AmideNH2:
            return rules.amide_nh2;
        case JointKind::GuanidiniumNH2:
            return rules.guanidinium_nh2;
        case JointKind::DoubleOrLinear:
            break;
    }
    return false;
}

// Atoms of the smallest ring through a bond that is no bridge.
std::size_t smallest_ring(const Neighbours& neighbours, std::array<std::uint32_t, 2> bond,
                          std::uint32_t number) {
    std::vector<std::size_t> steps(neighbours.atoms(), 0);
    std::vector<std::uint32_t> reached{bond[0]};
    steps[bond[0]] = 1;
    for (std::size_t i = 0; i < reached.size() && steps[bond[1]] == 0; ++i) {
        for (const Neighbour to : neighbours.of(reached[i])) {
            if (to.bond == number || steps[to.atom] != 0) continue;
            steps[to.atom] = steps[reached[i]] + 1;
            reached.push_back(to.atom);
        }
    }
    return steps[bond[1]];
}

// What is decided about each bond.
struct Bonds {
    std::vector<std::optional<BondMotion>> asked;  // by an override
    std::vector<std::uint8_t> is_cut;
    std::vector<std::uint8_t> is_bridge;  // of the rest
};

std::string bond_name(const Connectivity& connectivity, std::array<std::uint32_t, 2> bond) {
    return fmt::format("{} - {}", to_string(connectivity.names[bond[0]]),
                       to_string(connectivity.names[bond[1]]));
}

std::vector<std::optional<BondMotion>> find_overrides(const Connectivity& connectivity,
                                                      const JointRules& rules,
                                                      std::vector<std::string>& problems) {
    std::vector<std::optional<BondMotion>> asked(connectivity.bonds.size());
    for (const JointOverride& joint_override : rules.overrides) {
        bool is_found = false;
        for (std::size_t i = 0; i < asked.size(); ++i) {
            if (!std::ranges::is_permutation(connectivity.bonds[i], joint_override.bond)) continue;
            asked[i] = joint_override.motion;
            is_found = true;
        }
        if (is_found) continue;
        problems.push_back(
            fmt::format("{} are not bonded, so they cannot be a joint; expected two bonded atoms",
                        bond_name(connectivity, joint_override.bond)));
    }
    return asked;
}

// One after the other: a cut may leave the next bond as the only one that holds the molecule.
void cut_loops(const Connectivity& connectivity, const Chemistry& chemistry, Bonds& bonds,
               std::vector<std::string>& problems) {
    const std::size_t count = connectivity.bonds.size();
    bonds.is_cut.assign(count, 0);
    bonds.is_bridge = find_bridges(chemistry.neighbours(), count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto [a, b] = connectivity.bonds[i];
        const bool is_asked = bonds.asked[i] == BondMotion::Spring;
        const bool is_disulphide =
            chemistry.is(a, Sulphur) && chemistry.is(b, Sulphur) && !bonds.asked[i].has_value();
        if (!is_asked && !is_disulphide) continue;
        if (bonds.is_bridge[i] != 0) {
            if (is_asked) {
                problems.push_back(
                    fmt::format("{} cannot be a spring: this bond is not in a ring, or its ring is "
                                "already open; expected a bond of a closed ring",
                                bond_name(connectivity, connectivity.bonds[i])));
            }
            continue;
        }
        const Neighbours left(connectivity.mass.size(), connectivity.bonds, bonds.is_cut);
        if (is_disulphide && smallest_ring(left, connectivity.bonds[i], i) <= largest_rigid_ring)
            continue;
        bonds.is_cut[i] = 1;
        bonds.is_bridge = find_bridges(
            Neighbours(connectivity.mass.size(), connectivity.bonds, bonds.is_cut), count);
    }
}

}  // namespace

Joints build_joints(const Connectivity& connectivity, const JointRules& rules) {
    const Chemistry chemistry(connectivity);
    std::vector<std::string> problems;
    Bonds bonds;
    bonds.asked = find_overrides(connectivity, rules, problems);
    cut_loops(connectivity, chemistry, bonds, problems);

    // Springs hang nothing on a bond that would turn.
    const Neighbours left(connectivity.mass.size(), connectivity.bonds, bonds.is_cut);
    Joints result;
    for (std::uint32_t i = 0; i < connectivity.bonds.size(); ++i) {
        const auto [a, b] = connectivity.bonds[i];
        if (bonds.is_cut[i] != 0) {
            result.springs.push_back({std::min(a, b), std::max(a, b)});
            continue;
        }
        const bool can_turn =
            bonds.is_bridge[i] != 0 && left.of(a).size() > 1 && left.of(b).size() > 1;
        if (!can_turn) {
            if (bonds.asked[i] == BondMotion::Turn) {
                problems.push_back(
                    fmt::format("{} cannot turn: this bond is in a ring, or one of its atoms has "
                                "no other bonds",
                                bond_name(connectivity, connectivity.bonds[i])));
            }
            continue;
        }
        const JointKind kind = kind_of(chemistry, a, b);
        const bool is_on = bonds.asked[i] ? bonds.asked[i] == BondMotion::Turn : turns(kind, rules);
        if (is_on) result.joints.push_back({{std::min(a, b), std::max(a, b)}, kind});
    }
    if (!problems.empty()) {
        const std::string first = problems.front();
        problems.erase(problems.begin());
        throw LoadError({connectivity.file}, first, problems);
    }
    return result;
}

bool is_backbone(const Connectivity& connectivity,
                 const std::array<std::uint32_t, 2>& bond) noexcept {
    const std::string &a = connectivity.names[bond[0]].atom, &b = connectivity.names[bond[1]].atom;
    return (a == "CA" && (b == "N" || b == "C")) || (b == "CA" && (a == "N" || a == "C"));
}

}  // namespace palpa
