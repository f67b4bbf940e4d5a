// The content of a scene file as plain data with defaults; nothing is loaded yet.
#pragma once
#include "core/load_error.h"
#include "core/omni.h"
#include "core/units.h"
#include "scene/choices.h"
#include "scene/edits.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct ForceFieldDescription {
    std::vector<std::filesystem::path> files;
    double coulomb_constant = units::charmm_coulomb_constant;  // kcal Å/mol/e^2
    Solvent solvent = Solvent::None;
};

// How a molecule is drawn, if different from everything else.
struct Appearance {
    std::optional<Representation> representation;
    std::optional<Colouring> colouring;
    bool visible = true;
};

struct MoleculeDescription {
    std::string name;
    std::filesystem::path structure;
    std::filesystem::path topology;  // empty: from the force field's residues
    std::string segment;
    std::string reference_atom;  // atom that marks the molecule's position: "OH2", or "25 CG"
    Motion motion = Motion::Fixed;
    Shape shape = Shape::Rigid;
    bool structural_water = false;  // its waters are part of the structure, in implicit water
    // Atoms ("25 CA") or residues ("25") that springs hold where the structure has them.
    std::vector<std::string> anchors;
    double anchor_kcal_per_mol_angstrom2 = 5;
    std::vector<std::string>
        approximate;  // residues with approximate types, charges and parameters
    Appearance appearance{};
};

// A remote engine that moves all atoms, over IMD, in place of our own mechanics.
struct EngineDescription {
    std::string address = "127.0.0.1:8888";
    EngineProgram program = EngineProgram::Unknown;
    EngineProtocol protocol = EngineProtocol::Any;
    std::filesystem::path atoms;  // match of its atoms to the scene's; empty: all, in this order
    std::int64_t rate = 0;        // steps of the engine between frames; 0: the engine's setting
    double force_scale = 1;       // multiple of the hand's force that acts on the engine's atoms
    double most_force_nN = 1;     // largest force of the spring between hand and atoms
    double smoothing_ms = 50;     // time constant of the low-pass for the held atoms
    double late_s = 1;            // time without a frame after which the force is off
    double wait_s = 10;           // time to wait for the first frame

    friend bool operator==(const EngineDescription&, const EngineDescription&) = default;
};

// Which bonds of flexible molecules turn.
struct JointsDescription {
    bool backbone = true;
    bool hydroxyl = true, thiol = true, ammonium = true;
    bool methyl = false, amide = false, amide_nh2 = false, guanidinium_nh2 = false;
    std::vector<std::string> turn, rigid, springs;  // bonds: "A 25 CB CG", "A 25 C 26 N"
    std::optional<double> within_angstrom;          // distance from `around`; unset: everywhere
    std::string around;                             // a molecule; empty: the one in the hand
    std::optional<double> region_angstrom;          // region around what hands hold; unset: none
};

// How flexible molecules relax.
struct StaticsDescription {
    std::optional<RelaxMethod> method;  // unset: see method_of
    std::int64_t steps = 1;             // in each period
    double largest_move_angstrom = 0.05;
    // Of second order: pairs between what is held and atoms so near are exact; the way of a hand
    // between two linearisations.
    double near_angstrom = 6;
    double renew_angstrom = 0.1;
    std::int64_t responses = 0;  // second order: dimension of the subspace of a step; 0: all
    double renewal_ms = 0;       // declared time from the request of a linearisation to its use
    bool renews_beside = false;  // renewals on their own thread, as in a live session; no key
    PairPrecision pairs = PairPrecision::Fast;
    std::optional<double> cutoff_angstrom;  // unset: all pairs
    std::int64_t active = 1'000'000;        // active degrees of freedom
    std::optional<double> budget_us;        // time budget of a step; unset: none
    JointWeights weights = JointWeights::HandProximity;
    std::int64_t choose_every = 10;  // steps
    double rest_kcal_per_mol = 0.05;
    std::int64_t relax_steps = 4000;
    bool relaxes_start = true;  // false: everything starts where the files have it
};

// Where no method is set: second order, but the paper's step where fewer degrees of freedom than
// all are to be active, or steps have a time budget.
RelaxMethod method_of(const StaticsDescription& statics) noexcept;

struct GrabDescription {
    std::string molecule;       // molecule that the hand moves; empty: it holds nothing
    std::string measured_from;  // molecule from whose reference atom distances are measured; empty:
                                // the one in the hand
    std::string atom;           // "25 CA", or a residue "25", held by a spring; empty: no spring
    double spring_kcal_per_mol_angstrom2 = 20;
    std::optional<std::array<double, 3>>
        place_angstrom{};  // end of the spring; unset: at the atoms
    // Motion of the molecule after its release; unset: free where something moves by itself, else
    // fixed, and with a spring as it is.
    std::optional<Motion> released{};

