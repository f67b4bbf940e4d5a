#include "simulation/solvent.h"

#include "charmm/assign_solvation.h"
#include "charmm/ionic_groups.h"
#include "core/load_error.h"
#include "forces/solvation_law.h"
#include "simulation/components.h"
#include "simulation/resources.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr const char* solvent_key = "force_field.solvent";

std::vector<std::string_view> list_types(const AtomTable& atoms) {
    std::vector<std::string_view> types;
    for (const std::uint32_t type : atoms.type) types.emplace_back(atoms.type_names[type]);
    return types;
}

void refuse_neutral_groups(const ScenePlaces& places, const AtomTable& atoms) {
    std::vector<IonicGroup> groups =
        find_ionic_groups(atoms.names, list_types(atoms), atoms.charge);
    std::erase_if(groups, [](const IonicGroup& group) { return !group.has_neutral_charges; });
    if (groups.empty()) return;
    const AtomName& first = atoms.names[groups.front().atoms.front()];
    throw LoadError(
        places.place_of(solvent_key),
        fmt::format("the scene is in vacuum, but the molecules have EEF1-SB's neutral charges ({} "
                    "of {} {} {} is neutral, {} ionic groups in all); expected solvent = "
                    "\"eef1-sb\", or topology files without them (palpa prepare --solvent none)",
                    groups.front().kind, first.segment, first.residue, first.number,
                    groups.size()));
}

void refuse_charges(const ScenePlaces& places, const AtomTable& atoms) {
    const std::vector<std::string> charged =
        find_charged(atoms.names, list_types(atoms), atoms.charge);
    if (charged.empty()) return;
    throw LoadError(places.place_of(solvent_key),
                    fmt::format("EEF1-SB needs neutral charges, but {}; expected topology files "
                                "from `palpa prepare --solvent eef1-sb`, or solvent = \"none\"",
                                fmt::join(charged, "; ")));
}

// One entry per atom: which are of molecules that the scene calls structural water.
std::vector<std::uint8_t> find_structural(const World& world) {
    const AtomTable& atoms = world.resource<AtomTable>();
    const ScenePlaces& places = world.resource<ScenePlaces>();
    const std::vector<std::string>& structural =
        world.resource<ForceFieldInUse>().structural_waters;
    const std::vector<std::uint8_t> is_water = find_water_atoms(atoms.names, atoms.mass);
    std::vector<std::uint8_t> is_structural(atoms.size(), 0);
    world.each<Molecule>([&](Entity, const Molecule& molecule) {
        if (std::ranges::find(structural, molecule.name) == structural.end()) return;
        for (std::uint32_t i = molecule.atoms.first;
             i < molecule.atoms.first + molecule.atoms.count; ++i) {
            if (is_water[i] == 0) {
                throw LoadError(
                    places.place_of(fmt::format("molecules.{}.structural_water", molecule.name)),
                    fmt::format("{} is not part of a water; expected a molecule of waters only",
                                to_string(atoms.names[i])));
            }
            is_structural[i] = 1;
        }
    });
    return is_structural;
}

}  // namespace

NonbondedSettings solvent_settings(const ForceFieldDescription& force_field) {
    NonbondedSettings settings = eef1_settings();
    settings.coulomb_constant = force_field.coulomb_constant;
    return settings;
}

ForceField with_solvent(const ForceFieldDescription& description, ForceField force_field) {
    if (description.solvent == Solvent::None) return force_field;
    return neutralise_ionic_groups(std::move(force_field));
}

void set_solvation(World& world) {
    AtomTable& atoms = world.write<AtomTable>();
    const ScenePlaces& places = world.resource<ScenePlaces>();
    atoms.solvation = {};
    const std::optional<Solvation> solvation = find_solvation(world);
    if (!solvation) return refuse_neutral_groups(places, atoms);
    refuse_charges(places, atoms);
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const SolvationAtom atom = solvation_atom(*solvation, i);
        atoms.solvation.volume.push_back(atom.volume);
        atoms.solvation.strength.push_back(atom.strength);
        atoms.solvation.inverse_lambda.push_back(atom.inverse_lambda);
        atoms.solvation.radius.push_back(atom.radius);
    }
}

std::optional<Solvation> find_solvation(const World& world) {
    if (world.resource<ForceFieldInUse>().description.solvent == Solvent::None) return std::nullopt;
    return assign_solvation(world.resource<AtomTable>(), eef1sb_table(), find_structural(world),
                            world.resource<ScenePlaces>().place_of(solvent_key));
}

}  // namespace palpa
