#include "simulation/flexible.h"

#include "core/interrupt.h"
#include "core/text.h"
#include "core/units.h"

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
            for (; next < is_mobile_.size() &&
                   is_same_residue(connectivity.names[first], connectivity.names[next]);
                 ++next) {
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
    std::vector<std::uint8_t> is_mobile_;
};

const FlexiblePart& part_named(std::span<const FlexiblePart> parts, std::string_view name) {
    return *std::ranges::find_if(
        parts, [&](const FlexiblePart& part) { return part.description->name == name; });
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
            return is_backbone(connectivity, joint.bond) && !is_named(joint);
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
    settings.keeps_pairs = true;  // from period to period
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

AdaptiveSettings build_adaptive_settings(const StaticsDescription& s,
                                         const QuasiStaticSettings& step) {
    AdaptiveSettings settings;
    settings.step = step;
    settings.limits.degrees_of_freedom = static_cast<std::size_t>(s.active);
    settings.choose_every = static_cast<std::size_t>(s.choose_every);
    if (s.weights != JointWeights::Plain) settings.weight = MetricWeight::Inertia;
    if (s.weights != JointWeights::Plain && s.weights != JointWeights::Inertia)
        settings.limits.shape = SelectionShape::Single;
    return settings;
}

// A joint that turns half a chain makes all its pairs change; its factor falls with the third power
// of the atoms behind it, and that of a free base as if all were.
std::vector<double> find_lightness(const TorsionModel& model) {
    const AssemblyTree& tree = model.tree;
    const std::vector<Body>& bodies = tree.bodies.bodies;
    std::vector<double> behind(bodies.size(), 0), lightness;
    for (std::size_t b = bodies.size(); b-- > 0;) {
        behind[b] += tree.first_atom[b + 1] - tree.first_atom[b];
        if (!tree.bodies.is_base(b)) behind[bodies[b].parent] += behind[b];
    }
    for (const double atoms : behind) {
        lightness.push_back(1 / ((1 + atoms / 20) * (1 + atoms * atoms / 100)));
    }
    return lightness;
}

bool is_adaptive(const SceneDescription& scene, const TorsionModel& model) {
    const StaticsDescription& s = scene.statics;
    return s.method == StaticsMethod::QuasiStatic &&
           (s.active < model.coordinates || s.budget_us.has_value() ||
            scene.coupling.feel_within_pN.has_value());
}

// What is held.
Ball find_held_ball(const Flexible& flexible, const FewActive& few) {
    const TorsionModel& model = flexible.model;
    const std::vector<Vec3>& positions = flexible.state.positions;
    if (flexible.state.tether) {
        const Tether& tether = *flexible.state.tether;
        return {find_tethered(model, tether, positions), 0};
    }
    const AssemblyState& whole = few.statics.whole;
    return {whole.points[model.tree.bases[flexible.grabbed]], whole.gyration[flexible.grabbed]};
}

// How much each joint counts: less than half from 5 Å on around what is held, then less and less.
// As long as that stays where it is about, all stays; with the same factors a choice costs less.
void update_factors(const Flexible& flexible, FewActive& few) {
    constexpr double reach2 = 25, about = 0.5;  // Å^2, Å
    const TorsionModel& model = flexible.model;
    const std::vector<Body>& bodies = model.tree.bodies.bodies;
    std::vector<double>& factors = few.settings.factors;
    if (!few.statics.is_built && !flexible.state.tether) {
        factors = few.lightness;
        few.near_to.reset();
        return;
    }
    const Ball ball = find_held_ball(flexible, few);
    if (few.near_to && (ball.centre - few.near_to->centre).norm() < about) return;
    few.near_to = ball;
    factors = few.lightness;
    const auto [centre, radius] = ball;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (model.tree.bodies.is_base(b)) continue;
        const double distance = (flexible.state.positions[bodies[b].axis[1]] - centre).norm();
        const double beyond = std::max(0.0, distance - radius);
        const double nearness = reach2 / (reach2 + beyond * beyond);
        factors[b] *= nearness * nearness;
    }
}

