#include "scene/description.h"

#include <fmt/format.h>
#include <algorithm>

namespace palpa {

TextPlace SceneDescription::place_of(std::string_view key) const {
    const auto found = places.find(key);
    return found == places.end() ? TextPlace{file.string()} : found->second;
}

bool SceneDescription::has_statics() const {
    if (engine) return false;
    const bool by_spring = std::ranges::any_of(
        hands, [](const HandDescription& hand) { return !hand.grab.atom.empty(); });
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
    std::vector<HandTables> tables;
    for (const HandDescription& hand : scene.hands) {
        const std::string key = fmt::format("hand[{}]", tables.size() + 1);
        tables.push_back({key + ".grab", key, hand.grab, hand});
    }
    if (tables.size() == 1) {
        tables.front().grab_key = "grab";
        tables.front().hand_key = "hand";
    }
    return tables;
}

const DeviceDescription& device_of(const SceneDescription& scene, std::size_t hand) {
    const std::optional<DeviceDescription>& own = scene.hands.at(hand).device;
    return own ? *own : scene.device;
}

const CouplingDescription& coupling_of(const SceneDescription& scene, std::size_t hand) {
    const std::optional<CouplingDescription>& own = scene.hands.at(hand).coupling;
    return own ? *own : scene.coupling;
}

CouplingDescription& coupling_of(SceneDescription& scene, std::size_t hand) {
    std::optional<CouplingDescription>& own = scene.hands.at(hand).coupling;
    return own ? *own : scene.coupling;
}

}  // namespace palpa
