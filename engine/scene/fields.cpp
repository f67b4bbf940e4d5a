#include "scene/fields.h"

#include "scene/edit_fields.h"

#include <fmt/format.h>
#include <numeric>
#include <utility>

namespace palpa {
namespace {

void visit_force_field(FieldVisitor& v, ForceFieldDescription& f, bool is_required) {
    v.enter_table(
        {.key = "force_field", .meaning = "where the forces come from", .required = is_required});
    const Field files{
        .key = "files",
        .meaning =
            "CHARMM topology, parameter and stream files, in the order of reading; not "
            "needed with [engine]",
        .required = is_required};
    if (is_required || v.is_there(files, !f.files.empty())) v.files(files, f.files);
    v.real({.key = "coulomb_constant",
            .meaning = "kcal Å/mol/e²; the default is CHARMM's own",
            .lowest = 0,
            .highest = 1e6},
           f.coulomb_constant);
    choose(v,
           {.key = "solvent",
            .meaning = "what stands for the water around: none, or EEF1-SB's implicit water, with "
                       "neutral charges of ionic groups (`palpa prepare --solvent eef1-sb`), a "
                       "dielectric of 1.5 r and ends of its own at 9 and 9.5 Å"},
           solvent_names, f.solvent);
    v.leave_table();
}

void visit_molecule(FieldVisitor& v, MoleculeDescription& m, bool is_remote) {
    v.enter_table({.key = m.name, .meaning = "one molecule"});
    v.file({.key = "structure",
            .meaning = "structure file: .crd, .pdb, .cif or .gro; with [engine] also .psf: "
                       "the engine's first frame has the positions",
            .required = true},
           m.structure);
    v.file({.key = "topology",
            .meaning = "PSF file for types, charges, masses and bonds; unset: they come from the "
                       "force field's residues"},
           m.topology);
    v.text({.key = "segment",
            .meaning = "segment of that file whose atoms make up the molecule",
            .required = true},
           m.segment);
    v.text({.key = "reference_atom",
            .meaning = "atom that stands for the molecule's place: its name, with the residue "
                       "number before it where the name alone is not enough (\"25 CG\"); with "
                       "[engine], unset: the first",
            .required = !is_remote},
           m.reference_atom);
    choose(v,
           {.key = "motion",
            .meaning = "what the hand may do with the molecule without turning it: nothing, move "
                       "it along x, or in space after it was relaxed on loading; "
                       "translate-and-turn: it turns by itself meanwhile, about its reference "
                       "atom; with-handle: the handle turns it too, about that atom; free: it "
                       "moves and turns by itself, no hand holds it"},
           motion_names, m.motion);
    choose(v,
           {.key = "shape",
            .meaning = "whether its joints turn by themselves, those that [joints] names"},
           shape_names, m.shape);
    v.flag({.key = "structural_water",
            .meaning = "with `force_field.solvent`: its waters are part of the structure, without "
                       "volume or solvation energy; any others are refused there"},
           m.structural_water);
    v.texts(
        {.key = "anchors",
         .meaning = "atoms (\"25 CA\") or residues (\"25\", their centre of mass) that "
                    "springs hold where the structure has them, while the molecule moves by "
                    "itself, so that the hand does not carry all of it along; their energy is part "
                    "of the potential energy, and an anchor of what is in the hand is felt"},
        m.anchors);
    v.real({.key = "anchor_kcal_per_mol_angstrom2",
            .meaning = "stiffness k of these springs, E = k x²/2",
            .lowest = 1e-3,
            .highest = 1e4},
           m.anchor_kcal_per_mol_angstrom2);
    v.texts({.key = "approximate",
             .meaning = "residues whose types, charges and parameters are approximate (`palpa "
                        "prepare --approximate-ligands`); the window says so"},
            m.approximate);
    v.leave_table();
}

void visit_molecules(FieldVisitor& v, std::vector<MoleculeDescription>& molecules, bool is_remote) {
    v.enter_table({.key = "molecules", .meaning = "the molecules", .required = true});
    std::vector<std::string> names;
    for (const MoleculeDescription& molecule : molecules) names.push_back(molecule.name);
    v.list_tables({.key = "NAME", .meaning = "one molecule, under a name of your choice"}, names);
    molecules.resize(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
        molecules[i].name = names[i];
        visit_molecule(v, molecules[i], is_remote);
    }
    v.leave_table();
}

void visit_grab(FieldVisitor& v, const Field& table, GrabDescription& g, bool is_remote) {
    v.enter_table(table);
    v.text({.key = "molecule",
            .meaning = "name of the molecule that the hand moves",
            .required = true},
           g.molecule);
    v.text(
        {.key = "measured_from",
         .meaning = "name of the molecule whose reference atom distances are measured from; with "
                    "[engine], unset: the one in the hand",
         .required = !is_remote},
        g.measured_from);
    v.text({.key = "atom",
            .meaning = "atom of that molecule (\"25 CA\") or residue (\"25\", its centre of mass) "
                       "that the hand pulls at by a spring, or its Nth atom (\"#17\"); unset: it "
                       "moves the whole molecule, with [engine] by a spring too"},
           g.atom);
    v.real({.key = "spring_kcal_per_mol_angstrom2",
            .meaning = "stiffness k of that spring, E = k x²/2",
            .lowest = 1e-3,
            .highest = 1e4},
           g.spring_kcal_per_mol_angstrom2);
    v.leave_table();
}

void visit_joints(FieldVisitor& v, JointsDescription& j) {
    v.enter_table({.key = "joints",
                   .meaning = "which bonds of flexible molecules turn, beside chi and the like"});
    v.flag({.key = "backbone", .meaning = "phi and psi, bonds N-CA and CA-C"}, j.backbone);
    v.flag({.key = "hydroxyl", .meaning = "X-OH"}, j.hydroxyl);
    v.flag({.key = "thiol", .meaning = "X-SH"}, j.thiol);
    v.flag({.key = "ammonium", .meaning = "X-NH3, and X-NH2 where X is no planar carbon"},
           j.ammonium);
    v.flag({.key = "methyl", .meaning = "X-CH3"}, j.methyl);
    v.flag({.key = "amide", .meaning = "omega, and C-N of carbamates and ureas"}, j.amide);
    v.flag({.key = "amide_nh2", .meaning = "C-NH2 of amides and on aromatic rings"}, j.amide_nh2);
    v.flag({.key = "guanidinium_nh2", .meaning = "C-NH2 of guanidinium and amidinium"},
           j.guanidinium_nh2);
    v.texts({.key = "turn",
             .meaning = "bonds that turn whatever the rules say, \"SEGMENT RESIDUE ATOM ATOM\", or "
                        "\"SEGMENT RESIDUE ATOM RESIDUE ATOM\""},
            j.turn);
    v.texts({.key = "rigid", .meaning = "bonds that do not turn"}, j.rigid);
    v.texts({.key = "springs",
             .meaning = "bonds of rings that are opened, and held by their force field's terms "
                        "alone, as disulphides are"},
            j.springs);
    v.optional_real({.key = "within_angstrom",
                     .meaning = "only residues turn of which an atom is as near as this to "
                                "`around` on loading; unset: all",
                     .lowest = 0,
                     .highest = 1e3},
                    j.within_angstrom);
    v.text({.key = "around", .meaning = "name of a molecule; unset: the one in the hand"},
           j.around);
    v.optional_real({.key = "region_angstrom",
                     .meaning = "only residues move of which an atom is as near as this to what "
                                "hands hold, at a spring or whole: chains are cut where they leave "
                                "this region, and bonded terms hold them there; unset: no region",
                     .lowest = 0,
                     .highest = 1e3},
                    j.region_angstrom);
    v.leave_table();
}

void visit_statics(FieldVisitor& v, StaticsDescription& s) {
    v.enter_table({.key = "statics", .meaning = "how flexible molecules come to rest"});
    choose_if_set(
        v,
        {.key = "method",
         .meaning = "second-order: everything follows the hand by the second derivatives of the "
                    "energy, exact near the hand; quasi-static: the paper's step, of few joints "
                    "or all; or a minimiser, limited-memory BFGS with each joint on its own or "
                    "coupled by the mass matrix. Unset: second-order, but quasi-static with "
                    "`active` below all, with `budget_us`, or with more than 3,000 degrees of "
                    "freedom"},
        relax_method_names, s.method);
    v.integer({.key = "steps",
               .meaning = "of the method, in each period of the simulation",
               .lowest = 1,
               .highest = 10000},
              s.steps);
    v.real({.key = "largest_move_angstrom",
            .meaning = "that an atom may go in one step",
            .lowest = 1e-4,
            .highest = 1},
           s.largest_move_angstrom);
    v.real({.key = "near_angstrom",
            .meaning = "second-order: pairs of what is held with atoms so near are exact",
            .lowest = 0,
            .highest = 20},
           s.near_angstrom);
    v.real({.key = "renew_angstrom",
            .meaning = "second-order: way of a hand from one linearisation to the next",
            .lowest = 0.02,
            .highest = 0.3},
           s.renew_angstrom);
    v.integer(
        {.key = "responses",
         .meaning = "second-order: for each hand a step seeks the answer among so many combined "
                    "moves, responses to the hand and to the forces that these leave near "
                    "it, which costs less in a stiff pocket; 0: among all degrees of freedom",
         .lowest = 0,
         .highest = 3000},
        s.responses);
    v.real({.key = "renewal_ms",
            .meaning = "second-order: declared time from the request of a linearisation to its "
                       "use; 0: within the step",
            .lowest = 0,
            .highest = 1000},
           s.renewal_ms);
    choose(v,
           {.key = "pairs",
            .meaning = "all in double, or the non-bonded pairs in single precision, ten times "
                       "faster; of a rigid molecule in the hand from 10,000 pairs on"},
           pair_precision_names, s.pairs);
    v.optional_real({.key = "cutoff_angstrom",
                     .meaning = "where forces end, switched off over the last 2 Å; unset: never",
                     .lowest = 4,
                     .highest = 1e3},
                    s.cutoff_angstrom);
    v.integer({.key = "active",
               .meaning = "degrees of freedom that may move at a time, those that would move most; "
                          "a free base is 6 of them",
               .lowest = 0,
               .highest = 1e6},
              s.active);
    v.optional_real({.key = "budget_us",
                     .meaning = "time of a step, in which as many are active as 99 % of steps "
                                "have time for; such runs do not repeat to the bit; unset: any",
                     .lowest = 1,
                     .highest = 1e6},
                    s.budget_us);
    choose(v,
           {.key = "weights",
            .meaning = "what counts in that choice: accelerations of regions, as in the paper, or "
                       "with the inertia that they move; of joints one by one; of these the more "
                       "the fewer atoms they move; and the nearer they are to the hand",
            .renamed = renamed_joint_weights},
           joint_weight_names, s.weights);
    v.integer({.key = "choose_every",
               .meaning = "steps from one choice to the next",
               .lowest = 1,
               .highest = 1e6},
              s.choose_every);
    v.real({.key = "rest_kcal_per_mol",
            .meaning = "on loading all is relaxed until the rms force along the coordinates "
                       "(per radian and per Å) is below this; there limited-memory and "
                       "inverse-mass end in a step, too",
            .lowest = 1e-6,
            .highest = 1e6},
           s.rest_kcal_per_mol);
    v.integer(
        {.key = "relax_steps", .meaning = "steps for that, at most", .lowest = 0, .highest = 1e6},
        s.relax_steps);
    v.leave_table();
}

void visit_hand(FieldVisitor& v, const Field& table, HandDescription& h) {
    v.enter_table(table);
    choose(v, {.key = "grip", .meaning = "how firmly the handle is held; none leaves it free"},
           grip_names, h.grip);
    choose(v,
           {.key = "stroke",
            .meaning = "what the hand does: keep the handle where the force vanishes, go in to "
                       "peak_nN and out again, follow path, or lead the molecule along it by "
                       "sight, which takes what time it takes"},
           stroke_names, h.stroke);
    v.optional_real({.key = "start_angstrom",
                     .meaning = "distance of the reference atoms at the start; unset: for hold the "
                                "outermost distance without force, else as in the structure",
                     .lowest = 0,
                     .highest = 1e3},
                    h.start_angstrom);
    v.triple({.key = "start_offset_angstrom",
              .meaning = "where a molecule that moves in space starts, [x, y, z] from its relaxed "
                         "place",
              .lowest = -1e3,
              .highest = 1e3},
             h.start_offset_angstrom);
    v.real({.key = "peak_nN",
            .meaning = "in-out: repulsion of the molecules at the innermost point",
            .lowest = 1e-3,
            .highest = 100},
           h.peak_nN);
    v.real(
        {.key = "stroke_s", .meaning = "in-out: time of each way", .lowest = 0.01, .highest = 1e4},
        h.stroke_s);
    v.real({.key = "pause_s",
            .meaning = "in-out: rest at the innermost point",
            .lowest = 0,
            .highest = 1e4},
           h.pause_s);
    v.integer({.key = "cycles", .meaning = "in-out: how often", .lowest = 1, .highest = 10000},
              h.cycles);
    v.optional_real(
        {.key = "release_s",
         .meaning = "when the hand lets go: it wants no place any more, only its mass and damping "
                    "stay on the handle; unset: never",
         .lowest = 0,
         .highest = 1e5},
        h.release_s);
    v.real({.key = "kick_N_s",
            .meaning = "impulse that knocks the handle towards +x, spread over 10 ms at 1 s",
            .lowest = -0.1,
            .highest = 0.1},
           h.kick_N_s);
    v.path({.key = "path",
            .meaning = "path: where the hand is to be, [s, mm along x], [s, mm, mm, mm], or that "
                       "and a turn about x, y and z in degrees (a rotation vector), minimum jerk "
                       "in between; lead: where it is to have brought the molecule, [s, Å along "
                       "x] or [s, Å, Å, Å] from its start",
            .lowest = -1e5,
            .highest = 1e5},
           h.path);
    v.leave_table();
}

void visit_second(FieldVisitor& v, std::optional<SecondHand>& second, bool is_remote) {
    const Field table{.key = "second", .meaning = "a second hand"};
    if (!v.is_there(table, second.has_value())) return;
    if (!second) second.emplace();
    v.enter_table(table);
    visit_grab(v,
               {.key = "grab",
                .meaning = "what a second hand holds, on a device of its own",
                .required = true,
                .like = "grab"},
               second->grab, is_remote);
    visit_hand(v, {.key = "hand", .meaning = "what it does", .like = "hand"}, second->hand);
    v.leave_table();
}

void visit_engine(FieldVisitor& v, std::optional<EngineDescription>& engine) {
    const Field table{.key = "engine",
                      .meaning =
                          "a remote engine that moves all atoms, over IMD: GROMACS, LAMMPS, "
                          "NAMD; unset: Palpa itself"};
    if (!v.is_there(table, engine.has_value())) return;
    if (!engine) engine.emplace();
    v.enter_table(table);
    v.text({.key = "address", .meaning = "where it listens, HOST:PORT; the host in numbers"},
           engine->address);
    choose(
        v,
        {.key = "program",
         .meaning = "what it is, which decides the unit of energies that it sends: GROMACS sends "
                    "kJ/mol in version 2, the others kcal/mol"},
        engine_program_names, engine->program);
    choose(v, {.key = "protocol", .meaning = "version of IMD that it must speak"},
           engine_protocol_names, engine->protocol);
    v.file(
        {.key = "atoms",
         .meaning = "which of the engine's atoms are which of the scene's: the engine's own as a "
                    "PSF or GRO file, found by residue and name; or an index file (.ndx) whose "
                    "first group lists, in the order in which the engine sends its atoms, their "
                    "numbers in the scene; unset: all of the scene's, in their order"},
        engine->atoms);
    v.integer({.key = "rate",
               .meaning = "steps of the engine between two frames; 0: as the engine has it. LAMMPS "
                          "takes no forces at a rate of 1",
               .lowest = 0,
               .highest = 1e6},
              engine->rate);
    v.real({.key = "force_scale",
            .meaning = "force on the engine's atoms, as a share of what the hand feels",
            .lowest = 0,
            .highest = 100},
           engine->force_scale);
    v.real({.key = "most_force_nN",
            .meaning = "largest force of the spring between hand and atoms; beyond it the force "
                       "stays constant",
            .lowest = 1e-3,
            .highest = 100},
           engine->most_force_nN);
    v.real({.key = "smoothing_ms",
            .meaning = "time constant of the low-pass through which the spring sees the atoms, so "
                       "that heat does not shake the hand; the force is later by as much",
            .lowest = 0,
            .highest = 1e4},
           engine->smoothing_ms);
    v.real({.key = "late_s",
            .meaning = "without a frame for so long there is no force until the next",
            .lowest = 0.05,
            .highest = 60},
           engine->late_s);
    v.real(
        {.key = "wait_s",
         .meaning = "how long to wait for its first frame, without a window, and where only that "
                    "has the positions",
         .lowest = 0,
         .highest = 1e5},
        engine->wait_s);
    v.leave_table();
}

void visit_device(FieldVisitor& v, DeviceDescription& d) {
    v.enter_table({.key = "device", .meaning = "the emulated Omni"});
    v.real(
        {.key = "inertia_kg", .meaning = "mass felt at the handle", .lowest = 1e-3, .highest = 10},
        d.inertia_kg);
    v.real({.key = "viscosity_N_s_per_m",
            .meaning = "viscous friction of the device",
            .lowest = 0,
            .highest = 100},
           d.viscosity_N_s_per_m);
    v.real({.key = "friction_N",
            .meaning = "Coulomb friction of the device",
            .lowest = 0,
            .highest = 10},
           d.friction_N);
    v.real({.key = "encoder_step_mm",
            .meaning = "step of the position sensor; 0 reads exactly",
            .lowest = 1e-6,
            .highest = 1,
            .zero = true},
           d.encoder_step_mm);
    v.integer({.key = "servo_delay_ticks",
               .meaning = "servo ticks from a force to its sending",
               .lowest = 0,
               .highest = 7},
              d.servo_delay_ticks);
    v.leave_table();
}

void visit_coupling(FieldVisitor& v, CouplingDescription& c) {
    v.enter_table({.key = "coupling", .meaning = "from molecule to hand and back"});
    visit_coupling_keys(v, c);
    v.leave_table();
}

void visit_lesson_step(FieldVisitor& v, LessonStepDescription& s) {
    v.enter_table({.key = s.name, .meaning = "one step of the lesson"});
    v.text({.key = "text", .meaning = "what there is to know", .required = true}, s.text);
    v.text({.key = "task", .meaning = "what to do", .required = true}, s.task);
    choose(v,
           {.key = "quantity",
            .meaning = "what says that it was done: the distance of the reference atoms, the "
                       "force on the molecule or on the hand (+ repels), the coupling's mode"},
           lesson_quantity_names, s.quantity);
    v.optional_real({.key = "at_least",
                     .meaning = "smallest value that will do",
                     .lowest = -1e6,
                     .highest = 1e6},
                    s.at_least);
    v.optional_real(
        {.key = "at_most", .meaning = "largest value that will do", .lowest = -1e6, .highest = 1e6},
        s.at_most);
    v.real({.key = "for_s",
            .meaning = "how long without a break, in simulated seconds",
            .lowest = 0,
            .highest = 1e3},
           s.for_s);
    v.text({.key = "view",
            .meaning = "name of a saved view that is shown as the step begins; unset: none"},
           s.view);
    v.leave_table();
}

void visit_lesson(FieldVisitor& v, std::vector<LessonStepDescription>& steps) {
    v.enter_table({.key = "lesson", .meaning = "a first lesson, step by step"});
    std::vector<std::string> names;
    for (const LessonStepDescription& step : steps) names.push_back(step.name);
    v.list_tables({.key = "STEP", .meaning = "one step, under a name of your choice"}, names);
    steps.resize(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
        steps[i].name = names[i];
        visit_lesson_step(v, steps[i]);
    }
    v.leave_table();
}

void visit_layers(FieldVisitor& v, std::vector<ViewLayer>& layers) {
    const Field field{.key = "layers", .meaning = "what is drawn besides, in this order"};
    std::size_t count = layers.size();
    v.list_entries(field, count);
    layers.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        ViewLayer& layer = layers[i];
        v.enter_entry(field, i, layer.place);
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
        v.leave_table();
    }
}

void visit_saved_views(FieldVisitor& v, std::vector<SavedView>& views) {
    const Field field{.key = "saved", .meaning = "views to come back to, in this order"};
    std::size_t count = views.size();
    v.list_entries(field, count);
    views.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        SavedView& saved = views[i];
        v.enter_entry(field, i, saved.place);
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
        v.leave_table();
    }
}

