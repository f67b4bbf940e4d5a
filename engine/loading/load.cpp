#include "loading/load.h"

#include "charmm/assign.h"
#include "charmm/build_topology.h"
#include "charmm/force_field.h"
#include "charmm/generate.h"
#include "core/interrupt.h"
#include "core/load_error.h"
#include "core/stage.h"
#include "core/text.h"
#include "core/translate.h"
#include "core/units.h"
#include "loading/engine_atoms.h"
#include "loading/molecules.h"
#include "loading/named_parts.h"
#include "loading/sources.h"
#include "simulation/bonded_terms.h"
#include "simulation/components.h"
#include "simulation/coupling.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/probe.h"
#include "simulation/select_in_world.h"
#include "simulation/solvent.h"
#include "simulation/solver.h"
#include "simulation/systems/publish_contact.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// The force below which the grabbed molecule is at rest; relaxing goes on to a two-hundredth of it.
constexpr double resting_force = 20e-12 / units::newton_per_kcal_per_mol_angstrom;

// Finds it by name, or by residue number and name.
std::uint32_t find_reference_atom(const MoleculeDescription& molecule, const AtomTable& atoms,
                                  AtomRange range) {
    if (molecule.reference_atom.empty()) return range.first;  // a remote engine moves it
    const std::vector<std::string_view> words = split_words(molecule.reference_atom);
    std::uint32_t reference = 0;
    int matches = 0;
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
        const AtomName& name = atoms.names[i];
        if (words.empty() || words.size() > 2 || name.atom != words.back()) continue;
        if (words.size() == 2 && name.number != words.front()) continue;
        reference = i;
        ++matches;
    }
    if (matches != 1) {
        throw LoadError(
            {molecule.structure.string()},
            fmt::format("segment '{}' has {} atoms called '{}'; expected one, to be "
                        "the reference atom of molecule '{}'",
                        molecule.segment, matches, molecule.reference_atom, molecule.name));
    }
    return reference;
}

void add_molecule(const SceneDescription& scene, const MoleculeDescription& molecule,
                  const ForceField& force_field, SourceFiles& files, World& world) {
    AtomTable& atoms = world.write<AtomTable>();
    Source source =
        scene.engine
            ? find_engine_source(molecule.structure, molecule.topology, molecule.segment, files)
            : find_source(molecule.structure, molecule.topology, molecule.segment, files);
    source.loaded_as = molecule.name;
    const AtomRange range = scene.engine ? add_engine_atoms(source, atoms)
                                         : add_segment_atoms(force_field, source, atoms);
    const std::uint32_t reference = find_reference_atom(molecule, atoms, range);
    const Entity entity = create_molecule(world, {molecule.name, range, reference},
                                          {molecule.motion, molecule.shape}, std::move(source));
    const Appearance& look = molecule.appearance;
    if (look.representation || look.colouring || !look.visible) world.set(entity, look);
}

// Reports the state of relaxation every so many steps; empty if nobody waits.
RelaxProgressFunction tell_relaxing(const StageFunction& on_stage) {
    if (!on_stage) return {};
    return [&on_stage](const RelaxProgress& progress) {
        constexpr std::size_t between = 20;
        if (progress.step % between == 0) {
            on_stage(fmt::format("relaxing: step {}, {:.3f} kcal/mol, rms force {:.3g}",
                                 progress.step, progress.energy, progress.rms_force),
                     {});
        }
        return noted_interrupt() == 0;
    };
}

void relax_grabbed(const SceneDescription& scene, const HandTables& tables, Entity hand,
                   World& world) {
    const Molecule& grabbed = *world.find<Molecule>(grip_of(world, hand).molecule);
    AtomTable& atoms = world.write<AtomTable>();
    std::vector<std::uint32_t> others;
    for (const AtomRange& range : environment_of(world, hand)) {
        for (std::uint32_t i = 0; i < range.count; ++i) others.push_back(range.first + i);
    }
    const GatheredPoints environment(atoms, others);
    const RelaxReport report =
        relax_rigid(std::span(atoms.positions).subspan(grabbed.atoms.first, grabbed.atoms.count),
                    centre_of_mass(atoms, grabbed.atoms), held_points(world, hand),
                    environment.view(), pair_rule(world), resting_force / 200);
    if (!(report.force < resting_force)) {
        throw LoadError(
            scene.place_of(tables.grab_key + ".molecule"),
            fmt::format("'{}' does not come to rest: a force of {:.3g} pN remains after {} "
                        "evaluations; expected a minimised structure",
                        grabbed.name, report.force * units::newton_per_kcal_per_mol_angstrom * 1e12,
                        report.evaluations));
    }
    std::optional<RelaxReport>& rigid = world.write<StartReport>().rigid;
    if (!rigid) rigid = report;
}

