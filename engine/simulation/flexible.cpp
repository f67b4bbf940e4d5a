#include "simulation/flexible.h"

#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

// ---- which joints ----------------------------------------------------------------------------

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
    throw LoadError(place, fmt::format("\"{}\" names atom '{}' of residue {} of segment '{}', "
                                       "which is not there",
                                       bond, wanted.atom, wanted.number, wanted.segment));
}

JointOverride read_override(const Connectivity& connectivity, const std::string& bond,
                            BondMotion motion, const TextPlace& place) {
    const std::vector<std::string_view> words = split_words(bond);
    if (words.size() != 4 && words.size() != 5) {
        throw LoadError(place, fmt::format("\"{}\" is no bond; expected \"A 25 CB CG\" or, between "
                                           "residues, \"A 25 C 26 N\"",
                                           bond));
    }
    const NamedAtom first{words[0], words[1], words[2]};
    const NamedAtom second{words[0], words.size() == 5 ? words[3] : words[1], words.back()};
    return {
        {find_atom(connectivity, first, place, bond), find_atom(connectivity, second, place, bond)},
        motion};
}

JointRules read_rules(const SceneDescription& scene, const Connectivity& connectivity) {
    const JointsDescription& j = scene.joints;
    JointRules rules{j.hydroxyl, j.thiol,     j.ammonium,        j.methyl,
                     j.amide,    j.amide_nh2, j.guanidinium_nh2, {}};
    const auto add = [&](const std::vector<std::string>& bonds, BondMotion motion,
                         std::string_view key) {
        for (const std::string& bond : bonds) {
            rules.overrides.push_back(
                read_override(connectivity, bond, motion, scene.place_of(key)));
        }
    };
    add(j.turn, BondMotion::Turn, "joints.turn");
    add(j.rigid, BondMotion::Rigid, "joints.rigid");
    add(j.springs, BondMotion::Spring, "joints.springs");
    return rules;
}

// One entry per atom: whether bonds may turn there.
class Mobility {
public:
    explicit Mobility(std::size_t atoms) : is_mobile_(atoms, 0) {}

    void allow(AtomRange range) {
        std::fill_n(is_mobile_.begin() + range.first, range.count, std::uint8_t{1});
    }

    // Keeps only residues with an atom as near as that to one of `around`.
    void keep_within(double distance, AtomRange around, const Connectivity& connectivity,
                     std::span<const Vec3> positions) {
        const auto is_near = [&](std::size_t i) {
            return std::ranges::any_of(
                positions.subspan(around.first, around.count), [&](const Vec3& other) {
                    return (positions[i] - other).squaredNorm() <= distance * distance;
                });
        };
        for (std::size_t first = 0, next = 0; first < is_mobile_.size(); first = next) {
            bool is_kept = false;
            for (; next < is_mobile_.size() && is_same_residue(connectivity, first, next); ++next) {
                is_kept = is_kept || (is_mobile_[next] != 0 && is_near(next));
            }
            if (is_kept) continue;
            for (std::size_t i = first; i < next; ++i) is_mobile_[i] = 0;
        }
    }

    bool has(const std::array<std::uint32_t, 2>& bond) const {
        return is_mobile_[bond[0]] != 0 && is_mobile_[bond[1]] != 0;
    }

private:
    static bool is_same_residue(const Connectivity& connectivity, std::size_t a, std::size_t b) {
        const AtomName &first = connectivity.names[a], &second = connectivity.names[b];
        return first.segment == second.segment && first.number == second.number &&
               first.residue == second.residue;
    }

    std::vector<std::uint8_t> is_mobile_;
};

const FlexiblePart& part_named(std::span<const FlexiblePart> parts, std::string_view name) {
    return *std::ranges::find_if(
        parts, [&](const FlexiblePart& part) { return part.description->name == name; });
}

bool is_backbone(const Connectivity& connectivity, const Joint& joint) {
    const std::string &a = connectivity.names[joint.bond[0]].atom,
                      &b = connectivity.names[joint.bond[1]].atom;
    return (a == "CA" && (b == "N" || b == "C")) || (b == "CA" && (a == "N" || a == "C"));
}

struct SceneJoints {
    Joints joints;
    std::size_t held = 0;
};

