// The field between what two hands hold, against the reference in double at the same places.
#include "haptics/local_field.h"

#include "core/units.h"
#include "tests/support/two_held.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <random>

using namespace palpa;

namespace {

using Poses = std::array<MoleculePose, 2>;

Vec3 random_vector(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return size * Vec3(x, y, z);
}

MoleculePose moved(const MoleculePose& pose, const Vec3& by, const Vec3& turn) {
    return {pose.place_angstrom + by, turn_of(turn) * pose.orientation};
}

// Two waters about 3 Å from each other, far from the origin, whose places are measured from
// somewhere else.
test::TwoHeld two_waters(std::mt19937& random) {
    test::TwoHeld pair;
    for (test::RigidBody& body : pair.bodies) {
        body = test::water_body();
        body.counterpart = random_vector(random, 30);
    }
    pair.turns = {true, true};
    return pair;
}

Poses random_poses(std::mt19937& random, const test::TwoHeld& pair) {
    const Vec3 first = random_vector(random, 20);
    const Vec3 apart = 3 * random_vector(random, 1).normalized();
    return {MoleculePose{first - pair.bodies[0].counterpart, turn_of(random_vector(random, 2))},
            MoleculePose{first + apart - pair.bodies[1].counterpart,
                         turn_of(random_vector(random, 2))}};
}

// After a while in which both hands moved and turned.
Poses carried(std::mt19937& random, const Poses& poses) {
    Poses result;
    for (std::size_t i = 0; i < 2; ++i) {
        result[i] = moved(poses[i], random_vector(random, 0.6), random_vector(random, 0.7));
    }
    return result;
}

constexpr double force_unit = units::newton_per_kcal_per_mol_angstrom;
constexpr double torque_unit = units::joule_per_kcal_per_mol;
constexpr double stiffness_unit = units::newton_per_metre_per_kcal_per_mol_angstrom2;

}  // namespace

TEST_CASE("two held molecules push each other with opposite forces, those of the reference",
          "[haptics][held]") {
    std::mt19937 random(25);
    for (int i = 0; i < 200; ++i) {
        const test::TwoHeld pair = two_waters(random);
        const Poses then = random_poses(random, pair), now = carried(random, then);
        std::array<LocalForce, 2> there;
        for (std::size_t hand = 0; hand < 2; ++hand) {
            const LocalContactModel contact = pair.contact(hand, then);

            there[hand] =
                evaluate_local(contact.model, contact.field, now[hand], test::live_at(now));

            const FieldSum expected = pair.mutual(hand, now);
            const Vec3 torque =
                torque_unit * expected.torque_about(pair.bodies[hand].centre(now[hand]));
            // What single precision leaves of pairs of some 50 kcal/mol/Å.
            CHECK((there[hand].force_newton - force_unit * expected.force).norm() <
                  force_unit * (1e-4 + 1e-5 * expected.force.norm()));
            CHECK((there[hand].torque_newton_metre - torque).norm() <
                  torque_unit * (3e-4 + 1e-5 * expected.force.norm()));
            CHECK((there[hand].stiffness_N_per_m - stiffness_unit * expected.stiffness).norm() <
                  2e-5 * stiffness_unit * expected.stiffness.norm());
            CHECK(expected.force.norm() > 0.1);
        }
        CHECK((there[0].force_newton + there[1].force_newton).norm() <
              force_unit * 2e-4 + 2e-5 * there[0].force_newton.norm());
        CHECK((there[0].stiffness_N_per_m - there[1].stiffness_N_per_m).norm() <
              2e-5 * there[0].stiffness_N_per_m.norm());
        CHECK(there[0].clearance_angstrom == Approx(there[1].clearance_angstrom).margin(1e-5));
    }
}

