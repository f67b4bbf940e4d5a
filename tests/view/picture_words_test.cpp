// Where words go: every label beside its place, none over another.
#include "view/picture_words.h"

#include "core/load_error.h"
#include "loading/load.h"
#include "render/renderer.h"
#include "simulation/components.h"
#include "tests/support/skip.h"
#include "tests/support/water_scene.h"
#include "view/legend.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

using namespace palpa;

namespace {

constexpr std::uint32_t picture_width = 640, picture_height = 480;
constexpr int gap = 2;

PlacedLabels place(const std::vector<ViewLabel>& labels, const FrameCamera& camera = {}) {
    std::vector<TextSize> sizes;
    for (const ViewLabel& label : labels)
        sizes.push_back({8 * static_cast<int>(label.text.size()), 16});
    return place_labels(labels, sizes, camera, {picture_width, picture_height, gap, {}});
}

bool has(const PlacedLabels& found, std::size_t label) {
    return std::ranges::find(found.placed, label, &PlacedLabel::label) != found.placed.end();
}

std::vector<std::uint8_t> white(std::size_t across, std::size_t down) {
    return std::vector<std::uint8_t>(4 * across * down, 255);
}

// How far a place is from a box, pixels; 0 inside.
double distance(const glm::vec3& place, const PixelBox& box) {
    const auto beyond = [](double at, double low, double high) {
        return std::max({low - at, at - high, 0.0});
    };
    return std::hypot(beyond(place.x, box.left, box.right), beyond(place.y, box.top, box.bottom));
}

}  // namespace

TEST_CASE("labels stand beside their places, inside of the picture, and never on each other",
          "[view][words]") {
    std::vector<ViewLabel> labels;
    for (int i = 0; i < 400; ++i) {  // a crowd, in all of the picture and around it
        const auto at = [&](int step, float extent) {
            return extent * (static_cast<float>(i * step % 101) / 50 - 1);
        };
        labels.push_back({{at(37, 4), at(53, 3.2F), at(11, 2)}, "ASP 25", i % 3 == 0});
    }

    const PlacedLabels found = place(labels);

    CHECK(found.placed.size() > 40);
    for (std::size_t i = 0; i < found.placed.size(); ++i) {
        const auto& [label, box] = found.placed[i];
        CHECK(box.width() == 48);
        CHECK(box.left >= 0);
        CHECK(box.top >= 0);
        CHECK(box.right <= static_cast<int>(picture_width));
        CHECK(box.bottom <= static_cast<int>(picture_height));
        CHECK(distance(project({}, labels[label].place, picture_width, picture_height), box) <
              2 * 16);
        for (std::size_t k = 0; k < i; ++k) {
            const PixelBox& other = found.placed[k].box;
            const PixelBox wide{other.left - gap, other.top - gap, other.right + gap,
                                other.bottom + gap};
            CHECK(common(box, wide).is_empty());
        }
    }
}

TEST_CASE("where there is little room the nearest have it, and ticks none", "[view][words]") {
    // Of twenty labels at one place seen, only some find room beside it.
    std::vector<ViewLabel> labels{{{0, 0, 0}, "1.00 nN", true}};
    for (int i = 0; i < 20; ++i)
        labels.push_back({{0, 0, -0.1F * static_cast<float>(i)}, "ASP 25"});
    const PlacedLabels crowded = place(labels);
    const std::size_t placed = crowded.placed.size();
    REQUIRE(placed < 20);
    REQUIRE(placed > 3);
    CHECK(crowded.unplaced == 20 - placed);
    CHECK_FALSE(has(crowded, 0));
    for (std::size_t i = 1; i <= placed; ++i) CHECK(has(crowded, i));
    std::reverse(labels.begin(), labels.end());
    const PlacedLabels reversed = place(labels);
    CHECK(has(reversed, 19));
    CHECK_FALSE(has(reversed, 0));

    // A tick alone has room, and is not counted where it has none.
    CHECK(place({{{0, 0, 0}, "0.1", true}}).placed.size() == 1);
    CHECK(place({{{0, 0, 0}, std::string(100, 'x'), true}}).unplaced == 0);
    CHECK(place({{{0, 0, 0}, std::string(100, 'x')}}).unplaced == 1);
}

TEST_CASE("what is behind the camera or beside the picture has no label", "[view][words]") {
    const FrameCamera camera;  // 10 Å from the origin, along -z
    CHECK(place({{{0, 0, 0}, "seen"}}, camera).placed.size() == 1);
    const std::vector<ViewLabel> unseen{{{0, 0, 20}, "behind"},
                                        {{0, 0, 9.95F}, "too near"},
                                        {{9, 0, 0}, "right"},
                                        {{0, -9, 0}, "b"}};
    const PlacedLabels found = place(unseen, camera);
    CHECK(found.placed.empty());
    CHECK(found.unplaced == 0);
}

