#include "scene/mechanics_fields.h"

namespace palpa {

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
             .meaning = "bonds that turn in addition to the rules, \"SEGMENT RESIDUE ATOM ATOM\" "
                        "or \"SEGMENT RESIDUE ATOM RESIDUE ATOM\""},
            j.turn);
    v.texts({.key = "rigid", .meaning = "bonds that do not turn in spite of the rules"}, j.rigid);
    v.texts({.key = "springs",
             .meaning = "bonds at which a ring is opened; only their force field terms hold it "
                        "together, as for disulphides"},
            j.springs);
    v.optional_real({.key = "within_angstrom",
                     .meaning = "only residues with an atom within this distance of `around` on "
                                "loading can turn; unset: all",
                     .lowest = 0,
                     .highest = 1e3},
                    j.within_angstrom);
    v.text({.key = "around", .meaning = "name of a molecule; unset: the one in the hand"},
           j.around);
    v.optional_real({.key = "region_angstrom",
                     .meaning = "only residues with an atom within this distance of what the hands "
                                "hold can move; chains are cut at the border of this region, and "
                                "bonded terms hold them there; unset: no region",
                     .lowest = 0,
                     .highest = 1e3},
                    j.region_angstrom);
    v.leave_table();
}

void visit_statics(FieldVisitor& v, StaticsDescription& s) {
    v.enter_table({.key = "statics", .meaning = "how flexible molecules relax"});
    choose_if_set(
        v,
        {.key = "method",
         .meaning =
             "second-order: everything follows the hand by second derivatives of the energy, exact "
             "near the hand; quasi-static: the paper's step with few or all joints. Unset: "
             "second-order, but quasi-static with "
             "`active` below all, with `budget_us`, or with more than 3,000 degrees of freedom"},
        relax_method_names, s.method);
    v.integer({.key = "steps",
               .meaning = "steps of the method in each period of the simulation",
               .lowest = 1,
               .highest = 10000},
              s.steps);
    v.real({.key = "largest_move_angstrom",
            .meaning = "largest move of an atom in one step",
            .lowest = 1e-4,
            .highest = 1},
           s.largest_move_angstrom);
    v.real({.key = "near_angstrom",
            .meaning =
                "second-order: pairs of the held atoms with atoms within this distance are exact",
            .lowest = 0,
            .highest = 20},
           s.near_angstrom);
    v.real({.key = "renew_angstrom",
            .meaning = "second-order: path length of a hand from one linearisation to the next",
            .lowest = 0.02,
            .highest = 0.3},
           s.renew_angstrom);
    v.integer(
        {.key = "responses",
         .meaning =
             "second-order: for each hand a step searches for the relaxed state in a subspace of "
             "this many combined moves (responses to the hand and to the remaining forces near "
             "it), which is faster in a stiff pocket; 0: in all degrees of freedom",
         .lowest = 0,
         .highest = 3000},
        s.responses);
    v.real({.key = "renewal_ms",
            .meaning = "second-order: declared time from requesting a linearisation to using it; "
                       "0: within the step",
            .lowest = 0,
            .highest = 1000},
           s.renewal_ms);
    choose(v,
           {.key = "pairs",
            .meaning = "double, or single: non-bonded pairs in single precision, ten times faster "
                       "(for a rigid molecule in hand only with 10,000 pairs or more)"},
           pair_precision_names, s.pairs);
    v.optional_real(
        {.key = "cutoff_angstrom",
         .meaning = "cutoff of non-bonded forces, switched off over the last 2 Å; unset: no cutoff",
         .lowest = 4,
         .highest = 1e3},
        s.cutoff_angstrom);
    v.integer(
        {.key = "active",
         .meaning =
             "number of active degrees of freedom, those that would move most; a free base has 6",
         .lowest = 0,
         .highest = 1e6},
        s.active);
    v.optional_real(
        {.key = "budget_us",
         .meaning = "time budget of a step: as many degrees of freedom are active as 99 % of steps "
                    "have time for; such runs are not reproducible; unset: no limit",
         .lowest = 1,
         .highest = 1e6},
        s.budget_us);
    choose(v,
           {.key = "weights",
            .meaning = "weight in the selection of active joints: acceleration of regions, as in "
                       "the paper; per-joint: joints individually, also by the inertia that they "
                       "move; hand-proximity: also favours joints near the hand and such that "
                       "move few atoms"},
           joint_weight_names, s.weights);
    v.integer({.key = "choose_every",
               .meaning = "steps from one selection to the next",
               .lowest = 1,
               .highest = 1e6},
              s.choose_every);
    v.real({.key = "rest_kcal_per_mol",
            .meaning = "on loading the scene is relaxed until the rms force along the coordinates "
                       "(per radian and per Å) is below this",
            .lowest = 1e-6,
            .highest = 1e6},
           s.rest_kcal_per_mol);
    v.integer({.key = "relax_steps",
               .meaning = "largest number of steps of this relaxation",
               .lowest = 0,
               .highest = 1e6},
              s.relax_steps);
    v.flag({.key = "relaxes_start",
            .meaning = "whether loading relaxes the scene and brings a rigid molecule in the hand "
                       "to rest; false in saved scenes: everything starts where the files have it"},
           s.relaxes_start);
    v.leave_table();
}

}  // namespace palpa
