#include "simulation/solvent.h"

#include "charmm/solvation_reader.h"
#include "charmm/topology.h"
#include "core/load_error.h"
#include "forces/force_field.h"
#include "loading/edit.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/systems/publish_contact.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;

namespace {

SceneDescription scene_of(const std::string& name, const std::vector<std::string>& settings = {}) {
    return read_scene(test::in_project("scenes/" + name), settings);
}

std::string error_of(const SceneDescription& scene) {
    return load_error_of([&] { (void)load_system(scene); });
}

}  // namespace

TEST_CASE("pairs in implicit water act through 1.5 r and end at 9 Å", "[simulation][solvent]") {
    ForceFieldDescription force_field;
    force_field.coulomb_constant = 332;
    force_field.solvent = Solvent::Eef1Sb;
    const NonbondedSettings settings = solvent_settings(force_field);
    CHECK(settings.coulomb_constant == 332);
    CHECK(settings.dielectric == 1.5);
    CHECK(settings.distance_dielectric);
    CHECK(settings.cutoff == 9);
    CHECK(settings.coulomb14_factor == 1);
    CHECK(has_end(settings));
    CHECK_FALSE(find_problem(settings));
}

TEST_CASE("a scene in vacuum has no solvation, one in EEF1-SB has every atom's",
          "[simulation][solvent]") {
    const SceneSystem vacuum = load_system(scene_of("salt-bridge/vacuum.toml"));
    CHECK_FALSE(vacuum.topology.solvation);
    const SceneSystem water = load_system(scene_of("salt-bridge/solvent.toml"));
    REQUIRE(water.topology.solvation);
    const Solvation& solvation = *water.topology.solvation;
    REQUIRE(solvation.volume.size() == water.connectivity.names.size());
    CHECK(solvation.radius.size() == solvation.volume.size());
    for (std::size_t i = 0; i < solvation.volume.size(); ++i) {
        INFO(to_string(water.connectivity.names[i]));
        const auto row = eef1sb_table().types.find(water.connectivity.type[i]);
        const bool is_heavy = water.connectivity.mass[i] > 3.5;
        CHECK(is_heavy == (row != eef1sb_table().types.end()));
        CHECK(solvation.volume[i] == (is_heavy ? row->second.volume : 0));
        CHECK(solvation.dg_ref[i] == (is_heavy ? row->second.dg_ref : 0));
        CHECK(solvation.radius[i] > 0);
    }
    // One ammonium, two carboxylate oxygens, whose shells reach farther.
    CHECK(std::ranges::count(solvation.lambda, 6.0) == 3);
    double sum = 0;
    for (const double q : water.topology.charge) sum += q;
    CHECK(std::abs(sum) < 1e-9);
    CHECK(water.positions == vacuum.positions);
    REQUIRE(water.topology.size() == vacuum.topology.size());
}

TEST_CASE("HIV protease with TL-3 loads with neutral groups, at rest in implicit water",
          "[simulation][solvent]") {
    const SceneSystem vacuum = load_system(scene_of("hiv/flexible.toml"));
    const SceneSystem water = load_system(scene_of("hiv/solvent.toml"));
    REQUIRE(water.topology.solvation);
    const std::optional<JointRelaxReport> relaxed =
        load_world(scene_of("hiv/solvent.toml")).resource<StartReport>().joints_at_rest;
    REQUIRE(relaxed);
    CHECK(relaxed->largest_move < 0.01);
    CHECK(relaxed->energy_before == Approx(-1440.97).margin(0.05));
    double before = 0, after = 0;
    std::size_t changed = 0;
    for (std::size_t i = 0; i < water.topology.size(); ++i) {
        before += vacuum.topology.charge[i];
        after += water.topology.charge[i];
        CHECK(to_string(water.connectivity.names[i]) == to_string(vacuum.connectivity.names[i]));
        if (water.connectivity.type[i] == vacuum.connectivity.type[i]) continue;
        CHECK(water.connectivity.names[i].residue == "ASP");
        CHECK(water.connectivity.names[i].atom == "CB");
        ++changed;
    }
    CHECK(before == Approx(7));
    CHECK(std::abs(after) < 1e-9);
    CHECK(changed > 0);
    // Terms are the same but for those of Asp's renamed CB, which keep their number.
    CHECK(water.topology.bonds.size() == vacuum.topology.bonds.size());
    CHECK(water.topology.angles.size() == vacuum.topology.angles.size());
}

TEST_CASE("charges that do not go with the solvent are refused with what to do",
          "[simulation][solvent]") {
    CHECK_THAT(error_of(scene_of("salt-bridge/vacuum.toml", {"force_field.solvent=eef1-sb"})),
               Contains("EEF1-SB needs neutral charges, but ionic groups are not neutral: ASP of A "
                        "ASP 2 (-1.00 e), LYS of B LYS 2 (+1.00 e)") &&
                   Contains("palpa prepare --solvent eef1-sb"));
    CHECK_THAT(error_of(scene_of("salt-bridge/solvent.toml", {"force_field.solvent=none"})),
               Contains("neutral charges (ASP of A ASP 2 is neutral, 2 ionic groups in all)") &&
                   Contains("expected solvent = \"eef1-sb\""));
    CHECK_THAT(error_of(scene_of("hiv/flexible.toml", {"force_field.solvent=eef1-sb"})),
               Contains("the total charge is +7.00 e, not 0"));
    CHECK(error_of(scene_of("hiv/charged")) == "no error");
}