TEST_CASE("labels keep away from what is there", "[view][words]") {
    const std::vector<ViewLabel> label{{{0, 0, 0}, "ASP 25"}};
    const std::vector<TextSize> size{{48, 16}};
    const LabelRoom all_taken{
        picture_width, picture_height, gap, {{0, 0, picture_width, picture_height}}};
    CHECK(place_labels(label, size, {}, all_taken).unplaced == 1);
    const PixelBox right{static_cast<int>(picture_width) / 2, 0, picture_width, picture_height};
    const PlacedLabels found =
        place_labels(label, size, {}, {picture_width, picture_height, gap, {right}});
    REQUIRE(found.placed.size() == 1);
    CHECK(found.placed[0].box.right <= right.left - gap);
}

TEST_CASE("a legend and a label are on the picture, each where it belongs", "[view][words]") {
    std::optional<TextPainter> painter;
    try {
        painter.emplace(open_text_painter());
    } catch (const LoadError& error) {
        return test::skip(error.what());
    }
    Picture picture{picture_width, picture_height, white(picture_width, picture_height), {}, {}};
    PictureWords words{{{{1, 1, 0}, "ASP 25"}}, {{{1, 0, 0}, "helix"}, {{0, 0, 1}, "strand"}}};

    const LeftOutWords left_out = write_words(words, {}, *painter, picture);

    CHECK(left_out.labels == 0);
    CHECK_FALSE(left_out.has_legend);
    const glm::vec3 place = project({}, words.labels[0].place, picture_width, picture_height);
    int red = 0, blue = 0, beside = 0, elsewhere = 0;
    for (std::uint32_t y = 0; y < picture_height; ++y) {
        for (std::uint32_t x = 0; x < picture_width; ++x) {
            const std::uint8_t* const pixel =
                &picture.rgba[std::size_t{4} * (y * picture_width + x)];
            const bool is_red = pixel[0] == 255 && pixel[1] == 0 && pixel[2] == 0;
            const bool is_blue = pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 255;
            red += is_red ? 1 : 0;
            blue += is_blue ? 1 : 0;
            if ((is_red || is_blue)) {
                CHECK(x < 40);
                CHECK(y > picture_height - 60);
            }
            if (pixel[0] > 128) continue;  // dark: letters
            const bool is_near = std::abs(static_cast<float>(x) - place.x) < 80 &&
                                 std::abs(static_cast<float>(y) - place.y) < 40;
            const bool is_in_corner = x < 120 && y > picture_height - 60;
            beside += is_near ? 1 : 0;
            elsewhere += is_near || is_in_corner ? 0 : 1;
        }
    }
    CHECK(red == blue);
    CHECK(red == 10 * 10);  // letters of 12 pixels, less an edge of one
    CHECK(beside > 40);
    CHECK(elsewhere == 0);

    // A picture too small for a legend is without, and says so.
    Picture small{64, 24, white(64, 24), {}, {}};
    words.labels.clear();
    CHECK(write_words(words, {}, *painter, small).has_legend);
    CHECK(small.rgba == white(64, 24));
}

TEST_CASE("a view's legend has every colouring that something has, once", "[view][words]") {
    World world = load_world(test::water_scene());
    const auto texts = [&](const ViewSettings& settings) {
        std::vector<std::string> of;
        for (const LegendEntry& entry : find_legend(world, settings)) of.push_back(entry.text);
        return of;
    };
    const auto of = [&](Colouring colouring) { return find_legend(world, colouring).size(); };
    ViewSettings settings;
    CHECK(texts(settings).empty());  // chains are seen without
    settings.colouring = Colouring::Structure;
    CHECK(texts(settings).size() == of(Colouring::Structure));
    settings.layers = {
        {.representation = Representation::Surface, .of = "", .colouring = Colouring::Charge},
        {.representation = Representation::Licorice, .of = "", .colouring = Colouring::Structure},
        {.representation = Representation::Licorice, .of = ""}};
    CHECK(texts(settings).size() == of(Colouring::Structure) + of(Colouring::Charge));

    // Both molecules have a colouring of their own; then one of them is hidden.
    settings.layers.clear();
    std::vector<Entity> molecules;
    world.each<Molecule>([&](Entity molecule, const Molecule&) { molecules.push_back(molecule); });
    for (const Entity molecule : molecules)
        world.set(molecule, Appearance{.representation = {}, .colouring = Colouring::Charge});
    CHECK(texts(settings).size() == of(Colouring::Charge));
    world.set(molecules[0],
              Appearance{.representation = {}, .colouring = Colouring::Residue, .visible = false});
    CHECK(texts(settings).size() == of(Colouring::Charge));
}