// Before a choice.
void prepare_choice(const Flexible& flexible, FewActive& few) {
    if (few.is_near_hand) update_factors(flexible, few);
    std::size_t most = static_cast<std::size_t>(flexible.model.coordinates);
    if (few.exactness) {
        const Effort& effort = few.exactness->effort();
        most = few.settings.limits.degrees_of_freedom = effort.active;
        // More steps are of the same moment, in which no others have to be chosen.
        few.settings.choose_every = few.choose_every * effort.steps / flexible.settings.steps;
    }
    if (!few.budget) return;
    few.settings.limits.degrees_of_freedom = few.budget->find_freedom(most);
    // The budget is for as many quasi-static steps as make one of the simulation.
    const std::size_t together = flexible.settings.steps, usual = few.choose_every;
    few.settings.choose_every =
        std::max(usual, together * few.budget->find_interval(usual / together));
}

void keep_held(const Flexible& flexible, FewActive& few) {
    const TorsionState& state = flexible.state;
    few.held_before.shift = state.shifts[flexible.grabbed];
    if (state.tether) few.held_before.place = state.tether->place;
}

// What the hand did, from the coordinates, which are those of the last step else.
void take_back(Flexible& flexible, FewActive& few) {
    TorsionState& state = flexible.state;
    state.shifts[flexible.grabbed] = few.held_before.shift;
    if (state.tether) state.tether->place = few.held_before.place;
    update_positions(flexible.model, state);
    few.statics.is_built = false;
    (void)update_adaptive_forces(flexible.model, few.settings, state, few.statics);
}

// An audit begins where its share of the work allows, or goes on. In a time budget it makes one
// step in each of the simulation's, else all at once.
void update_audit(const Flexible& flexible, FewActive& few, SettleReport& report) {
    if (!few.exactness) return;
    constexpr double newton_per_pN = 1e-12, settled = 0.05;
    constexpr double kcal = newton_per_pN / units::newton_per_kcal_per_mol_angstrom;
    Exactness& exactness = *few.exactness;
    Audit& audit = few.audit;
    exactness.add_step({report.active, report.steps});
    if (!audit.is_under_way) {
        if (!exactness.is_due()) return;
        start_audit(flexible.model, few.settings.step, flexible.state,
                    std::max(few.statics.h, few.settings.step.first_h),
                    few.told.value_or(find_force_on_held(flexible)), flexible.grabbed, audit);
    }
    report.is_audited = true;
    const AuditLimits limits{settled * exactness.tolerance() * kcal, Exactness::audit_steps};
    do {
        if (audit.is_under_way)
            step_audit(flexible.model, few.settings.step, flexible.grabbed, limits, audit);
    } while (audit.is_under_way && !exactness.has_budget() && noted_interrupt() == 0);
    if (audit.is_under_way || !audit.is_finite) return;
    report.audited_pN = (audit.told - audit.found).norm() / kcal;
    exactness.add_audit(*report.audited_pN, audit.told / kcal, audit.steps);
}

// Whether a step of the simulation makes another of its own. One that somebody ended is the run's
// last, and nothing of it is felt or recorded.
bool goes_on(const SettleReport& report) { return report.is_finite && noted_interrupt() == 0; }