void visit_marks(FieldVisitor& v, ViewMarks& marks) {
    v.texts({.key = "measure",
             .meaning = "two, three or four selections, \"SELECTION; SELECTION\": the distance, "
                        "angle or dihedral of their atoms, or of the centres of their atoms"},
            marks.measures);
    choose(v,
           {.key = "contacts",
            .meaning = "which contacts, clashes (heavy atoms overlap by 0.4 Å and more) and salt "
                       "bridges are drawn, as of hydrogen_bonds"},
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
                       "activity: which joints answer, and by how much; "
                       "error: of their angles; potential: of the scene's charges, on "
                       "surfaces"},
           colouring_names, view.colouring);
    choose(v,
           {.key = "hydrogen_bonds",
            .meaning = "which are drawn as dashes; in-hand: between the molecule in hand and all "
                       "others; all: also within molecules"},
           shown_bond_names, view.hydrogen_bonds);
    choose(v,
           {.key = "hydrogens",
            .meaning = "which are drawn as balls and sticks, licorice, lines or filling space; "
                       "polar: bonded to N, O or S; besides always those of hydrogen bonds that "
                       "are drawn"},
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

// Gathers the notes; the values visited are the defaults.
class Lister final : public FieldVisitor {
public:
    std::vector<FieldNote> notes;

    void enter_table(const Field& field) override {
        if (field.is_inline) {
            inline_table_ = field;
            inline_keys_.clear();
            return;
        }
        if (!field.like.empty()) {
            notes.push_back({fmt::format("{}{}.KEY", path_, field.key),
                             fmt::format("as `{}.KEY`", field.like), "as there",
                             std::string(field.meaning)});
        }
        is_documented_ = !field.like.empty();
        path_ += std::string(field.key) + ".";
    }
    void leave_table() override {
        if (inline_table_) {
            const Field table = *inline_table_;
            inline_table_.reset();
            return add(table, fmt::format("table of {}", fmt::join(inline_keys_, ", ")), "unset");
        }
        is_documented_ = false;
        path_.pop_back();
        path_.resize(path_.rfind('.') == std::string::npos ? 0 : path_.rfind('.') + 1);
    }
    void list_tables(const Field& field, std::vector<std::string>& names) override {
        names = {std::string(field.key)};
    }
    void list_entries(const Field& /*field*/, std::size_t& count) override { count = 1; }
    void enter_entry(const Field& field, std::size_t /*index*/, TextPlace& /*place*/) override {
        enter_table(field);
    }
    std::vector<std::size_t> one_of(std::span<const std::string_view> keys,
                                    std::size_t /*chosen*/) override {
        std::vector<std::size_t> all(keys.size());
        std::iota(all.begin(), all.end(), 0);
        return all;
    }
    bool is_there(const Field& /*field*/, bool /*there*/) override { return true; }
    bool is_listing() const noexcept override { return true; }
    void real(const Field& field, double& value) override {
        add(field, fmt::format("number{}", range(field)), fmt::format("{}", value));
    }
    void optional_real(const Field& field, std::optional<double>& /*value*/) override {
        add(field, fmt::format("number{}", range(field)), "unset");
    }
    void optional_pair(const Field& field,
                       std::optional<std::array<double, 2>>& /*value*/) override {
        add(field, fmt::format("two numbers{}", range(field)), "unset");
    }
    void triple(const Field& field, std::array<double, 3>& value) override {
        add(field, fmt::format("three numbers{}", range(field)),
            fmt::format("[{}]", fmt::join(value, ", ")));
    }
    void flag(const Field& field, bool& value) override {
        add(field, "true, false", fmt::format("{}", value));
    }
    void integer(const Field& field, std::int64_t& value) override {
        add(field, fmt::format("whole number{}", range(field)), fmt::format("{}", value));
    }
    void text(const Field& field, std::string& value) override {
        add(field, "text", is_address(field) ? "unset" : fmt::format("\"{}\"", value));
    }
    void texts(const Field& field, std::vector<std::string>& /*value*/) override {
        if (is_address(field))
            return add(field, fmt::format("list of {} to {} texts", field.lowest, field.highest),
                       "unset");
        add(field, "list of texts", "[]");
    }
    void choice(const Field& field, std::span<const std::string_view> names,
                std::size_t& value) override {
        add(field, fmt::format("\"{}\"", fmt::join(names, "\", \"")),
            fmt::format("\"{}\"", names[value]));
    }
    void optional_choice(const Field& field, std::span<const std::string_view> names,
                         std::optional<std::size_t>& /*value*/) override {
        add(field, fmt::format("\"{}\"", fmt::join(names, "\", \"")), "unset");
    }
    void file(const Field& field, std::filesystem::path& /*value*/) override {
        add(field, "file name", "unset");
    }
    void files(const Field& field, std::vector<std::filesystem::path>& /*value*/) override {
        add(field, "list of file names", "[]");
    }
    void path(const Field& field, std::vector<PathPoint>& /*value*/) override {
        add(field, fmt::format("list of 2, 4 or 7 numbers each{}", range(field)), "[]");
    }
    void mark(const Field& field) override { add(field, "true", "unset"); }
    void coupling_settings(const Field& field, std::vector<std::string>& /*value*/) override {
        add(field, "table of keys of [coupling]", "unset");
    }

private:
    static bool is_address(const Field& field) { return field.form != TextForm::Any; }
    static std::string range(const Field& field) {
        return fmt::format(", {}{} to {}", field.zero ? "0 or " : "", field.lowest, field.highest);
    }
    void add(const Field& field, std::string type, std::string fallback) {
        if (inline_table_) return inline_keys_.push_back(field.key);
        if (is_documented_) return;
        notes.push_back({path_ + std::string(field.key), std::move(type),
                         field.required ? "required" : std::move(fallback),
                         std::string(field.meaning)});
    }

    std::string path_;
    bool is_documented_ = false;         // the table under way is like one before
    std::optional<Field> inline_table_;  // that is under way: one note with all its keys
    std::vector<std::string_view> inline_keys_;
};

}  // namespace

