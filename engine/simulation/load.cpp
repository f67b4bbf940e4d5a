// Once per scene: files to atoms, atoms to entities, the grabbed molecule to its start.
#include "charmm/assign.h"
#include "charmm/build_topology.h"
#include "charmm/force_field.h"
#include "charmm/generate.h"
#include "core/load_error.h"
#include "core/stage.h"
#include "core/text.h"
#include "core/units.h"
#include "formats/psf.h"
#include "formats/structure.h"
#include "molecule/alternatives.h"
#include "simulation/components.h"
#include "simulation/probe.h"
#include "simulation/simulation.h"
#include "simulation/touch.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// Below this the grabbed molecule is at rest; relaxing goes on to a two-hundredth of it.
constexpr double resting_force = 20e-12 / units::newton_per_kcal_per_mol_angstrom;

// Files by path; several molecules may come from one.
struct Files {
    std::map<std::filesystem::path, Structure> structures;
    std::map<std::filesystem::path, Connectivity> connectivities;
};

template <class Content, class Read>
const Content& find_or_read(std::map<std::filesystem::path, Content>& files,
                            const std::filesystem::path& path, const Read& read) {
    const auto found = files.find(path);
    if (found != files.end()) return found->second;
    return files.emplace(path, read(path)).first->second;
}

Structure read_whole_structure(const std::filesystem::path& path) {
    Structure structure = read_structure(path);
    refuse_alternatives(structure);
    return structure;
}

AtomRange add_atoms(const MoleculeDescription& molecule, const ForceField& force_field,
                    Files& files, AtomTable& atoms) {
    const Structure& structure =
        find_or_read(files.structures, molecule.structure, read_whole_structure);
    if (molecule.topology.empty()) {
        return add_segment_atoms(force_field, structure, molecule.segment, atoms);
    }
    return add_segment_atoms(force_field,
                             find_or_read(files.connectivities, molecule.topology, read_psf),
                             structure, molecule.segment, atoms);
}

