#include "haptics/guarded.h"

#include "core/units.h"
#include "field/pair_field.h"
#include "math/spatial.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

using namespace palpa;

namespace {

constexpr double newton = units::newton_per_kcal_per_mol_angstrom;

// Two argon atoms with charges, one of them in the hand; along x.
struct Pair {
    std::vector<Vec3> own{Vec3(6, 0, 0)}, others{Vec3::Zero()};
    std::vector<double> own_charge{0.3}, other_charge{-0.3}, sqrt_epsilon{0.5}, half_rmin{1.9};
    std::vector<std::uint32_t> type{0};
    double coulomb = units::charmm_coulomb_constant;

    FieldPoints group(const std::vector<Vec3>& places) const {
        return {places, own_charge, sqrt_epsilon, half_rmin, type};
    }
    FieldPoints environment() const {
        return {others, other_charge, sqrt_epsilon, half_rmin, type};
    }
    FieldSum at(double x) const {
        const std::vector<Vec3> place{Vec3(x, 0, 0)};
        return evaluate_pair_field(group(place), environment(), {coulomb});
    }
    double force(double x) const { return newton * at(x).force.x(); }

    LocalContactModel contact(double x) const {
        LocalContactModel contact;
        contact.model.molecule.place_angstrom = Vec3(x, 0, 0);
        contact.model.projector = Vec3::UnitX().asDiagonal();
        contact.model.force_newton = Vec3(force(x), 0, 0);
        contact.model.period_s = 0.014;
        contact.field.group = {Vec3(x, 0, 0)};
        contact.field.centre = Vec3(x, 0, 0);
        contact.field.frozen =
            build_frozen_field(group(contact.field.group), environment(), {coulomb});
        contact.field.at_step = evaluate_frozen_field(contact.field.frozen, contact.field.group);
        contact.field.has_atoms = true;
        return contact;
    }
};

struct Guarded {
    GuardedSettings settings;
    GuardedState state;
    LocalContactModel contact;

    explicit Guarded(const LocalContactModel& first) : contact(first) {
        take_local_contact(settings, contact, state);
    }
    GuardedTick move(const Vec3& by) {
        return step_guarded(settings, contact, Vec3::Zero(), {by}, false, state);
    }
    void update(const Pair& pair) {
        contact = pair.contact(x());
        take_local_contact(settings, contact, state);
    }
    double x() const { return state.molecule.place_angstrom.x(); }
};

}  // namespace

TEST_CASE("the local field is the contact model's at its place, and knows the way from there",
          "[haptics][guarded]") {
    const Pair pair;
    LocalContactModel contact = pair.contact(4);
    contact.model.prediction_gain = GENERATE(0.0, 0.5, 1.0);
    contact.model.force_newton.x() += 1e-10;  // that the field does not know of

    const auto at = [&](double x) {
        return evaluate_local(contact.model, contact.field, {Vec3(x, 0, 0)});
    };

    CHECK(at(4).force_newton.x() == Approx(contact.model.force_newton.x()));
    const double way = pair.force(3.6) - pair.force(4);
    CHECK(
        at(3.6).force_newton.x() ==
        Approx(contact.model.force_newton.x() + contact.model.prediction_gain * way).epsilon(1e-5));
    const double slope = -(pair.force(3.601) - pair.force(3.599)) / (0.002 * 1e-10);
    CHECK(at(3.6).stiffness_N_per_m(0, 0) ==
          Approx(contact.model.prediction_gain * slope).epsilon(1e-4).margin(1e-12));
    CHECK(at(4.5).clearance_angstrom == Approx(4.5 - 3.8).margin(1e-5));
    CHECK(at(3.6).clearance_angstrom == 0);
    CHECK(at(3.6).largest_newton == Approx(std::abs(pair.force(3.6))).epsilon(1e-5));
}

TEST_CASE("without atoms the local field is the tangent", "[haptics][guarded]") {
    LocalContactModel contact;
    contact.model.molecule.place_angstrom = Vec3(1, 2, 3);
    contact.model.force_newton = Vec3(1e-9, 0, 0);
    contact.model.stiffness_matrix_N_per_m = 10 * Mat3::Identity();
    contact.model.clearance_angstrom = 0.5;

    const LocalForce there = evaluate_local(contact.model, contact.field, {Vec3(1, 2.2, 3)});

    CHECK((there.force_newton - Vec3(1e-9, -10 * 0.2e-10, 0)).norm() < 1e-20);
    CHECK(there.clearance_angstrom == Approx(0.3));
}

