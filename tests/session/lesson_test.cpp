// The lesson of a scene: what counts as done, and the water scene's own, played by the operator.
#include "session/lesson.h"

#include "devices/emulated_omni.h"
#include "loading/load.h"
#include "session/lockstep.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/step.h"
#include "tests/support/water_run.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

using namespace palpa;

namespace {

LessonStepDescription step_of(LessonQuantity quantity, std::optional<double> at_least,
                              std::optional<double> at_most, double for_s = 0) {
    return {"step", "text", "task", quantity, at_least, at_most, for_s};
}

constexpr CouplingMode mode_2 = CouplingMode::VariableForceConstantDisplacement;

// Plays the water scene as the operator's path has it, and follows the lesson from `mode`.
Lesson play_water(const std::vector<std::string>& settings, Lesson lesson) {
    const SceneDescription scene = test::water_scene(settings);
    World world = load_world(scene);
    EmulatedOmni device(test::build_played_omni(scene, world));
    const auto step = [&](const HandPose& hand, const ContactModel& felt) {
        (void)step_world(world, hand, felt);
        return contact_at(world, 0);
    };
    run_lockstep({static_cast<std::uint64_t>(scene.seconds * servo_rate_hz), 1},
                 build_servo_settings(scene, world, 0), device, contact_at(world, 0).model, step,
                 [&](const ServoTick& tick) {
                     lesson.update(read_tick(tick), scene.coupling.mode);
                     lesson.go_on();
                 });
    return lesson;
}

}  // namespace

TEST_CASE("a step is done when its value held for its time without a break", "[session][lesson]") {
    Lesson lesson({step_of(LessonQuantity::Distance, 2.0, 3.0, 0.01),
                   step_of(LessonQuantity::Force, {}, -0.3)});
    Reading reading;
    reading.distance_angstrom = 2.5;
    for (int tick = 0; tick < 9; ++tick) lesson.update(reading, mode_2);
    CHECK_FALSE(lesson.is_step_done());
    CHECK(lesson.share() == Approx(0.9));

    reading.distance_angstrom = 3.5;  // a break: the time starts again
    lesson.update(reading, mode_2);
    CHECK(lesson.share() == 0);
    reading.distance_angstrom = 3.0;
    for (int tick = 0; tick < 10; ++tick) lesson.update(reading, mode_2);
    CHECK(lesson.is_step_done());
    CHECK(lesson.share() == 1);
    reading.distance_angstrom = 9;  // what is done stays done
    lesson.update(reading, mode_2);
    CHECK(lesson.is_step_done());
}

TEST_CASE("a step stays on screen for three seconds, and until the person goes on",
          "[session][lesson]") {
    Lesson lesson(
        {step_of(LessonQuantity::Force, {}, -0.3), step_of(LessonQuantity::Force, {}, 9)});
    Reading pulled;
    pulled.molecular_nN = -0.3;
    lesson.update(pulled, mode_2);
    CHECK(lesson.is_step_done());
    for (int tick = 1; tick < 2999; ++tick) lesson.update(pulled, mode_2);
    CHECK_FALSE(lesson.go_on());
    for (int tick = 0; tick < 3000; ++tick) lesson.update(pulled, mode_2);
    CHECK(lesson.current() == 0);  // nobody went on
    CHECK(lesson.steps_done() == 1);
    CHECK(lesson.go_on());
    CHECK(lesson.current() == 1);
    CHECK_FALSE(lesson.is_step_done());
    CHECK_FALSE(lesson.go_on());

    // A step that is not done is left by skipping it alone.
    for (int tick = 0; tick < 4000; ++tick) lesson.update({.molecular_nN = 10}, mode_2);
    CHECK_FALSE(lesson.go_on());
    lesson.skip();
    CHECK(lesson.is_done());
    lesson.update(pulled, mode_2);  // nothing left to do
    CHECK(lesson.current() == 2);
    lesson.restart();
    CHECK(lesson.current() == 0);
    CHECK_FALSE(lesson.is_step_done());
}

TEST_CASE("a step can ask for what the hand feels, and for a mode as the keys count it",
          "[session][lesson]") {
    Lesson felt({step_of(LessonQuantity::FeltForce, 1.0, {})});
    Reading reading;
    reading.hand_N = 0.9;
    felt.update(reading, mode_2);
    CHECK_FALSE(felt.is_step_done());
    reading.hand_N = 1.5;
    felt.update(reading, mode_2);
    CHECK(felt.is_step_done());

    Lesson mode({step_of(LessonQuantity::Mode, 4.0, 4.0)});
    mode.update(reading, mode_2);
    CHECK_FALSE(mode.is_step_done());
    mode.update(reading, CouplingMode::ConstantForceConstantDisplacement);
    CHECK(mode.is_step_done());
}

TEST_CASE("a question is done by its right answer alone", "[session][lesson]") {
    LessonStepDescription asked{"ask", "text", "task", LessonQuantity::Distance, {}, {}, 0};
    asked.question = LessonQuestion{"why?", {"so", "thus"}, 2, {"no", "yes"}};
    Lesson lesson({asked, step_of(LessonQuantity::Force, {}, -0.3)});
    for (int tick = 0; tick < 4000; ++tick) lesson.update({.molecular_nN = -1}, mode_2);
    CHECK_FALSE(lesson.is_step_done());
    lesson.answer(0);
    CHECK(lesson.chosen() == 0U);
    CHECK_FALSE(lesson.is_step_done());
    lesson.answer(1);
    CHECK(lesson.is_step_done());
    CHECK(lesson.go_on());
    CHECK_FALSE(lesson.chosen());
    lesson.answer(1);  // to no question
    CHECK_FALSE(lesson.is_step_done());
}