SettleReport step_adaptively(Flexible& flexible, FewActive& few) {
    const TorsionModel& model = flexible.model;
    const AdaptiveSettings& settings = few.settings;
    AdaptiveStatics& statics = few.statics;
    TorsionState& state = flexible.state;
    SettleReport report;
    const std::size_t evaluations = statics.memory.evaluations, renewals = statics.renewals;
    const double before = state.energy();
    report.is_finite = update_adaptive_forces(model, settings, state, statics);
    report.hand_work = state.energy() - before;
    report.steps = few.exactness ? few.exactness->effort().steps : flexible.settings.steps;
    // Many steps where all is at rest leave nothing of h but what rounding did not take.
    if (few.exactness) statics.h = std::max(statics.h, settings.step.first_h);
    for (std::size_t i = 0; i < report.steps && goes_on(report); ++i) {
        if (statics.steps_since_choice >= settings.choose_every) prepare_choice(flexible, few);
        const AdaptiveReport step = step_adaptive(model, settings, state, statics);
        report.is_finite = step.step.is_finite;
        report.is_chosen = report.is_chosen || step.is_chosen;
        if (step.step.is_taken) report.largest_move += step.step.largest_move;
    }
    report.energy_change = state.energy() - before - report.hand_work;
    report.is_renewed = statics.renewals != renewals;
    report.evaluations = statics.memory.evaluations - evaluations;
    report.active = find_active_freedom(model, statics);
    report.total = statics.selection.total;
    report.neglected = statics.selection.neglected;
    report.is_finite = report.is_finite && std::isfinite(state.energy());
    if (report.is_finite) {
        keep_held(flexible, few);
        update_audit(flexible, few, report);
    } else {
        take_back(flexible, few);
    }
    return report;
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
    const std::uint32_t in_hand = molecules_of(bodies)[bodies.body_of[grabbed.reference_atom]];
    std::vector<MoleculeBase> bases = find_bases(bodies, parts);
    const MoleculeBase held = bases[in_hand];
    if (is_moved) bases[in_hand].freedom = BaseFreedom::Free;
    const TorsionModel loose = build_torsion_model(
        bodies, connectivity.mass, {positions.begin(), positions.end()}, topology, bases);
    TorsionState rest = build_torsion_state(loose);
    QuasiStatics statics = build_quasi_statics(loose);
    RelaxSettings to_rest;
    to_rest.step.forces = build_settings(scene).step.forces;
    to_rest.force_tolerance = scene.statics.rest_kcal_per_mol;
    to_rest.steps = static_cast<std::size_t>(scene.statics.relax_steps);
    const JointRelaxReport relaxed = relax_joints(loose, to_rest, rest, statics, on_relax);
    if (relaxed.end == RelaxEnd::NotFinite) {
        throw LoadError(scene.place_of("molecules"),
                        "the energy at the start is not finite; expected atoms apart from each "
                        "other, and charges and parameters of molecules");
    }

    bases[in_hand] = held;
    TorsionModel model =
        build_torsion_model(bodies, connectivity.mass, rest.positions, topology, bases);
    Flexible flexible = build_flexible(scene, std::move(model), in_hand, std::move(tether));
    flexible.relaxed = relaxed;
    flexible.joints = joints.joints.joints.size();
    flexible.joints_held = joints.held;
    return flexible;
}

Flexible build_flexible(const SceneDescription& scene, TorsionModel model, std::uint32_t grabbed,
                        std::optional<Tether> tether) {
    Flexible result;
    result.grabbed = grabbed;
    result.settings = build_settings(scene);
    result.model = std::move(model);
    join_fixed(result.grabbed, result.model);
    result.state = build_torsion_state(result.model);
    result.statics = build_quasi_statics(result.model);
    result.joints = result.model.tree.bodies.joints();
    if (tether) {
        result.state.tether = std::move(tether);
        result.state.tether->place =
            find_tethered(result.model, *result.state.tether, result.state.positions);
    }
    if (is_adaptive(scene, result.model)) {
        FewActive& few = result.adaptive.emplace();
        few.settings = build_adaptive_settings(scene.statics, result.settings.step);
        few.statics = build_adaptive_statics(result.model);
        const JointWeights weights = scene.statics.weights;
        few.is_near_hand = weights == JointWeights::NearHand;
        if (weights == JointWeights::Light || weights == JointWeights::NearHand) {
            few.lightness = find_lightness(result.model);
            // What is in the hand weighs nothing.
            few.lightness[result.model.tree.bases[result.grabbed]] = 1;
            few.settings.factors = few.lightness;
        }
        few.choose_every = few.settings.choose_every;
        if (scene.statics.budget_us) few.budget.emplace(*scene.statics.budget_us);
        if (const auto within_pN = scene.coupling.feel_within_pN) {
            few.exactness.emplace(
                *within_pN, Effort{few.settings.limits.degrees_of_freedom, result.settings.steps},
                static_cast<std::size_t>(result.model.coordinates), few.budget.has_value());
        }
    }
    start_flexible(result);
    return result;
}

void start_flexible(Flexible& flexible) {
    if (flexible.adaptive) {
        FewActive& few = *flexible.adaptive;
        prepare_choice(flexible, few);
        if (!flexible.state.tether) few.statics.is_guided[flexible.grabbed] = 1;
        // What has no numbers is told by the first step.
        (void)update_adaptive_forces(flexible.model, few.settings, flexible.state, few.statics);
        keep_held(flexible, few);
        return;
    }
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
    } else if (flexible.adaptive) {
        shift_base(flexible.model, flexible.grabbed, by, flexible.state,
                   flexible.adaptive->statics);
    } else {
        shift_base(flexible.model, flexible.grabbed, by, flexible.state);
    }
}

