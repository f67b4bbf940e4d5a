#include "simulation/select_in_world.h"

#include "simulation/components.h"
#include "simulation/grip_queries.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace palpa {

std::vector<bool> select_in_world(const World& world, const Selection& selection,
                                  std::span<const SecondaryStructure> structure) {
    std::vector<NamedRange> molecules;
    world.each<Molecule>([&](Entity, const Molecule& molecule) {
        molecules.push_back({molecule.name, molecule.atoms});
    });
    std::vector<std::uint32_t> held;
    for (const Entity hand : find_hands(world)) {
        const std::vector<std::uint32_t> atoms = held_atoms(world, hand);
        held.insert(held.end(), atoms.begin(), atoms.end());
    }
    return select_atoms(selection, {world.resource<AtomTable>(), molecules, held, structure, {}});
}

namespace {

// Which of the selections of a measure.
constexpr std::array numbered_measure{"1st of view.measure", "2nd of view.measure",
                                      "3rd of view.measure", "4th of view.measure"};

}  // namespace

std::vector<std::string> find_empty_selections(const ViewDescription& view, const World& world) {
    // Whether there are helices is known only to who draws them.
    const std::vector<SecondaryStructure> any(world.resource<AtomTable>().size());
    std::vector<std::string> empty;
    const auto look_at = [&](const Selection& selection, const std::string& text, const char* key) {
        const std::vector<bool> chosen = select_in_world(world, selection, any);
        const bool needs_structure = text.find("helix") != std::string::npos ||
                                     text.find("strand") != std::string::npos ||
                                     text.find("sheet") != std::string::npos;
        if (!needs_structure && std::ranges::find(chosen, true) == chosen.end())
            empty.push_back(fmt::format("{} = '{}'", key, text));
    };
    const auto look = [&](const std::string& text, const char* key) {
        if (!text.empty()) look_at(parse_selection(text, key), text, key);
    };
    for (const ViewLayer& layer : view.layers) look(layer.of, "view.layers.of");
    for (const std::string& label : view.labels) look(label, "view.label");
    for (const std::string& hidden : view.hidden) look(hidden, "view.hide");
    for (const SavedView& saved : view.saved) {
        look(saved.look_at, "view.saved.look_at");
        for (const ViewLayer& layer : saved.layers) look(layer.of, "view.saved.layers.of");
    }
    for (const std::string& measure : view.marks.measures) {
        const std::vector<Selection> selections = parse_measure(measure, "view.measure");
        for (std::size_t i = 0; i < selections.size(); ++i)
            look_at(selections[i], measure, numbered_measure[i]);
    }
    return empty;
}

}  // namespace palpa
