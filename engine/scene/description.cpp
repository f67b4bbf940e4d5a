#include "scene/description.h"

#include <algorithm>

namespace palpa {

TextPlace SceneDescription::place_of(std::string_view key) const {
    const auto found = places.find(key);
    return found == places.end() ? TextPlace{file.string()} : found->second;
}

bool SceneDescription::has_statics() const {
    return !grab.atom.empty() || std::ranges::any_of(molecules, [](const MoleculeDescription& m) {
        return m.shape == Shape::Flexible || m.motion == Motion::TranslateAndTurn ||
               m.motion == Motion::Free;
    });
}

}  // namespace palpa
