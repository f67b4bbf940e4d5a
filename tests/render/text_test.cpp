// Letters by what can be said of them without knowing their shapes: where there is ink, how much,
// and what is around it.
#include "render/text.h"

#include "core/load_error.h"
#include "tests/support/paths.h"
#include "tests/support/skip.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

constexpr TextColours black_on_white{{0, 0, 0}, {255, 255, 255}};

Picture plain(std::uint32_t width, std::uint32_t height, std::array<std::uint8_t, 4> colour) {
    Picture picture{width, height, {}, {}, {}};
    for (std::size_t i = 0; i < std::size_t{width} * height; ++i)
        picture.rgba.insert(picture.rgba.end(), colour.begin(), colour.end());
    return picture;
}

constexpr std::array<std::uint8_t, 4> grey{128, 128, 128, 255};

// Of pixels of a grey picture that are darker (letters) or lighter (their halo) by 64 codes.
struct Found {
    int ink = 0, halo = 0;
    PixelBox ink_box{1 << 20, 1 << 20, 0, 0}, box{1 << 20, 1 << 20, 0, 0};  // box: of both
};
void widen(PixelBox& box, int x, int y) {
    box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x + 1),
           std::max(box.bottom, y + 1)};
}
Found look_at(const Picture& picture) {
    Found found;
    for (int y = 0; y < static_cast<int>(picture.height); ++y) {
        for (int x = 0; x < static_cast<int>(picture.width); ++x) {
            const int code = picture.rgba[4 * (static_cast<std::size_t>(y) * picture.width +
                                               static_cast<std::size_t>(x))];
            if (code < 64) ++found.ink, widen(found.ink_box, x, y);
            if (code > 192) ++found.halo;
            if (code != 128) widen(found.box, x, y);
        }
    }
    return found;
}

// Nothing where the program has no FreeType or the machine no font: the test is skipped then.
std::optional<TextPainter> find_painter() {
    try {
        return open_text_painter();
    } catch (const LoadError& error) {
        test::skip(error.what());
        return std::nullopt;
    }
}

}  // namespace

TEST_CASE("there is ink where the words are, a halo around it, and nothing elsewhere",
          "[render][text]") {
    std::optional<TextPainter> painter = find_painter();
    if (!painter) return;
    Picture picture = plain(200, 100, grey);

    painter->draw(picture, "Asp 25", 60, 40, 20, black_on_white);

    const Found found = look_at(picture);
    const TextSize size = painter->measure("Asp 25", 20);
    CHECK(found.ink > 60);
    CHECK(found.halo > found.ink);
    CHECK(found.ink_box.left >= 60);
    CHECK(found.ink_box.right <= 60 + size.width);
    CHECK(found.ink_box.top >= 40);
    CHECK(found.ink_box.bottom <= 40 + size.height);
    // On every side.
    CHECK(found.box.left < found.ink_box.left);
    CHECK(found.box.right > found.ink_box.right);
    CHECK(found.box.top < found.ink_box.top);
    CHECK(found.box.bottom > found.ink_box.bottom);
    CHECK(found.box.left >= 60 - halo_width(20));
    CHECK(found.box.bottom <= 40 + size.height + halo_width(20));
}

TEST_CASE("letters are as large as asked", "[render][text]") {
    std::optional<TextPainter> painter = find_painter();
    if (!painter) return;
    const auto height_of_ink = [&](int letter_size) {
        Picture picture = plain(400, 200, grey);
        painter->draw(picture, "H", 100, 50, letter_size, black_on_white);
        return look_at(picture).ink_box.height();
    };

    // Capitals of a font for reading are 0.6 to 0.8 of its em.
    for (const int letter_size : {12, 24, 48, 96}) {
        INFO(letter_size);
        CHECK(height_of_ink(letter_size) >= 0.6 * letter_size);
        CHECK(height_of_ink(letter_size) <= 0.8 * letter_size + 1);
    }
    const TextSize small = painter->measure("1.25 nN", 20), large = painter->measure("1.25 nN", 60);
    CHECK(large.width == Approx(3 * small.width).epsilon(0.05));
    CHECK(large.height == Approx(3 * small.height).margin(3));
    CHECK(text_size_for(720) == 16);
    CHECK(text_size_for(2160) == 48);
    CHECK(text_size_for(64) == 12);
}

