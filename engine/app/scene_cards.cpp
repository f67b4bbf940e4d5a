#include "app/scene_cards.h"

#include "app/preferences.h"
#include "core/load_error.h"
#include "core/text.h"
#include "render/picture_sheet.h"
#include "scene/choices.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <tuple>
#include <utility>

namespace palpa {
namespace {

namespace fs = std::filesystem;

// FNV-1a with 64 bits: a name for a file of any path.
std::uint64_t number_of(std::string_view text) {
    std::uint64_t number = 14695981039346656037U;
    for (const char letter : text) {
        number ^= static_cast<unsigned char>(letter);
        number *= 1099511628211U;
    }
    return number;
}

CardGroup group_of(const SceneEntry& scene) {
    const std::string_view researcher =
        scene_level_names[static_cast<std::size_t>(SceneLevel::Researcher)];
    if (scene.has_lesson) return CardGroup::Lessons;
    return scene.level == researcher ? CardGroup::Research : CardGroup::Explore;
}

std::optional<std::size_t> add_picture(const fs::path& scene, std::vector<Picture>& pictures) {
    if (pictures.size() >= most_sheet_pictures) return std::nullopt;
    try {
        const fs::path file = find_card_picture(scene);
        std::error_code error;
        if (file.empty() || !fs::exists(file, error)) return std::nullopt;
        Picture picture = read_png(file);
        if (picture.width != card_picture_width || picture.height != card_picture_height)
            return std::nullopt;
        pictures.push_back(std::move(picture));
        return pictures.size() - 1;
    } catch (const LoadError&) {  // a card without one
        return std::nullopt;
    }
}

}  // namespace

std::vector<SceneEntry> order_scenes(std::vector<SceneEntry> scenes) {
    constexpr std::array<std::string_view, 3> first{"water/tour", "water", "hiv/lesson"};
    const auto rank = [&](const SceneEntry& scene) {
        return std::tuple(std::ranges::find(first, scene.name),
                          std::ranges::find(scene_level_names, scene.level), !scene.has_lesson,
                          scene.minutes);
    };
    std::ranges::stable_sort(scenes, {}, rank);
    return scenes;
}

SceneCards list_cards(const CardSource& source) {
    SceneCards found;
    const auto is_done = [&](const SceneEntry& scene) {
        return scene.has_lesson && (std::ranges::count(source.lessons_done, scene.name) > 0 ||
                                    std::ranges::count(source.lessons_done, scene.file.string()));
    };
    for (const SceneEntry& scene : order_scenes(source.scenes))
        if (!scene.level.empty() && !scene.is_to_be_made)
            found.cards.push_back({scene, group_of(scene), is_done(scene)});
    for (const SceneEntry& scene : source.yours)
        found.cards.push_back({scene, CardGroup::Yours, is_done(scene)});
    std::ranges::stable_sort(found.cards, {}, &SceneCard::group);
    for (SceneCard& card : found.cards) card.picture = add_picture(card.scene.file, found.pictures);
    return found;
}

bool has_words(const SceneEntry& scene, std::string_view words) {
    const std::string text =
        upper_case(fmt::format("{} {} {}", scene.title, scene.about, scene.name));
    return std::ranges::all_of(split_words(words), [&](std::string_view word) {
        return text.find(upper_case(std::string(word))) != std::string::npos;
    });
}

fs::path find_card_picture(const fs::path& scene) {
    std::error_code error;
    fs::path beside = fs::path(scene).replace_extension(".png");
    if (fs::exists(beside, error)) return beside;
    const std::optional<fs::path> folder = find_cache_folder("pictures");
    if (!folder) return {};
    return *folder / fmt::format("{:016x}.png",
                                 number_of(fs::absolute(scene, error).lexically_normal().string()));
}

}  // namespace palpa