TEST_CASE("a handle that rests after it drove feels a finite force", "[haptics][guarded]") {
    // The force drove it, limits cut off what it went, and now nothing is wanted.
    Guarded guarded(Pair().contact(3.4));
    guarded.state.handle_m_per_s = Vec3(-0.01, 0, 0);  // as it attracts
    guarded.state.energy_balance_J = 1e-3;

    const GuardedTick tick = guarded.move(Vec3::Zero());

    REQUIRE(guarded.state.law_newton.dot(guarded.state.handle_m_per_s) > 0);
    REQUIRE(guarded.state.wanted_m == 0);
    // The law's, all of it, and the damping.
    CHECK((tick.hand_newton - guarded.state.law_newton - tick.damping_newton).norm() < 1e-12);
}

TEST_CASE("A_d is no less than so much for each newton that is felt", "[haptics][guarded]") {
    GuardedSettings settings;
    const Vec3 force(2e-9, 0, 0);
    const double felt = hand_force(settings.force_law, force).norm();
    const double law = guarded_gain(settings, force, Mat3::Zero()).A_d;
    const double share = GENERATE(0.5, 2.0);

    settings.least_A_d_per_newton = share * law / felt;

    CHECK(guarded_gain(settings, force, Mat3::Zero()).A_d == Approx(std::max(1.0, share) * law));
}

TEST_CASE("a new contact model does not make the force jump", "[haptics][guarded]") {
    const Pair pair;
    Guarded guarded(pair.contact(3.9));
    for (int i = 0; i < 13; ++i) (void)guarded.move(Vec3(-1e-4, 0, 0));
    const double before = guarded.move(Vec3::Zero()).force_newton.x();
    LocalContactModel next = pair.contact(guarded.x());
    const double news = 0.5e-9;
    next.model.force_newton.x() += news;
    guarded.contact = next;
    take_local_contact(guarded.settings, next, guarded.state);

    const double first = guarded.move(Vec3::Zero()).force_newton.x();
    CHECK(std::abs(first - before) < 0.3 * news);
    double last = first;
    for (int i = 0; i < 14; ++i) last = guarded.move(Vec3::Zero()).force_newton.x();
    CHECK(last == Approx(next.model.force_newton.x()).margin(0.03 * news));
}

namespace {

// The field of a pair, and a stiffness of its own for the force.
LocalContactModel relaxed_contact(const Pair& pair, double x, double stiffness, double reach) {
    LocalContactModel contact = pair.contact(x);
    contact.model.relaxed.emplace();
    contact.model.relaxed->matrix(3, 3) = stiffness;
    contact.model.relaxed->reach_angstrom = reach;
    return contact;
}

}  // namespace

TEST_CASE(
    "where everything follows, the force goes by the relaxed stiffness, all else by the field",
    "[haptics][guarded][relaxed]") {
    const Pair pair;
    const LocalContactModel frozen = pair.contact(3.7),
                            relaxed = relaxed_contact(pair, 3.7, 0.4, 0.3);
    const MoleculePose place{Vec3(3.6, 0, 0)};

    const LocalForce one = evaluate_local(frozen.model, frozen.field, place),
                     other = evaluate_local(relaxed.model, relaxed.field, place);

    CHECK(other.force_newton.x() == Approx(pair.force(3.7) + 0.4 * 0.1e-10));
    CHECK(other.slope_N_per_m(0, 0) == 0.4);
    CHECK(one.slope_N_per_m == one.stiffness_N_per_m);
    CHECK(other.stiffness_N_per_m == one.stiffness_N_per_m);
    CHECK(other.clearance_angstrom == one.clearance_angstrom);
    CHECK(other.largest_newton == one.largest_newton);
    REQUIRE(one.stiffness_N_per_m(0, 0) > 1);
}

TEST_CASE("a handle that turns what everything follows feels the relaxed force and torque",
          "[haptics][guarded][relaxed]") {
    // Two springs of a rigid body, apart from each other: a potential of turn and place.
    LocalContactModel contact;
    ContactModel& model = contact.model;
    model.turns_with_handle = true;
    model.molecule.place_angstrom = Vec3(1, 2, 3);
    contact.field.pivot = Vec3(5, 0, 0);
    contact.field.centre = Vec3(6, 1, 0);
    const std::array<Vec3, 2> arms{Vec3(2, 1, 0.5), Vec3(-1, 2, 1)};
    const std::array<double, 2> springs{3, 7};  // N/m
    constexpr double metre = units::metre_per_angstrom;
    model.relaxed.emplace();
    for (std::size_t i = 0; i < 2; ++i) {
        Eigen::Matrix<double, 3, 6> moves;  // of its end, per turn and place
        moves << -metre * cross_matrix(arms[i]), Mat3::Identity();
        model.relaxed->matrix += springs[i] * moves.transpose() * moves;
    }
    const Vec3 turn(2e-5, -1e-5, 3e-5), by(1e-4, 2e-4, -1e-4);

    const LocalForce there =
        evaluate_local(model, contact.field, {model.molecule.place_angstrom + by, turn_of(turn)});

    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3 end = turn_of(turn) * arms[i];
        const Vec3 pull = -springs[i] * metre * (end + by - arms[i]);
        force += pull;
        torque += metre * (end - turn_of(turn) * Vec3(1, 1, 0)).cross(pull);
    }
    CHECK((there.force_newton - force).norm() < 1e-3 * force.norm());
    CHECK((there.torque_newton_metre - torque).norm() < 1e-3 * torque.norm());
}

