#include "experiments/study_course.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <vector>

using namespace palpa;

namespace {

using Stage = StudyCourse::Stage;

constexpr std::array two_modes{CouplingMode::ConstantForceConstantDisplacement,
                               CouplingMode::NoForce};

// Plays ticks with the molecule at one distance, put there by the n-th start.
void play(StudyCourse& course, std::uint32_t start, double distance, int ticks) {
    ServoTick tick;
    tick.contact.grip_number = start;
    tick.contact.molecule.place_angstrom = Vec3(distance, 0, 0);
    for (int i = 0; i < ticks; ++i) course.add(tick);
}

}  // namespace

TEST_CASE("a person agrees, practises, and finds one trial after another", "[experiments][study]") {
    const std::vector<StudyTrial> trials = plan_study(471100, 1, two_modes, 1);
    StudyCourse course(trials, CouplingMode::Guarded, {.rest = 2.7, .wall = 2.0}, 1);
    std::set<std::string> texts{course.text()};

    CHECK(course.stage() == Stage::Consent);
    CHECK(course.press_key());  // the practice begins anew
    CHECK(course.stage() == Stage::Practice);
    CHECK(course.mode() == CouplingMode::Guarded);
    texts.insert(course.text());
    play(course, 1, 1.5, 5000);  // nothing of this counts
    CHECK_FALSE(course.press_key());

    for (std::uint32_t i = 0; i < 2; ++i) {
        CHECK(course.stage() == Stage::Break);
        texts.insert(course.text());
        CHECK(course.press_key());
        CHECK(course.stage() == Stage::Trial);
        CHECK(course.mode() == trials[i].mode);
        texts.insert(course.text());
        play(course, 1 + i, 1.5, 3000);  // still at its old place: the new one is being loaded
        play(course, 2 + i, 7, 1);
        play(course, 2 + i, i == 0 ? 1.9 : 2.5, 1000);
        play(course, 2 + i, 2.9, 500);
        CHECK_FALSE(course.press_key());
        REQUIRE(course.results().size() == i + 1);
    }

    CHECK(course.stage() == Stage::Done);
    texts.insert(course.text());
    CHECK(texts.size() == 7);
    CHECK_FALSE(course.press_key());
    const StudyResult& first = course.results()[0];
    CHECK(first.trial == trials[0]);
    CHECK(first.trial.participant == 471100);
    CHECK(first.start_angstrom == 7);
    CHECK(first.found_angstrom == 2.9);
    CHECK(first.off_angstrom == Approx(0.2));
    CHECK(first.seconds == Approx(1.501));
    CHECK(first.is_finished);
    CHECK(first.went_through);
    CHECK_FALSE(course.results()[1].went_through);
}

TEST_CASE("a key pressed before a trial has begun, or in its first second, ends nothing",
          "[experiments][study]") {
    StudyCourse course(plan_study(1, 1, two_modes, 1), CouplingMode::Guarded, {2.7, 2.0}, 1);
    play(course, 5, 7, 10);
    (void)course.press_key();
    play(course, 6, 7, 10);
    (void)course.press_key();
    (void)course.press_key();
    REQUIRE(course.stage() == Stage::Trial);

    CHECK_FALSE(course.press_key());
    play(course, 6, 7, 5000);  // not begun
    CHECK_FALSE(course.press_key());
    play(course, 7, 7, 999);
    CHECK_FALSE(course.press_key());
    CHECK(course.stage() == Stage::Trial);
    play(course, 7, 7, 2);
    (void)course.press_key();
    CHECK(course.stage() == Stage::Break);
    CHECK(course.results().size() == 1);
}

TEST_CASE("every trial begins at a place of its own, 4.0 to 6.2 Å outside",
          "[experiments][study]") {
    constexpr double rest = 2.7;
    const auto starts = [&](std::uint64_t seed) {
        StudyCourse course(plan_study(1, 200, two_modes, seed), CouplingMode::Guarded,
                           {.rest = rest, .wall = 2.0}, seed);
        std::vector<double> outside;
        while (course.stage() != Stage::Done) {
            if (course.stage() == Stage::Trial) outside.push_back(course.start_angstrom() - rest);
            play(course, 1, 7, 10);
            play(course, static_cast<std::uint32_t>(2 + course.results().size()), 7, 1100);
            (void)course.press_key();
        }
        return outside;
    };

    const std::vector<double> outside = starts(1);

    REQUIRE(outside.size() == 400);
    const auto [nearest, farthest] = std::ranges::minmax(outside);
    CHECK(nearest >= 4.0);
    CHECK(nearest < 4.1);
    CHECK(farthest <= 6.2);
    CHECK(farthest > 6.1);
    CHECK(outside == starts(1));
    CHECK(outside != starts(2));
}