TEST_CASE("what a hand holds pushes as part of what was foretold, beside what nobody holds",
          "[haptics][held]") {
    std::mt19937 random(26);
    test::TwoHeld pair = two_waters(random);
    const Poses then = random_poses(random, pair), now = carried(random, then);
    pair.environment = test::sphere_body(0.4);
    pair.environment.counterpart = pair.bodies[0].reference(then[0]) + Vec3(0, 4, -1);
    LocalContactModel contact = pair.contact(0, then);
    contact.model.prediction_gain = GENERATE(0.0, 0.4, 1.0);
    contact.model.force_newton += Vec3(0, 1e-10, 0);  // that no field knows of
    contact.model.projector = Vec3(1, 1, 0).asDiagonal();

    const LocalForce there =
        evaluate_local(contact.model, contact.field, now[0], test::live_at(now));

    const Vec3 change = pair.newton(0, now) - pair.newton(0, then);
    const Vec3 expected = contact.model.force_newton +
                          contact.model.prediction_gain * (contact.model.projector * change);
    CHECK((there.force_newton - expected).norm() < 1e-5 * (change.norm() + expected.norm()));
    // The nearest pair of both; and no atom is pushed harder than is told.
    const FrozenField still =
        build_frozen_field(pair.bodies[0].view(contact.field.group),
                           pair.environment.view(pair.environment.at({})), test::TwoHeld::rule);
    const double to_still = evaluate_frozen_field(still, pair.bodies[0].at(now[0])).clearance;
    CHECK(there.clearance_angstrom <= std::max(0.0, to_still) + 1e-5);
    CHECK(there.largest_newton >= force_unit * pair.around(0, now).force.norm() / 3);
}

TEST_CASE(
    "a molecule in a hand that the servo does not know, or that was put elsewhere, is where "
    "it stood",
    "[haptics][held]") {
    std::mt19937 random(27);
    const test::TwoHeld pair = two_waters(random);
    const Poses then = random_poses(random, pair);
    Poses now = carried(random, then);
    const LocalContactModel contact = pair.contact(0, then);
    const Vec3 live =
        evaluate_local(contact.model, contact.field, now[0], test::live_at(now)).force_newton;
    test::LiveArray unknown = test::live_at(now), anew = test::live_at(now);
    unknown[1].reset();
    anew[1]->grip_number = 1;
    now[1] = then[1];
    const Vec3 expected = pair.newton(0, now);
    REQUIRE((live - expected).norm() > 0.01 * expected.norm());

    for (const LiveMolecules others :
         {LiveMolecules{}, LiveMolecules(unknown), LiveMolecules(anew)}) {
        const Vec3 force =
            evaluate_local(contact.model, contact.field, now[0], others).force_newton;
        CHECK((force - expected).norm() < 1e-5 * expected.norm() + 1e-4 * force_unit);
    }
}

TEST_CASE("without atoms a hand feels how far another one has gone as a spring",
          "[haptics][held]") {
    std::mt19937 random(28);
    const test::TwoHeld pair = two_waters(random);
    const Poses then = random_poses(random, pair);
    LocalContactModel contact = pair.contact(0, then);
    contact.field.has_atoms = false;
    const Vec3 own(0.02, -0.01, 0.03), other(-0.03, 0.04, 0.01);
    const auto force_at = [&](const Vec3& by, const Vec3& other_by) {
        const Poses now{moved(then[0], by, Vec3::Zero()), moved(then[1], other_by, Vec3::Zero())};
        return evaluate_local(contact.model, contact.field, now[0], test::live_at(now));
    };

    const LocalForce there = force_at(own, other);

    // Both the same way: nothing has changed between them.
    CHECK((force_at(own, own).force_newton - contact.model.force_newton).norm() <
          1e-5 * contact.model.force_newton.norm());
    CHECK((there.force_newton - force_at(own - other, Vec3::Zero()).force_newton).norm() <
          1e-5 * there.force_newton.norm());
    CHECK(there.clearance_angstrom ==
          Approx(std::max(0.0, contact.model.clearance_angstrom - own.norm() - other.norm())));
}

namespace {

// A water between some others that stay, and a contact model of it whose servo knows how they
// follow.
struct FollowedWater {
    test::TwoHeld waters;
    Poses then;
    LocalContactModel contact;

    explicit FollowedWater(std::mt19937& random) : waters(two_waters(random)) {
        then = random_poses(random, waters);
        waters.environment = waters.bodies[1];
        waters.environment.counterpart = waters.bodies[1].reference(then[1]);
        contact = waters.contact(0, then);
        contact.field.held.clear();
        contact.model.turns_with_handle = false;
    }