TEST_CASE("a molecule that everything follows goes no farther than its model reaches, and back",
          "[haptics][guarded][relaxed]") {
    Guarded guarded(relaxed_contact(Pair(), 3.8, 0, 0.1));
    guarded.settings.displacement_law = ConstantDisplacementLaw{0.25e9};
    const double inward = GENERATE(1.0, -1.0);
    for (int i = 0; i < 1000; ++i) (void)guarded.move(Vec3(-inward * 1e-3, 0, 0));
    const double out = std::abs(guarded.x() - 3.8);
    CHECK(out <= 0.1 + guarded.state.at_place.clearance_angstrom + 1e-9);
    CHECK(out > 0.09);
    for (int i = 0; i < 100; ++i) (void)guarded.move(Vec3(inward * 1e-3, 0, 0));
    CHECK(std::abs(guarded.x() - 3.8) < out - 0.01);
}

TEST_CASE("where everything follows, a new model's force comes in over 30 ms, gently",
          "[haptics][guarded][relaxed]") {
    const Pair pair;
    const double news = GENERATE(0.02e-9, 0.5e-9, -3e-9);
    Guarded guarded(relaxed_contact(pair, 3.9, 0, 0.3));
    for (int i = 0; i < 50; ++i) (void)guarded.move(Vec3::Zero());
    double now = guarded.move(Vec3::Zero()).hand_newton.x();
    const double before = now;
    // Every tick, as at T_s = 1 ms.
    double largest = 0, after_ten = 0;
    for (int i = 0; i < 1000; ++i) {
        guarded.contact = relaxed_contact(pair, guarded.x(), 0, 0.3);
        guarded.contact.model.force_newton.x() += news;
        take_local_contact(guarded.settings, guarded.contact, guarded.state);
        const double next = guarded.move(Vec3::Zero()).hand_newton.x();
        largest = std::max(largest, std::abs(next - now));
        now = next;
        if (i == 9) after_ten = now;
    }
    const double wanted = hand_force(guarded.settings.force_law, pair.force(3.9) + news);
    CHECK(largest < 0.03);
    CHECK(now == Approx(wanted).margin(1e-6));
    CHECK(std::abs(after_ten - before) < 0.8 * std::abs(wanted - before));
}

TEST_CASE("a clash of one model alone is felt as the stop, outwards, and forgotten in 0.7 s",
          "[haptics][guarded][relaxed]") {
    const Pair pair;
    Guarded guarded(relaxed_contact(pair, 3.9, 0, 0.3));
    guarded.settings.force_law = ConstantForceLaw{0.8e9};
    for (int i = 0; i < 50; ++i) (void)guarded.move(Vec3::Zero());
    const LocalContactModel usual = guarded.contact;
    guarded.contact.model.force_newton.x() += 6e-6;  // 4.8 kN at the handle
    take_local_contact(guarded.settings, guarded.contact, guarded.state);
    const int ticks = GENERATE(1, 10, 100);
    double largest = 0, least = 0;
    for (int i = 0; i < ticks; ++i) {
        const double force = guarded.move(Vec3::Zero()).force_newton.x();
        largest = std::max(largest, force);
        least = std::min(least, force);
    }
    CHECK(largest <= guarded.settings.stop_newton * (1 + 1e-9));

    guarded.contact = usual;
    take_local_contact(guarded.settings, guarded.contact, guarded.state);
    double now = 0;
    for (int i = 0; i < 700; ++i) {
        now = guarded.move(Vec3::Zero()).force_newton.x();
        least = std::min(least, now);
    }
    CHECK(now == Approx(pair.force(3.9)).margin(1e-12));
    CHECK(least >= 1.01 * pair.force(3.9));
}

TEST_CASE("backing away from a stop with travel that waits, the wall never pushes harder",
          "[haptics][guarded][relaxed]") {
    Guarded guarded(relaxed_contact(Pair(), 3.8, 0, 0.05));
    guarded.settings.displacement_law = ConstantDisplacementLaw{0.25e9};
    for (int i = 0; i < 100; ++i) (void)guarded.move(Vec3(-2e-4, 0, 0));
    REQUIRE(guarded.state.waiting_m.norm() > 1e-3);
    double before = guarded.state.overtravel_m.norm();
    for (int i = 0; i < 40; ++i) {
        (void)guarded.move(Vec3(2e-4, 0, 0));
        CHECK(guarded.state.overtravel_m.norm() <= before + 1e-9);
        before = guarded.state.overtravel_m.norm();
    }
}

