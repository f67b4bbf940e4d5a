#include "render/text.h"

#include "core/load_error.h"
#include "core/text.h"
#include "render/font_files.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

#ifdef PALPA_FREETYPE
#include <ft2build.h>

#include FT_FREETYPE_H
#include FT_GLYPH_H
#include FT_STROKER_H
#endif

namespace palpa {

TextColours text_colours_on(const glm::vec3& background) {
    constexpr PixelColour dark{25, 30, 40}, light{255, 255, 255};
    // Luminance of sRGB's primaries (IEC 61966-2-1); of 0.18 is what looks half as light as white.
    const float luminance =
        0.2126F * background.r + 0.7152F * background.g + 0.0722F * background.b;
    if (luminance < 0.18F) return {light, dark};
    return {dark, light};
}

int text_size_for(std::uint32_t picture_height) {
    return static_cast<int>(std::clamp<std::uint32_t>((picture_height + 22) / 45, 12, 400));
}

namespace {

float halo_radius(int letter_size) {
    return std::max(1.5F, 0.12F * static_cast<float>(letter_size));
}

}  // namespace

int halo_width(int letter_size) { return static_cast<int>(std::ceil(halo_radius(letter_size))); }

TextPainter open_text_painter() {
    std::string problem =
        "no font is installed; expected DejaVu Sans (Debian: fonts-dejavu-core), "
        "or a font's file in the environment's PALPA_FONT";
    for (const std::filesystem::path& file : list_font_files()) {
        try {
            return TextPainter(file);
        } catch (const LoadError& error) {
            problem = error.what();
        }
    }
    throw LoadError({"words on pictures"}, problem);
}

#ifdef PALPA_FREETYPE
namespace {

constexpr std::size_t most_letters = 200;
constexpr float halo_opacity = 0.9F;

template <auto Free>
struct Freed {
    template <class Handle>
    void operator()(Handle handle) const {
        Free(handle);
    }
};
template <class Handle, auto Free>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Freed<Free>>;
using OwnedGlyph = Owned<FT_Glyph, FT_Done_Glyph>;

// Of UTF-8 as printable() leaves it.
std::vector<FT_ULong> list_letters(std::string_view text) {
    std::vector<FT_ULong> letters;
    for (const char c : printable(text)) {
        const auto byte = static_cast<unsigned char>(c);
        if ((byte & 0xc0U) == 0x80) {
            letters.back() = letters.back() << 6U | (byte & 0x3fU);
            continue;
        }
        if (letters.size() == most_letters) break;
        letters.push_back(byte < 0x80   ? byte
                          : byte < 0xe0 ? byte & 0x1fU
                          : byte < 0xf0 ? byte & 0x0fU
                                        : byte & 0x07U);
    }
    return letters;
}

int whole_pixels(FT_Pos sixty_fourths) { return static_cast<int>((sixty_fourths + 32) >> 6); }

// How much of each pixel letters cover, in a box that may reach beyond the picture.
struct Coverage {
    PixelBox box;
    std::vector<std::uint8_t> of;  // 255: wholly

    explicit Coverage(const PixelBox& covered)
        : box(covered),
          of(static_cast<std::size_t>(covered.width()) * static_cast<std::size_t>(covered.height()),
             0) {}
    std::uint8_t& at(int x, int y) {
        return of[static_cast<std::size_t>(y - box.top) * static_cast<std::size_t>(box.width()) +
                  static_cast<std::size_t>(x - box.left)];
    }
};

// The glyph is used up. One that FreeType cannot draw is omitted.
void add_glyph(OwnedGlyph glyph, int left, int baseline, Coverage& coverage) {
    FT_Glyph drawn = glyph.release();
    const bool fails = FT_Glyph_To_Bitmap(&drawn, FT_RENDER_MODE_NORMAL, nullptr, 1) != 0;
    glyph.reset(drawn);
    if (fails) return;
    const auto& image = *reinterpret_cast<FT_BitmapGlyph>(drawn);
    for (int row = 0; row < static_cast<int>(image.bitmap.rows); ++row) {
        for (int column = 0; column < static_cast<int>(image.bitmap.width); ++column) {
            const int x = left + image.left + column, y = baseline - image.top + row;
            if (!coverage.box.contains(x, y)) continue;
            std::uint8_t& covered = coverage.at(x, y);
            covered = std::max(covered, image.bitmap.buffer[row * image.bitmap.pitch + column]);
        }
    }
}

void lay_over(Picture& picture, Coverage& coverage, const PixelColour& colour, float opacity) {
    for (int y = coverage.box.top; y < coverage.box.bottom; ++y)
        for (int x = coverage.box.left; x < coverage.box.right; ++x)
            lay_over(picture, x, y, colour, opacity * static_cast<float>(coverage.at(x, y)) / 255);
}

}  // namespace

struct TextPainter::Font {
    Owned<FT_Library, FT_Done_FreeType> library;
    Owned<FT_Face, FT_Done_Face> face;
    Owned<FT_Stroker, FT_Stroker_Done> stroker;
    int size = 0;  // of letters, as set