TEST_CASE("what the world says counts, as soon as it is known", "[session][lesson]") {
    Lesson lesson({step_of(LessonQuantity::Way, 2.0, {}), step_of(LessonQuantity::Work, 2.0, {})});
    const std::vector<double> nothing{std::nan(""), 5}, done{2.5, 1};
    lesson.update({}, mode_2, nothing);
    CHECK_FALSE(lesson.value());
    CHECK_FALSE(lesson.is_step_done());
    lesson.update({}, mode_2, done);
    CHECK(lesson.value() == 2.5);
    CHECK(lesson.is_step_done());
    lesson.skip();
    lesson.update({}, mode_2, done);  // of its own step
    CHECK_FALSE(lesson.is_step_done());
}

TEST_CASE("a ripple is of the last two seconds of the force on the hand", "[session][lesson]") {
    Lesson lesson({step_of(LessonQuantity::Ripple, 0.3, {})});
    Reading reading;
    const auto shake = [&](double amplitude, int ticks) {
        for (int tick = 0; tick < ticks; ++tick) {
            reading.hand_N = amplitude * std::sin(2 * 3.14159265 * 20 * tick * 1e-3);
            lesson.update(reading, mode_2);
        }
    };
    shake(0.1, 1900);
    CHECK_FALSE(lesson.value());
    shake(0.1, 350);  // of a sine the rms is the amplitude over the root of 2
    CHECK(*lesson.value() == Approx(0.1 / std::sqrt(2)).epsilon(0.02));
    CHECK_FALSE(lesson.is_step_done());
    shake(0.5, 2250);
    CHECK(lesson.is_step_done());
}

TEST_CASE("a hand that has let go has no ripple", "[session][lesson]") {
    Lesson lesson({step_of(LessonQuantity::Ripple, {}, 0.03)});
    Reading reading;
    for (int tick = 0; tick < 2500; ++tick) {
        reading.hand_N = 0.2 * std::sin(2 * 3.14159265 * 20 * tick * 1e-3);
        lesson.update(reading, mode_2);
    }
    REQUIRE(lesson.value());
    reading.hand_N = 0;
    for (int tick = 0; tick < 5000; ++tick) lesson.update(reading, mode_2);
    CHECK_FALSE(lesson.value());
    CHECK_FALSE(lesson.is_step_done());
    reading.hand_N = 0.5;  // taken again, and held still
    for (int tick = 0; tick < 2500; ++tick) lesson.update(reading, mode_2);
    CHECK(lesson.is_step_done());
}

TEST_CASE("on one axis what drives apart is positive, in three dimensions a force is a norm",
          "[session][lesson]") {
    ServoTick tick;
    tick.contact.molecule.place_angstrom = {-3, 0, 0};  // on the other side of its counterpart
    tick.contact.force_newton = {-2e-9, 0, 0};
    tick.sent_newton = {0.5, 0, 0};
    tick.contact.active_freedom = 1;
    CHECK(read_tick(tick).distance_angstrom == 3);
    CHECK(read_tick(tick).molecular_nN == Approx(2));
    CHECK(read_tick(tick).hand_N == -0.5);
    tick.contact.active_freedom = 3;
    CHECK(read_tick(tick).hand_N == 0.5);
}

TEST_CASE("readings as CSV have names, units and every digit", "[session]") {
    const std::vector<Reading> readings{{0.1, 3.25, -0.3, 1.5, 2.5e8, -6.6}, {}};
    CHECK(format_readings(readings) ==
          "time_s,distance_angstrom,molecular_nN,hand_N,displacement_gain,potential_kcal_per_mol\n"
          "0.1,3.25,-0.3,1.5,250000000,-6.6\n"
          "0,0,0,0,0,0\n");
}

TEST_CASE("the emulated operator does the water scene's first lesson",
          "[session][lesson][coupling]") {
    // mm of the handle, 25 to 1 Å: to 3.9 Å, the strongest pull, the rest, the wall.
    const std::vector<std::string> path{"stroke=path", "seconds=24",
                                        "path=[[0.2, 77.5], [4, 0], [8, -20.0], [9, -20.0], [11, "
                                        "-28.3], [14, -28.3], [16, -42.0]]"};
    const Lesson lesson(test::water_scene().lesson);
    REQUIRE(lesson.steps().size() == 6);

    const Lesson first = play_water(path, lesson);
    INFO("stopped at " << (first.is_done() ? "the end" : first.steps()[first.current()].name));
    REQUIRE(first.current() == 4);

    // The last task is a key.
    Lesson second = first;
    second.update({}, CouplingMode::ConstantForceConstantDisplacement);
    CHECK(second.is_step_done());

    // A hand that does nothing learns nothing.
    CHECK(play_water({"stroke=path", "path=[[0, 0]]", "seconds=2"}, lesson).current() == 0);
}