SceneJoints find_joints(const SceneDescription& scene, const Connectivity& connectivity,
                        std::span<const Vec3> positions, std::span<const FlexiblePart> parts) {
    Mobility mobility(connectivity.names.size());
    for (const FlexiblePart& part : parts) {
        if (part.description->shape == Shape::Flexible) mobility.allow(part.atoms);
    }
    const JointRules rules = read_rules(scene, connectivity);
    SceneJoints result{build_joints(connectivity, rules), 0};
    // What the scene names turns whatever else it says, but for rigid molecules.
    const auto is_named = [&](const Joint& joint) {
        return std::ranges::any_of(rules.overrides, [&](const JointOverride& o) {
            return o.motion == BondMotion::Turn &&
                   std::minmax(o.bond[0], o.bond[1]) == std::minmax(joint.bond[0], joint.bond[1]);
        });
    };
    if (!scene.joints.backbone) {
        std::erase_if(result.joints.joints, [&](const Joint& joint) {
            return is_backbone(connectivity, joint) && !is_named(joint);
        });
    }
    for (const JointOverride& o : rules.overrides) {
        if (o.motion != BondMotion::Turn || mobility.has(o.bond)) continue;
        throw LoadError(scene.place_of("joints.turn"),
                        fmt::format("bond {} - {} is of a rigid molecule; expected shape = "
                                    "\"flexible\" there",
                                    to_string(connectivity.names[o.bond[0]]),
                                    to_string(connectivity.names[o.bond[1]])));
    }
    const auto keep_mobile = [&] {
        std::erase_if(result.joints.joints, [&](const Joint& joint) {
            return !mobility.has(joint.bond) && !is_named(joint);
        });
        std::erase_if(result.joints.springs, [&](const std::array<std::uint32_t, 2>& bond) {
            return !mobility.has(bond);
        });
    };
    keep_mobile();
    if (!scene.joints.within_angstrom) return result;
    const std::string& around =
        scene.joints.around.empty() ? scene.grab.molecule : scene.joints.around;
    const std::size_t all = result.joints.joints.size();
    mobility.keep_within(*scene.joints.within_angstrom, part_named(parts, around).atoms,
                         connectivity, positions);
    keep_mobile();
    result.held = all - result.joints.joints.size();
    return result;
}

// ---- which bases -----------------------------------------------------------------------------

// Which molecule of the bonded each body belongs to.
std::vector<std::uint32_t> molecules_of(const TorsionBodies& bodies) {
    std::vector<std::uint32_t> molecules;
    std::uint32_t count = 0;
    for (const Body& body : bodies.bodies) {
        molecules.push_back(body.parent == no_body ? count++ : molecules[body.parent]);
    }
    return molecules;
}

BaseFreedom freedom_of(Motion motion) {
    if (motion == Motion::Free) return BaseFreedom::Free;
    return motion == Motion::TranslateAndTurn ? BaseFreedom::Turning : BaseFreedom::Held;
}

bool is_moved_by_hand(Motion motion) {
    return motion == Motion::Translate || motion == Motion::TranslateAndTurn;
}

// Of each bonded molecule, as the scene's molecules have it that its atoms belong to.
std::vector<MoleculeBase> find_bases(const TorsionBodies& bodies,
                                     std::span<const FlexiblePart> parts) {
    const std::vector<std::uint32_t> molecule_of = molecules_of(bodies);
    std::vector<std::optional<MoleculeBase>> found(bodies.molecules());
    for (const FlexiblePart& part : parts) {
        const BaseFreedom freedom = freedom_of(part.description->motion);
        const auto set = [&](std::uint32_t atom) {
            const std::uint32_t body = bodies.body_of[atom];
            std::optional<MoleculeBase>& base = found[molecule_of[body]];
            if (!base && bodies.is_base(body)) base = MoleculeBase{freedom, atom};
        };
        set(part.reference_atom);
        for (std::uint32_t i = 0; i < part.atoms.count; ++i) set(part.atoms.first + i);
    }
    std::vector<MoleculeBase> bases;
    for (const std::optional<MoleculeBase>& base : found) {
        bases.push_back(base.value_or(MoleculeBase{}));
    }
    return bases;
}

