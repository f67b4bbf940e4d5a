#include "simulation/mechanics.h"

#include "core/load_error.h"
#include "simulation/bonded_terms.h"
#include "simulation/coupling.h"
#include "simulation/grip_queries.h"
#include "simulation/region.h"
#include "simulation/solver.h"
#include "simulation/systems/gather_springs.h"
#include "simulation/systems/relax.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace palpa {
namespace {

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
    world.set_resource(std::move(state));
    world.set_resource(Mechanics{std::make_shared<const TorsionModel>(std::move(model)),
                                 std::make_shared<const ModelAtoms>(std::move(atoms))});
    build_solver(held, world);
    start_solver(world);
}

// Keeps the present rotations of rigid molecules, since new mechanics count from identity.
void keep_orientations(World& world) {
    std::vector<std::pair<Entity, Quat>> kept;
    world.each<RigidShape>([&](Entity molecule, const RigidShape&) {
        kept.emplace_back(molecule, orientation_of(world, molecule));
        world.each<Grip>([&](Entity hand, const Grip& grip) {
            if (grip.molecule == molecule && grip.base < 0 && holds_whole(world, hand))
                kept.back().second = grip.pose.orientation;
        });
    });
    for (const auto& [molecule, orientation] : kept)
        world.write<RigidShape>(molecule)->orientation = orientation;
}

// Makes what hands hold as a whole rigid from here on.
void make_held_rigid(World& world) {
    for (const Entity hand : find_hands(world)) {
        Grip* const grip = world.write<Grip>(hand);
        if (!grip || grip->base < 0 || !holds_whole(world, hand)) continue;
        grip->pose.orientation = orientation_of(world, grip->molecule);
        set_shape(world, grip->molecule, grip->pose.orientation);
    }
}

RelaxSettings rest_settings(const World& world, std::int64_t steps) {
    RelaxSettings to_rest;
    to_rest.step.forces = build_step_settings(world).forces;
    to_rest.force_tolerance = world.resource<MechanicsSettings>().statics.rest_kcal_per_mol;
    to_rest.steps = static_cast<std::size_t>(steps);
    return to_rest;
}

void clear_mechanics(World& world) {
    make_held_rigid(world);
    keep_orientations(world);
    world.set_resource(Mechanics{});
    world.set_resource(TorsionState{});
    world.set_resource(GatheredSprings{});
    world.set_resource(Solver{});
    world.write_each<Grip>([](Entity, Grip& grip) { grip.base = -1; });
}

}  // namespace

bool needs_mechanics(const World& world) {
    if (!places_atoms(world)) return false;
    bool needs = false;
    world.each<Mobility>([&](Entity, const Mobility& mobility) {
        needs = needs || mobility.shape == Shape::Flexible || mobility.motion == Motion::Free ||
                mobility.motion == Motion::TranslateAndTurn;
    });
    world.each<Grip, Spring>([&](Entity, const Grip&, const Spring&) { needs = true; });
    return needs;
}

void rebuild_mechanics(World& world) {
    if (!places_atoms(world)) return hold_engine_atoms(world);
    if (!needs_mechanics(world)) return clear_mechanics(world);
    MechanicsPlan plan = plan_mechanics(world);
    if (plan.bodies.bodies.empty()) return clear_mechanics(world);
    keep_orientations(world);
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

JointRelaxReport relax_around_hands(World& world) {
    const Mechanics& mechanics = world.resource<Mechanics>();
    const StaticsDescription& s = world.resource<MechanicsSettings>().statics;
    QuasiStatics statics = build_quasi_statics(*mechanics.model);
    TorsionState& state = world.write<TorsionState>();
    const JointRelaxReport report =
        relax_joints(*mechanics.model, rest_settings(world, s.relax_steps), state, statics);
    put_in_table(*mechanics.model, *mechanics.atoms, state.positions,
                 world.write<AtomTable>().positions);
    return report;
}

void relax_and_build_mechanics(World& world, const RelaxProgressFunction& on_relax) {
    const StaticsDescription& s = world.resource<MechanicsSettings>().statics;
    const MechanicsPlan plan = plan_mechanics(world);
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
    const RelaxSettings to_rest = rest_settings(world, s.relaxes_start ? s.relax_steps : 0);
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
    world.set(hand, build_coupling(coupling_of(scene, 0), false));
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
    StartReport report;
    report.joints = model.tree.bodies.joints();
    world.set_resource(report);
    set_mechanics(std::move(model), {}, std::span(&held, 1), world);
    return world;
}

void move_held(World& world, const Vec3& by) {
    const Entity hand = hand_at(world, 0);
    MoleculePose pose = grip_of(world, hand).pose;
    pose.place_angstrom = held_place(world, hand) + by - grip_of(world, hand).anchor;
    place_held(world, hand, pose);
}

HeldPart held_part(const World& world) {
    const Grip& grip = grip_of(world, hand_at(world, 0));
    HeldPart held{static_cast<std::uint32_t>(grip.base), {}};
    if (const ModelSpring* const spring = spring_of(world, hand_at(world, 0)))
        held.spring = *spring;
    return held;
}

}  // namespace palpa
