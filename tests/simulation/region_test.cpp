// Only what is around the hand moves, and the mechanics have no more atoms than that needs.
#include "simulation/region.h"
#include "session/undo_history.h"

#include "assembly/bodies.h"
#include "assembly/joints.h"
#include "loading/edit.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "simulation/step.h"
#include "statics/second_order_step.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "tests/support/world_bytes.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;
using test::world_bytes;

namespace {

using BondAtoms = std::array<std::uint32_t, 2>;

constexpr double reach = 6, cutoff = 9;  // Å

// The flap of HIV-1 protease on a spring, over the inhibitor, which is free; chains are fixed but
// for what is near.
SceneDescription read_flap(std::vector<std::string> settings = {}) {
    for (const char* const setting :
         {"joints.region_angstrom=6", "molecules.protease_b.motion=fixed",
          "molecules.inhibitor.motion=free", "grab.molecule=protease_b", "grab.atom=\"50\"",
          "statics.cutoff_angstrom=9", "statics.pairs=double", "statics.relax_steps=0",
          "molecules.protease_a.anchors=[]", "molecules.protease_b.anchors=[]"})
        settings.insert(settings.begin(), setting);
    return read_scene(test::in_project("scenes/hiv/flexible.toml"), settings);
}

World load_flap(const std::vector<std::string>& settings = {}) {
    return load_world(read_flap(settings));
}

// Which atoms are in residues in reach of residue 50 of chain B, and in the inhibitor.
std::vector<std::uint8_t> find_inside(const SceneSystem& system) {
    const std::vector<AtomName>& names = system.connectivity.names;
    const auto is_held = [&](std::size_t i) {
        return names[i].segment == "B" && names[i].number == "50";
    };
    std::set<std::array<std::string, 2>> residues;
    for (std::size_t i = 0; i < names.size(); ++i) {
        for (std::size_t j = 0; j < names.size(); ++j) {
            if (is_held(j) && (system.positions[i] - system.positions[j]).norm() <= reach)
                residues.insert({names[i].segment, names[i].number});
        }
    }
    std::vector<std::uint8_t> is_inside;
    for (const AtomName& name : names) {
        is_inside.push_back(
            name.segment == "TL3C" || residues.contains({name.segment, name.number}) ? 1 : 0);
    }
    return is_inside;
}

// The same region with every atom of the scene in the model. Between residues of a protein it is
// C-N that is cut, where the first one is inside and the second is not.
struct WholeModel {
    SceneSystem system;
    std::vector<std::uint8_t> is_inside;
    std::vector<BondAtoms> cuts;
    TorsionModel model;
};

WholeModel build_whole(const SceneDescription& scene) {
    WholeModel whole{load_system(scene), {}, {}, {}};
    const Connectivity& connectivity = whole.system.connectivity;
    whole.is_inside = find_inside(whole.system);
    Joints joints = build_joints(connectivity);
    std::erase_if(joints.joints, [&](const Joint& joint) {
        return whole.is_inside[joint.bond[0]] == 0 || whole.is_inside[joint.bond[1]] == 0;
    });
    REQUIRE(joints.springs.empty());
    for (const auto& [a, b] : connectivity.bonds) {
        const std::uint32_t first = std::min(a, b), second = std::max(a, b);
        if (whole.is_inside[first] != 0 && whole.is_inside[second] == 0) {
            CHECK(
                (connectivity.names[first].atom == "C" && connectivity.names[second].atom == "N"));
            whole.cuts.push_back({first, second});
        }
    }
    joints.springs = whole.cuts;
    std::vector<std::uint32_t> outside;
    for (std::uint32_t i = 0; i < whole.is_inside.size(); ++i) {
        if (whole.is_inside[i] == 0) outside.push_back(i);
    }
    std::vector<std::uint32_t> base_atoms = outside;
    for (std::uint32_t i = 0; i < whole.is_inside.size(); ++i) {
        if (connectivity.names[i].segment == "TL3C" && connectivity.names[i].atom == "C68")
            base_atoms.push_back(i);
    }
    const TorsionBodies bodies = build_bodies(connectivity, joints, base_atoms);
    std::vector<MoleculeBase> bases(bodies.molecules(), {BaseFreedom::Free, 0});
    const std::vector<std::uint32_t> molecule_of = molecules_of(bodies);
    for (const std::uint32_t atom : outside) {
        REQUIRE(bodies.is_base(bodies.body_of[atom]));
        bases[molecule_of[bodies.body_of[atom]]] = {BaseFreedom::Held, atom};
    }
    CHECK(std::ranges::count(bases, BaseFreedom::Free, &MoleculeBase::freedom) == 1);
    whole.model = build_torsion_model(bodies, connectivity.mass, whole.system.positions,
                                      whole.system.topology, std::move(bases));
    return whole;
}

// Turns every joint a little, the same in all models that have it.
void turn_joints(const TorsionModel& model, const ModelAtoms& atoms, TorsionState& state) {
    for (std::size_t b = 0; b < state.angles.size(); ++b) {
        if (model.tree.bodies.is_base(b)) continue;
        const auto [j, k] = model.tree.bodies.bodies[b].axis;
        state.angles[b] =
            0.02 * std::sin(atoms.number_in_table(j) + 0.1 * atoms.number_in_table(k));
    }
    update_positions(model, state);
}

// Of joints by their axes, and of the free base, in the table's numbers.
std::map<BondAtoms, double> forces_by_axis(const TorsionModel& model, const ModelAtoms& atoms,
                                           const Coordinates& forces) {
    std::map<BondAtoms, double> found;
    for (std::size_t b = 0; b < model.tree.bodies.bodies.size(); ++b) {
        if (model.tree.bodies.is_base(b)) {
            const Eigen::Index first = model.coordinate_of_base[model.tree.molecule_of[b]];
            for (std::uint32_t i = 0; first >= 0 && i < 6; ++i) found[{i, i}] = forces[first + i];
            continue;
        }
        const auto [j, k] = model.tree.bodies.bodies[b].axis;
        found[{atoms.number_in_table(j), atoms.number_in_table(k)}] =
            forces[model.coordinate_of_body[b]];
    }
    return found;
}

void check_same(const TorsionModel& model, const ModelAtoms& atoms, const Coordinates& own,
                const TorsionModel& whole, const Coordinates& others, double within) {
    const auto mine = forces_by_axis(model, atoms, own), theirs = forces_by_axis(whole, {}, others);
    REQUIRE(mine.size() == theirs.size());
    double largest = 0, difference = 0;
    for (const auto& [axis, force] : mine) {
        REQUIRE(theirs.contains(axis));
        largest = std::max(largest, std::abs(force));
        difference = std::max(difference, std::abs(force - theirs.at(axis)));
    }
    CHECK(largest > 1);
    CHECK(difference < within * largest);
}

ForceSettings double_with_cutoff() {
    ForceSettings forces;
    forces.nonbonded.electrostatics = ElectrostaticCutoff::ForceSwitch;
    forces.nonbonded.van_der_waals = VanDerWaalsCutoff::ForceSwitch;
    forces.nonbonded.cutoff = cutoff;
    forces.nonbonded.switch_from = cutoff - 2;
    return forces;
}

// The servo has put the spring's end so far (Å) from where it was at first.
void pull(World& world, const Vec3& by) {
    HandPose hand;
    const Entity first = hand_at(world, 0);
    hand.molecule = grip_of(world, first).pose;
    hand.molecule->place_angstrom += by;
    hand.grip_number = contact_of(world, first).sent.model.grip_number;
    REQUIRE(step_world(world, hand, contact_of(world, first).sent.model).finite);
}

// Of cut bonds, by how much any has become longer or shorter, Å.
double find_stretch(const std::vector<BondAtoms>& bonds, const std::vector<Vec3>& before,
                    const std::vector<Vec3>& after) {
    double most = 0;
    for (const auto& [a, b] : bonds) {
        const double change = (after[a] - after[b]).norm() - (before[a] - before[b]).norm();
        most = std::max(most, std::abs(change));
    }
    return most;
}

std::vector<std::uint32_t> moved_atoms(const std::vector<Vec3>& before,
                                       const std::vector<Vec3>& after) {
    std::vector<std::uint32_t> moved;
    for (std::uint32_t i = 0; i < before.size(); ++i) {
        if (before[i] != after[i]) moved.push_back(i);
    }
    return moved;
}

const std::vector<Vec3>& positions_of(const World& world) {
    return world.resource<AtomTable>().positions;
}

}  // namespace

