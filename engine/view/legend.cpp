#include "view/legend.h"

#include "simulation/components.h"
#include "view/palette.h"

#include <algorithm>

namespace palpa {

std::vector<LegendEntry> find_legend(const World& world, const ViewSettings& settings) {
    std::vector<Colouring> used;
    const auto use = [&](Colouring colouring) {
        if (std::ranges::find(used, colouring) == used.end()) used.push_back(colouring);
    };
    world.each<Molecule>([&](Entity molecule, const Molecule&) {
        const Appearance* const own = world.find<Appearance>(molecule);
        if (own && !own->visible) return;
        use(own ? own->colouring.value_or(settings.colouring) : settings.colouring);
    });
    for (const ViewLayer& layer : settings.layers)
        if (layer.colouring) use(*layer.colouring);
    std::vector<LegendEntry> legend;
    for (const Colouring colouring : used) {
        const std::vector<LegendEntry> entries = find_legend(world, colouring);
        legend.insert(legend.end(), entries.begin(), entries.end());
    }
    if (settings.marks.contacts != ShownBonds::None) {
        legend.push_back({contact_colour, "contact"});
        legend.push_back({clash_colour, "clash"});
        legend.push_back({salt_bridge_colour, "salt bridge"});
    }
    return legend;
}

}  // namespace palpa
