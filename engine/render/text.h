// Draws text on pictures by FreeType. A program built without FreeType draws none.
#pragma once
#include "render/picture.h"

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <string_view>

namespace palpa {

// Size of a line of text, pixels: from the top of the highest letter to the bottom of the lowest.
struct TextSize {
    int width = 0, height = 0;
};

// Letters, and the rim around them by which they can be read over anything.
struct TextColours {
    PixelColour ink{}, halo{};
};

// Dark letters on a light background (linear RGB), light ones on a dark one.
TextColours text_colours_on(const glm::vec3& background);

// The size of letters that suits a picture of so many pixels: a 45th of its height, 12 at least.
int text_size_for(std::uint32_t picture_height);

// How far a halo reaches beyond the letters, whole pixels.
int halo_width(int letter_size);

// Text is UTF-8, of which bytes that are none and control characters are written as "\x1b"; what is
// longer than 200 letters is cut. `letter_size`: the font's em, pixels, 1 to 400. One thread at a
// time.
class TextPainter {
public:
    // Throws LoadError where the file is no font with outlines, or FreeType is lacking.
    explicit TextPainter(const std::filesystem::path& font);
    TextPainter(TextPainter&&) noexcept;
    TextPainter& operator=(TextPainter&&) noexcept;
    ~TextPainter();

    TextSize measure(std::string_view text, int letter_size);

    // One line whose upper left corner is at these pixels. What lies outside of the picture is not
    // drawn.
    void draw(Picture& picture, std::string_view text, int left, int top, int letter_size,
              const TextColours& colours);

private:
    struct Font;
    std::unique_ptr<Font> font_;
};

// A painter with the first readable font of list_font_files(). Throws LoadError if there is none.
TextPainter open_text_painter();

}  // namespace palpa
