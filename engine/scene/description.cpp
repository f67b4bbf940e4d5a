#include "scene/description.h"

namespace palpa {

TextPlace SceneDescription::place_of(std::string_view key) const {
    const auto found = places.find(key);
    return found == places.end() ? TextPlace{file.string()} : found->second;
}

}  // namespace palpa
