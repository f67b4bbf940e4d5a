#include "simulation/mechanics.h"

#include "assembly/region_bodies.h"
#include "charmm/build_topology.h"
#include "charmm/cut_topology.h"
#include "charmm/generate.h"
#include "core/text.h"
#include "core/units.h"
#include "simulation/coupling.h"
#include "simulation/held.h"
#include "simulation/region.h"
#include "simulation/remote_engine.h"
#include "simulation/solvent.h"
#include "simulation/systems/choose_active.h"
#include "simulation/systems/gather_springs.h"
#include "simulation/systems/relax.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

// A molecule in the atom table.
struct ScenePart {
    std::string_view name;
    Mobility mobility;
    AtomRange atoms;
    std::uint32_t reference_atom;
};

std::vector<ScenePart> list_parts(const World& world) {
    std::vector<ScenePart> parts;
    world.each<Molecule, Mobility>([&](Entity, const Molecule& molecule, const Mobility& mobility) {
        parts.push_back({molecule.name, mobility, molecule.atoms, molecule.reference_atom});
    });
    return parts;
}

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

    // Of a molecule keeps only residues with an atom as near as that to one of `around`. Another
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

struct SceneJoints {
    Joints joints;
    std::size_t held = 0;
};

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
    // What the scene names turns whatever else it says, but for rigid molecules.
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

// ---- which bases -----------------------------------------------------------------------------

BaseFreedom freedom_of(Motion motion) {
    if (motion == Motion::Free) return BaseFreedom::Free;
    return motion == Motion::TranslateAndTurn ? BaseFreedom::Turning : BaseFreedom::Held;
}