    friend bool operator==(const GrabDescription&, const GrabDescription&) = default;
};

// Where the hand is to be at a time, mm, or where it is to have brought the molecule, Å from its
// start. Turns as rotation vectors: along the axis, as long as the angle.
struct PathPoint {
    double time_s = 0;
    std::array<double, 3> place{}, turn_deg{};

    friend bool operator==(const PathPoint&, const PathPoint&) = default;
};

struct DeviceDescription {
    double inertia_kg = 0.045;
    double viscosity_N_s_per_m = 0.1;
    double friction_N = 0.26;
    double encoder_step_mm = 0.055;
    std::int64_t servo_delay_ticks = 1;

    friend bool operator==(const DeviceDescription&, const DeviceDescription&) = default;
};

struct CouplingDescription {
    CouplingMode mode = CouplingMode::Guarded;
    double clamp_N = truncation_newton;
    // Eq. 2 and eq. 3, with the numbers of the paper's figures 4 and 6.
    double F_h1_N = 1, F_h2_N = truncation_newton, F_0_nN = 1.5, A_f_min = 0.64e9, A_f_max = 5.1e9;
    double gamma_per_N = 10e11, F_off_pN = 20, A_d_min = 0.005e9, A_d_max = 0.25e9;
    double A_f = 0.64e9, A_d = 0.25e9;  // constant gains

    // What must be felt, of the force on the molecule, and how exactly; unset: what the laws and
    // the statics give.
    std::optional<std::array<double, 2>> feel_pN;  // from and to
    std::optional<double> feel_within_pN;

    // Of guarded coupling.
    ForceLawChoice force_law = ForceLawChoice::Printed;
    DisplacementLawChoice displacement_law = DisplacementLawChoice::Repaired;
    GainShape gain_shape = GainShape::Scalar;
    WorkspaceChoice workspace = WorkspaceChoice::Clutch;
    double F_lo_pN = 20, F_hi_nN = 3;  // perceptual law
    double damping_N_s_per_m = 0.5;
    double stop_nN = 10;
    std::int64_t pairs_per_tick = 130'000;
    Engage engage = Engage::AtOnce;

    friend bool operator==(const CouplingDescription&, const CouplingDescription&) = default;
};

// A hand: what it holds, what it does, and how it feels.
struct HandDescription {
    GrabDescription grab{};
    HandGrip grip = HandGrip::Medium;
    Stroke stroke = Stroke::InOut;
    std::optional<double> start_angstrom;
    std::array<double, 3> start_offset_angstrom{};
    double peak_nN = 3;
    double stroke_s = 3;
    double pause_s = 1;
    std::int64_t cycles = 1;
    std::optional<double> release_s;
    double kick_N_s = 0;
    std::vector<PathPoint> path;
    std::optional<DeviceDescription> device{};      // unset: the scene's
    std::optional<CouplingDescription> coupling{};  // unset: the scene's

    friend bool operator==(const HandDescription&, const HandDescription&) = default;
};

// A question with one right answer; each answer is explained once it was chosen.
struct LessonQuestion {
    std::string text;
    std::vector<std::string> answers;
    std::int64_t right = 1;  // counted from 1
    std::vector<std::string> why;

    friend bool operator==(const LessonQuestion&, const LessonQuestion&) = default;
};

// One step of a lesson: what there is to know, what to do, and how to tell that it was done.
struct LessonStepDescription {
    std::string name, text, task;
    LessonQuantity quantity = LessonQuantity::Distance;
    std::optional<double> at_least, at_most;
    double for_s = 0;               // for which the value must stay accepted
    std::string view{};             // saved view at the start of the step; empty: none
    std::vector<std::string> of{};  // selections for the quantity
    LessonPlot plot = LessonPlot::None;
    LessonPanel panel = LessonPanel::None;     // opened as the step begins
    std::optional<LessonQuestion> question{};  // question in place of a quantity
    // What an operator of `palpa lessons play` does: takes something in hand, changes the coupling,
    // then leads what it holds, Å from where the scene began, by seconds since the step began.
    std::string operator_take{};
    std::vector<std::string> operator_coupling{};
    std::vector<PathPoint> operator_path{};
};

// How the scene is seen at first, in a window and by `palpa render`.
// What is drawn beside, or in the place of, how everything is.
struct ViewLayer {
    Representation representation = Representation::BallAndStick;
    std::string of{};                      // a selection (molecule/select.h); empty: all atoms
    std::optional<Colouring> colouring{};  // unset: as the rest
    double opacity = 1;                    // opacity of a surface
    TextPlace place{};

    friend bool operator==(const ViewLayer& a, const ViewLayer& b) {
        return a.representation == b.representation && a.of == b.of && a.colouring == b.colouring &&
               a.opacity == b.opacity;
    }
};