    void set_size(int wanted) {
        wanted = std::clamp(wanted, 1, 400);
        if (size == wanted) return;
        FT_Set_Pixel_Sizes(face.get(), 0, static_cast<FT_UInt>(wanted));
        size = wanted;
    }
    int ascent() const { return whole_pixels(face->size->metrics.ascender); }
    int height() const { return ascent() - whole_pixels(face->size->metrics.descender); }

    // Calls `use` with each letter, loaded into the face, and how far right it stands; returns how
    // far the line goes.
    template <class Use>
    int lay_out(std::string_view text, const Use& use) {
        FT_Pos pen = 0;  // sixty-fourths of a pixel
        FT_UInt before = 0;
        for (const FT_ULong letter : list_letters(text)) {
            const FT_UInt index = FT_Get_Char_Index(face.get(), letter);
            FT_Vector kerning{};
            if (before != 0 && index != 0)
                FT_Get_Kerning(face.get(), before, index, FT_KERNING_DEFAULT, &kerning);
            before = index;
            constexpr FT_Int32 how = FT_LOAD_TARGET_LIGHT | FT_LOAD_NO_BITMAP;
            if (FT_Load_Glyph(face.get(), index, how) != 0) continue;
            pen += kerning.x;
            use(whole_pixels(pen));
            pen += face->glyph->advance.x;
        }
        return whole_pixels(pen);
    }
};

TextPainter::TextPainter(const std::filesystem::path& font) : font_(std::make_unique<Font>()) {
    FT_Library library = nullptr;
    if (FT_Init_FreeType(&library) != 0) throw LoadError({"FreeType"}, "does not start");
    font_->library.reset(library);
    FT_Face face = nullptr;
    const bool is_read = FT_New_Face(library, font.string().c_str(), 0, &face) == 0;
    if (is_read) font_->face.reset(face);
    if (!is_read || !FT_IS_SCALABLE(face))
        throw LoadError({font.string()}, "is not a font; expected one with outlines, such as .ttf");
    FT_Stroker stroker = nullptr;
    if (FT_Stroker_New(library, &stroker) != 0) throw LoadError({"FreeType"}, "has no memory");
    font_->stroker.reset(stroker);
}

TextSize TextPainter::measure(std::string_view text, int letter_size) {
    font_->set_size(letter_size);
    const int width = font_->lay_out(text, [](int) {});
    return {width, font_->height()};
}

void TextPainter::draw(Picture& picture, std::string_view text, int left, int top, int letter_size,
                       const TextColours& colours) {
    const TextSize size = measure(text, letter_size);
    const int margin = halo_width(font_->size);
    const PixelBox box = common(
        {left - margin, top - margin, left + size.width + margin, top + size.height + margin},
        {0, 0, static_cast<int>(picture.width), static_cast<int>(picture.height)});
    if (box.is_empty()) return;
    Coverage ink(box), halo(box);
    FT_Stroker_Set(font_->stroker.get(), std::lround(64 * halo_radius(font_->size)),
                   FT_STROKER_LINECAP_ROUND, FT_STROKER_LINEJOIN_ROUND, 0);
    const int baseline = top + font_->ascent();
    font_->lay_out(text, [&](int right) {
        FT_Glyph letter = nullptr;
        if (FT_Get_Glyph(font_->face->glyph, &letter) != 0) return;
        OwnedGlyph owned(letter);
        FT_Glyph rim = nullptr;
        if (FT_Glyph_Copy(letter, &rim) == 0) {
            // The border replaces the copy, which stays where there is none.
            FT_Glyph_StrokeBorder(&rim, font_->stroker.get(), 0, 1);
            add_glyph(OwnedGlyph(rim), left + right, baseline, halo);
        }
        add_glyph(std::move(owned), left + right, baseline, ink);
    });
    lay_over(picture, halo, colours.halo, halo_opacity);
    lay_over(picture, ink, colours.ink, 1);
}

#else

struct TextPainter::Font {};

TextPainter::TextPainter(const std::filesystem::path& /*font*/) {
    throw LoadError({"FreeType"}, "is missing: this program was built without it");
}

TextSize TextPainter::measure(std::string_view /*text*/, int /*letter_size*/) { return {}; }

void TextPainter::draw(Picture& /*picture*/, std::string_view /*text*/, int /*left*/, int /*top*/,
                       int /*letter_size*/, const TextColours& /*colours*/) {}

#endif

TextPainter::TextPainter(TextPainter&&) noexcept = default;
TextPainter& TextPainter::operator=(TextPainter&&) noexcept = default;
TextPainter::~TextPainter() = default;

}  // namespace palpa