TEST_CASE("a region's model has fewer atoms and the forces of the whole one",
          "[simulation][region]") {
    const World world = load_flap();
    const WholeModel whole = build_whole(read_flap());
    const TorsionModel& model = model_of(world);
    const ModelAtoms& atoms = model_atoms_of(world);
    const AtomTable& table = world.resource<AtomTable>();
    CHECK(model.masses.size() < 0.85 * static_cast<double>(table.size()));
    CHECK(model.coordinates == whole.model.coordinates);
    REQUIRE(atoms.in_table.size() == model.masses.size());
    for (std::uint32_t i = 0; i < atoms.in_table.size(); ++i) {
        REQUIRE(model.masses[i] == table.mass[atoms.in_table[i]]);
        REQUIRE(model.topology.charge[i] == table.charge[atoms.in_table[i]]);
        REQUIRE(model.reference[i] == table.positions[atoms.in_table[i]]);
    }

    TorsionState own = build_torsion_state(model), other = build_torsion_state(whole.model);
    turn_joints(model, atoms, own);
    turn_joints(whole.model, {}, other);
    ForceMemory memory, memory_of_whole;
    update_forces(model, double_with_cutoff(), memory, own);
    update_forces(whole.model, double_with_cutoff(), memory_of_whole, other);
    update_coordinate_forces(model, own);
    update_coordinate_forces(whole.model, other);
    check_same(model, atoms, own.coordinate_forces, whole.model, other.coordinate_forces, 1e-9);
    double farthest = 0, largest = 0, difference = 0;
    for (const std::uint32_t i : model.mobile_atoms) {
        const std::uint32_t in_table = atoms.in_table[i];
        farthest = std::max(farthest, (own.positions[i] - other.positions[in_table]).norm());
        largest = std::max(largest, own.forces[i].norm());
        difference = std::max(difference, (own.forces[i] - other.forces[in_table]).norm());
    }
    CHECK(farthest < 1e-12);
    CHECK(difference < 1e-9 * largest);
    CHECK(std::abs(own.terms.bond - other.terms.bond) < 1e-9);
    CHECK(own.terms.bond > 0);  // of what is cut
    CHECK(std::abs(own.terms.cmap - other.terms.cmap) < 1e-9);

    // With atoms taken for others it would not be so.
    ModelAtoms wrong = atoms;
    std::swap(wrong.in_table[model.mobile_atoms[0]], wrong.in_table[model.mobile_atoms[10]]);
    CHECK(forces_by_axis(model, wrong, own.coordinate_forces) !=
          forces_by_axis(model, atoms, own.coordinate_forces));
}