void visit_coupling_keys(FieldVisitor& v, CouplingDescription& c) {
    choose(v,
           {.key = "mode",
            .meaning = "guarded: the servo moves the molecule in the field around it; the paper's, "
                       "which may vibrate: 1 variable force and displacement gain, 2 variable "
                       "force gain, 3 variable displacement gain, 4 both constant, 5 no force"},
           coupling_mode_names, c.mode);
    v.real({.key = "clamp_N",
            .meaning = "largest force sent to the device",
            .lowest = 0,
            .highest = 3.3},
           c.clamp_N);
    v.real({.key = "F_h1_N",
            .meaning = "eq. 2: force that low forces tend to",
            .lowest = 1e-3,
            .highest = 100},
           c.F_h1_N);
    v.real({.key = "F_h2_N",
            .meaning = "eq. 2: force that high forces tend to, above F_h1_N",
            .lowest = 1e-3,
            .highest = 100},
           c.F_h2_N);
    v.real({.key = "F_0_nN",
            .meaning = "eq. 2: molecular force between low and high",
            .lowest = 0,
            .highest = 1e3},
           c.F_0_nN);
    v.real(
        {.key = "A_f_min", .meaning = "eq. 2: gain of high forces", .lowest = 1, .highest = 1e13},
        c.A_f_min);
    v.real({.key = "A_f_max", .meaning = "eq. 2: gain of low forces", .lowest = 1, .highest = 1e13},
           c.A_f_max);
    v.real({.key = "gamma_per_N",
            .meaning = "eq. 3: sharpness of the transition",
            .lowest = 1e-3,
            .highest = 1e18},
           c.gamma_per_N);
    v.real({.key = "F_off_pN",
            .meaning = "eq. 3: molecular force of the transition",
            .lowest = 0,
            .highest = 1e6},
           c.F_off_pN);
    v.real({.key = "A_d_min",
            .meaning = "eq. 3: displacement gain far away, handle metres per "
                       "molecule metre",
            .lowest = 1,
            .highest = 1e15},
           c.A_d_min);
    v.real({.key = "A_d_max",
            .meaning = "eq. 3: displacement gain in contact",
            .lowest = 1,
            .highest = 1e15},
           c.A_d_max);
    v.real({.key = "A_f",
            .meaning = "constant force gain of modes 3 and 4",
            .lowest = 0,
            .highest = 1e13},
           c.A_f);
    v.real({.key = "A_d",
            .meaning = "constant displacement gain of modes 2, 4 and 5",
            .lowest = 1,
            .highest = 1e15},
           c.A_d);
    v.optional_pair({.key = "feel_pN",
                     .meaning = "guarded: [weakest, strongest] molecular force that must be felt, "
                                "as 0.3 N or more and 2.7 N or less, in place of force_law; the "
                                "cap makes the molecule go less far for it; unset: force_law",
                     .lowest = 1e-3,
                     .highest = 1e6},
                    c.feel_pN);
    v.optional_real({.key = "feel_within_pN",
                     .meaning = "how far the force may be from that of complete relaxation; where "
                                "something moves by itself, how far pairs are exact, the age of "
                                "the model and its evaluations follow (second-order), or active "
                                "joints and steps (quasi-static); unset: as [statics] has them",
                     .lowest = 1e-6,
                     .highest = 1e6},
                    c.feel_within_pN);
    choose(
        v,
        {.key = "force_law",
         .meaning = "guarded: eq. 2 as printed, or calibrated to the slopes A_f_max and A_f_min, "
                    "constant A_f, or perceptual: equal noticeable steps a decade"},
        force_law_names, c.force_law);
    choose(v,
           {.key = "displacement_law",
            .meaning = "guarded: eq. 3 repaired to see stiff places too, as printed, constant A_d"},
           displacement_law_names, c.displacement_law);
    choose(v,
           {.key = "gain_shape",
            .meaning = "guarded: where A_d is raised for the cap, it is in all directions, or, a "
                       "tensor, in those that are stiff"},
           gain_shape_names, c.gain_shape);
    choose(v,
           {.key = "workspace",
            .meaning = "guarded: how far places are reached: by the clutch alone, beyond a bubble "
                       "at a rate, with a drift to the centre"},
           workspace_names, c.workspace);
    v.real({.key = "F_lo_pN",
            .meaning = "perceptual law: molecular force that is felt as 0.3 N",
            .lowest = 1e-3,
            .highest = 1e6},
           c.F_lo_pN);
    v.real({.key = "F_hi_nN",
            .meaning = "perceptual law: molecular force that is felt as 3 N, above 2 F_lo",
            .lowest = 1e-6,
            .highest = 1e6},
           c.F_hi_nN);
    v.real({.key = "damping_N_s_per_m",
            .meaning = "guarded: damping of the handle by the servo",
            .lowest = 0,
            .highest = 5},
           c.damping_N_s_per_m);
    v.real(
        {.key = "stop_nN",
         .meaning =
             "guarded: force on the molecule or one atom of it beyond which it goes no further in",
         .lowest = 1e-3,
         .highest = 1e3},
        c.stop_nN);
    v.integer({.key = "pairs_per_tick",
               .meaning = "guarded: pairs of atoms that the servo has time for in a tick",
               .lowest = 1000,
               .highest = 10'000'000},
              c.pairs_per_tick);
    choose(v,
           {.key = "engage",
            .meaning = "guarded, headless: the force is there at once, or after quiet ticks in a "
                       "ramp of 2 s, as in a window"},
           engage_names, c.engage);
}

