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
                       "the fewer atoms they move; and the nearer they are to the hand"},
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

}  // namespace palpa
