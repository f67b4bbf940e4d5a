// The cards of the start screen: scenes with their pictures.
#pragma once
#include "render/picture.h"
#include "scene/find_scene.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

struct SceneCards {
    std::vector<SceneEntry> cards;
    std::vector<std::optional<std::size_t>> picture_numbers;  // of the cards; none: no picture
    std::vector<Picture> pictures;                            // of one size
};

// Cards of the scenes that a person can open, what a beginner opens first at the beginning.
SceneCards list_cards(std::span<const SceneEntry> scenes);

}  // namespace palpa