void visit_scene(FieldVisitor& v, SceneDescription& scene) {
    v.text({.key = "title", .meaning = "name of the scene"}, scene.title);
    v.text({.key = "about", .meaning = "what it shows, in a few sentences"}, scene.about);
    v.text(
        {.key = "made_by",
         .meaning = "how the files that the scene names are made, for who reads it; nothing runs "
                    "it"},
        scene.made_by);
    visit_engine(v, scene.engine);
    const bool is_remote = scene.engine && !v.is_listing();
    visit_force_field(v, scene.force_field, !is_remote);
    visit_molecules(v, scene.molecules, is_remote);
    visit_joints(v, scene.joints);
    visit_statics(v, scene.statics);
    visit_grab(v, {.key = "grab", .meaning = "what the hand holds", .required = true}, scene.grab,
               is_remote);
    visit_hand(v, {.key = "hand", .meaning = "the hand on the emulated device"}, scene.hand);
    visit_second(v, scene.second, is_remote);
    visit_device(v, scene.device);
    visit_coupling(v, scene.coupling);
    visit_view(v, scene.view);
    visit_lesson(v, scene.lesson);
    v.enter_table({.key = "run", .meaning = "a headless run"});
    v.real({.key = "period_ms",
            .meaning = "declared period of the simulation, a whole number of 1 ms servo ticks",
            .lowest = 1,
            .highest = 1e4},
           scene.period_ms);
    v.real({.key = "seconds", .meaning = "length of the run", .lowest = 1e-3, .highest = 1e5},
           scene.seconds);
    v.integer({.key = "every",
               .meaning = "the trace keeps one row of this many servo ticks",
               .lowest = 1,
               .highest = 1e6},
              scene.every);
    v.integer({.key = "seed",
               .meaning = "of everything random; the strokes so far draw nothing",
               .lowest = 0,
               .highest = 1e15},
              scene.seed);
    v.leave_table();
    visit_edits(v, scene.edits);
}

std::vector<FieldNote> list_fields() {
    Lister lister;
    SceneDescription defaults;
    visit_scene(lister, defaults);
    return std::move(lister.notes);
}

}  // namespace palpa