TEST_CASE("a step by second order in a region is that of the whole model",
          "[simulation][region][second-order]") {
    const World world = load_flap();
    const WholeModel whole = build_whole(read_flap());
    const TorsionModel& model = model_of(world);
    const ModelAtoms& atoms = model_atoms_of(world);
    SecondOrderSettings settings;
    settings.forces = double_with_cutoff();

    const auto step = [&](const TorsionModel& of, const ModelAtoms& numbers) {
        TorsionState state = build_torsion_state(of);
        ModelSpring spring = *spring_of(world, hand_at(world, 0));
        for (std::uint32_t& atom : spring.atoms) {
            const std::uint32_t in_table = atoms.number_in_table(atom);
            atom = numbers.in_model(in_table).value();
        }
        state.springs.push_back(spring);
        HeldParts held;
        held.hands.push_back({.spring = 0});
        held.atoms = spring.atoms;
        SecondOrderStatics statics = build_second_order_statics(of, held);
        ForceMemory memory;
        update_forces(of, settings.forces, memory, state);
        start_second_order(of, settings, state, statics);
        for (int i = 0; i < 2; ++i) {
            state.springs.front().place += Vec3(0, 0.06, 0);
            REQUIRE(step_second_order(of, settings, state, statics).is_finite);
        }
        CHECK(statics.model_evaluations > 2);
        return state;
    };
    const TorsionState own = step(model, atoms), other = step(whole.model, {});
    double farthest = 0, moved = 0;
    for (const std::uint32_t i : model.mobile_atoms) {
        farthest =
            std::max(farthest, (own.positions[i] - other.positions[atoms.in_table[i]]).norm());
        moved = std::max(moved, (own.positions[i] - model.reference[i]).norm());
    }
    CHECK(moved > 0.02);
    CHECK(farthest < 1e-9);
}

