// Once per scene: files to atoms, atoms to entities, the grabbed molecule to its start.
#include "charmm/assign.h"
#include "charmm/force_field.h"
#include "core/load_error.h"
#include "formats/crd.h"
#include "simulation/components.h"
#include "simulation/probe.h"
#include "simulation/simulation.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>

namespace palpa {
namespace {

// Structure files by path; several molecules may come from one.
using Structures = std::map<std::filesystem::path, Structure>;

const Structure& find_or_read(Structures& structures, const std::filesystem::path& path) {
    const auto found = structures.find(path);
    if (found != structures.end()) return found->second;
    return structures.emplace(path, read_crd(path)).first->second;
}

std::uint32_t find_reference_atom(const MoleculeDescription& molecule, const AtomTable& atoms,
                                  AtomRange range) {
    std::uint32_t reference = 0;
    int matches = 0;
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
        if (atoms.names[i].atom != molecule.reference_atom) continue;
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
                    Structures& structures, Simulation& simulation) {
    const AtomRange range =
        add_segment_atoms(force_field, find_or_read(structures, molecule.structure),
                          molecule.segment, simulation.atoms);
    const Entity entity = simulation.world.create();
    simulation.world.set(entity, Molecule{molecule.name, range,
                                          find_reference_atom(molecule, simulation.atoms, range)});
    if (molecule.motion == Motion::AlongX) simulation.world.set(entity, LineGuide{});
    return entity;
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

void place_grabbed(const SceneDescription& scene, Simulation& simulation) {
    const Grab& grab = *simulation.world.find<Grab>(simulation.hand);
    const Molecule& grabbed = *simulation.world.find<Molecule>(grab.molecule);
    const Molecule& origin = *simulation.world.find<Molecule>(grab.measured_from);
    LineGuide& guide = *simulation.world.find<LineGuide>(grab.molecule);

    const Vec3 place = simulation.atoms.positions[grabbed.reference_atom];
    for (std::uint32_t i = 0; i < grabbed.atoms.count; ++i) {
        simulation.grabbed_shape.push_back(simulation.atoms.positions[i] - place);
    }
    const Vec3 from_origin = place - simulation.atoms.positions[origin.reference_atom];
    guide.distance = from_origin.dot(guide.axis);
    if ((from_origin - guide.distance * guide.axis).norm() > 1e-6) {
        throw LoadError(
            scene.place_of("grab.measured_from"),
            fmt::format("the reference atoms of '{}' and '{}' are not on one line along "
                        "x: they are ({}) Å apart",
                        grabbed.name, origin.name,
                        fmt::join(from_origin.begin(), from_origin.end(), ", ")));
    }

    std::optional<double> start = scene.hand.start_angstrom;
    if (!start && scene.hand.stroke == Stroke::Hold) {
        start = equilibrium_distance(simulation);
        if (!start) {
            throw LoadError(scene.place_of("hand.stroke"),
                            "'hand.stroke' is \"hold\", but there is no distance where the force "
                            "vanishes; set hand.start_angstrom");
        }
    }
    move_grabbed(simulation, start.value_or(guide.distance));
}

}  // namespace

CouplingLaws build_coupling_laws(const CouplingDescription& c) {
    const PrintedForceLaw printed_force({.F_h1 = c.F_h1_N,
                                         .F_h2 = c.F_h2_N,
                                         .F_0 = c.F_0_nN * 1e-9,
                                         .A_fmin = c.A_f_min,
                                         .A_fmax = c.A_f_max});
    const PrintedDisplacementLaw printed_displacement({.gamma = c.gamma_per_N,
                                                       .F_off = c.F_off_pN * 1e-12,
                                                       .A_dmin = c.A_d_min,
                                                       .A_dmax = c.A_d_max});
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
        case CouplingMode::Guarded:
            break;  // read_scene lets no guarded scene pass
    }
    return {ConstantForceLaw{0}, constant_displacement};
}

Simulation load_simulation(const SceneDescription& scene) {
    Simulation simulation(build_coupling_laws(scene.coupling));
    simulation.coulomb_constant = scene.force_field.coulomb_constant;
    simulation.period_s = scene.period_ms * 1e-3;

    const ForceField force_field = read_force_field(scene.force_field.files);
    Structures structures;
    Grab grab;
    for (const MoleculeDescription* const molecule : grabbed_first(scene)) {
        const Entity entity = add_molecule(*molecule, force_field, structures, simulation);
        if (molecule->name == scene.grab.molecule) grab.molecule = entity;
        if (molecule->name == scene.grab.measured_from) grab.measured_from = entity;
    }
    simulation.hand = simulation.world.create();
    simulation.world.set(simulation.hand, grab);
    place_grabbed(scene, simulation);
    return simulation;
}

FieldPoints grabbed_points(const Simulation& simulation) noexcept {
    const AtomTable& atoms = simulation.atoms;
    const std::size_t count = simulation.grabbed_shape.size();
    return {std::span(atoms.positions).first(count), std::span(atoms.charge).first(count),
            std::span(atoms.sqrt_epsilon).first(count), std::span(atoms.half_rmin).first(count)};
}

FieldPoints environment_points(const Simulation& simulation) noexcept {
    const AtomTable& atoms = simulation.atoms;
    const std::size_t from = simulation.grabbed_shape.size();
    return {std::span(atoms.positions).subspan(from), std::span(atoms.charge).subspan(from),
            std::span(atoms.sqrt_epsilon).subspan(from), std::span(atoms.half_rmin).subspan(from)};
}

}  // namespace palpa
