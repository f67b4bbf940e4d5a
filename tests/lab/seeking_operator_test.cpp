#include "tools/lab/experiments/seeking_operator.h"

#include "haptics/device.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

using namespace palpa;

namespace {

constexpr double far_angstrom = 7, handle_m_per_angstrom = 0.025;

struct Found {
    double distance = far_angstrom;
    double seconds = 0;
    bool is_done = false;
};

// Seeks with a handle that is where the operator wants it, a molecule that follows with a constant
// A_d, and a force on the hand (N) that is given by the distance (Å).
Found seek(const OperatorSettings& settings, std::uint64_t seed,
           const std::function<double(double)>& force_newton) {
    constexpr double longest_s = 60;
    SeekingOperator person(settings, Draws(seed, 0));
    Found found;
    while (!person.is_done() && found.seconds < longest_s) {
        found.distance = far_angstrom + person.wish_m() / handle_m_per_angstrom;
        person.feel(force_newton(found.distance), found.distance);
        found.seconds += servo_tick_s;
    }
    found.is_done = person.is_done();
    return found;
}

// Pushes out inside of the one distance, pulls in outside of the other, and is nothing between.
std::function<double(double)> gap(double inner, double outer) {
    return [=](double distance) { return distance < inner ? 0.4 : distance > outer ? -0.4 : 0; };
}

}  // namespace

TEST_CASE("a spring's rest is found to what can be noticed", "[experiments][operator]") {
    const double spring_N_per_angstrom = GENERATE(1.0, 4.0);
    const auto manner = GENERATE(OperatorManner::Naive, OperatorManner::Careful);
    OperatorSettings settings;
    settings.manner = manner;
    settings.threshold_newton = 0.08;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const Found found = seek(settings, seed, [=](double distance) {
            return distance > 4 ? 0 : -spring_N_per_angstrom * (distance - 2.7);
        });

        INFO("seed " << seed << ": " << found.distance << " Å after " << found.seconds << " s");
        CHECK(found.is_done);
        // The threshold, noise on it, and 1 mm of drift and prediction horizon.
        CHECK(std::abs(found.distance - 2.7) <
              0.13 / spring_N_per_angstrom + 0.001 / handle_m_per_angstrom);
    }
}

TEST_CASE("between two walls the naive stay at one, the careful take the middle",
          "[experiments][operator]") {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        OperatorSettings settings;
        const Found naive = seek(settings, seed, gap(2.6, 3.4));
        settings.manner = OperatorManner::Careful;
        const Found careful = seek(settings, seed, gap(2.6, 3.4));

        INFO("seed " << seed << ": " << naive.distance << " and " << careful.distance << " Å");
        REQUIRE(naive.is_done);
        REQUIRE(careful.is_done);
        CHECK(std::abs(careful.distance - 3.0) < 0.06);
        CHECK(naive.distance < 2.85);
        CHECK(careful.seconds > naive.seconds + 1);
    }
}

TEST_CASE("a force is answered 0.15 s late", "[experiments][operator]") {
    OperatorSettings settings;
    settings.approach_m_per_s = 0.05;
    SeekingOperator person(settings, Draws(1, 0));
    const auto wait = [&](int ticks) {
        for (int i = 0; i < ticks; ++i) person.feel(2, 2.7);
        return person.wish_m();
    };

    // On its way in until then; a drift of 0.3 mm is beside it.
    CHECK(wait(150) == Approx(-0.05 * 0.150).margin(1e-3));
    const double turned = wait(30);
    CHECK(turned < -0.05 * 0.140);
    CHECK(wait(300) > turned + 3e-3);
}

TEST_CASE("without force the picture leads to what is guessed", "[experiments][operator]") {
    OperatorSettings settings;
    settings.has_force = false;
    settings.guess_angstrom = 3.3;
    settings.handle_m_per_angstrom = handle_m_per_angstrom;

    const Found found = seek(settings, 3, [](double) { return 5.0; });

    CHECK(found.is_done);
    CHECK(found.distance == Approx(3.3).margin(0.05));
}

TEST_CASE("the same seed is the same person", "[experiments][operator]") {
    const auto wall = gap(2.6, 3.4);

    const Found one = seek({}, 1, wall), again = seek({}, 1, wall), other = seek({}, 2, wall);

    CHECK(one.distance == again.distance);
    CHECK(one.seconds == again.seconds);
    CHECK(one.distance != other.distance);
}