TEST_CASE("letters beyond ASCII are one letter each, and bytes that are no text are reported",
          "[render][text]") {
    std::optional<TextPainter> painter = find_painter();
    if (!painter) return;
    const auto width = [&](const char* text) { return painter->measure(text, 40).width; };
    const int rounding = 2;

    CHECK(std::abs(width("ÅÅÅ") - width("AAA")) <= rounding);  // a ring makes no letter wider
    CHECK(width("5 Å²") > width("5 Å"));
    for (const char* const bad : {"\xff", "\xc3", "\xe2\x82", "\xed\xa0\x80", "\xf5\x80\x80\x80",
                                  "\x80\x80", "\n", "\x1b[1m"}) {
        Picture picture = plain(400, 60, grey);
        painter->draw(picture, bad, 5, 5, 20, black_on_white);
        CHECK(look_at(picture).ink > 0);  // as "\xff"
    }
    CHECK(width("\xff") == width("\\xff"));
    CHECK(width("") == 0);
    CHECK(width(std::string(100000, 'A').c_str()) == width(std::string(200, 'A').c_str()));
}

TEST_CASE("what lies outside of the picture is not drawn", "[render][text]") {
    std::optional<TextPainter> painter = find_painter();
    if (!painter) return;
    Picture whole = plain(300, 100, grey);
    painter->draw(whole, "molecule", 100, 40, 30, black_on_white);
    Picture part = plain(60, 40, grey);  // the pixels 120 to 179, 45 to 84 of that
    painter->draw(part, "molecule", -20, -5, 30, black_on_white);

    for (std::size_t y = 0; y < part.height; ++y)
        for (std::size_t x = 0; x < std::size_t{4} * part.width; ++x)
            REQUIRE(part.rgba[std::size_t{4} * part.width * y + x] ==
                    whole.rgba[std::size_t{4} * whole.width * (y + 45) + std::size_t{4} * 120 + x]);
    for (const auto& [left, top] : {std::pair{-1000, 0}, {1000, 0}, {0, -1000}, {0, 1000}}) {
        Picture untouched = plain(60, 40, grey);
        painter->draw(untouched, "molecule", left, top, 30, black_on_white);
        CHECK(untouched.rgba == plain(60, 40, grey).rgba);
    }
}

TEST_CASE("letters can be read over light, dark and nothing", "[render][text]") {
    const auto light = [](const PixelColour& colour) { return colour[0] + colour[1] + colour[2]; };
    const TextColours on_white = text_colours_on({1, 1, 1}), on_black = text_colours_on({0, 0, 0});
    CHECK(light(on_white.halo) - light(on_white.ink) > 500);
    CHECK(light(on_black.ink) - light(on_black.halo) > 500);
    std::optional<TextPainter> painter = find_painter();
    if (!painter) return;

    Picture clear = plain(200, 60, {0, 0, 0, 0});
    painter->draw(clear, "Asp 25", 20, 15, 20, on_white);

    int opaque = 0, untouched = 0;
    for (std::size_t i = 3; i < clear.rgba.size(); i += 4) {
        opaque += clear.rgba[i] > 240 ? 1 : 0;
        untouched += clear.rgba[i] == 0 ? 1 : 0;
    }
    CHECK(opaque > 60);
    CHECK(untouched > 6000);  // half of the pixels
}

TEST_CASE("a colour over a pixel is mixed by its opacity", "[render][picture]") {
    Picture picture = plain(2, 1, {100, 0, 200, 255});
    lay_over(picture, 1, 0, {200, 255, 0}, 0.25F);
    CHECK(picture.rgba == std::vector<std::uint8_t>{100, 0, 200, 255, 125, 64, 150, 255});
    // Where it was clear the colour is whole, and as opaque as it was laid.
    Picture clear = plain(1, 1, {9, 9, 9, 0});
    lay_over(clear, 0, 0, {200, 255, 0}, 0.6F);
    CHECK(clear.rgba == std::vector<std::uint8_t>{200, 255, 0, 153});
    CHECK(srgb_code(0.5F) == 188);
    CHECK(srgb_code(2) == 255);
}

TEST_CASE("a font that is none is reported", "[render][text]") {
    CHECK_THROWS_AS(TextPainter(test::in_project("README.md")), LoadError);
    CHECK_THROWS_AS(TextPainter("/nowhere/font.ttf"), LoadError);
}
