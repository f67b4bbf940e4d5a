#include "app/marks.h"

#include "app/editing.h"
#include "app/notices.h"
#include "app/selecting.h"
#include "app/settings.h"
#include "app/window_world.h"
#include "core/translate.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>

namespace palpa {
namespace {

constexpr double trail_s = 5;
constexpr std::size_t most_atoms = 4;

ViewSettings& view_of(World& app) { return app.write<PictureState>().view; }
const ViewSettings& view_of(const World& app) { return app.resource<PictureState>().view; }

// The measure in the form of view.measure.
std::string measure_of(const World& app, const std::vector<std::uint32_t>& atoms) {
    std::string text;
    for (const std::uint32_t atom : atoms)
        text += (text.empty() ? "" : "; ") + expression_of(*frame_of(app).atoms, atom);
    return text;
}

// Says which click comes next, by the number of atoms so far.
void tell_next(World& app, std::size_t count) {
    constexpr std::array<const char*, most_atoms + 1> next{
        for_translation("measure: click on the first atom; I ends"),
        for_translation("measure: click on the second atom; I ends"),
        for_translation("distance; a third atom makes it an angle, I ends"),
        for_translation("angle at the second atom; a fourth atom makes it a dihedral, I ends"),
        for_translation("dihedral; the next atom begins another measure, I ends")};
    tell(app, translated(next[std::min(count, most_atoms)]), long_notice_s);
}

}  // namespace

void measure_or_end(World& app) {
    Measuring& measuring = app.write<Measuring>();
    measuring = {!measuring.is_on, {}};
    if (measuring.is_on) return tell_next(app, 0);
    tell(app, translated("measuring ended; what was measured stays, see \"In the picture\" at the "
                         "left"));
}

bool measures(const World& app) { return app.resource<Measuring>().is_on; }

void measure_atom(World& app, std::uint32_t atom) {
    Measuring& measuring = app.write<Measuring>();
    if (measuring.atoms.size() == most_atoms) measuring.atoms.clear();
    if (std::ranges::count(measuring.atoms, atom) > 0) return;
    ViewAdditions additions = app.resource<ViewAdditions>();
    if (measuring.atoms.size() >= 2)
        std::erase(additions.measures, measure_of(app, measuring.atoms));
    measuring.atoms.push_back(atom);
    if (measuring.atoms.size() >= 2) additions.measures.push_back(measure_of(app, measuring.atoms));
    set_additions(app, std::move(additions));
    tell_next(app, measuring.atoms.size());
}

void remove_measures(World& app) {
    ViewAdditions additions = app.resource<ViewAdditions>();
    additions.measures.clear();
    set_additions(app, std::move(additions));
    app.write<Measuring>().atoms.clear();
}

bool has_measures(const World& app) { return !app.resource<ViewAdditions>().measures.empty(); }

bool shows_contacts(const World& app) { return view_of(app).marks.contacts != ShownBonds::None; }
void toggle_contacts(World& app) {
    const ShownBonds own = options_of(app).view.marks.contacts;  // the scene's
    const ShownBonds shown = own == ShownBonds::None ? ShownBonds::InHand : own;
    view_of(app).marks.contacts = shows_contacts(app) ? ShownBonds::None : shown;
    tell(app, shows_contacts(app)
                  ? translated("contacts, clashes and salt bridges of what is in hand")
                  : translated("contacts hidden"));
}

bool shows_forces_by_residue(const World& app) {
    return view_of(app).marks.forces != ShownForces::Hand;
}
void toggle_forces_by_residue(World& app) {
    const ShownForces own = options_of(app).view.marks.forces;
    const ShownForces shown = own == ShownForces::Hand ? ShownForces::Residues : own;
    view_of(app).marks.forces = shows_forces_by_residue(app) ? ShownForces::Hand : shown;
    tell(app, shows_forces_by_residue(app)
                  ? translated("the strongest forces of single residues on what is in hand")
                  : translated("forces of residues hidden"));
}

bool shows_ghost(const World& app) { return view_of(app).marks.ghost; }
void toggle_ghost(World& app) {
    view_of(app).marks.ghost = !shows_ghost(app);
    tell(app, shows_ghost(app) ? translated("ghost: where the molecule in hand was at the start")
                               : translated("ghost hidden"));
}

bool shows_trail(const World& app) { return view_of(app).marks.trail_s > 0; }
void toggle_trail(World& app) {
    const double own = options_of(app).view.marks.trail_s;
    view_of(app).marks.trail_s = shows_trail(app) ? 0 : own > 0 ? own : trail_s;
    tell(app, shows_trail(app) ? format_translated(
                                     "trail: the path of the molecule in hand in the last {:.0f} s",
                                     view_of(app).marks.trail_s)
                               : std::string(translated("trail hidden")));
}

bool shows_shadows(const World& app) { return view_of(app).shadows != Shadows::None; }
void toggle_shadows(World& app) {
    view_of(app).shadows = shows_shadows(app) ? Shadows::None : Shadows::Soft;
}

}  // namespace palpa
