// Goals of lessons in words.
#include "ui/lesson_plots.h"

#include <catch2/catch.hpp>
#include <optional>

using namespace palpa;

namespace {

LessonStepDescription step_of(LessonQuantity quantity, std::optional<double> at_least,
                              std::optional<double> at_most) {
    LessonStepDescription step;
    step.quantity = quantity;
    step.at_least = at_least;
    step.at_most = at_most;
    return step;
}

}  // namespace

TEST_CASE("a force that must be below 0 is a pull, and no number has a sign", "[ui][lesson]") {
    const LessonStepDescription felt = step_of(LessonQuantity::FeltForce, {}, -0.5);
    const LessonGoal goal = describe_goal(felt, -0.279, 0);
    CHECK(goal.now == "pull on your hand: 0.279 N");
    CHECK(goal.goal == "goal: 0.5 N or more");
    CHECK(goal.share == Approx(0.279 / 0.5));
    CHECK(describe_goal(felt, -0.7, 0).share == 1);
    CHECK(describe_goal(felt, 0.4, 0).share == 0);  // the wrong way

    const LessonStepDescription held = step_of(LessonQuantity::Force, -0.4, -0.2);
    CHECK(describe_goal(held, -0.1, 0).now == "pull on the molecule: 0.1 nN");
    CHECK(describe_goal(held, -0.1, 0).goal == "goal: 0.2 to 0.4 nN");
    CHECK(describe_goal(held, -0.1, 0).share == Approx(0.5));

    const LessonStepDescription wall = step_of(LessonQuantity::Force, 1.0, {});
    CHECK(describe_goal(wall, 0.25, 0).now == "force on the molecule: 0.25 nN");
    CHECK(describe_goal(wall, 0.25, 0).goal == "goal: 1 nN or more");
}

TEST_CASE("a goal is as near as the way from where the step began", "[ui][lesson]") {
    const LessonStepDescription near = step_of(LessonQuantity::Distance, {}, 4.0);
    CHECK(describe_goal(near, 7, 7).share == 0);
    CHECK(describe_goal(near, 5, 7).share == Approx(2.0 / 3));
    CHECK(describe_goal(near, 5, 7).goal == "goal: 4 Å or less");
    CHECK(describe_goal(near, 3, 7).share == 1);
    CHECK(describe_goal(near, 9, 7).share == 0);

    const LessonStepDescription within = step_of(LessonQuantity::Distance, 2.72, 2.82);
    CHECK(describe_goal(within, 2.77, 4).share == 1);
    CHECK(describe_goal(within, 2.6, 3.1).share == Approx(1 - 0.12 / 0.38));
}

TEST_CASE("a mode is a number, and what is next to nothing is 0", "[ui][lesson]") {
    const LessonStepDescription mode = step_of(LessonQuantity::Mode, 5, 5);
    CHECK(describe_goal(mode, 6, 6).now == "mode: 6");
    CHECK(describe_goal(mode, 6, 6).goal == "goal: 5");
    CHECK(describe_goal(mode, 6, 6).share == 0);
    CHECK(describe_goal(mode, 5, 6).share == 1);

    const LessonStepDescription shakes = step_of(LessonQuantity::Ripple, 0.1, {});
    CHECK(describe_goal(shakes, 8.77e-15, 0).now == "the force shakes by: 0 N");
}
