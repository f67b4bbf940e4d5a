#include "scene/description.h"

#include <algorithm>

namespace palpa {

TextPlace SceneDescription::place_of(std::string_view key) const {
    const auto found = places.find(key);
    return found == places.end() ? TextPlace{file.string()} : found->second;
}

bool SceneDescription::has_statics() const {
    if (engine) return false;
    const bool by_spring = !grab.atom.empty() || (second && !second->grab.atom.empty());
    return by_spring || std::ranges::any_of(molecules, [](const MoleculeDescription& m) {
               return m.shape == Shape::Flexible || m.motion == Motion::TranslateAndTurn ||
                      m.motion == Motion::Free;
           });
}

RelaxMethod method_of(const StaticsDescription& statics) noexcept {
    if (statics.method) return *statics.method;
    const bool is_adaptive = statics.budget_us || statics.active < StaticsDescription{}.active;
    return is_adaptive ? RelaxMethod::QuasiStatic : RelaxMethod::SecondOrder;
}

std::vector<HandTables> list_hands(const SceneDescription& scene) {
    std::vector<HandTables> hands{{"grab", "hand", scene.grab, scene.hand}};
    if (scene.second) {
        hands.push_back({"second.grab", "second.hand", scene.second->grab, scene.second->hand});
    }
    return hands;
}

}  // namespace palpa
