#include "view/colour_scales.h"

#include "tests/support/colour_difference.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <limits>

using namespace palpa;

namespace {

test::Colour doubles_of(const glm::vec3& c) { return {c.r, c.g, c.b}; }

double lightness(const test::Vision& vision, const glm::vec3& colour) {
    return test::lab_of(test::multiply(vision.matrix, doubles_of(colour)))[0];
}

}  // namespace

TEST_CASE("potentials are red, white and blue, and stay so beyond the ends", "[view][palette]") {
    const glm::vec3 red = potential_colour(-5), white = potential_colour(0),
                    blue = potential_colour(5);

    CHECK(red.r > 10 * red.b);
    CHECK(blue.b > 5 * blue.r);
    CHECK(white.r == white.g);
    CHECK(white.g == white.b);
    CHECK(white.r > 0.9F);
    CHECK(potential_colour(-50) == red);
    CHECK(potential_colour(1e9) == blue);
    CHECK(diverging_colour(2, 2) == blue);
    const glm::vec3 none = potential_colour(std::numeric_limits<double>::quiet_NaN());
    CHECK(none.r == none.b);
    CHECK(none.r < 0.5F);
}

TEST_CASE("away from 0 a potential's colour is darker and darker for every kind of colour vision",
          "[view][palette]") {
    for (const test::Vision& vision : test::visions) {
        INFO(vision.name);
        for (const double sign : {-1.0, 1.0}) {
            double last = 101;
            for (double potential = 0; potential <= 5; potential += 0.25) {
                const double now = lightness(vision, potential_colour(sign * potential));
                CHECK(now < last);
                last = now;
            }
        }
        // Equal amounts of either sign differ.
        for (double potential = 1; potential <= 5; potential += 1)
            CHECK(test::colour_difference(vision, doubles_of(potential_colour(potential)),
                                          doubles_of(potential_colour(-potential))) > 15);
    }
}

TEST_CASE("the sequential scale becomes lighter in even steps for every kind of colour vision",
          "[view][palette]") {
    for (const test::Vision& vision : test::visions) {
        INFO(vision.name);
        double last = lightness(vision, sequential_colour(0));
        const double begin = last;
        for (int i = 1; i <= 40; ++i) {
            const double now = lightness(vision, sequential_colour(i / 40.0));
            CHECK(now > last);
            CHECK(now - last < 4.5);
            last = now;
        }
        CHECK(last - begin > 60);
    }
    CHECK(sequential_colour(-1) == sequential_colour(0));
    CHECK(sequential_colour(2) == sequential_colour(1));
}

TEST_CASE("hydropathy's ends and middle differ for every kind of colour vision",
          "[view][palette]") {
    const test::Colour water = doubles_of(hydropathy_colour(-4.5)),
                       middle = doubles_of(hydropathy_colour(0)),
                       fat = doubles_of(hydropathy_colour(4.5)),
                       none = doubles_of(hydropathy_colour(std::nullopt));
    for (const test::Vision& vision : test::visions) {
        INFO(vision.name);
        CHECK(test::colour_difference(vision, water, middle) > 25);
        CHECK(test::colour_difference(vision, fat, middle) > 25);
        CHECK(test::colour_difference(vision, water, fat) > 25);
        CHECK(test::colour_difference(vision, none, middle) > 20);
    }
}

TEST_CASE("categories are Okabe and Ito's and differ for every kind of colour vision",
          "[view][palette]") {
    for (const test::Vision& vision : test::visions)
        for (std::size_t i = 0; i < 8; ++i)
            for (std::size_t j = i + 1; j < 8; ++j) {
                INFO(vision.name << ": " << i << ", " << j);
                CHECK(test::colour_difference(vision, doubles_of(categorical_colour(i)),
                                              doubles_of(categorical_colour(j))) > 9);
            }
    CHECK(categorical_colour(9) == categorical_colour(1));
    // Vermilion, #D55E00.
    CHECK(categorical_colour(6).r == Approx(std::pow((213 / 255.0 + 0.055) / 1.055, 2.4)));
    CHECK(categorical_colour(6).b == 0);
}