// By name, or by residue number and name.
std::uint32_t find_reference_atom(const MoleculeDescription& molecule, const AtomTable& atoms,
                                  AtomRange range) {
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

Entity add_molecule(const MoleculeDescription& molecule, const ForceField& force_field,
                    Files& files, Simulation& simulation) {
    const AtomRange range = add_atoms(molecule, force_field, files, simulation.atoms);
    const Entity entity = simulation.world.create();
    simulation.world.set(entity, Molecule{molecule.name, range,
                                          find_reference_atom(molecule, simulation.atoms, range)});
    return entity;
}

// Atoms and terms of all molecules, in the order of the table.
Connectivity build_scene_connectivity(const std::vector<const MoleculeDescription*>& molecules,
                                      const ForceField& force_field, Files& files) {
    Connectivity all;
    for (const MoleculeDescription* const molecule : molecules) {
        const bool has_topology = !molecule->topology.empty();
        const Connectivity& from =
            has_topology ? find_or_read(files.connectivities, molecule->topology, read_psf)
                         : find_or_read(files.connectivities, molecule->structure,
                                        [&](const std::filesystem::path& path) {
                                            return build_connectivity(force_field,
                                                                      files.structures.at(path));
                                        });
        const auto out = append_segment(from, molecule->segment, all);
        if (!out) continue;
        throw LoadError(
            {from.file, from.lines[(*out)[0]]},
            fmt::format("atoms {} and {} are bonded, across segments; expected "
                        "molecules that are not bonded to others, where any moves by "
                        "itself",
                        to_string(from.names[(*out)[0]]), to_string(from.names[(*out)[1]])));
    }
    return all;
}

// Every so many steps, what relaxing has come to; nothing where nobody waits.
RelaxProgressFunction tell_relaxing(const StageFunction& on_stage) {
    if (!on_stage) return {};
    return [&on_stage](const RelaxProgress& progress) {
        constexpr std::size_t between = 20;
        if (progress.step % between == 0) {
            on_stage(fmt::format("relaxing: step {}, {:.3f} kcal/mol, rms force {:.3g}",
                                 progress.step, progress.energy, progress.rms_force),
                     {});
        }
        return true;
    };
}

void load_flexible(const SceneDescription& scene, const ForceField& force_field, Files& files,
                   const std::vector<const MoleculeDescription*>& molecules,
                   const std::vector<Entity>& entities, const StageFunction& on_stage,
                   Simulation& simulation) {
    for (const MoleculeDescription* const a : molecules) {
        for (const MoleculeDescription* const b : molecules) {
            if (a == b || a->structure != b->structure || a->segment != b->segment) continue;
            throw LoadError(scene.place_of("molecules." + b->name + ".segment"),
                            fmt::format("'{}' and '{}' are the same atoms, segment '{}'; expected "
                                        "each segment once, where anything moves by itself",
                                        a->name, b->name, b->segment));
        }
    }
    tell(on_stage, "finding bonded terms");
    const Connectivity connectivity = build_scene_connectivity(molecules, force_field, files);
    const Topology topology = build_topology(connectivity, force_field);
    std::vector<FlexiblePart> parts;
    for (std::size_t i = 0; i < molecules.size(); ++i) {
        const Molecule& molecule = *simulation.world.find<Molecule>(entities[i]);
        parts.push_back({molecules[i], molecule.atoms, molecule.reference_atom});
    }
    tell(on_stage, "building joints and lists of neighbours");
    simulation.flexible = build_flexible(scene, connectivity, topology, simulation.atoms.positions,
                                         parts, tell_relaxing(on_stage));
    simulation.atoms.positions = simulation.flexible->state.positions;
}

std::vector<ReplacedPair> build_replaced_pairs(const ForceField& force_field,
                                               const std::vector<std::string>& types) {
    std::vector<ReplacedPair> pairs;
    for (std::uint32_t a = 0; a < types.size(); ++a) {
        for (std::uint32_t b = a; b < types.size(); ++b) {
            const auto found = force_field.nbfix.find(std::minmax(types[a], types[b]));
            if (found == force_field.nbfix.end()) continue;
            pairs.push_back({a, b, found->second.epsilon, found->second.rmin});
        }
    }
    return pairs;
}

// The grabbed molecule first, so that its environment is one range of the table.
std::vector<const MoleculeDescription*> grabbed_first(const SceneDescription& scene) {
    std::vector<const MoleculeDescription*> order;
    for (const MoleculeDescription& molecule : scene.molecules) order.push_back(&molecule);
    std::stable_partition(order.begin(), order.end(), [&](const MoleculeDescription* m) {
        return m->name == scene.grab.molecule;
    });
    return order;
}

void relax_grabbed(const SceneDescription& scene, const Molecule& grabbed, Simulation& simulation) {
    const std::span<Vec3> positions =
        std::span(simulation.atoms.positions).first(grabbed.atoms.count);
    const RelaxReport report = relax_rigid(
        positions, centre_of_mass(simulation.atoms, grabbed.atoms), grabbed_points(simulation),
        environment_points(simulation), pair_rule(simulation), resting_force / 200);
    if (!(report.force < resting_force)) {
        throw LoadError(
            scene.place_of("grab.molecule"),
            fmt::format("'{}' finds no rest where it stands: {:.3g} pN are left after {} "
                        "evaluations; expected a structure that was minimised",
                        grabbed.name, report.force * units::newton_per_kcal_per_mol_angstrom * 1e12,
                        report.evaluations));
    }
    simulation.relaxed = report;
}

// Nothing is felt from farther away, and looking for what is would take minutes.
void check_distance(const SceneDescription& scene, const Simulation& simulation) {
    constexpr double farthest = 1000;  // Å
    const double distance = (grabbed_place(simulation) - simulation.anchor).norm();
    if (distance <= farthest) return;
    throw LoadError(scene.place_of("grab.measured_from"),
                    fmt::format("the reference atoms of '{}' and '{}' are {:.6g} Å apart; expected "
                                "{} Å at most",
                                scene.grab.molecule, scene.grab.measured_from, distance, farthest));
}

// Where the hand holds a molecule on a line.
double find_start(const SceneDescription& scene, const Simulation& simulation, double distance) {
    if (scene.hand.start_angstrom) return *scene.hand.start_angstrom;
    if (scene.hand.stroke != Stroke::Hold) return distance;
    const std::optional<double> rest = equilibrium_distance(simulation);
    if (!rest) {
        throw LoadError(scene.place_of("hand.stroke"),
                        "'hand.stroke' is \"hold\", but there is no distance where the force "
                        "vanishes; set hand.start_angstrom");
    }
    return *rest;
}

void start_grabbed(const SceneDescription& scene, Simulation& simulation) {
    const Grab& grab = *simulation.world.find<Grab>(simulation.hand);
    const Molecule& grabbed = *simulation.world.find<Molecule>(grab.molecule);
    const Molecule& origin = *simulation.world.find<Molecule>(grab.measured_from);
    Guide& guide = *simulation.world.find<Guide>(grab.molecule);
    const bool on_line = guide.freedom == 1;
    if (!on_line && !simulation.flexible) relax_grabbed(scene, grabbed, simulation);

    simulation.anchor = simulation.atoms.positions[origin.reference_atom];
    const Vec3 reference = simulation.flexible ? find_held(*simulation.flexible)
                                               : simulation.atoms.positions[grabbed.reference_atom];
    for (std::uint32_t i = 0; i < grabbed.atoms.count; ++i) {
        simulation.grabbed_shape.push_back(simulation.atoms.positions[i] - reference);
    }
    const Vec3 from_origin = reference - simulation.anchor;
    if (!on_line) {
        const Vec3 offset(scene.hand.start_offset_angstrom.data());
        guide.line_origin = from_origin + Vec3(0, offset.y(), offset.z());
        move_grabbed(simulation, offset.x());
        if (simulation.flexible) start_flexible(*simulation.flexible);
        return;
    }
    if ((from_origin - from_origin.x() * Vec3::UnitX()).norm() > 1e-6) {
        throw LoadError(
            scene.place_of("grab.measured_from"),
            fmt::format("the reference atoms of '{}' and '{}' are not on one line along "
                        "x: they are ({}) Å apart",
                        grabbed.name, origin.name,
                        fmt::join(from_origin.begin(), from_origin.end(), ", ")));
    }
    move_grabbed(simulation, find_start(scene, simulation, from_origin.x()));
}

}  // namespace