TEST_CASE("what is blended counts in the energy books", "[haptics][guarded][relaxed]") {
    Guarded guarded(relaxed_contact(Pair(), 3.9, 0, 0.3));
    guarded.settings.damping_N_s_per_m = 0;
    guarded.contact.model.force_newton.x() -= 0.2e-9;
    take_local_contact(guarded.settings, guarded.contact, guarded.state);
    REQUIRE(guarded.state.blend_residual_newton.x() > 0.1e-9);
    // As the rest of the old force pulls: work on the hand.
    const double by = 1e-4;
    const GuardedTick tick = guarded.move(Vec3(by, 0, 0));
    const double with = hand_force(guarded.settings.force_law, tick.force_newton.x());
    const double without =
        hand_force(guarded.settings.force_law, guarded.state.at_place.force_newton.x());
    REQUIRE(tick.clipped_m.isZero());
    CHECK(guarded.state.energy_balance_J == Approx(by * (with - without)));
}

TEST_CASE("the relaxed stiffness decides the cap, the frozen one the law's own term",
          "[haptics][guarded][relaxed]") {
    // At rest, where eq. 3 falls into its notch but for its term of the stiffness.
    GuardedSettings settings;
    settings.displacement_law = RepairedDisplacementLaw({});
    const Vec3 none = Vec3::Zero();
    const Mat3 frozen = 30 * Mat3::Identity(), relaxed = 0.5 * Mat3::Identity();

    const GuardedGain gain = guarded_gain(settings, none, frozen, relaxed);

    const double law = displacement_gain(settings.displacement_law, 0, 30);
    CHECK(law > 0.9 * displacement_gain(settings.displacement_law, 1e-9));
    CHECK(gain.A_d == law);
    CHECK(gain.felt_N_per_m == Approx(largest_felt(settings.force_law, none, relaxed) / gain.A_d));
    // A relaxed stiffness that is felt as more than the cap raises A_d to it.
    const double soft = guarded_gain(settings, none, frozen, frozen).A_d;
    CHECK(soft == Approx(largest_felt(settings.force_law, none, frozen) / settings.cap_N_per_m));
    CHECK(soft > gain.A_d);
}

TEST_CASE("the gain of a relaxed model is that of the frozen surroundings beyond its region",
          "[haptics][guarded][relaxed]") {
    const Pair pair;
    Guarded guarded(relaxed_contact(pair, 3.75, 0.1, 0.05));
    guarded.settings.displacement_law = ConstantDisplacementLaw{0.005e9};
    const double within = guarded.move(Vec3::Zero()).displacement_gain;
    CHECK(within == Approx(0.005e9));

    // The clearance lets it go beyond; there the frozen stiffness is felt.
    guarded.state.molecule.place_angstrom.x() = 3.75 - 0.06;
    take_local_contact(guarded.settings, guarded.contact, guarded.state);
    const GuardedTick beyond = guarded.move(Vec3::Zero());
    const double felt = largest_felt(guarded.settings.force_law, beyond.force_newton,
                                     guarded.state.at_place.stiffness_N_per_m);
    REQUIRE(felt > 1.1 * guarded.settings.cap_N_per_m * within);
    CHECK(beyond.displacement_gain == Approx(felt / guarded.settings.cap_N_per_m).epsilon(0.01));
}