// Refuses a start so far away that nothing is felt, where a search for atoms would take minutes.
void check_distance(const SceneDescription& scene, const HandTables& tables, Entity hand,
                    const World& world) {
    constexpr double farthest = 1000;  // Å
    const double distance = (held_place(world, hand) - grip_of(world, hand).anchor).norm();
    if (distance <= farthest) return;
    throw LoadError(
        scene.place_of(tables.grab_key + ".measured_from"),
        fmt::format("the reference atoms of '{}' and '{}' are {:.6g} Å apart; expected "
                    "{} Å at most",
                    tables.grab.molecule, tables.grab.measured_from, distance, farthest));
}

// The distance at which the hand holds a molecule on a line.
double find_start(const SceneDescription& scene, const HandTables& tables, Entity hand,
                  const World& world, double distance) {
    if (tables.hand.start_angstrom) return *tables.hand.start_angstrom;
    if (tables.hand.stroke != Stroke::Hold) return distance;
    const std::optional<double> rest = equilibrium_distance(world, hand);
    if (!rest) {
        throw LoadError(scene.place_of(tables.hand_key + ".stroke"),
                        fmt::format("'{0}.stroke' is \"hold\", but there is no distance where the "
                                    "force vanishes; set {0}.start_angstrom",
                                    tables.hand_key));
    }
    return *rest;
}

void start_grabbed(const SceneDescription& scene, const HandTables& tables, Entity hand,
                   World& world) {
    Grip& grip = *world.write<Grip>(hand);
    const Molecule& grabbed = *world.find<Molecule>(grip.molecule);
    const Molecule& origin = *world.find<Molecule>(grip.measured_from);
    const bool on_line = grip.freedom == 1;
    const bool is_rigid = !is_mobile(world, hand);
    if (!on_line && is_rigid && scene.statics.relaxes_start)
        relax_grabbed(scene, tables, hand, world);

    grip.anchor = world.resource<AtomTable>().positions[origin.reference_atom];
    if (is_rigid) set_shape(world, grip.molecule);
    const Vec3 from_origin = held_place(world, hand) - grip.anchor;
    if (!on_line) {
        const Vec3 offset(tables.hand.start_offset_angstrom.data());
        const auto& end = tables.grab.place_angstrom;
        const Vec3 start = end ? Vec3(Vec3(end->data()) - grip.anchor) : from_origin;
        grip.line_origin = start + Vec3(0, offset.y(), offset.z());
        move_grabbed(world, offset.x(), hand);
        grip.is_new = false;
        return;
    }
    if ((from_origin - from_origin.x() * Vec3::UnitX()).norm() > 1e-6) {
        throw LoadError(scene.place_of(tables.grab_key + ".measured_from"),
                        fmt::format("the reference atoms of '{}' and '{}' are not on a line along "
                                    "x: they are ({}) Å apart in x, y and z",
                                    grabbed.name, origin.name,
                                    fmt::join(from_origin.begin(), from_origin.end(), ", ")));
    }
    move_grabbed(world, find_start(scene, tables, hand, world, from_origin.x()), hand);
    grip.is_new = false;
}

// The atoms of an atom or residue of a molecule that the scene names at `place`.
std::vector<std::uint32_t> find_named_atoms(const World& world, Entity molecule,
                                            const std::string& name, const TextPlace& place) {
    std::vector<std::uint32_t> atoms = atoms_called(world, molecule, name);
    if (atoms.empty()) {
        throw LoadError(place, fmt::format("'{}' has no atom or residue \"{}\"; expected \"25 CA\" "
                                           "or \"25\"",
                                           world.find<Molecule>(molecule)->name, name));
    }
    return atoms;
}

// Springs from atoms of a molecule to where its structure has them; they act while it moves by
// itself.
void add_anchors(const SceneDescription& scene, const MoleculeDescription& molecule, World& world) {
    if (molecule.anchors.empty()) return;
    const TextPlace place = scene.place_of(fmt::format("molecules.{}.anchors", molecule.name));
    const Entity entity = molecule_called(world, molecule.name);
    for (const std::string& name : molecule.anchors) {
        Spring spring;
        spring.ends.push_back({entity, find_named_atoms(world, entity, name, place)});
        spring.place = middle_of(world, spring.ends.front());
        spring.k = molecule.anchor_kcal_per_mol_angstrom2;
        world.set(world.create(), std::move(spring));
    }
}

