#include "simulation/mobile_joints.h"

#include "core/load_error.h"
#include "core/text.h"
#include "simulation/resources.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <string>

namespace palpa {
namespace {

struct NamedAtom {
    std::string_view segment, number, atom;
};

std::uint32_t find_atom(const Connectivity& connectivity, const NamedAtom& wanted,
                        const TextPlace& place, std::string_view bond) {
    for (std::uint32_t i = 0; i < connectivity.names.size(); ++i) {
        const AtomName& name = connectivity.names[i];
        if (name.segment == wanted.segment && name.number == wanted.number &&
            name.atom == wanted.atom)
            return i;
    }
    throw LoadError(
        place,
        fmt::format("\"{}\" names atom '{}' of residue {} of segment '{}', which does not exist",
                    bond, wanted.atom, wanted.number, wanted.segment));
}

JointOverride read_override(const Connectivity& connectivity, const std::string& bond,
                            BondMotion motion, const TextPlace& place) {
    const std::vector<std::string_view> words = split_words(bond);
    if (words.size() != 4 && words.size() != 5) {
        throw LoadError(place, fmt::format("\"{}\" is not a bond; expected \"A 25 CB CG\" or, "
                                           "between residues, \"A 25 C 26 N\"",
                                           bond));
    }
    const NamedAtom first{words[0], words[1], words[2]};
    const NamedAtom second{words[0], words.size() == 5 ? words[3] : words[1], words.back()};
    return {
        {find_atom(connectivity, first, place, bond), find_atom(connectivity, second, place, bond)},
        motion};
}

JointRules read_rules(const JointsDescription& j, const ScenePlaces& places,
                      const Connectivity& connectivity) {
    JointRules rules{j.hydroxyl, j.thiol,     j.ammonium,        j.methyl,
                     j.amide,    j.amide_nh2, j.guanidinium_nh2, {}};
    const auto add = [&](const std::vector<std::string>& bonds, BondMotion motion,
                         std::string_view key) {
        for (const std::string& bond : bonds) {
            rules.overrides.push_back(
                read_override(connectivity, bond, motion, places.place_of(key)));
        }
    };
    add(j.turn, BondMotion::Turn, "joints.turn");
    add(j.rigid, BondMotion::Rigid, "joints.rigid");
    add(j.springs, BondMotion::Spring, "joints.springs");
    return rules;
}

// One entry per atom: whether bonds may turn there.
class MobileAtoms {
public:
    explicit MobileAtoms(std::size_t atoms) : is_mobile_(atoms, 0) {}

    void allow(AtomRange range) {
        std::fill_n(is_mobile_.begin() + range.first, range.count, std::uint8_t{1});
    }

    // Keeps only residues of a molecule with an atom as near as that to one of `around`. Another
    // molecule's residues beside these may have the same names.
    void keep_within(double distance, AtomRange around, AtomRange molecule,
                     const Connectivity& connectivity, std::span<const Vec3> positions) {
        const std::size_t end = molecule.first + molecule.count;
        const auto is_near = [&](std::size_t i) {
            return std::ranges::any_of(
                positions.subspan(around.first, around.count), [&](const Vec3& other) {
                    return (positions[i] - other).squaredNorm() <= distance * distance;
                });
        };
        for (std::size_t first = molecule.first, next = first; first < end; first = next) {
            bool is_kept = false;
            for (;
                 next < end && is_same_residue(connectivity.names[first], connectivity.names[next]);
                 ++next) {
                is_kept = is_kept || (is_mobile_[next] != 0 && is_near(next));
            }
            if (is_kept) continue;
            for (std::size_t i = first; i < next; ++i) is_mobile_[i] = 0;
        }
    }

    void keep(std::span<const std::uint8_t> is_kept) {
        for (std::size_t i = 0; i < is_kept.size(); ++i) is_mobile_[i] &= is_kept[i];
    }

    bool has(const std::array<std::uint32_t, 2>& bond) const {
        return is_mobile_[bond[0]] != 0 && is_mobile_[bond[1]] != 0;
    }

private:
    std::vector<std::uint8_t> is_mobile_;
};

}  // namespace

std::vector<ScenePart> list_parts(const World& world) {
    std::vector<ScenePart> parts;
    world.each<Molecule, Mobility>([&](Entity, const Molecule& molecule, const Mobility& mobility) {
        parts.push_back({molecule.name, mobility, molecule.atoms, molecule.reference_atom});
    });
    return parts;
}

SceneJoints find_joints(const World& world, const Connectivity& connectivity,
                        std::span<const Vec3> positions, std::span<const ScenePart> parts,
                        const std::optional<Region>& region) {
    const JointsDescription& described = world.resource<MechanicsSettings>().joints;
    const ScenePlaces& places = world.resource<ScenePlaces>();
    MobileAtoms mobile(connectivity.names.size());
    for (const ScenePart& part : parts) {
        if (part.mobility.shape == Shape::Flexible) mobile.allow(part.atoms);
    }
    const JointRules rules = read_rules(described, places, connectivity);
    SceneJoints result{build_joints(connectivity, rules), 0};
    // A bond that the scene names turns whatever else it says, but for rigid molecules.
    const auto is_named = [&](const Joint& joint) {
        return std::ranges::any_of(rules.overrides, [&](const JointOverride& o) {
            return o.motion == BondMotion::Turn &&
                   std::minmax(o.bond[0], o.bond[1]) == std::minmax(joint.bond[0], joint.bond[1]);
        });
    };
    if (!described.backbone) {
        std::erase_if(result.joints.joints, [&](const Joint& joint) {
            return is_backbone(connectivity, joint.bond) && !is_named(joint);
        });
    }
    for (const JointOverride& o : rules.overrides) {
        if (o.motion != BondMotion::Turn || mobile.has(o.bond)) continue;
        throw LoadError(
            places.place_of("joints.turn"),
            fmt::format(
                "bond {} - {} belongs to a rigid molecule; expected shape = \"flexible\" for it",
                to_string(connectivity.names[o.bond[0]]),
                to_string(connectivity.names[o.bond[1]])));
    }
    const auto keep_mobile = [&] {
        std::erase_if(result.joints.joints, [&](const Joint& joint) {
            return !mobile.has(joint.bond) && (region || !is_named(joint));
        });
        std::erase_if(result.joints.springs,
                      [&](const std::array<std::uint32_t, 2>& bond) { return !mobile.has(bond); });
    };
    keep_mobile();
    const std::size_t all = result.joints.joints.size();
    if (region) {
        mobile.keep(region->is_inside);
        keep_mobile();
        result.held = all - result.joints.joints.size();
        return result;
    }
    if (!described.within_angstrom) return result;
    const auto around = std::ranges::find(parts, described.around, &ScenePart::name);
    if (around == parts.end()) return result;
    for (const ScenePart& part : parts) {
        mobile.keep_within(*described.within_angstrom, around->atoms, part.atoms, connectivity,
                           positions);
    }
    keep_mobile();
    result.held = all - result.joints.joints.size();
    return result;
}

}  // namespace palpa