TEST_CASE("while the molecule waits for its model the travel is kept, felt, and followed later",
          "[haptics][guarded][relaxed]") {
    const Pair pair;
    Guarded guarded(relaxed_contact(pair, 3.8, 0, 0.05));
    guarded.settings.displacement_law = ConstantDisplacementLaw{0.25e9};
    guarded.settings.damping_N_s_per_m = 0;
    double clipped_m = 0;
    const auto move = [&](double by) {
        const GuardedTick tick = guarded.move(Vec3(by, 0, 0));
        clipped_m += tick.clipped_m.norm();
        return tick;
    };
    for (int i = 0; i < 100; ++i) (void)move(-2e-4);
    const double stood = guarded.x();
    const double kept = guarded.state.waiting_m.norm();
    CHECK(stood < 3.8);
    CHECK(kept > 0.005);
    CHECK(kept <= most_waiting_m * (1 + 1e-12));
    CHECK(guarded.state.overtravel_m.isZero());
    // Handle travel is what the molecule went, what waits, and what was clipped: nothing is lost.
    const double gone = (3.8 - stood) * 1e-10 * 0.25e9;
    CHECK(gone + kept + clipped_m == Approx(0.02).epsilon(1e-6));
    // The force of the molecule is still told from the spring.
    for (int i = 0; i < 100; ++i) (void)move(0);
    guarded.state.energy_balance_J = 0;  // what the attraction did for nothing would be taken back
    const GuardedTick still = move(0);
    const double law = hand_force(guarded.settings.force_law, still.force_newton.x());
    CHECK(std::abs(still.hand_newton.x() - law) == Approx(waiting_N_per_m * kept).epsilon(1e-6));
    CHECK(waiting_N_per_m * kept <= most_waiting_newton);

    // More is clipped, and counted.
    const double before = clipped_m;
    for (int i = 0; i < 200; ++i) (void)move(-2e-4);
    CHECK(guarded.state.waiting_m.norm() == Approx(most_waiting_m));
    CHECK(clipped_m - before > 0.02);

    // Its model has come: it follows, by no more than the limits of a step each tick.
    double last = guarded.x(), longest = 0;
    for (int i = 0; i < 3000 && guarded.state.waiting_m.norm() > 1e-9; ++i) {
        if (i % 10 == 0) {
            guarded.contact = relaxed_contact(pair, guarded.x(), 0, 0.05);
            take_local_contact(guarded.settings, guarded.contact, guarded.state);
        }
        (void)move(0);
        longest = std::max(longest, std::abs(guarded.x() - last));
        last = guarded.x();
    }
    CHECK(guarded.state.waiting_m.norm() < 1e-9);
    CHECK(longest < 0.05);
    CHECK(last < stood - 0.1);
}

TEST_CASE("travel that waits is undone first, and stays while the hand clutches",
          "[haptics][guarded][relaxed]") {
    Guarded guarded(relaxed_contact(Pair(), 3.8, 0, 0.02));
    guarded.settings.displacement_law = ConstantDisplacementLaw{0.25e9};
    for (int i = 0; i < 100; ++i) (void)guarded.move(Vec3(-2e-4, 0, 0));
    const Vec3 kept = guarded.state.waiting_m;
    REQUIRE(kept.norm() > 0.01);
    const double stood = guarded.x();

    for (int i = 0; i < 400; ++i)
        (void)step_guarded(guarded.settings, guarded.contact, Vec3::Zero(), {Vec3(1e-3, 0, 0)},
                           true, guarded.state);
    CHECK((guarded.state.waiting_m - kept).norm() < 1e-6);

    for (int i = 0; i < 45; ++i) (void)guarded.move(Vec3(2e-4, 0, 0));
    CHECK(guarded.state.waiting_m.norm() == Approx(kept.norm() - 45 * 2e-4).epsilon(1e-3));
    CHECK(guarded.x() == Approx(stood).epsilon(1e-6));
}

TEST_CASE("a closed path with travel that waits gives the hand no energy",
          "[haptics][guarded][relaxed]") {
    // Out against a spring faster than models come, a rest, and back; models every `period` ticks.
    const Pair pair;
    const int period = GENERATE(1, 14, 83), ticks = GENERATE(50, 400);
    const double spring = GENERATE(2.0, 15.0);  // N/m of the relaxed surroundings
    CAPTURE(period, ticks, spring);
    Guarded guarded(relaxed_contact(pair, 5, spring, 0.1));
    guarded.settings.displacement_law = ConstantDisplacementLaw{0.0416e9};
    const double rest = 5;
    double work_J = 0;
    Vec3 force = Vec3::Zero();
    int tick = 0;
    const auto move = [&](double by) {
        work_J += force.x() * by;
        if (tick++ % period == 0) {
            guarded.contact = relaxed_contact(pair, guarded.x(), spring, 0.1);
            guarded.contact.model.period_s = 1e-3 * period;
            guarded.contact.model.force_newton = {-spring * (guarded.x() - rest) * 1e-10, 0, 0};
            take_local_contact(guarded.settings, guarded.contact, guarded.state);
        }
        force = guarded.move(Vec3(by, 0, 0)).hand_newton;
    };
    for (int path = 0; path < 3; ++path) {
        const double by = 0.02 / ticks;
        for (int i = 0; i < ticks; ++i) move(by);
        for (int i = 0; i < 500; ++i) move(0);
        for (int i = 0; i < ticks; ++i) move(-by);
        for (int i = 0; i < 500; ++i) move(0);
        CHECK(work_J < 1e-3);
    }
}

