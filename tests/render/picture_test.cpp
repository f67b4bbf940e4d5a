#include "render/picture.h"

#include "core/load_error.h"
#include "tests/support/temporary_folder.h"

#include <png.h>
#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>
#include <vector>

using namespace palpa;

TEST_CASE("a PNG holds the picture's colours, row by row from the top", "[render][picture]") {
    const test::TemporaryFolder folder;
    Picture picture{3, 2, {}, {}, {}};
    for (std::uint8_t i = 0; i < 24; ++i) {
        picture.rgba.push_back(i % 4 == 3 ? std::uint8_t{255} : static_cast<std::uint8_t>(10 * i));
    }
    const std::filesystem::path path = folder.path() / "a.png";

    write_png(path, picture);

    CHECK(has_mark(path, picture_mark));
    CHECK_THROWS_AS(write_png(path, picture), LoadError);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_file(&image, path.string().c_str()) != 0);
    image.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(image));
    REQUIRE(png_image_finish_read(&image, nullptr, read.data(), 0, nullptr) != 0);
    CHECK(image.width == 3);
    CHECK(image.height == 2);
    CHECK(read == picture.rgba);
}

TEST_CASE("a smaller picture has the mean light, not the mean of its codes", "[render][picture]") {
    Picture picture{4, 2, {}, {}, {}};
    for (const int value : {0, 255, 80, 80, 255, 0, 80, 80}) {  // half black, half white; and grey
        const auto code = static_cast<std::uint8_t>(value);
        picture.rgba.insert(picture.rgba.end(), {code, code, code, 255});
    }

    const Picture smaller = average_down(picture, 2);

    CHECK(smaller.width == 2);
    CHECK(smaller.height == 1);
    CHECK(smaller.rgba == std::vector<std::uint8_t>{188, 188, 188, 255, 80, 80, 80, 255});
}

TEST_CASE("a smaller picture weights colours by alpha", "[render][picture]") {
    // A green that covers all beside a red that hardly does; and nothing but what is clear.
    const Picture picture{4,
                          2,
                          {0, 128, 0, 255, 255, 0, 0, 51, 9, 9, 9, 0, 9, 9, 9, 0,
                           0, 128, 0, 255, 255, 0, 0, 51, 9, 9, 9, 0, 9, 9, 9, 0},
                          {},
                          {}};

    const Picture smaller = average_down(picture, 2);

    // Of light: 51 / (255 + 51) red, 255 / (255 + 51) of green's 0.2159.
    CHECK(smaller.rgba == std::vector<std::uint8_t>{113, 118, 0, 153, 0, 0, 0, 0});
}

TEST_CASE("colours times alpha are divided by it", "[render][picture]") {
    // Half of the light of code 187, which is 0.497, at the alpha 128; more light than there is.
    Picture picture{2, 2, {137, 0, 0, 128, 1, 2, 3, 255, 0, 0, 0, 0, 200, 0, 0, 10}, {}, {}};

    divide_by_alpha(picture);

    CHECK(picture.rgba ==
          std::vector<std::uint8_t>{187, 0, 0, 128, 1, 2, 3, 255, 0, 0, 0, 0, 255, 0, 0, 10});
}

TEST_CASE("a picture that cannot be written is a LoadError, and leaves nothing",
          "[render][picture]") {
    const test::TemporaryFolder folder;
    const Picture picture{1, 1, {1, 2, 3, 255}, {}, {}};

    CHECK_THROWS_AS(write_png(folder.path() / "nowhere" / "a.png", picture), LoadError);
    CHECK_THROWS_AS(write_png(folder.path(), picture), LoadError);
    CHECK(std::filesystem::is_empty(folder.path()));
}