// Adds the springs that act and the atoms that are marked from the start.
void add_restraints_and_pins(const SceneDescription& scene, World& world) {
    for (const StartRestraint& restraint : scene.restraints)
        name_place(restraint.place, [&] {
            const Spring spring = build_spring(world, restraint);
            if (spring.k > 0) world.set(world.create(), spring);
        });
    for (const StartPin& pin : scene.pins)
        name_place(pin.place, [&] { world.set(world.create(), build_mark(world, pin)); });
}

// Atoms that the hand holds by a spring at first; none if it holds the molecule as a whole.
AtomsOf find_part_at_first(const SceneDescription& scene, const HandTables& tables,
                           const World& world) {
    AtomsOf part{molecule_called(world, tables.grab.molecule), {}};
    if (!tables.grab.atom.empty()) {
        part.atoms = find_named_atoms(world, part.molecule, tables.grab.atom,
                                      scene.place_of(tables.grab_key + ".atom"));
    } else if (scene.engine) {
        part.atoms = all_atoms_of(world, part.molecule);
    }
    return part;
}

// The grip of the hand at first.
Grip build_grip(const SceneDescription& scene, const HandTables& tables, bool is_whole,
                const World& world) {
    const GrabDescription& grab = tables.grab;
    Grip grip;
    grip.molecule = molecule_called(world, grab.molecule);
    grip.measured_from =
        molecule_called(world, grab.measured_from.empty() ? grab.molecule : grab.measured_from);
    const Mobility& mobility = *world.find<Mobility>(grip.molecule);
    grip.before = mobility;
    if (is_whole) grip.before.motion = scene.has_statics() ? Motion::Free : Motion::Fixed;
    if (grab.released) grip.before.motion = *grab.released;
    if (mobility.motion == Motion::AlongX && !scene.engine) return grip;
    grip.freedom = mobility.motion == Motion::WithHandle && !scene.engine ? 6 : 3;
    grip.projector = Mat3::Identity();
    return grip;
}

// Sets the grip, and the spring if the hand holds a part. Throws LoadError if another hand holds
// the molecule as a whole, too.
void set_grip(const SceneDescription& scene, const HandTables& tables, Entity hand, World& world) {
    AtomsOf part = find_part_at_first(scene, tables, world);
    const bool is_whole = part.atoms.empty();
    Grip grip = build_grip(scene, tables, is_whole, world);
    world.write_each<Grip>([&](Entity holder, Grip& other) {
        if (other.molecule != grip.molecule) return;
        // The hand that holds it as a whole knows its mobility without hands.
        (is_whole ? other : grip).before = (is_whole ? grip : other).before;
        if (!holds_whole(world, holder) || !is_whole) return;
        throw LoadError(scene.place_of(tables.grab_key + ".molecule"),
                        fmt::format("two hands hold '{0}' as a whole; expected another molecule, "
                                    "or one of them to hold an atom or a residue of it by a "
                                    "spring ({1}.atom)",
                                    tables.grab.molecule, tables.grab_key));
    });
    world.set(hand, Hand{.turns = grip.freedom == 6});
    world.set(hand, std::move(grip));
    if (!is_whole)
        hold_by_spring(world, hand, std::move(part), tables.grab.spring_kcal_per_mol_angstrom2);
}

// Creates the hands in the order of their devices.
void add_hands(const SceneDescription& scene, World& world) {
    std::size_t slot = 0;
    const std::string& first_origin = scene.hands.front().grab.measured_from;
    for (const HandTables& tables : list_hands(scene)) {
        const Entity hand = world.create();
        world.set(hand,
                  build_coupling(coupling_of(scene, slot++), tables.hand.coupling.has_value()));
        const GrabDescription& grab = tables.grab;
        world.set(hand, GripSettings{grab.measured_from.empty() ? first_origin : grab.measured_from,
                                     grab.spring_kcal_per_mol_angstrom2,
                                     Vec3(tables.hand.start_offset_angstrom.data())});
        if (grab.molecule.empty()) {
            world.set(hand, Hand{.turns = !scene.has_statics()});
            world.set(hand, Contact{build_still_contact(world), {}});
        } else {
            set_grip(scene, tables, hand, world);
            world.set(hand, Contact{});
        }
    }
}

