#include "app/inspected.h"

#include "app/editing.h"
#include "app/panels.h"
#include "app/window_world.h"

#include <fmt/format.h>
#include <algorithm>

namespace palpa {
namespace {

bool is_there(const World& app, const InspectedMolecule& molecule) {
    const auto& all = frame_of(app).objects.molecules;
    return std::ranges::find(all, molecule.name, &SceneMolecule::name) != all.end();
}

bool is_there(const World& app, const InspectedHand& hand) {
    return hand.number < frame_of(app).hands.size();
}

bool is_there(const World& app, const InspectedSpring& spring) {
    const auto& all = frame_of(app).objects.restraints;
    return std::ranges::find(all, spring.atoms, &RestraintEdit::atoms) != all.end();
}

bool is_there(const World& app, const InspectedMark& mark) {
    return std::ranges::any_of(frame_of(app).objects.marks, [&](const SceneMark& other) {
        return other.atoms.atoms == mark.atoms;
    });
}

}  // namespace

Inspectable find_inspected(const World& app) {
    const Inspectable& what = app.resource<Inspected>().what;
    if (std::visit([&](const auto& one) { return is_there(app, one); }, what)) return what;
    return InspectedMolecule{molecule_in_hand(app)};
}

void inspect(World& app, const Inspectable& what) {
    app.write<Inspected>().what = what;
    open_panel(app, "inspector");
}

std::string describe_value(const SceneMark& mark) {
    const std::size_t atoms = mark.atoms.atoms.size();
    if (atoms < 2) return {};
    return fmt::format("{:.3f}{}", mark.value, atoms == 2 ? " Å" : "°");
}

}  // namespace palpa
