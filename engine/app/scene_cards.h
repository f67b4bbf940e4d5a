// The cards of the start screen: scenes in groups, with their pictures.
#pragma once
#include "render/picture.h"
#include "scene/find_scene.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

enum class CardGroup { Lessons, Explore, Research, Yours };
inline constexpr std::size_t card_groups = 4;

struct SceneCard {
    SceneEntry scene;
    CardGroup group = CardGroup::Yours;
    bool is_done = false;                  // a lesson
    std::optional<std::size_t> picture{};  // its number; none: there is none
};

struct SceneCards {
    std::vector<SceneCard> cards;   // by groups
    std::vector<Picture> pictures;  // of one size
};

// Sources of cards: Palpa's own scenes, the person's, and which lessons they have done.
struct CardSource {
    std::vector<SceneEntry> scenes{};         // those with a level are shown
    std::vector<SceneEntry> yours{};          // all are
    std::vector<std::string> lessons_done{};  // names of Palpa's own, paths of others
};

// The scenes for whom they are, beginners first: lessons before others, short ones before long
// ones, and before all some that show best what Palpa is.
std::vector<SceneEntry> order_scenes(std::vector<SceneEntry> scenes);

// Each group in the order of order_scenes, the person's own as they are.
SceneCards list_cards(const CardSource& source);

// True if title, text or name of the scene have each of the words, in any case of letters.
bool has_words(const SceneEntry& scene, std::string_view words);

// The picture of a scene: beside its file, or else, of a person's own, the one that the window
// made of it, which may not be there yet. Empty: there is no folder for such pictures.
std::filesystem::path find_card_picture(const std::filesystem::path& scene);

inline constexpr std::uint32_t card_picture_width = 400, card_picture_height = 250;  // pixels

}  // namespace palpa
