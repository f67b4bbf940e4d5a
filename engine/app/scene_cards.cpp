#include "app/scene_cards.h"

#include "core/load_error.h"
#include "scene/choices.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <tuple>
#include <utility>

namespace palpa {

SceneCards list_cards(std::span<const SceneEntry> scenes) {
    SceneCards found;
    std::ranges::copy_if(scenes, std::back_inserter(found.cards), [](const SceneEntry& scene) {
        return !scene.level.empty() && !scene.is_to_be_made;
    });
    // Lessons come before others, short ones before long ones.
    const auto rank = [](const SceneEntry& scene) {
        return std::tuple(std::ranges::find(scene_level_names, scene.level), !scene.has_lesson,
                          scene.minutes);
    };
    std::ranges::stable_sort(found.cards, {}, rank);
    std::vector<Picture>& pictures = found.pictures;
    for (const SceneEntry& card : found.cards) {
        found.picture_numbers.emplace_back();
        try {
            Picture picture = read_png(std::filesystem::path(card.file).replace_extension(".png"));
            if (!pictures.empty() &&
                (picture.width != pictures[0].width || picture.height != pictures[0].height))
                continue;
            found.picture_numbers.back() = pictures.size();
            pictures.push_back(std::move(picture));
        } catch (const LoadError&) {  // a card without one
        }
    }
    return found;
}

}  // namespace palpa