// The hand has hold of one base only.
void check_one_piece(const SceneDescription& scene, const TorsionBodies& bodies,
                     const FlexiblePart& grabbed) {
    const std::vector<std::uint32_t> molecule_of = molecules_of(bodies);
    const auto piece = [&](std::uint32_t atom) { return molecule_of[bodies.body_of[atom]]; };
    for (std::uint32_t i = 0; i < grabbed.atoms.count; ++i) {
        if (piece(grabbed.atoms.first + i) == piece(grabbed.reference_atom)) continue;
        throw LoadError(scene.place_of("grab.molecule"),
                        fmt::format("'{}' is not all bonded together; expected one molecule, or a "
                                    "free one held by a spring (grab.atom)",
                                    scene.grab.molecule));
    }
}

// What bases that nothing moves do to each other is constant.
void join_fixed(std::uint32_t grabbed, TorsionModel& model) {
    const TorsionBodies& bodies = model.tree.bodies;
    std::optional<std::uint32_t> first;
    for (std::uint32_t i = 0; i < bodies.body_of.size(); ++i) {
        const std::uint32_t body = bodies.body_of[i], molecule = model.tree.molecule_of[body];
        if (!bodies.is_base(body) || molecule == grabbed ||
            model.bases[molecule].freedom != BaseFreedom::Held)
            continue;
        if (!first) first = body;
        model.fast.atoms.groups[i] = *first;
    }
}

// ---- the hand's spring -----------------------------------------------------------------------

// "25 CA": an atom; "25": a residue.
Tether read_tether(const SceneDescription& scene, const Connectivity& connectivity,
                   const FlexiblePart& grabbed) {
    const std::vector<std::string_view> words = split_words(scene.grab.atom);
    Tether tether;
    tether.k = scene.grab.spring_kcal_per_mol_angstrom2;
    for (std::uint32_t i = 0; i < grabbed.atoms.count; ++i) {
        const std::uint32_t atom = grabbed.atoms.first + i;
        const AtomName& name = connectivity.names[atom];
        if (words.empty() || words.size() > 2 || name.number != words[0]) continue;
        if (words.size() == 1 || name.atom == words[1]) tether.atoms.push_back(atom);
    }
    if (tether.atoms.empty()) {
        throw LoadError(scene.place_of("grab.atom"),
                        fmt::format("'{}' has no atom or residue \"{}\"; expected \"25 CA\" or "
                                    "\"25\"",
                                    scene.grab.molecule, scene.grab.atom));
    }
    return tether;
}

RelaxSettings build_settings(const SceneDescription& scene) {
    const StaticsDescription& s = scene.statics;
    RelaxSettings settings;
    settings.method = static_cast<RelaxMethod>(s.method);
    settings.force_tolerance = s.rest_kcal_per_mol;
    settings.steps = static_cast<std::size_t>(s.steps);
    settings.largest_move = s.largest_move_angstrom;
    settings.step.largest_move = s.largest_move_angstrom;
    ForceSettings& forces = settings.step.forces;
    forces.fast = s.pairs == PairPrecision::Fast;
    forces.nonbonded.coulomb_constant = scene.force_field.coulomb_constant;
    if (s.cutoff_angstrom) {
        constexpr double width = 2;  // Å
        forces.nonbonded.electrostatics = ElectrostaticCutoff::ForceSwitch;
        forces.nonbonded.van_der_waals = VanDerWaalsCutoff::ForceSwitch;
        forces.nonbonded.cutoff = *s.cutoff_angstrom;
        forces.nonbonded.switch_from = *s.cutoff_angstrom - width;
    }
    return settings;
}

}  // namespace