// Of each bonded molecule, as the scene's molecules have it that its atoms belong to. What has
// atoms outside of a region is fixed.
std::vector<MoleculeBase> find_bases(const TorsionBodies& bodies, std::span<const ScenePart> parts,
                                     const std::optional<Region>& region) {
    const std::vector<std::uint32_t> molecule_of = molecules_of(bodies);
    std::vector<std::optional<MoleculeBase>> found(bodies.molecules());
    for (const std::uint32_t atom : region ? region->atoms : std::vector<std::uint32_t>{}) {
        std::optional<MoleculeBase>& base = found[molecule_of[bodies.body_of[atom]]];
        if (!base && region->is_inside[atom] == 0) base = MoleculeBase{BaseFreedom::Held, atom};
    }
    for (const ScenePart& part : parts) {
        const BaseFreedom freedom = freedom_of(part.mobility.motion);
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

// A hand has hold of one base only.
void check_one_piece(const TextPlace& place, const Molecule& held,
                     const std::function<std::uint32_t(std::uint32_t)>& piece_of) {
    for (std::uint32_t i = 0; i < held.atoms.count; ++i) {
        if (piece_of(held.atoms.first + i) == piece_of(held.reference_atom)) continue;
        throw LoadError(place,
                        fmt::format("'{}' has parts without bonds between them; expected one "
                                    "bonded molecule, or a free one held by a spring (grab.atom)",
                                    held.name));
    }
}

// Bases that are held, but by no hand.
void fix_held(std::span<const HeldPart> held, TorsionModel& model) {
    std::vector<std::uint8_t> is_fixed;
    for (const MoleculeBase& base : model.bases)
        is_fixed.push_back(base.freedom == BaseFreedom::Held ? 1 : 0);
    for (const HeldPart& part : held) {
        if (!part.spring) is_fixed[part.base] = 0;
    }
    fix_bases(is_fixed, model);
}

// ---- settings --------------------------------------------------------------------------------

RelaxSettings build_settings(const World& world) {
    const StaticsDescription& s = world.resource<MechanicsSettings>().statics;
    const ForceFieldDescription& force_field = world.resource<ForceFieldInUse>().description;
    RelaxSettings settings;
    settings.method = method_of(s);
    settings.force_tolerance = s.rest_kcal_per_mol;
    settings.steps = static_cast<std::size_t>(s.steps);
    settings.largest_move = s.largest_move_angstrom;
    settings.keeps_pairs = true;  // from period to period
    settings.step.largest_move = s.largest_move_angstrom;
    ForceSettings& forces = settings.step.forces;
    forces.fast = s.pairs == PairPrecision::Fast;
    forces.nonbonded.coulomb_constant = force_field.coulomb_constant;
    if (force_field.solvent != Solvent::None) {
        forces.nonbonded = solvent_settings(force_field);
    } else if (s.cutoff_angstrom) {
        constexpr double width = 2;  // Å
        forces.nonbonded.electrostatics = ElectrostaticCutoff::ForceSwitch;
        forces.nonbonded.van_der_waals = VanDerWaalsCutoff::ForceSwitch;
        forces.nonbonded.cutoff = *s.cutoff_angstrom;
        forces.nonbonded.switch_from = *s.cutoff_angstrom - width;
    }
    return settings;
}

AdaptiveSettings build_adaptive_settings(const StaticsDescription& s,
                                         const QuasiStaticSettings& step) {
    AdaptiveSettings settings;
    settings.step = step;
    settings.limits.degrees_of_freedom = static_cast<std::size_t>(s.active);
    settings.choose_every = static_cast<std::size_t>(s.choose_every);
    if (s.weights != JointWeights::Acceleration) {
        settings.weight = MetricWeight::Inertia;
        settings.limits.shape = SelectionShape::Single;
    }
    return settings;
}

// A joint that turns half a chain makes all its pairs change; its factor falls with the third power
// of the atoms behind it, and that of a free base as if all were.
std::vector<double> find_mobility_weights(const TorsionModel& model) {
    const AssemblyTree& tree = model.tree;
    const std::vector<Body>& bodies = tree.bodies.bodies;
    std::vector<double> behind(bodies.size(), 0), mobility_weights;
    for (std::size_t b = bodies.size(); b-- > 0;) {
        behind[b] += tree.first_atom[b + 1] - tree.first_atom[b];
        if (!tree.bodies.is_base(b)) behind[bodies[b].parent] += behind[b];
    }
    for (const double atoms : behind) {
        mobility_weights.push_back(1 / ((1 + atoms / 20) * (1 + atoms * atoms / 100)));
    }
    return mobility_weights;
}

AdaptiveState build_adaptive(const RelaxSettings& settings, const TorsionModel& model,
                             std::span<const HeldPart> held, const World& world) {
    const StaticsDescription& s = world.resource<MechanicsSettings>().statics;
    AdaptiveState adaptive;
    adaptive.settings = build_adaptive_settings(s, settings.step);
    adaptive.statics = build_adaptive_statics(model);
    adaptive.weighs_hand_proximity = s.weights == JointWeights::HandProximity;
    if (adaptive.weighs_hand_proximity) {
        adaptive.mobility_weights = find_mobility_weights(model);
        // What is in the hand weighs nothing.
        for (const HeldPart& part : held)
            adaptive.mobility_weights[model.tree.bases[part.base]] = 1;
        adaptive.settings.factors = adaptive.mobility_weights;
    }
    adaptive.choose_every = adaptive.settings.choose_every;
    if (s.budget_us) adaptive.budget.emplace(*s.budget_us);
    if (const auto within_pN = world.resource<Coupling>().description.feel_within_pN) {
        adaptive.accuracy.emplace(
            *within_pN, WorkBudget{adaptive.settings.limits.degrees_of_freedom, settings.steps},
            static_cast<std::size_t>(model.coordinates), adaptive.budget.has_value());
    }
    return adaptive;
}

void add_held_atoms(const TorsionModel& model, const TorsionState& state, const HandHold& hold,
                    std::vector<std::uint32_t>& atoms) {
    if (hold.spring) {
        const std::vector<std::uint32_t>& pulled = state.springs[*hold.spring].atoms;
        atoms.insert(atoms.end(), pulled.begin(), pulled.end());
        return;
    }
    for (std::uint32_t i = 0; i < model.masses.size(); ++i) {
        if (model.tree.molecule_of[model.tree.bodies.body_of[i]] == hold.molecule)
            atoms.push_back(i);
    }
}

// What hands hold that is mobile, in their order.
HeldParts find_held_parts(const World& world, std::vector<Entity>& hands) {
    const TorsionModel& model = model_of(world);
    HeldParts held;
    world.each<Grip>([&](Entity hand, const Grip& grip) {
        if (!is_mobile(world, hand)) return;
        HandHold hold;
        hold.molecule = static_cast<std::uint32_t>(grip.base);
        hold.spring = find_spring_index(world, hand);
        hold.turns = !hold.spring && grip.freedom == 6;
        held.hands.push_back(hold);
        hands.push_back(hand);
        add_held_atoms(model, world.resource<TorsionState>(), hold, held.atoms);
    });
    std::ranges::sort(held.atoms);
    const auto doubles = std::ranges::unique(held.atoms);
    held.atoms.erase(doubles.begin(), doubles.end());
    return held;
}

SecondOrder build_second_order(const StaticsDescription& s, const RelaxSettings& settings,
                               const World& world) {
    SecondOrder second;
    second.settings.forces = settings.step.forces;
    second.settings.near_reach = s.near_angstrom;
    second.settings.renew_hand = s.renew_angstrom;
    if (s.responses > 0) second.settings.responses = static_cast<std::size_t>(s.responses);
    second.most_evaluations = second.settings.evaluations;
    if (!s.renews_beside) second.delay_s = 1e-3 * s.renewal_ms;
    // A renewal beside the steps relaxes a little and linearises anew rather than relaxing long
    // with an old factor: after a snap that is at rest sooner.
    if (s.renews_beside) {
        second.settings.least_relaxation = 4;
        second.settings.most_relaxation = 10;
        second.settings.relax_move = 0.25;
    }
    second.settings.renews_at_once = !s.renews_beside && s.renewal_ms == 0;
    second.statics =
        build_second_order_statics(model_of(world), find_held_parts(world, second.hands));
    return second;
}

// Against all pairs, whatever cutoff the steps have; the ends that go with a solvent are part of
// its energy.
ErrorEstimate build_error_estimate(const RelaxSettings& settings, Solvent solvent,
                                   const World& world) {
    ErrorEstimate estimate;
    ForceSettings& forces = estimate.settings.forces = settings.step.forces;
    if (solvent == Solvent::None) {
        const double coulomb = forces.nonbonded.coulomb_constant;
        forces.nonbonded = {};
        forces.nonbonded.coulomb_constant = coulomb;
    }
    estimate.settings.relaxed = 0.1;
    estimate.settings.most_relaxation = 500;
    std::vector<Entity> hands;
    estimate.held = find_held_parts(world, hands);
    return estimate;
}

// Matrices of more coordinates are too large.
RelaxMethod find_method(const World& world, Eigen::Index coordinates) {
    const StaticsDescription& s = world.resource<MechanicsSettings>().statics;
    const RelaxMethod method = method_of(s);
    if (method != RelaxMethod::SecondOrder || coordinates <= most_second_order_coordinates)
        return method;
    if (!s.method) return RelaxMethod::QuasiStatic;
    throw LoadError(
        world.resource<ScenePlaces>().place_of("statics.method"),
        fmt::format("the second-order method with {} degrees of freedom would need {:.1f} GB and "
                    "minutes; expected at most {} degrees of freedom: use fewer joints "
                    "(joints.region_angstrom, joints.within_angstrom), or quasi-static",
                    coordinates, 5e-8 * static_cast<double>(coordinates * coordinates),
                    most_second_order_coordinates));
}

// ---- together --------------------------------------------------------------------------------

// Bodies and bases as molecules may now move.
struct Plan {
    ModelAtoms atoms;
    TorsionBodies bodies;
    std::vector<MoleculeBase> bases;
    std::size_t joints = 0, joints_held = 0;
};

// Leaves nothing in a plan but what a region needs.
void cut_plan(const Region& region, Plan& plan) {
    if (region.atoms.size() == region.is_inside.size()) return;
    CutBodies cut = cut_bodies(plan.bodies, region.atoms);
    plan.atoms.in_table = region.atoms;
    std::vector<MoleculeBase> bases;
    for (const std::uint32_t molecule : cut.molecules) {
        bases.push_back(plan.bases[molecule]);
        bases.back().pivot = plan.atoms.in_model(bases.back().pivot).value();
    }
    plan.bodies = std::move(cut.bodies);
    plan.bases = std::move(bases);
}

Plan plan_mechanics(World& world) {
    const Connectivity& connectivity = *bonded_terms(world).connectivity;
    const std::vector<ScenePart> parts = list_parts(world);
    const std::optional<Region> region = find_region(world);
    SceneJoints joints =
        find_joints(world, connectivity, world.resource<AtomTable>().positions, parts, region);
    std::vector<std::uint32_t> base_atoms;
    if (region) {
        const auto cuts = find_region_cuts(connectivity, region->is_inside, joints.joints.springs);
        joints.joints.springs.insert(joints.joints.springs.end(), cuts.begin(), cuts.end());
        for (std::uint32_t i = 0; i < region->is_inside.size(); ++i) {
            if (region->is_inside[i] == 0) base_atoms.push_back(i);
        }
    }
    for (const ScenePart& part : parts) base_atoms.push_back(part.reference_atom);
    Plan plan{{}, build_bodies(connectivity, joints.joints, base_atoms), {}, 0, 0};
    plan.bases = find_bases(plan.bodies, parts, region);
    if (region) cut_plan(*region, plan);
    plan.joints = joints.joints.joints.size();
    plan.joints_held = joints.held;
    return plan;
}

// What hands hold, in their order.
std::vector<HeldPart> find_held(const World& world, const Plan& plan) {
    const std::vector<std::uint32_t> molecule_of = molecules_of(plan.bodies);
    const auto piece_of = [&](std::uint32_t atom) {
        return molecule_of[plan.bodies.body_of[plan.atoms.in_model(atom).value()]];
    };
    const ScenePlaces& places = world.resource<ScenePlaces>();
    std::vector<HeldPart> held;
    world.each<Grip>([&](Entity hand, const Grip& grip) {
        const bool is_first = hand == first_hand(world);
        const Molecule& molecule = *world.find<Molecule>(grip.molecule);
        HeldPart& part = held.emplace_back();
        if (const Spring* const spring = world.find<Spring>(hand)) {
            part.base = piece_of(molecule.atoms.first + spring->ends.front().atoms.front());
            part.spring = find_model_spring(world, plan.atoms, *spring);
        } else {
            part.base = piece_of(molecule.reference_atom);
            check_one_piece(places.place_of(is_first ? "grab.molecule" : "second.grab.molecule"),
                            molecule, piece_of);
        }
    });
    return held;
}

TorsionModel build_model(World& world, const Plan& plan, std::vector<MoleculeBase> bases) {
    const BondedTerms& terms = bonded_terms(world);
    const std::vector<Vec3>& positions = world.resource<AtomTable>().positions;
    const std::vector<std::uint32_t>& atoms = plan.atoms.in_table;
    if (atoms.empty()) {
        return build_torsion_model(plan.bodies, terms.connectivity->mass, positions,
                                   *terms.topology, std::move(bases));
    }
    std::vector<double> masses;
    std::vector<Vec3> places;
    for (const std::uint32_t atom : atoms) {
        masses.push_back(terms.connectivity->mass[atom]);
        places.push_back(positions[atom]);
    }
    return build_torsion_model(plan.bodies, std::move(masses), std::move(places),
                               cut_topology(*terms.topology, atoms), std::move(bases));
}

void set_mechanics(TorsionModel model, ModelAtoms atoms, std::span<const HeldPart> held,
                   World& world) {
    fix_held(held, model);
    TorsionState state = build_torsion_state(model);
    std::size_t next = 0;
    world.write_each<Grip>([&](Entity hand, Grip& grip) {
        const HeldPart& part = held[next++];
        grip.base = static_cast<std::int32_t>(part.base);
        if (!part.spring) return;
        world.write<Spring>(hand)->place =
            grip.is_new ? find_centre_of_mass(model, part.spring->atoms, state.positions)
                        : Vec3(grip.anchor + grip.pose.place_angstrom);
    });
    world.remove_resource<AdaptiveState>();
    world.remove_resource<SecondOrder>();
    world.remove_resource<ErrorEstimate>();
    RelaxSettings settings = build_settings(world);
    settings.method = find_method(world, model.coordinates);
    if (settings.method == RelaxMethod::QuasiStatic)
        world.set_resource(build_adaptive(settings, model, held, world));
    world.set_resource(Solver{settings, build_quasi_statics(model)});
    world.set_resource(std::move(state));
    world.set_resource(Mechanics{std::make_shared<const TorsionModel>(std::move(model)),
                                 std::make_shared<const ModelAtoms>(std::move(atoms))});
    gather_springs(world, {});
    if (settings.method == RelaxMethod::SecondOrder) {
        SecondOrder second =
            build_second_order(world.resource<MechanicsSettings>().statics, settings, world);
        if (const auto within_pN = world.resource<Coupling>().description.feel_within_pN)
            second.settings.tolerance = *within_pN / units::piconewton_per_kcal_per_mol_angstrom;
        world.set_resource(std::move(second));
    } else if (model_of(world).coordinates <= most_second_order_coordinates) {
        world.set_resource(build_error_estimate(
            settings, world.resource<ForceFieldInUse>().description.solvent, world));
    }
    start_mechanics(world);
}

// What must be different atoms.
void check_segments(const World& world) {
    const ScenePlaces& places = world.resource<ScenePlaces>();
    world.each<Molecule, Source>([&](Entity a, const Molecule& one, const Source& from) {
        world.each<Molecule, Source>([&](Entity b, const Molecule& other, const Source& source) {
            if (a == b || from.structure != source.structure || from.segment != source.segment)
                return;
            throw LoadError(
                places.place_of("molecules." + other.name + ".segment"),
                fmt::format("'{}' and '{}' are the same atoms (segment '{}'); expected each "
                            "segment only once in a scene with molecules that move by themselves",
                            one.name, other.name, from.segment));
        });
    });
}

void clear_mechanics(World& world) {
    world.set_resource(Mechanics{});
    world.set_resource(TorsionState{});
    world.set_resource(GatheredSprings{});
    world.remove_resource<Solver>();
    world.remove_resource<AdaptiveState>();
    world.remove_resource<SecondOrder>();
    world.remove_resource<ErrorEstimate>();
    world.write_each<Grip>([](Entity, Grip& grip) { grip.base = -1; });
}

}  // namespace

bool needs_mechanics(const World& world) {
    if (find_remote_engine(world)) return false;
    bool needs = false;
    world.each<Mobility>([&](Entity, const Mobility& mobility) {
        needs = needs || mobility.shape == Shape::Flexible || mobility.motion == Motion::Free ||
                mobility.motion == Motion::TranslateAndTurn;
    });
    world.each<Grip, Spring>([&](Entity, const Grip&, const Spring&) { needs = true; });
    return needs;
}

const BondedTerms& bonded_terms(World& world) {
    const BondedTerms& present = world.resource<BondedTerms>();
    if (present.topology) return present;
    check_segments(world);
    const ForceField& force_field = *world.resource<ForceFieldInUse>().force_field;
    // Several molecules may be of one file.
    std::map<const Structure*, std::shared_ptr<const Connectivity>> generated;
    auto all = std::make_shared<Connectivity>();
    world.write_each<Source, Molecule>([&](Entity, Source& source, const Molecule&) {
        if (!source.connectivity) {
            std::shared_ptr<const Connectivity>& of_file = generated[source.structure.get()];
            if (!of_file)
                of_file = std::make_shared<const Connectivity>(
                    build_connectivity(force_field, *source.structure));
            source.connectivity = of_file;
        }
        const Connectivity& from = *source.connectivity;
        const auto out = append_segment(from, source.segment, *all);
        if (!out) return;
        throw LoadError(
            {from.file, from.lines[(*out)[0]]},
            fmt::format(
                "atoms {} and {} of different segments are bonded; expected molecules without "
                "bonds between them in a scene with molecules that move by themselves",
                to_string(from.names[(*out)[0]]), to_string(from.names[(*out)[1]])));
    });
    auto topology = std::make_shared<Topology>(build_topology(*all, force_field));
    topology->solvation = find_solvation(world);
    return world.set_resource(BondedTerms{std::move(all), std::move(topology)});
}

void rebuild_mechanics(World& world) {
    if (find_remote_engine(world)) return hold_engine_atoms(world);
    if (!needs_mechanics(world)) {
        clear_mechanics(world);
        return;
    }
    Plan plan = plan_mechanics(world);
    if (plan.bodies.bodies.empty()) {
        clear_mechanics(world);
        return;
    }
    const std::vector<HeldPart> held = find_held(world, plan);
    TorsionModel model = build_model(world, plan, plan.bases);
    set_mechanics(std::move(model), std::move(plan.atoms), held, world);
}

bool has_left_region(const World& world) noexcept {
    const RegionCentre* const centre = world.find_resource<RegionCentre>();
    if (!centre || centre->stays) return false;
    const std::vector<Vec3>&now = world.resource<TorsionState>().positions,
          &reference = model_of(world).reference;
    return std::ranges::any_of(model_of(world).mobile_atoms, [&](std::uint32_t atom) {
        return (now[atom] - reference[atom]).squaredNorm() > region_margin * region_margin;
    });
}

void renew_region(World& world) noexcept {
    try {
        World renewed = world;
        rebuild_mechanics(renewed);
        world = std::move(renewed);
    } catch (const LoadError&) {
        world.write<RegionCentre>().stays = true;
    }
}

void relax_and_build_mechanics(World& world, const RelaxProgressFunction& on_relax) {
    const StaticsDescription& s = world.resource<MechanicsSettings>().statics;
    const Plan plan = plan_mechanics(world);
    const std::vector<HeldPart> held = find_held(world, plan);

    // At first nobody holds anything.
    std::vector<MoleculeBase> bases = plan.bases;
    for (const HeldPart& part : held) {
        if (!part.spring) bases[part.base].freedom = BaseFreedom::Free;
    }
    const TorsionModel loose = build_model(world, plan, std::move(bases));
    TorsionState rest = build_torsion_state(loose);
    world.each<Spring>([&](Entity hand, const Spring& spring) {
        if (world.find<Grip>(hand)) return;
        if (auto found = find_model_spring(world, plan.atoms, spring))
            rest.springs.push_back(std::move(*found));
    });
    QuasiStatics statics = build_quasi_statics(loose);
    RelaxSettings to_rest;
    to_rest.step.forces = build_settings(world).step.forces;
    to_rest.force_tolerance = s.rest_kcal_per_mol;
    to_rest.steps = s.relaxes_start ? static_cast<std::size_t>(s.relax_steps) : 0;
    StartReport& report = world.write<StartReport>();
    report.joints = plan.joints;
    report.joints_held = plan.joints_held;
    report.joints_at_rest = relax_joints(loose, to_rest, rest, statics, on_relax);
    if (report.joints_at_rest->end == RelaxEnd::NotFinite) {
        throw LoadError(world.resource<ScenePlaces>().place_of("molecules"),
                        "the energy at the start is not finite; expected atoms that do not "
                        "overlap, with sensible charges and parameters");
    }
    put_in_table(loose, plan.atoms, rest.positions, world.write<AtomTable>().positions);
    TorsionModel model = build_model(world, plan, plan.bases);
    set_mechanics(std::move(model), plan.atoms, held, world);
    copy_positions(world);
}

World build_mechanics_world(const SceneDescription& scene, TorsionModel model,
                            const HeldPart& held) {
    World world;
    const Entity hand = world.create();
    world.set(hand, Hand{});
    const Entity all = world.create();
    world.set(all, Molecule{"", {0, static_cast<std::uint32_t>(model.reference.size())}});
    Grip grip;
    grip.molecule = all;
    world.set(hand, grip);
    if (held.spring) hold_by_spring(world, hand, {all, held.spring->atoms}, held.spring->k);
    AtomTable atoms;
    atoms.positions = model.reference;
    world.set_resource(std::move(atoms));
    world.set_resource(GatheredSprings{});
    world.set_resource(Clock{scene.period_ms * 1e-3});  // a renewal is due after a time
    world.set_resource(ScenePlaces{scene.file, scene.places});
    world.set_resource(ForceFieldInUse{scene.force_field, nullptr, {}});
    world.set_resource(MechanicsSettings{{}, scene.statics});
    world.set_resource(build_coupling(scene.coupling));
    StartReport report;
    report.joints = model.tree.bodies.joints();
    world.set_resource(report);
    set_mechanics(std::move(model), {}, std::span(&held, 1), world);
    return world;
}

void start_mechanics(World& world) {
    if (!has_mobile(world)) return;
    const TorsionModel& model = model_of(world);
    TorsionState& state = world.write<TorsionState>();
    if (AdaptiveState* const adaptive = world.write_if<AdaptiveState>()) {
        prepare_choice(world);
        world.each<Grip>([&](Entity hand, const Grip& grip) {
            if (grip.base >= 0 && holds_whole(world, hand))
                adaptive->statics.is_guided[static_cast<std::size_t>(grip.base)] = 1;
        });
        // The first step reports what is not finite.
        (void)update_adaptive_forces(model, adaptive->settings, state, adaptive->statics);
        return;
    }
    Solver& solver = world.write<Solver>();
    update_forces(model, solver.settings.step.forces, solver.statics.memory, state);
    if (SecondOrder* const second = world.write_if<SecondOrder>())
        start_second_order(model, second->settings, state, second->statics);
}

void move_held(World& world, const Vec3& by) {
    const Entity hand = first_hand(world);
    MoleculePose pose = grip_of(world, hand).pose;
    pose.place_angstrom = held_place(world, hand) + by - grip_of(world, hand).anchor;
    place_held(world, hand, pose);
}

RelaxStepReport relax_step(World& world) {
    choose_active(world, {});
    return relax_mobile(world, {});
}

void put_state(World& world, const TorsionState& state) {
    world.write<TorsionState>() = state;
    world.write<Solver>().statics.h = 0;
    if (AdaptiveState* const adaptive = world.write_if<AdaptiveState>()) {
        adaptive->statics = build_adaptive_statics(model_of(world));
        adaptive->near_to.clear();
    }
    if (SecondOrder* const second = world.write_if<SecondOrder>()) {
        HeldParts held = second->statics.renewals.lineariser.held;
        second->statics = build_second_order_statics(model_of(world), std::move(held));
    }
    update_positions(model_of(world), world.write<TorsionState>());
    return_ends(world);
    start_mechanics(world);
}

HeldPart held_part(const World& world) {
    const Grip& grip = grip_of(world, first_hand(world));
    HeldPart held{static_cast<std::uint32_t>(grip.base), {}};
    if (const ModelSpring* const spring = spring_of(world, first_hand(world)))
        held.spring = *spring;
    return held;
}

}  // namespace palpa
