#include "view/palette.h"

#include "tests/support/colour_difference.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

using namespace palpa;

namespace {

struct Category {
    std::string name;
    test::Colour colour;
};

test::Colour as_doubles(const glm::vec3& c) { return {c.r, c.g, c.b}; }

std::vector<Category> categories() {
    std::vector<Category> all;
    for (const ElementLook& look : element_looks) {
        all.push_back({std::string(look.element), as_doubles(look.colour)});
    }
    all.push_back({"other element", as_doubles(other_element.colour)});
    all.push_back({"grabbed carbon", as_doubles(grabbed_carbon)});
    for (const glm::vec3& carbon : chain_carbons) {
        all.push_back({"chain carbon", as_doubles(carbon)});
    }
    all.push_back({"force", as_doubles(force_colour)});
    all.push_back({"wish", as_doubles(wish_colour)});
    all.push_back({"hydrogen bond", as_doubles(hydrogen_bond_colour)});
    all.push_back({"selected", as_doubles(selected_colour)});
    return all;
}

// Carbons are in the element's colour or in those of their chains, never both in one picture.
bool are_seen_together(const Category& a, const Category& b) {
    return !(a.name == "C" && b.name == "chain carbon");
}

}  // namespace

TEST_CASE("the colour difference is that of the published pairs", "[view][palette]") {
    // G. Sharma, W. Wu, E. N. Dalal, Color Res. Appl. 30, 21 (2005), table 1: pairs 1, 4, 7, 8, 14,
    // 17, 20, 22, 25, 27, 31 and 34, which reach every branch of the formula.
    struct Pair {
        test::Lab one, two;
        double difference;
    };
    const Pair pair = GENERATE(
        Pair{{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
        Pair{{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
        Pair{{50, 0, 0}, {50, -1, 2}, 2.3669}, Pair{{50, -1, 2}, {50, 0, 0}, 2.3669},
        Pair{{50, -0.0010, 2.4900}, {50, 0.0009, -2.4900}, 4.8045},
        Pair{{50, 2.5, 0}, {73, 25, -18}, 27.1492}, Pair{{50, 2.5, 0}, {58, 24, 15}, 19.4535},
        Pair{{50, 2.5, 0}, {50, 3.2972, 0}, 1.0000},
        Pair{{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
        Pair{{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
        Pair{{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
        Pair{{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082});

    CHECK(test::colour_difference(pair.one, pair.two) == Approx(pair.difference).margin(5e-5));
    CHECK(test::colour_difference(pair.two, pair.one) == Approx(pair.difference).margin(5e-5));
}

TEST_CASE("white, grey and the display's red are where CIE Lab has them", "[view][palette]") {
    const test::Lab white = test::lab_of({1, 1, 1});
    CHECK(white[0] == Approx(100));
    CHECK(std::hypot(white[1], white[2]) < 1e-9);
    CHECK(test::lab_of({0.18418652, 0.18418652, 0.18418652})[0] == Approx(50).margin(1e-3));
    const test::Lab red = test::lab_of({1, 0, 0});
    CHECK(red[0] == Approx(53.24).margin(0.01));
    CHECK(red[1] == Approx(80.09).margin(0.02));
    CHECK(red[2] == Approx(67.20).margin(0.02));
}

TEST_CASE("without one kind of cone greys stay grey, and its colours are confused",
          "[view][palette]") {
    for (const test::Vision& vision : test::visions) {
        INFO(vision.name);
        CHECK(test::colour_difference(vision, {1, 1, 1}, {1, 1, 1}) == 0);
        const test::Colour grey = test::multiply(vision.matrix, {0.4, 0.4, 0.4});
        for (const double channel : grey) CHECK(channel == Approx(0.4).margin(1e-5));
    }
    // A red and a green, a blue and a green of the same mobility weight to those who confuse them.
    const test::Colour red{0.45, 0.10, 0.02}, green{0.10, 0.24, 0.02};
    CHECK(test::colour_difference(test::visions[0], red, green) > 40);
    CHECK(test::colour_difference(test::visions[2], red, green) < 20);
}

TEST_CASE("colours that mark different things differ for every kind of colour vision",
          "[view][palette]") {
    constexpr double usual = 15, least_of_selected = 10;  // CIEDE2000
    const std::vector<Category> all = categories();
    REQUIRE(all.size() == 16);
    for (const test::Vision& vision : test::visions) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            for (std::size_t j = i + 1; j < all.size(); ++j) {
                if (!are_seen_together(all[i], all[j])) continue;
                INFO(vision.name << ": " << all[i].name << ", " << all[j].name << " " << j);
                const double least = all[j].name == "selected" ? least_of_selected : usual;
                CHECK(test::colour_difference(vision, all[i].colour, all[j].colour) >= least);
            }
        }
    }
}

TEST_CASE("ions differ from each other and from all else, and keep the hue of Jmol's",
          "[view][palette]") {
    constexpr double usual = 15, to_the_deficient = 5;  // CIEDE2000
    std::vector<Category> all;
    for (const ElementLook& look : ion_looks)
        all.push_back({std::string(look.element), as_doubles(look.colour)});
    const std::size_t ions = all.size();
    for (const Category& other : categories()) all.push_back(other);
    for (const test::Vision& vision : test::visions) {
        const bool is_normal = std::string(vision.name) == "normal";
        for (std::size_t i = 0; i < ions; ++i) {
            for (std::size_t j = i + 1; j < all.size(); ++j) {
                INFO(vision.name << ": " << all[i].name << ", " << all[j].name << " " << j);
                CHECK(test::colour_difference(vision, all[i].colour, all[j].colour) >=
                      (is_normal ? usual : to_the_deficient));
            }
        }
    }

    // jmol.sourceforge.net/jscolors, 8 bits a channel of sRGB.
    const std::vector<std::array<int, 3>> of_jmol{{171, 92, 242}, {143, 64, 212},  {138, 255, 0},
                                                  {61, 255, 0},   {125, 128, 176}, {31, 240, 31}};
    REQUIRE(of_jmol.size() == ions);
    for (std::size_t i = 0; i < ions; ++i) {
        test::Colour jmol{};
        for (std::size_t c = 0; c < 3; ++c) {
            const double v = of_jmol[i][c] / 255.0;
            jmol[c] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
        }
        INFO(all[i].name);
        CHECK(test::colour_difference(test::visions[0], all[i].colour, jmol) < 20);
    }
}

TEST_CASE("elements are told by their symbols, whatever they are", "[view][palette]") {
    CHECK(look_of("CL").colour == ion_looks.back().colour);
    CHECK(look_of("C").colour == element_looks[1].colour);
    CHECK(look_of("FE").colour == other_element.colour);
}

TEST_CASE("marks on request differ from each other and from signs for every kind of colour vision",
          "[view][palette]") {
    constexpr double least = 15;  // CIEDE2000
    const std::vector<Category> marks{{"contact", as_doubles(contact_colour)},
                                      {"clash", as_doubles(clash_colour)},
                                      {"salt bridge", as_doubles(salt_bridge_colour)},
                                      {"measure", as_doubles(measure_colour)},
                                      {"force", as_doubles(force_colour)},
                                      {"wish", as_doubles(wish_colour)},
                                      {"hydrogen bond", as_doubles(hydrogen_bond_colour)},
                                      {"background", {1, 1, 1}}};
    for (const test::Vision& vision : test::visions) {
        for (std::size_t i = 0; i < marks.size(); ++i) {
            for (std::size_t j = i + 1; j < marks.size(); ++j) {
                INFO(vision.name << ": " << marks[i].name << ", " << marks[j].name);
                CHECK(test::colour_difference(vision, marks[i].colour, marks[j].colour) >= least);
            }
        }
    }
}