void start_hands(const SceneDescription& scene, World& world) {
    const std::vector<HandTables> tables = list_hands(scene);
    const std::vector<Entity> hands = find_hands(world);
    const auto for_full_hands = [&](const auto& function) {
        for (std::size_t i = 0; i < hands.size(); ++i)
            if (world.find<Grip>(hands[i])) function(scene, tables[i], hands[i], world);
    };
    for_full_hands(start_grabbed);
    start_solver(world);
    for_full_hands(check_distance);
}

void set_settings(const SceneDescription& scene, std::shared_ptr<const ForceField> force_field,
                  World& world) {
    world.set_resource(SceneFile{std::make_shared<const SceneDescription>(scene)});
    world.set_resource(ScenePlaces{scene.file, scene.places});
    ForceFieldInUse in_use{scene.force_field, std::move(force_field), {}};
    for (const MoleculeDescription& molecule : scene.molecules)
        if (molecule.structural_water) in_use.structural_waters.push_back(molecule.name);
    world.set_resource(std::move(in_use));
    MechanicsSettings mechanics{scene.joints, scene.statics};
    if (mechanics.joints.around.empty())
        mechanics.joints.around = scene.hands.front().grab.molecule;
    world.set_resource(std::move(mechanics));
}

// Molecules as files have them; nobody holds anything.
World read_world(const SceneDescription& scene, const StageFunction& on_stage) {
    World world;
    world.set_resource(AtomTable{});
    world.set_resource(AtomEdition{});
    world.set_resource(Clock{scene.period_ms * 1e-3});
    world.set_resource(BondedTerms{});
    world.set_resource(Mechanics{});
    world.set_resource(TorsionState{});
    world.set_resource(GatheredSprings{});
    world.set_resource(StartReport{});
    world.set_resource(StepReport{});

    tell(on_stage, for_translation("reading the force field"));
    auto force_field = std::make_shared<const ForceField>(
        with_solvent(scene.force_field, read_force_field(scene.force_field.files)));
    SourceFiles files;
    for (const MoleculeDescription& molecule : scene.molecules) {
        tell(on_stage, for_translation("reading and typing atoms"),
             static_cast<double>(world.entity_count()) /
                 static_cast<double>(scene.molecules.size()));
        add_molecule(scene, molecule, *force_field, files, world);
    }
    set_settings(scene, std::move(force_field), world);
    set_interactions(world);
    return world;
}

void check_laws(const SceneDescription& scene) {
    std::string key = "coupling.force_law";
    bool can = can_build_laws(scene.coupling);
    for (const HandTables& tables : list_hands(scene)) {
        if (!can || !tables.hand.coupling || can_build_laws(*tables.hand.coupling)) continue;
        can = false;
        key = tables.hand_key + "." + key;
    }
    if (can) return;
    throw LoadError(scene.place_of(key), why_no_laws);
}

}  // namespace

World load_world(const SceneDescription& scene, const StageFunction& on_stage) {
    check_laws(scene);
    World world = read_world(scene, on_stage);
    add_hands(scene, world);
    if (scene.engine) {
        set_remote_engine(*scene.engine, find_engine_atoms(scene, world.resource<AtomTable>()),
                          world);
        hold_engine_atoms(world);
    }
    for (const MoleculeDescription& molecule : scene.molecules) add_anchors(scene, molecule, world);
    add_restraints_and_pins(scene, world);
    if (needs_mechanics(world)) {
        tell(on_stage, for_translation("finding bonded terms"));
        bonded_terms(world);
        tell(on_stage, for_translation("building joints and neighbour lists"));
        relax_and_build_mechanics(world, tell_relaxing(on_stage));
    }
    tell(on_stage, for_translation("moving the molecule in the hand to its start"));
    start_hands(scene, world);
    std::vector<Entity> molecules;
    world.each<Molecule>([&](Entity molecule, const Molecule&) { molecules.push_back(molecule); });
    for (const Entity molecule : molecules) set_start_places(world, molecule);
    set_couplings(scene, world);
    (void)find_empty_selections(scene.view, world);  // throws for those that are none
    return world;
}

World load_again(const World& world) { return load_world(*world.resource<SceneFile>().scene); }

SceneSystem load_system(const SceneDescription& scene) {
    World world = read_world(scene, {});
    const BondedTerms& terms = bonded_terms(world);
    return {*terms.connectivity, *terms.topology, world.resource<AtomTable>().positions};
}

}  // namespace palpa