Flexible build_flexible(const SceneDescription& scene, const Connectivity& connectivity,
                        const Topology& topology, std::span<const Vec3> positions,
                        std::span<const FlexiblePart> parts,
                        const RelaxProgressFunction& on_relax) {
    const SceneJoints joints = find_joints(scene, connectivity, positions, parts);
    std::vector<std::uint32_t> base_atoms;
    for (const FlexiblePart& part : parts) base_atoms.push_back(part.reference_atom);
    const TorsionBodies bodies = build_bodies(connectivity, joints.joints, base_atoms);
    const FlexiblePart& grabbed = parts.front();
    const bool is_moved = is_moved_by_hand(grabbed.description->motion);
    if (is_moved) check_one_piece(scene, bodies, grabbed);
    std::optional<Tether> tether;
    if (!scene.grab.atom.empty()) tether = read_tether(scene, connectivity, grabbed);

    // At first nobody holds anything.
    Flexible result;
    result.grabbed = molecules_of(bodies)[bodies.body_of[grabbed.reference_atom]];
    std::vector<MoleculeBase> bases = find_bases(bodies, parts);
    const MoleculeBase held = bases[result.grabbed];
    if (is_moved) bases[result.grabbed].freedom = BaseFreedom::Free;
    const TorsionModel loose = build_torsion_model(
        bodies, connectivity.mass, {positions.begin(), positions.end()}, topology, bases);
    TorsionState rest = build_torsion_state(loose);
    QuasiStatics statics = build_quasi_statics(loose);
    result.settings = build_settings(scene);
    RelaxSettings to_rest;
    to_rest.step.forces = result.settings.step.forces;
    to_rest.force_tolerance = scene.statics.rest_kcal_per_mol;
    to_rest.steps = static_cast<std::size_t>(scene.statics.relax_steps);
    result.relaxed = relax_joints(loose, to_rest, rest, statics, on_relax);
    if (result.relaxed.end == RelaxEnd::NotFinite) {
        throw LoadError(scene.place_of("molecules"),
                        "the energy at the start is not finite; expected atoms apart from each "
                        "other");
    }

    bases[result.grabbed] = held;
    result.model = build_torsion_model(bodies, connectivity.mass, rest.positions, topology, bases);
    join_fixed(result.grabbed, result.model);
    result.state = build_torsion_state(result.model);
    result.statics = build_quasi_statics(result.model);
    result.joints = joints.joints.joints.size();
    result.joints_held = joints.held;
    if (tether) {
        result.state.tether = std::move(tether);
        result.state.tether->place =
            find_tethered(result.model, *result.state.tether, result.state.positions);
    }
    start_flexible(result);
    return result;
}

void start_flexible(Flexible& flexible) {
    update_forces(flexible.model, flexible.settings.step.forces, flexible.statics.memory,
                  flexible.state);
    flexible.safe = flexible.state;
}

Vec3 find_held(const Flexible& flexible) noexcept {
    if (flexible.state.tether) return flexible.state.tether->place;
    return flexible.state.positions[flexible.model.bases[flexible.grabbed].pivot];
}

void move_held(Flexible& flexible, const Vec3& by) noexcept {
    if (flexible.state.tether) {
        flexible.state.tether->place += by;
    } else {
        shift_base(flexible.model, flexible.grabbed, by, flexible.state);
    }
}

SettleReport step_flexible(Flexible& flexible) {
    const TorsionModel& model = flexible.model;
    const RelaxSettings& settings = flexible.settings;
    TorsionState& state = flexible.state;
    SettleReport report;
    const std::size_t evaluations = flexible.statics.memory.evaluations;
    const double before = flexible.safe.energy();
    if (settings.method == RelaxMethod::QuasiStatic) {
        update_forces(model, settings.step.forces, flexible.statics.memory, state);
        report.hand_work = state.energy() - before;
        for (std::size_t i = 0; i < settings.steps && report.is_finite; ++i) {
            const QuasiStaticReport step =
                step_quasi_static(model, settings.step, state, flexible.statics);
            report.is_finite = step.is_finite;
            if (step.is_taken) report.energy_change += step.energy_change;
        }
    } else {
        const JointRelaxReport relaxed = relax_joints(model, settings, state, flexible.statics);
        report.hand_work = relaxed.energy_before - before;
        report.energy_change = relaxed.energy_after - relaxed.energy_before;
        report.is_finite = relaxed.end != RelaxEnd::NotFinite;
    }
    report.evaluations = flexible.statics.memory.evaluations - evaluations;
    report.is_finite = report.is_finite && std::isfinite(state.energy());
    if (!report.is_finite) {
        state = flexible.safe;
        return report;
    }
    report.largest_move = find_largest_move(flexible.safe.positions, state.positions);
    flexible.safe = state;
    return report;
}

}  // namespace palpa