// A saved view.
struct SavedView {
    std::string name;
    std::array<double, 3> camera{0, 0, 1};  // azimuth and elevation in degrees, zoom
    std::string look_at{};                  // a selection; empty: all atoms
    std::array<double, 3> shift{};          // shift of the view's centre from the middle of it, Å
    std::optional<Representation> representation{};  // unset: that of the scene
    std::vector<ViewLayer> layers{};                 // additional layers while it is shown
    TextPlace place{};

    friend bool operator==(const SavedView& a, const SavedView& b) {
        return a.name == b.name && a.camera == b.camera && a.look_at == b.look_at &&
               a.shift == b.shift && a.representation == b.representation && a.layers == b.layers;
    }
};

// Additional marks in the picture.
struct ViewMarks {
    std::vector<std::string> measures{};  // two to four selections each, with ';' between them
    ShownBonds contacts = ShownBonds::None;
    ShownForces forces = ShownForces::Hand;
    bool ghost = false;  // shows the held molecule at its start
    double trail_s = 0;  // path of the held molecule over the last seconds; 0: none

    friend bool operator==(const ViewMarks&, const ViewMarks&) = default;
};

struct ViewDescription {
    std::optional<Representation> representation;  // unset: chosen for the scene
    Colouring colouring = Colouring::Chain;
    ShownBonds hydrogen_bonds = ShownBonds::InHand;
    std::array<double, 3> camera{0, 0, 1};  // azimuth and elevation in degrees, zoom
    std::string look_at;                    // a molecule; empty: all of them
    bool clip = false;                      // hides atoms in front of the grabbed molecule
    std::vector<ViewLayer> layers{};
    std::vector<std::string> labels{};  // selections to label
    ShownHydrogens hydrogens = ShownHydrogens::All;
    Shadows shadows = Shadows::None;
    bool occlusion = true;              // darker crevices
    std::int64_t outline = 1;           // pixels
    std::vector<std::string> hidden{};  // selections that only layers draw
    std::vector<SavedView> saved{};     // in the order of the file
    ViewMarks marks{};
};

// Restraints and pins that a scene has from the start, in the form of an edit.
struct StartRestraint : RestraintEdit {
    TextPlace place;
};
struct StartPin : PinEdit {
    TextPlace place;
};

inline constexpr std::string_view unmeasured = "nowhere";

struct SceneDescription {
    std::filesystem::path file;
    std::string format;  // version that the file states (core/file_versions.h); empty: none
    std::string title, about;
    SceneLevel level = SceneLevel::Unstated;
    double minutes = 0;   // minutes that a person needs; 0: not stated
    std::string made_by;  // command that makes the files; empty: they exist
    std::string lesson_goal, lesson_learned;
    ForceFieldDescription force_field;
    std::vector<MoleculeDescription> molecules;  // in the order of the file
    std::vector<StartRestraint> restraints;
    std::vector<StartPin> pins;
    JointsDescription joints;
    StaticsDescription statics;
    std::optional<EngineDescription> engine;
    std::vector<HandDescription> hands{HandDescription{}};  // one to most_hands
    DeviceDescription device;                               // for hands without one of their own
    CouplingDescription coupling;                           // for hands without one of their own
    ViewDescription view;
    std::vector<LessonStepDescription> lesson;  // in the order of the file
    std::vector<EditDescription> edits;         // in the order of the file
    double period_ms = 1;
    // The machine on which period and gains were measured (core/machine.h); unmeasured: nowhere
    // yet; empty: they are wanted as they are.
    std::string measured_on;
    double seconds = 10;
    std::int64_t every = 1;
    std::int64_t seed = 1;

    // Position of each field in the file or settings, by full key.
    std::map<std::string, TextPlace, std::less<>> places;

    // What a user should know of how it was read, a sentence each: old names, a newer format.
    std::vector<std::string> notes;

    // The place of a field for messages: its own, or the file where the default holds.
    TextPlace place_of(std::string_view key) const;

    // Whether something moves by itself: joints, a turning or free molecule.
    bool has_statics() const;
};

// One of the hands, with the tables that say what it holds and does: "grab" and "hand" of the only
// one, "hand[2].grab" and "hand[2]" of several.
struct HandTables {
    std::string grab_key, hand_key;
    const GrabDescription& grab;
    const HandDescription& hand;
};

// All hands in the order of their devices. They are the scene's, which must outlive them.
std::vector<HandTables> list_hands(const SceneDescription& scene);

// The device and the coupling of a hand, counted from 0.
const DeviceDescription& device_of(const SceneDescription& scene, std::size_t hand);
const CouplingDescription& coupling_of(const SceneDescription& scene, std::size_t hand);
CouplingDescription& coupling_of(SceneDescription& scene, std::size_t hand);

}  // namespace palpa