SettleReport step_flexible(Flexible& flexible) {
    if (flexible.adaptive) return step_adaptively(flexible, *flexible.adaptive);
    const TorsionModel& model = flexible.model;
    const RelaxSettings& settings = flexible.settings;
    TorsionState& state = flexible.state;
    SettleReport report;
    const std::size_t evaluations = flexible.statics.memory.evaluations;
    const double before = flexible.safe.energy();
    if (settings.method == RelaxMethod::QuasiStatic) {
        update_forces(model, settings.step.forces, flexible.statics.memory, state);
        report.hand_work = state.energy() - before;
        for (std::size_t i = 0; i < settings.steps && goes_on(report); ++i) {
            const QuasiStaticReport step =
                step_quasi_static(model, settings.step, state, flexible.statics);
            report.is_finite = step.is_finite;
            if (step.is_taken) report.energy_change += step.energy_change;
        }
    } else {
        const JointRelaxReport relaxed =
            relax_joints(model, settings, state, flexible.statics,
                         [](const RelaxProgress&) { return noted_interrupt() == 0; });
        report.hand_work = relaxed.energy_before - before;
        report.energy_change = relaxed.energy_after - relaxed.energy_before;
        report.is_finite = relaxed.end != RelaxEnd::NotFinite;
    }
    report.evaluations = flexible.statics.memory.evaluations - evaluations;
    report.active = static_cast<std::size_t>(model.coordinates);
    report.steps = settings.steps;
    report.is_finite = report.is_finite && std::isfinite(state.energy());
    if (!report.is_finite) {
        state = flexible.safe;
        return report;
    }
    report.largest_move = find_largest_move(flexible.safe.positions, state.positions);
    flexible.safe = state;
    return report;
}

std::size_t find_active_freedom(const Flexible& flexible) noexcept {
    return flexible.adaptive ? find_active_freedom(flexible.model, flexible.adaptive->statics)
                             : static_cast<std::size_t>(flexible.model.coordinates);
}

void note_time(Flexible& flexible, const SettleReport& report, double took_us) noexcept {
    if (!flexible.adaptive || !flexible.adaptive->budget) return;
    if (report.is_audited) return;
    TimeBudget& budget = *flexible.adaptive->budget;
    if (report.is_chosen || report.is_renewed) {
        budget.add_choice(took_us);
    } else {
        budget.add_step(took_us);
    }
}

Vec6 find_pull_on_held(const Flexible& flexible) noexcept {
    if (flexible.adaptive) return find_wrench_on(flexible.adaptive->statics, flexible.grabbed);
    // What atoms of the molecule do to each other adds up to nothing.
    const TorsionModel& model = flexible.model;
    Vec6 wrench = Vec6::Zero();
    for (std::size_t i = 0; i < flexible.state.forces.size(); ++i) {
        if (model.tree.molecule_of[model.tree.bodies.body_of[i]] != flexible.grabbed) continue;
        wrench.head<3>() += flexible.state.positions[i].cross(flexible.state.forces[i]);
        wrench.tail<3>() += flexible.state.forces[i];
    }
    return wrench;
}

Vec3 find_force_on_held(const Flexible& flexible) noexcept {
    if (flexible.adaptive && !flexible.state.tether)
        return find_wrench_on(flexible.adaptive->statics, flexible.grabbed).tail<3>();
    return find_force_on_held(flexible.model, flexible.state, flexible.grabbed);
}

void copy_positions(Flexible& flexible, std::vector<Vec3>& positions) {
    if (!flexible.adaptive) {
        positions = flexible.state.positions;
        return;
    }
    FewActive& few = *flexible.adaptive;
    AdaptiveStatics& statics = few.statics;
    if (!statics.is_built || few.copied != statics.rebuilds) {
        positions = flexible.state.positions;
        few.copied = statics.rebuilds;
    } else {
        for (std::size_t c = 0; c < statics.has_moved.size(); ++c) {
            if (statics.has_moved[c] == 0) continue;
            for (const std::uint32_t i : atoms_of(statics.clusters, c))
                positions[i] = flexible.state.positions[i];
        }
    }
    std::ranges::fill(statics.has_moved, std::uint8_t{0});
}

}  // namespace palpa