namespace {

ForceLaw guarded_force_law(const CouplingDescription& c,
                           const PrintedForceLaw::Parameters& parameters) {
    if (const auto range = c.feel_pN) {
        const auto [weakest_pN, strongest_pN] = *range;
        return PerceptualForceLaw::for_range(weakest_pN * 1e-12, strongest_pN * 1e-12);
    }
    switch (c.force_law) {
        case ForceLawChoice::Printed:
            break;
        case ForceLawChoice::Calibrated:
            if (const auto law = PrintedForceLaw::find_calibrated(parameters)) return *law;
            break;  // see can_build_laws
        case ForceLawChoice::Constant:
            return ConstantForceLaw{c.A_f};
        case ForceLawChoice::Perceptual:
            return PerceptualForceLaw({.F_lo = c.F_lo_pN * 1e-12, .F_hi = c.F_hi_nN * 1e-9});
    }
    return PrintedForceLaw(parameters);
}

DisplacementLaw guarded_displacement_law(const CouplingDescription& c,
                                         const PrintedDisplacementLaw::Parameters& parameters) {
    switch (c.displacement_law) {
        case DisplacementLawChoice::Repaired:
            break;
        case DisplacementLawChoice::Printed:
            return PrintedDisplacementLaw(parameters);
        case DisplacementLawChoice::Constant:
            return ConstantDisplacementLaw{c.A_d};
    }
    return RepairedDisplacementLaw({.printed = parameters});
}

PrintedForceLaw::Parameters force_parameters(const CouplingDescription& c) {
    return {.F_h1 = c.F_h1_N,
            .F_h2 = c.F_h2_N,
            .F_0 = c.F_0_nN * 1e-9,
            .A_fmin = c.A_f_min,
            .A_fmax = c.A_f_max};
}

void check_laws(const SceneDescription& scene) {
    if (can_build_laws(scene.coupling)) return;
    throw LoadError(scene.place_of("coupling.force_law"),
                    "eq. 2 of these F_h1_N, F_h2_N, F_0_nN cannot have the slopes A_f_max at 0 and "
                    "A_f_min at F_0; expected others, or coupling.force_law = \"printed\"");
}

}  // namespace

bool can_build_laws(const CouplingDescription& c) {
    return c.mode != CouplingMode::Guarded || c.feel_pN.has_value() ||
           c.force_law != ForceLawChoice::Calibrated ||
           PrintedForceLaw::find_calibrated(force_parameters(c)).has_value();
}

CouplingLaws build_coupling_laws(const CouplingDescription& c) {
    const PrintedForceLaw printed_force(force_parameters(c));
    const PrintedDisplacementLaw::Parameters displacement{.gamma = c.gamma_per_N,
                                                          .F_off = c.F_off_pN * 1e-12,
                                                          .A_dmin = c.A_d_min,
                                                          .A_dmax = c.A_d_max};
    const PrintedDisplacementLaw printed_displacement(displacement);
    const ConstantForceLaw constant_force{c.A_f};
    const ConstantDisplacementLaw constant_displacement{c.A_d};
    switch (c.mode) {
        case CouplingMode::VariableForceVariableDisplacement:
            return {printed_force, printed_displacement};
        case CouplingMode::VariableForceConstantDisplacement:
            return {printed_force, constant_displacement};
        case CouplingMode::ConstantForceVariableDisplacement:
            return {constant_force, printed_displacement};
        case CouplingMode::ConstantForceConstantDisplacement:
            return {constant_force, constant_displacement};
        case CouplingMode::NoForce:
            break;
        case CouplingMode::Guarded:
            return {guarded_force_law(c, force_parameters(c)),
                    guarded_displacement_law(c, displacement)};
    }
    return {ConstantForceLaw{0}, constant_displacement};
}

