#include "tools/lab/experiments/ligand_comparison.h"

#include "charmm/build_topology.h"
#include "charmm/complete.h"
#include "charmm/find_parameters.h"
#include "charmm/generate.h"
#include "core/units.h"
#include "field/pair_field.h"
#include "forces/minimise.h"
#include "ligands/approximate.h"
#include "molecule/atoms.h"
#include "molecule/element.h"
#include "prepare/build_positions.h"
#include "tools/lab/experiments/water_dimer.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

namespace palpa {
namespace {

// Three heavy atoms in a row, about where they belong; the others follow from IC tables.
void place_first(const ModelCompound& compound, std::vector<Vec3>& places) {
    for (std::uint32_t middle = 0; middle < compound.graph.size(); ++middle) {
        std::vector<std::uint32_t> ends;
        for (const std::uint32_t bond : compound.seen.bonds[middle]) {
            const std::uint32_t end = other_end(compound.graph.bonds[bond], middle);
            if (!compound.graph.is_hydrogen(end)) ends.push_back(end);
        }
        if (compound.graph.is_hydrogen(middle) || ends.size() < 2) continue;
        places[middle] = Vec3::Zero();
        places[ends[0]] = Vec3(1.45, 0, 0);
        places[ends[1]] = Vec3(-0.6, 1.3, 0);
        return;
    }
}

// The residue alone, where its own parameters relax it.
std::vector<Vec3> build_places(const ForceField& force_field, const ModelCompound& compound) {
    const std::string& name = compound.name;
    const Residue& residue = force_field.residues.at(name);
    Structure structure;
    structure.file = name;
    for (const ResidueAtom& atom : residue.atoms) {
        structure.names.push_back({"LIG", name, "1", atom.name});
        structure.positions.push_back(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
        structure.lines.push_back(0);
    }
    place_first(compound, structure.positions);
    const Connectivity connectivity = build_connectivity(force_field, structure);
    const Topology topology = build_topology(connectivity, force_field);
    (void)build_positions(connectivity, topology, find_internal_coordinates(force_field, structure),
                          structure.positions);
    MinimiseSettings settings;
    settings.steps = 1000;
    settings.force_tolerance = 0.01;
    (void)minimise(topology, settings, {}, structure.positions);
    return structure.positions;
}

// What a pair energy needs of a molecule.
struct PairNumbers {
    std::vector<double> charge, sqrt_epsilon, half_rmin;
};

PairNumbers numbers_of(const ForceField& force_field, const Residue& residue) {
    PairNumbers numbers;
    for (const ResidueAtom& atom : residue.atoms) {
        const NonbondedType& type = force_field.nonbonded.at(atom.type);
        numbers.charge.push_back(atom.charge);
        numbers.sqrt_epsilon.push_back(std::sqrt(type.epsilon));
        numbers.half_rmin.push_back(type.half_rmin);
    }
    return numbers;
}

double energy(const RigidWater& water, const std::vector<Vec3>& water_places,
              const PairNumbers& numbers, const std::vector<Vec3>& places) {
    return evaluate_pair_field({water_places, water.charge, water.sqrt_epsilon, water.half_rmin},
                               {places, numbers.charge, numbers.sqrt_epsilon, numbers.half_rmin},
                               {units::charmm_coulomb_constant})
        .energy();
}

bool is_acceptor(const ModelCompound& compound, std::uint32_t atom) {
    const std::string& element = compound.graph.atoms[atom].element;
    const bool is_halogen = element == "F" || element == "CL" || element == "BR" || element == "I";
    return (is_polar(element) || is_halogen) && compound.seen.bonds[atom].size() <= 2;
}

// Away from an atom's neighbours; nothing where they are all around it.
std::optional<Vec3> way_out(const ModelCompound& compound, const std::vector<Vec3>& places,
                            std::uint32_t atom) {
    Vec3 way = Vec3::Zero();
    for (const std::uint32_t bond : compound.seen.bonds[atom]) {
        way += (places[atom] - places[other_end(compound.graph.bonds[bond], atom)]).normalized();
    }
    if (way.norm() < 0.1) return std::nullopt;
    return way.normalized();
}

// The water's O, and its hydrogens: both away from the residue, or one towards it.
std::vector<Vec3> build_water(const RigidWater& water, const Vec3& oxygen, const Vec3& way,
                              bool gives) {
    const Vec3 aside = way.unitOrthogonal();
    if (!gives) {
        const double half = water.angle / 2;
        return {oxygen, oxygen + water.bond * (std::cos(half) * way + std::sin(half) * aside),
                oxygen + water.bond * (std::cos(half) * way - std::sin(half) * aside)};
    }
    return {oxygen, oxygen - water.bond * way,
            oxygen - water.bond * (std::cos(water.angle) * way - std::sin(water.angle) * aside)};
}

bool has_room(const std::vector<Vec3>& water, const std::vector<Vec3>& places) {
    constexpr double least = 1.6;  // Å
    return std::all_of(water.begin(), water.end(), [&](const Vec3& a) {
        return std::all_of(places.begin(), places.end(),
                           [&](const Vec3& b) { return (a - b).norm() > least; });
    });
}

std::vector<WaterPose> compare_poses(const ModelCompound& compound, const RigidWater& water,
                                     const std::vector<Vec3>& places, const PairNumbers& own,
                                     const PairNumbers& approximate) {
    std::vector<WaterPose> poses;
    const auto add = [&](std::uint32_t atom, const std::vector<Vec3>& at) {
        if (!has_room(at, places)) return;
        poses.push_back({compound.graph.atoms[atom].name, energy(water, at, own, places),
                         energy(water, at, approximate, places)});
    };
    for (std::uint32_t atom = 0; atom < compound.graph.size(); ++atom) {
        const auto way = way_out(compound, places, atom);
        if (!way) continue;
        const std::string& element = compound.graph.atoms[atom].element;
        if (element == "H") {
            const std::uint32_t heavy =
                other_end(compound.graph.bonds[compound.seen.bonds[atom][0]], atom);
            if (!is_polar(compound.graph.atoms[heavy].element)) continue;
            add(atom, build_water(water, places[atom] + 1.9 * *way, *way, false));
        } else if (is_acceptor(compound, atom)) {
            const double gap = element == "N" || element == "O" ? 2.8 : 3.3;
            add(atom, build_water(water, places[atom] + gap * *way, *way, true));
        }
    }
    return poses;
}

LigandComparison compare(const ForceField& force_field, const LigandModel& model,
                         const RigidWater& water, const ModelCompound& compound) {
    ForceField copy = force_field;
    MoleculeGraph graph = compound.graph;
    copy.residues.erase(graph.name);
    const ApproximateLigand made = approximate_ligand(graph, model, copy);
    LigandComparison result;
    result.residue = compound.name;
    result.atoms = graph.size();
    result.analogies = made.analogies.size();
    for (const Analogy& analogy : made.analogies) {
        result.highest_penalty = std::max(result.highest_penalty, analogy.penalty);
    }
    double squares = 0;
    for (std::size_t i = 0; i < graph.size(); ++i) {
        const bool is_right = made.types[i].type == compound.types[i];
        const bool is_heavy = !graph.is_hydrogen(i);
        result.right_types += is_right ? 1 : 0;
        result.heavy += is_heavy ? 1 : 0;
        result.right_heavy += is_heavy && is_right ? 1 : 0;
        if (!is_right) {
            result.wrong.push_back({graph.atoms[i].name, compound.types[i], made.types[i].type});
        }
        squares += std::pow(made.charges[i] - compound.charges[i], 2);
    }
    result.charge_rms = std::sqrt(squares / static_cast<double>(graph.size()));
    result.poses = compare_poses(compound, water, build_places(force_field, compound),
                                 numbers_of(force_field, force_field.residues.at(compound.name)),
                                 numbers_of(copy, made.residue));
    return result;
}

}  // namespace

double LigandComparison::pose_rms() const noexcept {
    double squares = 0;
    for (const WaterPose& pose : poses) squares += std::pow(pose.approximate - pose.own, 2);
    return poses.empty() ? 0 : std::sqrt(squares / static_cast<double>(poses.size()));
}

std::vector<std::string> choose_compounds(const ForceField& force_field, std::size_t count) {
    std::vector<std::string> eligible;
    for (const ModelCompound& compound : find_model_compounds(force_field)) {
        std::size_t heavy = 0;
        for (std::size_t i = 0; i < compound.graph.size(); ++i) {
            heavy += compound.graph.is_hydrogen(i) ? 0 : 1;
        }
        const Residue& residue = force_field.residues.at(compound.name);
        constexpr std::size_t least = 6;
        if (heavy >= least && residue.lone_pair_line == 0 &&
            residue.atoms.size() == compound.graph.size()) {
            eligible.push_back(compound.name);
        }
    }
    std::vector<std::string> chosen;
    for (std::size_t i = 0; i < std::min(count, eligible.size()); ++i) {
        chosen.push_back(eligible[i * eligible.size() / std::min(count, eligible.size())]);
    }
    return chosen;
}

std::vector<LigandComparison> compare_ligands(const ForceField& force_field,
                                              const std::vector<std::string>& residues) {
    if (!force_field.residues.contains("TIP3")) {
        throw LoadError(
            {"TIP3"},
            "the residue TIP3 is missing; expected toppar_water_ions.str among the files");
    }
    const RigidWater water = find_water(force_field);
    const LigandModel model = build_ligand_model(force_field, residues);
    std::vector<LigandComparison> results;
    for (const std::string& name : residues) {
        const auto compound = force_field.residues.contains(name)
                                  ? find_model_compound(force_field, name)
                                  : std::nullopt;
        if (!compound || compound->graph.size() != force_field.residues.at(name).atoms.size()) {
            throw LoadError({name},
                            "is not a model compound; expected a residue with CGenFF types only, "
                            "without lone pairs, whose valences agree with its charge");
        }
        results.push_back(compare(force_field, model, water, *compound));
    }
    return results;
}

}  // namespace palpa