TEST_CASE("outside of the region nothing moves by a bit, and chains stay closed",
          "[simulation][region]") {
    const WholeModel whole = build_whole(read_flap());
    REQUIRE(whole.cuts.size() >= 2);
    const bool is_fast = GENERATE(false, true);
    World world = load_flap({is_fast ? "statics.pairs=fast" : "statics.pairs=double"});
    const std::vector<Vec3> before = positions_of(world);
    const std::vector<std::uint32_t> held = held_atoms(world, hand_at(world, 0));
    const AtomTable& table = world.resource<AtomTable>();
    for (const std::uint32_t atom : held) {
        REQUIRE(table.names[atom].number == "50");
        REQUIRE(table.names[atom].segment == "B");
    }
    const AtomsOf residue = held_part_of(world, hand_at(world, 0));
    const Vec3 start = middle_of(world, residue);
    for (int i = 0; i < 20; ++i) pull(world, Vec3(0, 0.1, 0));
    CHECK((middle_of(world, residue) - start).y() > 0.5);
    const std::vector<std::uint32_t> moved = moved_atoms(before, positions_of(world));
    CHECK(moved.size() > 100);
    for (const std::uint32_t atom : moved) REQUIRE(whole.is_inside[atom] != 0);
    // A bond's k is 740 kcal/mol/Å^2 and the spring pulls by less than 30 kcal/mol/Å.
    const double stretch = find_stretch(whole.cuts, before, positions_of(world));
    CHECK(stretch < 0.05);
    CHECK(stretch > 0);
}

TEST_CASE("a region is made anew before atoms come to others that it does not have",
          "[simulation][region]") {
    World world = load_flap({"grab.molecule=inhibitor", "grab.atom=\"200\"", "statics.pairs=fast"});
    const std::vector<std::uint32_t> first = model_atoms_of(world).in_table;
    for (int i = 0; i < 60; ++i) pull(world, Vec3(0.25, 0, 0));
    const ModelAtoms& atoms = model_atoms_of(world);
    CHECK(atoms.in_table != first);
    const std::vector<Vec3>& positions = positions_of(world);
    for (const std::uint32_t mobile : model_of(world).mobile_atoms) {
        const Vec3& place = positions[atoms.in_table[mobile]];
        REQUIRE(place == world.resource<TorsionState>().positions[mobile]);
        for (std::uint32_t i = 0; i < positions.size(); ++i) {
            if ((positions[i] - place).norm() < cutoff) REQUIRE(atoms.in_model(i));
        }
    }
}