void set_coupling(const CouplingDescription& coupling, Simulation& simulation) {
    simulation.laws = build_coupling_laws(coupling);
    simulation.is_guarded = coupling.mode == CouplingMode::Guarded;
    if (simulation.flexible && simulation.flexible->adaptive) {
        std::optional<Exactness>& exactness = simulation.flexible->adaptive->exactness;
        if (exactness && coupling.feel_within_pN)
            exactness->set_tolerance(*coupling.feel_within_pN);
    }
    simulation.pairs_per_tick = static_cast<std::size_t>(coupling.pairs_per_tick);
    update_near(simulation);
    const std::uint32_t start = simulation.touch.model.start;
    simulation.touch = build_touch(simulation, {});
    simulation.touch.model.start = start;
}

Simulation load_simulation(const SceneDescription& scene, const StageFunction& on_stage) {
    check_laws(scene);
    Simulation simulation(build_coupling_laws(scene.coupling));
    simulation.coulomb_constant = scene.force_field.coulomb_constant;
    simulation.period_s = scene.period_ms * 1e-3;

    tell(on_stage, "reading the force field");
    const ForceField force_field = read_force_field(scene.force_field.files);
    Files files;
    Grab grab;
    const std::vector<const MoleculeDescription*> molecules = grabbed_first(scene);
    std::vector<Entity> entities;
    for (const MoleculeDescription* const molecule : molecules) {
        tell(on_stage, "reading and typing atoms",
             static_cast<double>(entities.size()) / static_cast<double>(molecules.size()));
        const Entity entity = add_molecule(*molecule, force_field, files, simulation);
        if (molecule->name == scene.grab.molecule) grab.molecule = entity;
        if (molecule->name == scene.grab.measured_from) grab.measured_from = entity;
        entities.push_back(entity);
    }
    simulation.hand = simulation.world.create();
    simulation.world.set(simulation.hand, grab);
    const Motion motion = molecules.front()->motion;
    Guide guide;
    if (motion != Motion::AlongX) {
        guide.freedom = motion == Motion::WithHandle ? 6 : 3;
        guide.projector = Mat3::Identity();
    }
    simulation.world.set(grab.molecule, guide);
    simulation.replaced_pairs = build_replaced_pairs(force_field, simulation.atoms.type_names);
    if (scene.has_statics()) {
        load_flexible(scene, force_field, files, molecules, entities, on_stage, simulation);
    }
    tell(on_stage, "bringing the molecule in the hand to its start");
    start_grabbed(scene, simulation);
    check_distance(scene, simulation);
    set_coupling(scene.coupling, simulation);
    return simulation;
}

SceneSystem load_system(const SceneDescription& scene) {
    const ForceField force_field = read_force_field(scene.force_field.files);
    Files files;
    AtomTable atoms;
    const std::vector<const MoleculeDescription*> molecules = grabbed_first(scene);
    for (const MoleculeDescription* const molecule : molecules) {
        add_atoms(*molecule, force_field, files, atoms);
    }
    SceneSystem system;
    system.connectivity = build_scene_connectivity(molecules, force_field, files);
    system.topology = build_topology(system.connectivity, force_field);
    system.positions = std::move(atoms.positions);
    return system;
}

Vec3 centre_of_mass(const AtomTable& atoms, AtomRange range) noexcept {
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
        sum += atoms.mass[i] * atoms.positions[i];
        mass += atoms.mass[i];
    }
    return mass > 0 ? Vec3(sum / mass) : atoms.positions[range.first];
}

FieldPoints grabbed_points(const Simulation& simulation) noexcept {
    const Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const std::size_t count = simulation.world.find<Molecule>(grab->molecule)->atoms.count;
    const AtomTable& atoms = simulation.atoms;
    return {std::span(atoms.positions).first(count), std::span(atoms.charge).first(count),
            std::span(atoms.sqrt_epsilon).first(count), std::span(atoms.half_rmin).first(count),
            std::span(atoms.type).first(count)};
}

FieldPoints environment_points(const Simulation& simulation) noexcept {
    const std::size_t from = grabbed_points(simulation).positions.size();
    const AtomTable& atoms = simulation.atoms;
    return {std::span(atoms.positions).subspan(from), std::span(atoms.charge).subspan(from),
            std::span(atoms.sqrt_epsilon).subspan(from), std::span(atoms.half_rmin).subspan(from),
            std::span(atoms.type).subspan(from)};
}

PairRule pair_rule(const Simulation& simulation) noexcept {
    return {simulation.coulomb_constant, simulation.replaced_pairs};
}

}  // namespace palpa