TEST_CASE("how much A_d is raised for the cap is told", "[haptics][guarded]") {
    GuardedSettings settings;
    settings.force_law = ConstantForceLaw{2e9};
    settings.displacement_law = ConstantDisplacementLaw{0.25e9};
    settings.cap_N_per_m = 200;
    const Vec3 springs = GENERATE(Vec3(10, 20, 25), Vec3(10, 50, 75), Vec3(-300, 0, 100));
    settings.gain_shape = GENERATE(GainShape::Scalar, GainShape::Tensor);

    const GuardedGain gain = guarded_gain(settings, Vec3(1e-9, 0, 0), Mat3(springs.asDiagonal()));

    // A gain of 2e9 makes k N/m into 8 k N/m at the handle: 25 N/m are the cap's 200.
    CHECK(gain.cap_ratio == Approx(std::max(1.0, springs.maxCoeff() / 25)));
    CHECK(gain.felt_N_per_m == Approx(std::min(200.0, 8 * springs.maxCoeff())));
}

TEST_CASE("laws that are exchanged while they are felt make no jump", "[haptics][guarded]") {
    const Pair pair;
    const std::vector<ForceLaw> laws{PrintedForceLaw({}), ConstantForceLaw{0.64e9},
                                     ConstantForceLaw{0}, PerceptualForceLaw({}),
                                     PrintedForceLaw::find_calibrated({}).value()};
    for (const ForceLaw& from : laws) {
        for (const ForceLaw& to : laws) {
            Guarded guarded(pair.contact(3.5));
            guarded.settings.force_law = from;
            double before = 0;
            for (int i = 0; i < 20; ++i) before = guarded.move(Vec3::Zero()).hand_newton.x();
            guarded.settings.force_law = to;
            guarded.settings.displacement_law = ConstantDisplacementLaw{1e9};
            ++guarded.settings.revision;
            const double wanted = hand_force(to, pair.force(3.5));
            double largest = 0, now = before;
            for (int i = 0; i < 1000; ++i) {
                const double next = guarded.move(Vec3::Zero()).hand_newton.x();
                largest = std::max(largest, std::abs(next - now));
                now = next;
            }
            CHECK(largest < 0.02 * std::abs(wanted - before) + 1e-12);
            CHECK(now == Approx(wanted).margin(1e-3));
        }
    }
}

TEST_CASE("a law that is exchanged again while the force glides makes no jump either",
          "[haptics][guarded]") {
    const Pair pair;
    Guarded guarded(pair.contact(3.5));
    guarded.settings.force_law = ConstantForceLaw{0};
    guarded.settings.displacement_law = ConstantDisplacementLaw{1e9};
    for (int i = 0; i < 20; ++i) (void)guarded.move(Vec3::Zero());
    guarded.settings.force_law = ConstantForceLaw{0.64e9};
    const double wanted = hand_force(guarded.settings.force_law, pair.force(3.5));
    double now = 0, farthest = 0, largest = 0;
    for (int i = 0; i < 1000; ++i) {
        if (i < 50) ++guarded.settings.revision;
        const double next = guarded.move(Vec3::Zero()).hand_newton.x();
        largest = std::max(largest, std::abs(next - now));
        farthest = std::max(farthest, next / wanted);
        now = next;
    }
    CHECK(largest < 0.02 * std::abs(wanted));
    CHECK(farthest < 1 + 1e-9);
    CHECK(now == Approx(wanted).epsilon(1e-3));
}

TEST_CASE("a hand that takes another molecule feels no jump", "[haptics][guarded]") {
    const Pair pair;
    Guarded guarded(pair.contact(4));
    // Against the wall, so that the stop keeps travel: that is felt too.
    for (int i = 0; i < 3000; ++i) {
        if (i % 14 == 0) guarded.update(pair);
        (void)guarded.move(Vec3(-1e-4, 0, 0));
    }
    const double before = guarded.move(Vec3::Zero()).hand_newton.x();
    REQUIRE(guarded.state.overtravel_m.norm() > 0.05);

    LocalContactModel other = pair.contact(4.2);
    other.model.grip_number = 1;
    guarded.contact = other;
    take_local_contact(guarded.settings, other, guarded.state);
    const double wanted = hand_force(guarded.settings.force_law, pair.force(4.2));
    double now = before, largest = 0;
    for (int i = 0; i < 1500; ++i) {
        const double next = guarded.move(Vec3::Zero()).hand_newton.x();
        largest = std::max(largest, std::abs(next - now));
        now = next;
    }
    CHECK(largest < 0.02 * std::abs(wanted - before));
    CHECK(now == Approx(wanted).epsilon(1e-3));
    CHECK(guarded.x() == Approx(4.2));
}