    void follow(const std::vector<Mat3>& group, const std::vector<Mat3>& environment) {
        FollowingAtoms atoms;
        atoms.points = build_following_points(group, environment);
        atoms.memory = build_following_memory(contact.field.frozen);
        atoms.at_step = evaluate_following_field(contact.field.frozen, contact.field.group,
                                                 atoms.points, Vec3::Zero(), atoms.memory);
        atoms.reach_angstrom = 1;
        contact.field.following = atoms;
    }
    LocalForce at(const Vec3& by) const {
        MoleculePose pose = contact.model.molecule;
        pose.place_angstrom += by;
        return evaluate_local(contact.model, contact.field, pose);
    }
};

}  // namespace

TEST_CASE(
    "where nothing follows and the stiffness is the frozen one, the force is the frozen field's",
    "[haptics][relaxed]") {
    std::mt19937 random(40);
    for (int i = 0; i < 20; ++i) {
        FollowedWater c(random);
        const Vec3 by = random_vector(random, 0.3);
        const LocalForce frozen = c.at(by);

        c.follow(std::vector<Mat3>(3, Mat3::Identity()), std::vector<Mat3>(3, Mat3::Zero()));
        c.contact.model.relaxed.emplace();
        c.contact.model.relaxed->matrix.bottomRightCorner<3, 3>() =
            stiffness_unit * c.contact.field.at_step.stiffness;
        const LocalForce following = c.at(by);

        const double size = c.contact.field.at_step.stiffness.norm() * by.norm() +
                            c.contact.field.at_step.force.norm();
        CHECK((following.force_newton - frozen.force_newton).norm() < 1e-5 * force_unit * size);
        CHECK((following.slope_N_per_m - frozen.slope_N_per_m).norm() <
              1e-4 * (frozen.slope_N_per_m.norm() + stiffness_unit));
        CHECK(following.clearance_angstrom == Approx(frozen.clearance_angstrom).margin(1e-5));
        CHECK(following.largest_newton == Approx(frozen.largest_newton).epsilon(1e-4));
    }
}

TEST_CASE("the force of atoms that follow is the slope of the energy on their way",
          "[haptics][relaxed]") {
    std::mt19937 random(41);
    std::vector<Mat3> group, environment;
    for (int i = 0; i < 3; ++i) {
        const auto matrix = [&] {
            return Mat3(Mat3::NullaryExpr([&] { return random_vector(random, 0.5).x(); }));
        };
        group.push_back(Mat3::Identity() + 0.3 * matrix());
        environment.push_back(matrix());
    }
    FollowedWater c(random);
    c.follow(group, environment);
    c.contact.model.relaxed.emplace();
    const Mat3 relaxed = Vec3(1, 2, -3).asDiagonal();  // N/m
    c.contact.model.relaxed->matrix.bottomRightCorner<3, 3>() = relaxed;

    // To first order the relaxed stiffness alone.
    constexpr double h = 1e-3;
    for (int i = 0; i < 3; ++i) {
        const Vec3 step = h * Vec3::Unit(i);
        const Vec3 change = c.at(step).force_newton - c.at(-step).force_newton;
        const Vec3 slope = -change / (2 * h * units::metre_per_angstrom);
        CHECK((slope - relaxed.col(i)).norm() < 0.02);
    }
    // Farther out the predicted slope is that of the force.
    const Vec3 by(0.15, -0.1, 0.2);
    const LocalForce there = c.at(by);
    for (int i = 0; i < 3; ++i) {
        const Vec3 step = h * Vec3::Unit(i);
        const Vec3 change = c.at(by + step).force_newton - c.at(by - step).force_newton;
        const Vec3 slope = -change / (2 * h * units::metre_per_angstrom);
        CHECK((slope - there.slope_N_per_m.col(i)).norm() < 0.02 + 1e-3 * slope.norm());
    }
    CHECK((there.slope_N_per_m - relaxed).norm() > 0.1);

    // Beyond their reach they add what they add there.
    c.contact.field.following->reach_angstrom = 0.5 * by.norm();
    const Vec3 beyond = c.at(by).force_newton - c.at(0.5 * by).force_newton;
    CHECK((beyond + 0.5 * units::metre_per_angstrom * (relaxed * by)).norm() < 1e-15);
    CHECK(c.at(by).slope_N_per_m == relaxed);
}