TEST_CASE("where no other region can be had the old one goes on", "[simulation][region][errors]") {
    World world = load_flap({"grab.molecule=inhibitor", "grab.atom=\"200\"", "statics.pairs=fast"});
    const std::vector<std::uint32_t> first = model_atoms_of(world).in_table;
    world.write<MechanicsSettings>().joints.turn = {"B 999 CB CG"};
    for (int i = 0; i < 40; ++i) pull(world, Vec3(0.25, 0, 0));
    CHECK(model_atoms_of(world).in_table == first);
    REQUIRE(find_solver<SecondOrder>(world) != nullptr);
    const std::vector<Vec3> before = positions_of(world);
    pull(world, Vec3(0.1, 0, 0));
    CHECK_FALSE(moved_atoms(before, positions_of(world)).empty());
}

TEST_CASE("a region goes with the hand, stays when it lets go, and comes back when undone",
          "[simulation][region][edit]") {
    World world = load_flap({"statics.pairs=fast"});
    UndoHistory history;
    const auto edit = [&](EditAction action) {
        history.apply(world, {0, 0, std::move(action), {"scene.toml", 7, 0}});
    };
    const std::vector<std::uint32_t> first = model_atoms_of(world).in_table;
    const std::string start = world_bytes(world);
    edit(ReleaseEdit{});
    CHECK(model_atoms_of(world).in_table == first);
    CHECK(model_of(world).coordinates > 0);
    std::vector<Vec3> before = positions_of(world);
    REQUIRE(step_world(world, HandPose{}, {}).finite);
    for (const std::uint32_t atom : moved_atoms(before, positions_of(world)))
        REQUIRE(model_atoms_of(world).in_model(atom));

    edit(GrabEdit{"protease_a:16"});
    const std::vector<std::uint32_t> second = model_atoms_of(world).in_table;
    CHECK(second != first);
    before = positions_of(world);
    for (int i = 0; i < 3; ++i) pull(world, Vec3(0, 0.1, 0));
    const std::vector<std::uint32_t> moved = moved_atoms(before, positions_of(world));
    REQUIRE_FALSE(moved.empty());
    for (const std::uint32_t atom : moved) {
        REQUIRE(std::ranges::binary_search(second, atom));
        REQUIRE(world.resource<AtomTable>().names[atom].segment == "A");
    }

    edit(UndoEdit{});
    edit(UndoEdit{});
    CHECK(model_atoms_of(world).in_table == first);
    CHECK(world_bytes(world).size() == start.size());

    RestraintEdit restraint;
    restraint.atoms = {"protease_a:16", "protease_a:60"};
    edit(restraint);
    CHECK(world.resource<TorsionState>().springs.size() == 2);
    REQUIRE(step_world(world, HandPose{}, {}).finite);
    edit(RemoveEdit{"protease_a"});
    CHECK(world.resource<TorsionState>().springs.size() == 1);
    for (const std::uint32_t atom : held_atoms(world, hand_at(world, 0)))
        REQUIRE(world.resource<AtomTable>().names[atom].number == "50");
    pull(world, Vec3(0, 0.1, 0));
    edit(RemoveEdit{"protease_b"});
    REQUIRE(step_world(world, HandPose{}, {}).finite);
}

TEST_CASE("a region as large as everything cuts nothing", "[simulation][region]") {
    const World world = load_flap({"joints.region_angstrom=1000", "statics.method=quasi-static"});
    CHECK(model_atoms_of(world).in_table.empty());
    CHECK(model_of(world).masses.size() == positions_of(world).size());
    CHECK(model_of(world).tree.bodies.springs.empty());
    CHECK(world.resource<StartReport>().joints_held == 0);
}

TEST_CASE("a region is one thing, joints around a molecule another",
          "[simulation][region][errors]") {
    CHECK_THAT(load_error_of([] { (void)load_flap({"joints.within_angstrom=8"}); }),
               Contains("expected one of them"));
}
