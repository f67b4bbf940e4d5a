#include "scene/view_fields.h"

#include <vector>

namespace palpa {
namespace {

void visit_layers(FieldVisitor& v, std::vector<ViewLayer>& layers) {
    const Field field{.key = "layers", .meaning = "what is drawn besides, in this order"};
    visit_entries(v, field, layers, [&](ViewLayer& layer) {
        choose(v, {.key = "representation", .meaning = "how these atoms are drawn"},
               representation_names, layer.representation);
        v.text({.key = "of",
                .meaning = "which atoms, as `palpa select` takes them (tools/selections.md); "
                           "unset: all"},
               layer.of);
        choose_if_set(v, {.key = "colour", .meaning = "as of [view]"}, colouring_names,
                      layer.colouring);
        v.real({.key = "opacity",
                .meaning = "of a surface; 1: nothing shines through",
                .lowest = 0.05,
                .highest = 1},
               layer.opacity);
    });
}

void visit_saved_views(FieldVisitor& v, std::vector<SavedView>& views) {
    const Field field{.key = "saved", .meaning = "views to come back to, in this order"};
    visit_entries(v, field, views, [&](SavedView& saved) {
        v.text(
            {.key = "name", .meaning = "by which lessons and `--view` call it", .required = true},
            saved.name);
        v.triple({.key = "camera",
                  .meaning = "as `view.camera`, around what `look_at` selects",
                  .lowest = -360,
                  .highest = 360},
                 saved.camera);
        v.text({.key = "look_at", .meaning = "a selection that the picture frames; unset: all"},
               saved.look_at);
        v.triple({.key = "shift",
                  .meaning = "Å along x, y and z: what is in the middle of the picture, from the "
                             "middle of what is framed",
                  .lowest = -1e4,
                  .highest = 1e4},
                 saved.shift);
        choose_if_set(
            v, {.key = "representation", .meaning = "as `view.representation`; unset: that one"},
            representation_names, saved.representation);
        visit_layers(v, saved.layers);  // last: they have tables of their own
    });
}

void visit_marks(FieldVisitor& v, ViewMarks& marks) {
    v.texts({.key = "measure",
             .meaning = "two, three or four selections, \"SELECTION; SELECTION\": the distance, "
                        "angle or dihedral of their atoms, or of the centres of their atoms"},
            marks.measures);
    choose(
        v,
        {.key = "contacts",
         .meaning = "which contacts, clashes (heavy atoms overlap by 0.4 Å or more, by 0.8 Å in a "
                    "hydrogen bond) and salt bridges are drawn; the values are those of "
                    "hydrogen_bonds"},
        shown_bond_names, marks.contacts);
    choose(v,
           {.key = "forces",
            .meaning = "hand: the force on what is in the hand; residues, atoms: besides, what "
                       "those around do to it, the strongest 10 or 20"},
           shown_force_names, marks.forces);
    v.flag({.key = "ghost",
            .meaning = "what is in the hand as it was at the start, pale, residues around that "
                       "have moved by 0.5 Å since, and its place of rest"},
           marks.ghost);
    v.real({.key = "trail_s",
            .meaning = "where the centre of what is in the hand was in the last seconds; 0: "
                       "nothing is drawn",
            .lowest = 0,
            .highest = 1e4},
           marks.trail_s);
}

}  // namespace

void visit_view(FieldVisitor& v, ViewDescription& view) {
    v.enter_table({.key = "view", .meaning = "how the scene is seen at first"});
    choose_if_set(
        v,
        {.key = "representation",
         .meaning = "how molecules are drawn; in-hand: all but the molecule in hand as thin sticks "
                    "without hydrogens; pocket: of these only residues within 4.5 Å of it, and "
                    "a cartoon; cartoon: ribbons of proteins and nucleic acids, all else but "
                    "waters as balls and sticks; unset: pocket where others would hide it, else "
                    "ball-and-stick"},
        representation_names, view.representation);
    choose(v,
           {.key = "colour",
            .meaning = "chain: carbons in a colour of their chain; charge: of each residue; "
                       "activity: by second order, how far each joint turned beyond the linear "
                       "answer; with few active joints, which are active; else how far each "
                       "turned since the files; error: estimated error of each joint's angle, by "
                       "second order; potential: of the scene's charges, on surfaces"},
           colouring_names, view.colouring);
    choose(v,
           {.key = "hydrogen_bonds",
            .meaning = "which are drawn as dashes; in-hand: between the molecule in hand and all "
                       "others; all: also within molecules"},
           shown_bond_names, view.hydrogen_bonds);
    choose(v,
           {.key = "hydrogens",
            .meaning = "which are drawn as balls and sticks (also beside a cartoon), licorice, "
                       "lines or filling space; polar: bonded to N, O or S; those of hydrogen "
                       "bonds that are drawn are always there; in-hand, pocket and surface have "
                       "rules of their own"},
           shown_hydrogen_names, view.hydrogens);
    choose(v, {.key = "shadows", .meaning = "of things upon each other"}, shadow_names,
           view.shadows);
    v.flag({.key = "occlusion", .meaning = "crevices are darker"}, view.occlusion);
    v.integer({.key = "outline",
               .meaning = "width in pixels of the dark outline of what stands in front",
               .lowest = 0,
               .highest = 8},
              view.outline);
    v.triple(
        {.key = "camera",
         .meaning = "[azimuth, elevation, zoom]: degrees around what is looked at and above it, "
                    "-90 to 90, and how many times nearer than where all of that is seen, 0.01 "
                    "to 100; a device's right is the picture's right where the azimuth is 0",
         .lowest = -360,
         .highest = 360},
        view.camera);
    v.text({.key = "look_at", .meaning = "name of a molecule that the picture frames; unset: all"},
           view.look_at);
    v.flag({.key = "clip", .meaning = "leave out what stands in front of the molecule in hand"},
           view.clip);
    v.texts({.key = "label",
             .meaning = "selections: their residues are named beside their atoms CA, single atoms "
                        "beside themselves"},
            view.labels);
    v.texts({.key = "hide", .meaning = "selections that nothing but layers draws"}, view.hidden);
    visit_marks(v, view.marks);
    visit_layers(v, view.layers);
    visit_saved_views(v, view.saved);
    v.leave_table();
}

}  // namespace palpa