TEST_CASE("water is refused in implicit water unless it is structural", "[simulation][solvent]") {
    const std::string error = load_error_of(
        [&] { (void)load_world(test::water_scene({"force_field.solvent=eef1-sb"})); });
    CHECK_THAT(error, Contains("no solvation parameters in eef1sb.csv for type OT of"));
    SceneDescription scene = test::water_scene({"force_field.solvent=eef1-sb"});
    for (MoleculeDescription& molecule : scene.molecules) molecule.structural_water = true;
    const World world = load_world(scene);
    const std::optional<Solvation> solvation = find_solvation(world);
    REQUIRE(solvation);
    CHECK(std::ranges::count(solvation->volume, 0.0) == 6);
    CHECK(std::ranges::count(solvation->dg_ref, 0.0) == 6);
    CHECK_FALSE(find_solvation(load_world(test::water_scene())));

    SceneDescription bridge = scene_of("salt-bridge/solvent.toml");
    bridge.molecules[0].structural_water = true;
    CHECK_THAT(error_of(bridge),
               Contains("is not part of a water; expected a molecule of waters only"));
}

TEST_CASE("what is added to a scene must go with its solvent", "[simulation][solvent]") {
    SceneDescription scene = scene_of("salt-bridge/vacuum.toml");
    World world = load_world(scene);
    const std::size_t atoms = world.resource<AtomTable>().size();
    AddEdit edit;
    edit.structure = test::in_project("scenes/salt-bridge/system.crd");
    edit.topology = test::in_project("scenes/salt-bridge/solvent.psf");
    edit.segment = "B";
    edit.name = "another";
    edit.at_angstrom = {0, 40, 0};
    CHECK_THAT(load_error_of([&] { edit.apply(world, 0); }),
               Contains("LYS of another LYS 2 is neutral"));
    CHECK(world.resource<AtomTable>().size() == atoms);
    edit.topology = test::in_project("scenes/salt-bridge/vacuum.psf");
    CHECK(load_error_of([&] { edit.apply(world, 0); }) == "no error");
}

// Whatever a molecule does to itself sums to no force and no torque.
TEST_CASE("what is felt of a rigid TL-3 in implicit water is the sum of all forces on its atoms",
          "[simulation][solvent]") {
    SceneDescription scene = scene_of("hiv/solvent.toml");
    for (MoleculeDescription& molecule : scene.molecules) molecule.shape = Shape::Rigid;
    scene.molecules[1].motion = Motion::Fixed;
    const World world = load_world(scene);
    const Entity hand = hand_at(world, 0);
    const AtomTable& atoms = world.resource<AtomTable>();
    const SceneSystem system = load_system(scene);
    REQUIRE(system.topology.size() == atoms.size());
    const NonbondedSettings settings = solvent_settings(scene.force_field);
    const AtomRange held = held_range(world, hand);
    const auto wrench_at = [&](const Vec3& by) {
        std::vector<Vec3> positions = atoms.positions, forces(atoms.size(), Vec3::Zero());
        for (std::uint32_t i = 0; i < held.count; ++i) positions[held.first + i] += by;
        (void)add_forces(system.topology, settings, positions, forces);
        Vec6 wrench = Vec6::Zero();
        for (std::uint32_t i = held.first; i < held.first + held.count; ++i) {
            wrench.head<3>() += positions[i].cross(forces[i]);
            wrench.tail<3>() += forces[i];
        }
        return wrench;
    };
    const LocalContactModel contact = build_local_contact(world, hand, {});
    CHECK(contact.field.has_atoms);
    CHECK(contact.field.frozen.smooth);
    // Those in reach, not all.
    CHECK(contact.field.frozen.environment.positions.size() < 1900);
    for (const Vec3& by : {Vec3(0, 0, 0), Vec3(0.8, 0, 0), Vec3(0, -0.5, 1)}) {
        CAPTURE(by.transpose());
        const Vec6 expected = wrench_at(by);
        std::vector<Vec3> moved(contact.field.group);
        for (Vec3& place : moved) place += by;
        FieldPoints group = held_points(world, hand);
        group.positions = moved;
        const FieldSum sum = field_on(world, hand, group);
        CHECK((sum.force - expected.tail<3>()).norm() < 1e-9 * expected.tail<3>().norm() + 1e-8);
        CHECK((sum.torque - expected.head<3>()).norm() < 1e-9 * expected.head<3>().norm() + 1e-7);
        const FrozenSum fast = evaluate_frozen_field(contact.field.frozen, moved);
        CHECK((fast.force - sum.force).norm() < 1e-5 * sum.force.norm() + 1e-3);
        CHECK((fast.stiffness - sum.stiffness).norm() < 1e-5 * sum.stiffness.norm() + 1e-2);
    }
}
