// The enumerations of a scene file with their names in the file.
#pragma once
#include "core/choices.h"

#include <array>
#include <string_view>

namespace palpa {

// Every choice of a scene file: its names stand in the order of the enumerators.
enum class Motion { Fixed, AlongX, Translate, TranslateAndTurn, Free, WithHandle };
inline constexpr std::array<std::string_view, 6> motion_names{
    "fixed", "along-x", "translate", "translate-and-turn", "free", "with-handle"};

enum class Shape { Rigid, Flexible };
inline constexpr std::array<std::string_view, 2> shape_names{"rigid", "flexible"};

// Solvent model: none, or EEF1-SB (charmm/solvation.h) with neutral ionic groups and a dielectric
// of 1.5 r.
enum class Solvent { None, Eef1Sb };
inline constexpr std::array<std::string_view, 2> solvent_names{"none", "eef1-sb"};

// Remote engines, which differ in the units of energies that they send.
enum class EngineProgram { Unknown, Gromacs, Lammps, Namd };
inline constexpr std::array<std::string_view, 4> engine_program_names{"unknown", "gromacs",
                                                                      "lammps", "namd"};

// Versions of IMD.
enum class EngineProtocol { Any, Two, Three };
inline constexpr std::array<std::string_view, 3> engine_protocol_names{"any", "2", "3"};

enum class PairPrecision { Double, Fast };
inline constexpr std::array<std::string_view, 2> pair_precision_names{"double", "fast"};

// What counts where active joints are chosen.
enum class JointWeights { Acceleration, PerJoint, HandProximity };
inline constexpr std::array<std::string_view, 3> joint_weight_names{"acceleration", "per-joint",
                                                                    "hand-proximity"};

enum class Stroke { Hold, InOut, Path, Lead };
inline constexpr std::array<std::string_view, 4> stroke_names{"hold", "in-out", "path", "lead"};

// The paper's five modes, and guarded coupling.
enum class CouplingMode {
    VariableForceVariableDisplacement,
    VariableForceConstantDisplacement,
    ConstantForceVariableDisplacement,
    ConstantForceConstantDisplacement,
    NoForce,
    Guarded
};
inline constexpr std::array<std::string_view, 6> coupling_mode_names{"1", "2", "3",
                                                                     "4", "5", "guarded"};

// Laws of guarded coupling, and workspace mapping.
enum class ForceLawChoice { Printed, Calibrated, Constant, Perceptual };
inline constexpr std::array<std::string_view, 4> force_law_names{"printed", "calibrated",
                                                                 "constant", "perceptual"};
enum class DisplacementLawChoice { Repaired, Printed, Constant };
inline constexpr std::array<std::string_view, 3> displacement_law_names{"repaired", "printed",
                                                                        "constant"};
enum class WorkspaceChoice { Clutch, Bubble, Drift };
inline constexpr std::array<std::string_view, 3> workspace_names{"clutch", "bubble", "drift"};

// How the force of a headless run begins; a window always uses the ramp.
enum class Engage { AtOnce, Ramp };
inline constexpr std::array<std::string_view, 2> engage_names{"at-once", "ramp"};

// Audience of a scene.
enum class SceneLevel { Unstated, Beginner, Student, Researcher };
inline constexpr std::array<std::string_view, 4> scene_level_names{"unstated", "beginner",
                                                                   "student", "researcher"};

// The quantity that a step of a lesson checks.
enum class LessonQuantity {
    Distance,
    Force,
    FeltForce,
    Mode,
    Ripple,
    Between,
    Dihedral,
    HydrogenBonds,
    MapCells,
    Way,
    Work,
    Energy
};
inline constexpr std::array<std::string_view, 12> lesson_quantity_names{
    "distance_angstrom", "force_nN",           "felt_N",         "mode",      "ripple_N",
    "between_angstrom",  "dihedral_deg",       "hydrogen_bonds", "map_cells", "way_angstrom",
    "work_kcal_per_mol", "energy_kcal_per_mol"};

// The drawing beside a step of a lesson. Map: the cells of two dihedrals that were visited.
// Force: that on the molecule, over the distance. Way: the same over the way of what is in hand.
enum class LessonPlot { None, Map, Force, Way };
inline constexpr std::array<std::string_view, 4> lesson_plot_names{"none", "map", "force", "way"};

// The panel of the window that a step of a lesson teaches, and opens.
enum class LessonPanel { None, Coupling, Plots };
inline constexpr std::array<std::string_view, 3> lesson_panel_names{"none", "coupling", "plots"};

// In hand: the grabbed molecule as balls and sticks, all others as thin sticks without hydrogens.
// Pocket: of the others a cartoon, and thin sticks of those residues that are near to it. Cartoon:
// ribbons of proteins and nucleic acids, all else but waters as balls and sticks. Surface: the
// solvent-excluded one, beyond 2,000 atoms a Gaussian one.
enum class Representation {
    BallAndStick,
    SpaceFilling,
    Licorice,
    InHand,
    Pocket,
    Lines,
    Cartoon,
    Surface
};
inline constexpr std::array<std::string_view, 8> representation_names{
    "ball-and-stick", "space-filling", "licorice", "in-hand",
    "pocket",         "lines",         "cartoon",  "surface"};

// By chain: carbons in a colour of their chain, everything else as by element. Carbons of the
// grabbed molecule have a colour of their own in these two. The others colour whole atoms or
// residues; view/colours.h has their scales.
enum class Colouring {
    Element,
    Chain,
    Residue,
    Structure,
    Charge,
    BFactor,
    Force,
    Activity,
    Potential,
    Hydrophobicity,
    Error
};
inline constexpr std::array<std::string_view, 11> colouring_names{
    "element", "chain",    "residue",   "structure",      "charge", "b-factor",
    "force",   "activity", "potential", "hydrophobicity", "error"};

// Which hydrogen bonds are drawn. In hand: of what hands hold with all the rest. All: also within
// molecules.
enum class ShownBonds { None, InHand, All };
inline constexpr std::array<std::string_view, 3> shown_bond_names{"none", "in-hand", "all"};

// Which hydrogens are drawn. Polar: those bonded to nitrogen, oxygen or sulphur.
enum class ShownHydrogens { All, Polar, None };
inline constexpr std::array<std::string_view, 3> shown_hydrogen_names{"all", "polar", "none"};

// Shadows of opaque objects on each other.
enum class Shadows { None, Soft };
inline constexpr std::array<std::string_view, 2> shadow_names{"none", "soft"};
// Of which parts the force on what is in the hand is shown: as a whole, and besides what the
// residues or atoms around do to it, the strongest.
enum class ShownForces { Hand, Residues, Atoms };
inline constexpr std::array<std::string_view, 3> shown_force_names{"hand", "residues", "atoms"};

}  // namespace palpa