TEST_CASE("no atom is pushed harder than the stop allows, and what was held back comes back first",
          "[haptics][guarded]") {
    const Pair pair;
    Guarded guarded(pair.contact(4));
    double hardest = 0, held = 0;
    for (int i = 0; i < 3000; ++i) {
        if (i % 14 == 0) guarded.update(pair);
        (void)guarded.move(Vec3(-1e-4, 0, 0));
        hardest = std::max(hardest, pair.force(guarded.x()));
        held = guarded.state.overtravel_m.norm();
    }
    const double innermost = guarded.x();
    CHECK(hardest <= 10e-9);
    CHECK(hardest > 5e-9);
    REQUIRE(held > 0.05);
    // The spring that it is felt as.
    const GuardedTick pushed = guarded.move(Vec3::Zero());
    CHECK(pushed.hand_newton.x() == Approx(hand_force(guarded.settings.force_law, hardest) +
                                           guarded.settings.cap_N_per_m * held)
                                        .epsilon(0.05));
    for (int i = 0; i < static_cast<int>(0.9 * held / 1e-4); ++i)
        (void)guarded.move(Vec3(1e-4, 0, 0));
    CHECK(guarded.x() == Approx(innermost).margin(0.02));
    for (int i = 0; i < 2000; ++i) {
        if (i % 14 == 0) guarded.update(pair);
        (void)guarded.move(Vec3(1e-4, 0, 0));
    }
    CHECK(guarded.x() > innermost + 1);
}

TEST_CASE("a step goes no farther than clearance and period allow, and stays on its line",
          "[haptics][guarded]") {
    const Pair pair;
    Guarded guarded(pair.contact(8));
    double start = 8;
    for (int i = 0; i < 420; ++i) {
        const double before = guarded.x(), clearance = std::max(0.0, before - 3.8);
        const GuardedTick tick = guarded.move(Vec3(-5e-3, 1e-3, -2e-3));
        CHECK(before - guarded.x() <= 0.02 + 0.1 * clearance + 1e-5);
        CHECK(tick.clipped_m.x() <= 0);
        CHECK(guarded.state.molecule.place_angstrom.tail<2>().norm() == 0);
        if (i % 14 != 13) continue;
        // From one model to the next, and what was saved up at its beginning.
        const double room = std::max(0.0, start - 3.8);
        CHECK(start - guarded.x() <= 0.2 + room + 0.02 + 0.1 * room);
        start = guarded.x();
        guarded.update(pair);
    }
}

TEST_CASE("the felt stiffness stays under the cap", "[haptics][guarded]") {
    const Pair pair;
    const double x = GENERATE(3.2, 3.4, 3.6, 3.8, 4.2, 6.0);
    Guarded guarded(pair.contact(x));
    const GuardedTick tick = guarded.move(Vec3::Zero());
    // By differences of hand force and place.
    const auto hand = [&](double at) {
        return hand_force(guarded.settings.force_law, pair.force(at));
    };
    const double handle_m = tick.displacement_gain * 2e-4 * 1e-10;
    const double felt = -(hand(x + 1e-4) - hand(x - 1e-4)) / handle_m;

    CHECK(tick.felt_N_per_m == Approx(std::max(0.0, felt)).epsilon(1e-3).margin(1e-6));
    CHECK(tick.felt_N_per_m <= guarded.settings.cap_N_per_m * (1 + 1e-12));
}

TEST_CASE("on a tangent the molecule goes no farther than its model may be trusted",
          "[haptics][guarded]") {
    LocalContactModel contact;
    contact.model.projector = Vec3::UnitX().asDiagonal();
    contact.model.is_compliant = GENERATE(false, true);
    contact.model.period_s = 0.1;
    contact.model.clearance_angstrom = 1;
    Guarded guarded(contact);
    for (int i = 0; i < 100; ++i) (void)guarded.move(Vec3(-5e-3, 0, 0));

    // 0.2 Å and a sixth of the clearance, and what was saved up.
    CHECK(-guarded.x() <= 0.2 + 0.15 + 0.12);
}

TEST_CASE("a start anew forgets a force that was no number", "[haptics][guarded]") {
    const Pair pair;
    Guarded guarded(pair.contact(4));
    LocalContactModel bad = pair.contact(4);
    bad.model.force_newton.x() = std::numeric_limits<double>::quiet_NaN();
    guarded.contact = bad;
    take_local_contact(guarded.settings, bad, guarded.state);
    CHECK_FALSE(guarded.move(Vec3::Zero()).hand_newton.allFinite());

    LocalContactModel anew = pair.contact(4);
    anew.model.grip_number = 1;
    ++guarded.settings.revision;
    guarded.contact = anew;
    take_local_contact(guarded.settings, anew, guarded.state);

    double felt = 0;
    for (int i = 0; i < 1500; ++i) felt = guarded.move(Vec3::Zero()).hand_newton.x();
    CHECK(felt == Approx(hand_force(guarded.settings.force_law, pair.force(4))).epsilon(1e-3));
}

