#include "scene/fields.h"

#include "scene/edit_fields.h"
#include "scene/mechanics_fields.h"
#include "scene/run_commands.h"
#include "scene/view_fields.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace palpa {
namespace {

void visit_force_field(FieldVisitor& v, ForceFieldDescription& f, bool is_required) {
    v.enter_table(
        {.key = "force_field", .meaning = "where the forces come from", .required = is_required});
    const Field files{.key = "files",
                      .meaning =
                          "CHARMM topology, parameter and stream files, in reading order; not "
                          "needed with [engine]",
                      .required = is_required};
    if (is_required || v.is_there(files, !f.files.empty())) v.files(files, f.files);
    v.real({.key = "coulomb_constant",
            .meaning = "Coulomb's constant, kcal Å/mol/e²; the default is CHARMM's",
            .lowest = 0,
            .highest = 1e6},
           f.coulomb_constant);
    choose(v,
           {.key = "solvent",
            .meaning = "solvent model: none, or EEF1-SB's implicit water, which needs neutral "
                       "ionic groups (`palpa prepare --solvent eef1-sb`) and has a dielectric of "
                       "1.5 r and its own cutoffs at 9 and 9.5 Å"},
           solvent_names, f.solvent);
    v.leave_table();
}

void visit_molecule(FieldVisitor& v, MoleculeDescription& m, bool is_remote) {
    v.enter_table({.key = m.name, .meaning = "one molecule"});
    v.file({.key = "structure",
            .meaning = "structure file: .crd, .pdb, .cif or .gro; with [engine] also .psf, because "
                       "the engine's first frame has the positions",
            .required = true},
           m.structure);
    v.file({.key = "topology",
            .meaning = "PSF file with types, charges, masses and bonds; unset: from the force "
                       "field's residues"},
           m.topology);
    v.text({.key = "segment",
            .meaning = "segment of that file whose atoms form the molecule",
            .required = true},
           m.segment);
    v.text(
        {.key = "reference_atom",
         .meaning = "atom that marks the molecule's position: its name, after the residue number "
                    "if the name is not unique (\"25 CG\"); unset with [engine]: the first atom",
         .required = !is_remote},
        m.reference_atom);
    choose(
        v,
        {.key = "motion",
         .meaning =
             "how the molecule moves. fixed: not at all; along-x: the hand moves it along x; "
             "translate: the hand moves it in space, after a relaxation on loading; "
             "translate-and-turn: it also turns by itself about its reference atom; with-handle: "
             "the handle turns it about that atom; free: it moves and turns by itself"},
        motion_names, m.motion);
    choose(v,
           {.key = "shape",
            .meaning = "rigid, or flexible: the joints that [joints] names turn by themselves"},
           shape_names, m.shape);
    v.flag({.key = "structural_water",
            .meaning = "with `force_field.solvent`: its waters are part of the structure, without "
                       "volume or solvation energy; other waters are not allowed then"},
           m.structural_water);
    v.texts({.key = "anchors",
             .meaning = "atoms (\"25 CA\") or residues (\"25\", their centre of mass) that springs "
                        "hold at their place in the structure, so that the hand does not carry the "
                        "whole molecule along; the springs are part of the potential energy, and "
                        "those on the molecule in hand are felt"},
            m.anchors);
    v.real({.key = "anchor_kcal_per_mol_angstrom2",
            .meaning = "stiffness k of these springs, E = k x²/2",
            .lowest = 1e-3,
            .highest = 1e4},
           m.anchor_kcal_per_mol_angstrom2);
    v.texts({.key = "approximate",
             .meaning = "residues with approximate types, charges and parameters (`palpa prepare "
                        "--approximate-ligands`), which the window lists"},
            m.approximate);
    visit_look(v, m.appearance);
    v.leave_table();
}

void visit_restraints(FieldVisitor& v, std::vector<StartRestraint>& restraints) {
    visit_entries(v,
                  {.key = "restraints",
                   .meaning = "springs between two atoms or residues, or from one to a place"},
                  restraints, [&](StartRestraint& r) { r.visit_keys(v); });
}

void visit_pins(FieldVisitor& v, std::vector<StartPin>& pins) {
    visit_entries(v, {.key = "pins", .meaning = "atoms that are marked"}, pins, [&](StartPin& p) {
        v.texts({.key = "atoms",
                 .meaning = "one atom for a label, two for a distance, three for an angle, four "
                            "for a dihedral",
                 .lowest = 1,
                 .highest = 4,
                 .required = true,
                 .form = TextForm::Atom},
                p.atoms);
    });
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

void visit_grab(FieldVisitor& v, GrabDescription& g, bool is_remote) {
    v.enter_table({.key = "grab", .meaning = "what the hand holds", .required = true});
    v.text({.key = "molecule",
            .meaning = "name of the molecule that the hand moves; \"\": the hand holds nothing",
            .required = true,
            .may_be_empty = true},
           g.molecule);
    v.text({.key = "measured_from",
            .meaning = "name of the molecule to whose reference atom distances are measured; "
                       "\"\", or unset with [engine]: the one in the hand",
            .required = !is_remote,
            .may_be_empty = true},
           g.measured_from);
    v.text({.key = "atom",
            .meaning = "part of that molecule that the hand pulls by a spring: an atom (\"25 "
                       "CA\"), a residue (\"25\", its centre of mass) or the Nth atom (\"#17\"); "
                       "unset: the hand moves the whole molecule, with [engine] also by a spring"},
           g.atom);
    v.real({.key = "spring_kcal_per_mol_angstrom2",
            .meaning = "stiffness k of that spring, E = k x²/2",
            .lowest = 1e-3,
            .highest = 1e4},
           g.spring_kcal_per_mol_angstrom2);
    triple_if_set(v,
                  {.key = "place_angstrom",
                   .meaning = "place of the hand's end of that spring at the start, Å; unset: "
                              "where the part is that it pulls",
                   .lowest = -farthest_angstrom,
                   .highest = farthest_angstrom},
                  g.place_angstrom);
    constexpr std::array<std::string_view, 2> motions{"fixed", "free"};
    std::optional<std::size_t> motion;
    if (g.released) motion = *g.released == Motion::Free ? 1 : 0;
    v.optional_choice({.key = "released",
                       .meaning = "motion of the molecule after the hand has released it; unset: "
                                  "by a spring as before, as a whole free where something moves by "
                                  "itself, else fixed"},
                      motions, motion);
    if (motion) g.released = *motion == 1 ? Motion::Free : Motion::Fixed;
    v.leave_table();
}

void visit_hand_keys(FieldVisitor& v, HandDescription& h) {
    choose(
        v,
        {.key = "grip", .meaning = "how firmly the hand holds the handle; none: nobody holds it"},
        grip_names, h.grip);
    choose(
        v,
        {.key = "stroke",
         .meaning =
             "what the hand does. hold: keep the handle where the force vanishes; in-out: move in "
             "until the repulsion is peak_nN and out again; path: follow path with the handle; "
             "lead: lead the molecule along path by sight, at the speed that the force allows"},
        stroke_names, h.stroke);
    v.optional_real({.key = "start_angstrom",
                     .meaning = "distance of the reference atoms at the start, Å; unset: with hold "
                                "the outermost distance without force, else as in the structure",
                     .lowest = 0,
                     .highest = 1e3},
                    h.start_angstrom);
    v.triple({.key = "start_offset_angstrom",
              .meaning =
                  "start of a molecule that moves in space, [x, y, z] in Å from its relaxed place",
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
    v.integer(
        {.key = "cycles", .meaning = "in-out: number of strokes", .lowest = 1, .highest = 10000},
        h.cycles);
    v.optional_real({.key = "release_s",
                     .meaning = "time when the hand lets go, s: then only its mass and damping act "
                                "on the handle; unset: never",
                     .lowest = 0,
                     .highest = 1e5},
                    h.release_s);
    v.real({.key = "kick_N_s",
            .meaning = "impulse on the handle towards +x, spread over 10 ms at 1 s",
            .lowest = -0.1,
            .highest = 0.1},
           h.kick_N_s);
    v.path({.key = "path",
            .meaning =
                "path: positions of the hand, [s, mm along x], [s, mm, mm, mm], or with a rotation "
                "vector about x, y and z in degrees as well, minimum jerk in between; lead: "
                "positions of the molecule from its start, [s, Å along x] or [s, Å, Å, Å]",
            .lowest = -1e5,
            .highest = 1e5},
           h.path);
}

void visit_engine(FieldVisitor& v, std::optional<EngineDescription>& engine) {
    const Field table{.key = "engine",
                      .meaning =
                          "a remote engine that moves all atoms, over IMD: GROMACS, LAMMPS, "
                          "NAMD; unset: Palpa itself"};
    if (!v.is_there(table, engine.has_value())) return;
    if (!engine) engine.emplace();
    v.enter_table(table);
    v.text({.key = "address",
            .meaning = "address where the engine listens, HOST:PORT with a numeric host"},
           engine->address);
    choose(v,
           {.key = "program",
            .meaning = "program, which decides the unit of its energies: GROMACS sends kJ/mol in "
                       "IMD version 2, the others kcal/mol"},
           engine_program_names, engine->program);
    choose(v, {.key = "protocol", .meaning = "required IMD version"}, engine_protocol_names,
           engine->protocol);
    v.file({.key = "atoms",
            .meaning = "how the engine's atoms match the scene's: a PSF or GRO file of the "
                       "engine's atoms, matched by residue and name; or an index file (.ndx) whose "
                       "first group lists the scene's atom numbers in the order in which the "
                       "engine sends its atoms; unset: all atoms of the scene in their order"},
           engine->atoms);
    v.integer({.key = "rate",
               .meaning = "steps of the engine between two frames; 0: the engine's setting. LAMMPS "
                          "does not accept forces at a rate of 1",
               .lowest = 0,
               .highest = 1e6},
              engine->rate);
    v.real(
        {.key = "force_scale",
         .meaning = "force on the engine's atoms, as a multiple of the force that the hand feels",
         .lowest = 0,
         .highest = 100},
        engine->force_scale);
    v.real({.key = "most_force_nN",
            .meaning = "largest force of the spring between hand and atoms; beyond it the force "
                       "stays constant",
            .lowest = 1e-3,
            .highest = 100},
           engine->most_force_nN);
    v.real(
        {.key = "smoothing_ms",
         .meaning = "time constant of a low-pass filter for the atoms that the spring pulls, so "
                    "that thermal motion does not shake the hand; it delays the force by as much",
         .lowest = 0,
         .highest = 1e4},
        engine->smoothing_ms);
    v.real({.key = "late_s",
            .meaning = "time without a frame after which the force is off until the next frame",
            .lowest = 0.05,
            .highest = 60},
           engine->late_s);
    v.real({.key = "wait_s",
            .meaning = "time to wait for the first frame, in runs without a window and where only "
                       "that frame has the positions",
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
            .meaning = "resolution of the position sensor; 0: exact",
            .lowest = 1e-6,
            .highest = 1,
            .zero = true},
           d.encoder_step_mm);
    v.integer({.key = "servo_delay_ticks",
               .meaning = "delay of the device, servo ticks from computing a force to sending it",
               .lowest = 0,
               .highest = 7},
              d.servo_delay_ticks);
    v.leave_table();
}

void visit_coupling(FieldVisitor& v, CouplingDescription& c) {
    v.enter_table({.key = "coupling", .meaning = "coupling between molecule and hand"});
    visit_coupling_keys(v, c);
    v.leave_table();
}

// Visits a device or a coupling that a hand may have for itself; keys that the table does not have
// are as in `from`.
template <class Part, class Visit>
void visit_own(FieldVisitor& v, const Field& table, const Part& from, std::optional<Part>& own,
               const Visit& visit) {
    if (!v.is_there(table, own.has_value())) return;
    if (!own) own = from;
    visit(v, *own);
}

void visit_hands(FieldVisitor& v, SceneDescription& scene, bool is_remote) {
    const Field list{.key = "hand",
                     .meaning =
                         "the Nth hand if there are several: [[hand]] with [hand.grab], and "
                         "[hand.device] and [hand.coupling] if they differ from the scene's; as "
                         "a setting hand[2].stroke, hand[2].grab.atom, hand[2].coupling.mode",
                     .lowest = 1,
                     .highest = most_hands};
    if (!v.is_list(list, scene.hands.size() > 1)) {
        visit_grab(v, scene.hands.front().grab, is_remote);
        v.enter_table({.key = "hand", .meaning = "the hand on the emulated device"});
        visit_hand_keys(v, scene.hands.front());
        return v.leave_table();
    }
    // A hand does not inherit feel_pN and feel_within_pN, since no key could unset them.
    CouplingDescription coupling = scene.coupling;
    coupling.feel_pN.reset();
    coupling.feel_within_pN.reset();
    std::size_t count = scene.hands.size();
    v.list_entries(list, count);
    scene.hands.resize(std::max<std::size_t>(count, 1));
    for (std::size_t i = 0; i < count; ++i) {
        HandDescription& hand = scene.hands[i];
        TextPlace place = scene.place_of(fmt::format("hand[{}]", i + 1));
        v.enter_entry(list, i, place);
        visit_hand_keys(v, hand);
        visit_grab(v, hand.grab, is_remote);
        visit_own(v, {.key = "device", .meaning = "its device"}, scene.device, hand.device,
                  visit_device);
        visit_own(v, {.key = "coupling", .meaning = "its coupling"}, coupling, hand.coupling,
                  visit_coupling);
        v.leave_table();
    }
}

void visit_question(FieldVisitor& v, std::optional<LessonQuestion>& question) {
    const Field table{
        .key = "question",
        .meaning = "a question whose right answer completes the step, in place of a quantity"};
    if (!v.is_there(table, question.has_value())) return;
    if (!question) question.emplace();
    v.enter_table(table);
    v.text({.key = "text", .meaning = "what is asked", .required = true}, question->text);
    v.texts({.key = "answers",
             .meaning = "answers to choose from",
             .lowest = 2,
             .highest = 6,
             .required = true},
            question->answers);
    v.integer({.key = "right",
               .meaning = "number of the right answer, from 1",
               .lowest = 1,
               .highest = 6},
              question->right);
    v.texts({.key = "why",
             .meaning = "for each answer, why it is right or wrong",
             .lowest = 2,
             .highest = 6,
             .required = true},
            question->why);
    v.leave_table();
}

void visit_lesson_step(FieldVisitor& v, LessonStepDescription& s) {
    v.enter_table({.key = s.name, .meaning = "one step of the lesson"});
    v.text({.key = "text", .meaning = "explanation", .required = true}, s.text);
    v.text({.key = "task", .meaning = "what to do", .required = true}, s.task);
    choose(
        v,
        {.key = "quantity",
         .meaning = "quantity that decides whether the step is done: distance of the reference "
                    "atoms; force on the molecule or on the hand (+ repels); coupling mode; ripple "
                    "of the force on the hand in the last 2 s; for the selections of `of`: "
                    "distance of two centres, dihedral of four atoms, number of hydrogen bonds "
                    "between two, number of cells of 20° by 20° that two dihedrals have visited, "
                    "distance of a centre from its start; work of the hand; potential energy"},
        lesson_quantity_names, s.quantity);
    v.texts(
        {.key = "of",
         .meaning = "selections (tools/selections.md): two for between_angstrom and "
                    "hydrogen_bonds, four atoms for dihedral_deg, five bonded atoms for map_cells "
                    "(C, N, CA, C, N: φ and ψ), one for way_angstrom; unset: the molecule in hand"},
        s.of);
    v.optional_real(
        {.key = "at_least", .meaning = "smallest accepted value", .lowest = -1e6, .highest = 1e6},
        s.at_least);
    v.optional_real(
        {.key = "at_most", .meaning = "largest accepted value", .lowest = -1e6, .highest = 1e6},
        s.at_most);
    v.real({.key = "for_s",
            .meaning = "simulated seconds for which the value must stay accepted",
            .lowest = 0,
            .highest = 1e3},
           s.for_s);
    v.text({.key = "view",
            .meaning = "name of a saved view that is shown as the step begins; unset: none"},
           s.view);
    choose(v,
           {.key = "plot",
            .meaning = "plot beside the task: the map of map_cells; the force on the molecule over "
                       "the distance, or over the way of what is in hand"},
           lesson_plot_names, s.plot);
    choose(v, {.key = "panel", .meaning = "panel of the window that is opened as the step begins"},
           lesson_panel_names, s.panel);
    v.text({.key = "operator_take",
            .meaning = "what the operator of `palpa lessons play` takes in hand as the step "
                       "begins, as in `edits.take`; unset: no change"},
           s.operator_take);
    const Field coupling{
        .key = "operator_coupling",
        .meaning = "coupling keys that the operator changes then, as in `edits.coupling`"};
    if (v.is_there(coupling, !s.operator_coupling.empty()))
        v.coupling_settings(coupling, s.operator_coupling);
    v.path({.key = "operator_path",
            .meaning = "path along which the operator then leads the molecule, as `hand.path` of "
                       "\"lead\": s since the step began, Å from the start of the scene",
            .lowest = -1e5,
            .highest = 1e5},
           s.operator_path);
    visit_question(v, s.question);  // last, as a table of its own
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
        path_ += std::string(field.key) + ".";
    }
    void leave_table() override {
        if (inline_table_) {
            const Field table = *inline_table_;
            inline_table_.reset();
            return add(table, fmt::format("table of {}", fmt::join(inline_keys_, ", ")), "unset");
        }
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
    bool is_list(const Field& field, bool /*list*/) override {
        notes.push_back({fmt::format("{}[N].KEY", field.key), fmt::format("as `{}.KEY`", field.key),
                         "as there", std::string(field.meaning)});
        return false;
    }
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
            field.may_be_unset ? "unset" : fmt::format("[{}]", fmt::join(value, ", ")));
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
        notes.push_back({path_ + std::string(field.key), std::move(type),
                         field.required ? "required" : std::move(fallback),
                         std::string(field.meaning)});
    }

    std::string path_;
    std::optional<Field> inline_table_;  // that is under way: one note with all its keys
    std::vector<std::string_view> inline_keys_;
};

}  // namespace

void triple_if_set(FieldVisitor& v, Field field, std::optional<std::array<double, 3>>& value) {
    if (!v.is_there(field, value.has_value())) return;
    if (!value) value.emplace();
    field.may_be_unset = true;
    v.triple(field, *value);
}

void visit_scene(FieldVisitor& v, SceneDescription& scene) {
    v.text({.key = "format", .meaning = "version of the scene format; empty: 2.0"}, scene.format);
    v.text({.key = "title", .meaning = "name of the scene"}, scene.title);
    v.text({.key = "about", .meaning = "description in a few sentences"}, scene.about);
    choose(v, {.key = "level", .meaning = "audience, which the start screen shows"},
           scene_level_names, scene.level);
    v.real({.key = "minutes",
            .meaning = "minutes that a person needs for it; 0: not stated",
            .lowest = 0,
            .highest = 600},
           scene.minutes);
    v.text({.key = "made_by",
            .meaning = "how to make the files of the scene, for the reader; Palpa does not run it"},
           scene.made_by);
    v.text({.key = "lesson_goal", .meaning = "what a person can do after the lesson"},
           scene.lesson_goal);
    v.text({.key = "lesson_learned",
            .meaning = "what a person has learned, in two sentences, shown after the last step"},
           scene.lesson_learned);
    visit_engine(v, scene.engine);
    const bool is_remote = scene.engine && !v.is_listing();
    visit_force_field(v, scene.force_field, !is_remote);
    visit_molecules(v, scene.molecules, is_remote);
    visit_restraints(v, scene.restraints);
    visit_pins(v, scene.pins);
    visit_joints(v, scene.joints);
    visit_statics(v, scene.statics);
    visit_device(v, scene.device);
    visit_coupling(v, scene.coupling);
    visit_hands(v, scene, is_remote);
    visit_view(v, scene.view);
    visit_lesson(v, scene.lesson);
    v.enter_table({.key = "run", .meaning = "a headless run"});
    v.real(
        {.key = "period_ms",
         .meaning = "declared period of the simulation, ms, a whole number of servo ticks of 1 ms",
         .lowest = 1,
         .highest = 1e4},
        scene.period_ms);
    v.text({.key = "measured_on",
            .meaning = "machine on which period and gains were measured: on another one the window "
                       "measures the period again, where it says \"nowhere\" the gains too; unset: "
                       "never"},
           scene.measured_on);
    v.real({.key = "seconds", .meaning = "length of the run, s", .lowest = 1e-3, .highest = 1e5},
           scene.seconds);
    v.integer({.key = "every",
               .meaning = "the trace has one row for every N servo ticks",
               .lowest = 1,
               .highest = 1e6},
              scene.every);
    v.integer({.key = "seed",
               .meaning = "random seed; the present strokes use no random numbers",
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

std::vector<FieldNote> list_run_commands() {
    Lister lister;
    RunCommand command;
    visit_run_command(lister, command);
    return std::move(lister.notes);
}

}  // namespace palpa
