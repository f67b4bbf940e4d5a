#include "ligands/type_library.h"

#include <algorithm>
#include <cstddef>

namespace palpa {

double level_penalty(Surroundings level) noexcept {
    constexpr std::array<double, surroundings_levels> penalties{100, 60, 40, 30, 20, 10, 3, 0};
    return penalties[static_cast<std::size_t>(level)];
}

TypeLibrary::TypeLibrary(std::span<const ModelCompound> compounds) {
    for (const ModelCompound& compound : compounds) {
        for (std::size_t i = 0; i < compound.graph.size(); ++i) {
            for (std::size_t level = 0; level < surroundings_levels; ++level) {
                Entry& entry = entries_[level][compound.keys[i][level]];
                ++entry.types[compound.types[i]];
                entry.examples.try_emplace(compound.types[i], compound.name);
                ++entry.atoms;
                if (compound.has_improper[i]) ++entry.impropers;
            }
        }
    }
}

std::optional<TypeChoice> TypeLibrary::find(const EnvironmentKeys& keys) const {
    for (std::size_t level = surroundings_levels; level-- > 0;) {
        const auto found = entries_[level].find(keys[level]);
        if (found == entries_[level].end()) continue;
        const Entry& entry = found->second;
        const auto most =
            std::max_element(entry.types.begin(), entry.types.end(),
                             [](const auto& a, const auto& b) { return a.second < b.second; });
        TypeChoice choice;
        choice.type = most->first;
        choice.level = static_cast<Surroundings>(level);
        choice.share = static_cast<double>(most->second) / entry.atoms;
        choice.example = entry.examples.at(most->first);
        choice.penalty = level_penalty(choice.level) + 20 * (1 - choice.share);
        choice.has_improper = 2 * entry.impropers > entry.atoms;
        return choice;
    }
    return std::nullopt;
}

}  // namespace palpa