TEST_CASE("what carries a workspace carries nothing where a force is felt", "[haptics][guarded]") {
    const Pair pair;
    const WorkspaceMap map = GENERATE(WorkspaceMap(BubbleMap{}), WorkspaceMap(DriftMap{}));
    const auto carried = [&](double from) {
        Guarded guarded(pair.contact(from));
        guarded.settings.workspace = map;
        guarded.settings.displacement_law = ConstantDisplacementLaw{1e9};
        for (int i = 0; i < 20; ++i) {
            const Vec3 moved(i % 2 == 0 ? 1e-5 : -1e-5, 0, 0);
            (void)step_guarded(guarded.settings, guarded.contact, Vec3(0.09, 0, 0), {moved}, false,
                               guarded.state);
        }
        return std::abs(guarded.x() - from);
    };
    CHECK(carried(3.6) < 1e-12);
    CHECK(carried(40) > 1e-5);
}

TEST_CASE("the cap is what a device keeps calm, and what the damping pays for",
          "[haptics][guarded]") {
    CHECK(guarded_cap(0.1, 0.5, 1) == Approx(200));
    CHECK(guarded_cap(0, 0.5, 1) == Approx(166.7).epsilon(1e-3));
    CHECK(guarded_cap(5, 0.5, 1) == Approx(200));
    CHECK(guarded_cap(5, 0.5, 0) == Approx(333.3).epsilon(1e-3));
    CHECK(guarded_cap(0.3, 0, 1) == Approx(100));
    CHECK(guarded_cap(0, 0, 1) == 1);
    CHECK(guarded_cap(0.1, 2, 7) == Approx(140));  // 0.5 x 2.1/7.5 ms
    CHECK(guarded_cap(DeviceSpec{.name = "a", .viscosity_N_s_per_m = 0.1}, 0.5, 1) == Approx(200));
    CHECK(guarded_cap(DeviceSpec{.name = "a", .viscosity_N_s_per_m = 0.1, .cap_N_per_m = 1234}, 0.5,
                      1) == 1234);
    CHECK(guarded_damping(0.5, 0.045, 1) == 0.5);
    // 2 ms of filter and 2.5 ms: pi/6 x 0.01/4.5 ms.
    CHECK(guarded_damping(5, 0.01, 1) == Approx(1.1636).epsilon(1e-4));
}

TEST_CASE("a molecule that stands still is not moved, and is let go where it stands",
          "[haptics][guarded]") {
    const Pair pair;
    Guarded guarded(pair.contact(5));
    guarded.contact.model.is_still = true;
    take_local_contact(guarded.settings, guarded.contact, guarded.state);
    for (int i = 0; i < 50; ++i) {
        CHECK(guarded.move(Vec3(-1e-3, 0, 0)).hand_newton.norm() == 0);
    }
    CHECK(guarded.x() == 5);
}

TEST_CASE("clutched, a hand feels nothing of the molecule, and finds it where it was",
          "[haptics][guarded]") {
    const Pair pair;
    Guarded guarded(pair.contact(3.4));
    guarded.settings.damping_N_s_per_m = 0;
    const auto carry = [&](double by_m, bool is_clutched) {
        const Vec3 by(by_m, 0, 0);
        return step_guarded(guarded.settings, guarded.contact, Vec3::Zero(), {by}, is_clutched,
                            guarded.state);
    };
    const double before = carry(0, false).hand_newton.x(), place = guarded.x();
    REQUIRE(std::abs(before) > 0.3);

    for (int i = 0; i < 100; ++i) carry(0, true);
    double work = 0;
    for (int i = 0; i < 100; ++i) work += carry(1e-3, true).hand_newton.x() * 1e-3;
    for (int i = 0; i < 100; ++i) carry(0, true);  // until no speed of the handle is foretold
    CHECK(work == 0);
    CHECK(guarded.x() == place);
    double last = 0, largest_step = 0;
    for (int i = 0; i < 300; ++i) {
        const double felt = carry(0, false).hand_newton.x();
        largest_step = std::max(largest_step, std::abs(felt - last));
        last = felt;
    }
    CHECK(last == Approx(before));
    // Back in a fifth of a second.
    CHECK(largest_step == Approx(std::abs(before) / 200).epsilon(1e-6));
}

TEST_CASE("what the stop has kept is gone once the hand clutches", "[haptics][guarded]") {
    const Pair pair;
    Guarded guarded(pair.contact(3.4));
    guarded.settings.stop_newton = 1.5 * std::abs(pair.force(3.4));
    for (int i = 0; i < 200; ++i) guarded.move(Vec3(-1e-3, 0, 0));
    REQUIRE(guarded.state.overtravel_m.norm() > 0.05);
    for (int i = 0; i < 100; ++i)
        (void)step_guarded(guarded.settings, guarded.contact, Vec3::Zero(), {}, true,
                           guarded.state);
    CHECK(guarded.state.overtravel_m.norm() == 0);
}
