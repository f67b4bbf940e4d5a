#include "scene/view_fields.h"

#include <vector>

namespace palpa {
namespace {

void visit_layers(FieldVisitor& v, std::vector<ViewLayer>& layers) {
    const Field field{.key = "layers",
                      .meaning = "additional representations, drawn in this order"};
    visit_entries(v, field, layers, [&](ViewLayer& layer) {
        choose(v, {.key = "representation", .meaning = "how these atoms are drawn"},
               representation_names, layer.representation);
        v.text({.key = "of",
                .meaning = "which atoms, as `palpa select` takes them (tools/selections.md); "
                           "unset: all"},
               layer.of);
        choose_if_set(v, {.key = "colour", .meaning = "as in [view]"}, colouring_names,
                      layer.colouring);
        v.real({.key = "opacity",
                .meaning = "opacity of a surface; 1: opaque",
                .lowest = 0.05,
                .highest = 1},
               layer.opacity);
    });
}

void visit_saved_views(FieldVisitor& v, std::vector<SavedView>& views) {
    const Field field{.key = "saved", .meaning = "saved views, in this order"};
    visit_entries(v, field, views, [&](SavedView& saved) {
        v.text({.key = "name", .meaning = "name for lessons and `--view`", .required = true},
               saved.name);
        v.triple({.key = "camera",
                  .meaning = "as `view.camera`, around what `look_at` selects",
                  .lowest = -360,
                  .highest = 360},
                 saved.camera);
        v.text({.key = "look_at", .meaning = "selection that the picture frames; unset: all"},
               saved.look_at);
        v.triple({.key = "shift",
                  .meaning = "shift of the centre of the picture from the centre of what is "
                             "framed, Å along x, y and z",
                  .lowest = -1e4,
                  .highest = 1e4},
                 saved.shift);
        choose_if_set(
            v, {.key = "representation", .meaning = "as `view.representation`; unset: the same"},
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
            .meaning = "hand: the force on the molecule in hand; residues, atoms: also the forces "
                       "of the strongest 10 residues or 20 atoms on it"},
           shown_force_names, marks.forces);
    v.flag({.key = "ghost",
            .meaning = "the molecule in hand as it was at the start, pale, residues around that "
                       "have moved by 0.5 Å since, and its place of rest"},
           marks.ghost);
    v.real({.key = "trail_s",
            .meaning = "path of the centre of the molecule in hand over the last seconds; 0: none",
            .lowest = 0,
            .highest = 1e4},
           marks.trail_s);
}

}  // namespace

void visit_view(FieldVisitor& v, ViewDescription& view) {
    v.enter_table({.key = "view", .meaning = "first view of the scene"});
    choose_if_set(v,
                  {.key = "representation",
                   .meaning = "how molecules are drawn; in-hand: all other molecules as thin "
                              "sticks without hydrogens; pocket: of these only residues within 4.5 "
                              "Å, and a cartoon; cartoon: ribbons for proteins and nucleic acids, "
                              "balls and sticks for other molecules except waters; unset: pocket "
                              "if others would hide the molecule in hand, else ball-and-stick"},
                  representation_names, view.representation);
    choose(v,
           {.key = "colour",
            .meaning = "colouring. chain: carbons in a colour of their chain; charge: of each "
                       "residue; activity: with second-order, how far each joint turned beyond its "
                       "linear response; with few active joints, which are active; else how far "
                       "each joint turned since the files; error: estimated error of each joint's "
                       "angle (second-order); potential: of the scene's charges, on surfaces"},
           colouring_names, view.colouring);
    choose(v,
           {.key = "hydrogen_bonds",
            .meaning = "which hydrogen bonds are drawn as dashes; in-hand: between the molecule in "
                       "hand and all others; all: also within molecules"},
           shown_bond_names, view.hydrogen_bonds);
    choose(v,
           {.key = "hydrogens",
            .meaning =
                "which hydrogens ball-and-stick (also beside a cartoon), licorice, lines and "
                "space-filling draw; polar: those bonded to N, O or S; hydrogens of drawn hydrogen "
                "bonds are always drawn; in-hand, pocket and surface have their own rules"},
           shown_hydrogen_names, view.hydrogens);
    choose(v, {.key = "shadows", .meaning = "shadows of objects on each other"}, shadow_names,
           view.shadows);
    v.flag({.key = "occlusion", .meaning = "darker crevices (ambient occlusion)"}, view.occlusion);
    v.integer({.key = "outline",
               .meaning = "width of the dark outline of objects in front, pixels",
               .lowest = 0,
               .highest = 8},
              view.outline);
    v.triple({.key = "camera",
              .meaning = "[azimuth, elevation, zoom]: degrees around the framed molecule and above "
                         "it (-90 to 90), and a zoom factor from 0.01 to 100 (1: it fills the "
                         "picture); at azimuth 0 the device's right is the picture's right",
              .lowest = -360,
              .highest = 360},
             view.camera);
    v.text({.key = "look_at", .meaning = "name of a molecule that the picture frames; unset: all"},
           view.look_at);
    v.flag({.key = "clip", .meaning = "hide atoms in front of the molecule in hand"}, view.clip);
    v.texts(
        {.key = "label",
         .meaning =
             "selections whose residues are labelled at their CA atom, single atoms at themselves"},
        view.labels);
    v.texts({.key = "hide", .meaning = "selections that only layers draw"}, view.hidden);
    visit_marks(v, view.marks);
    visit_layers(v, view.layers);
    visit_saved_views(v, view.saved);
    v.leave_table();
}

}  // namespace palpa
