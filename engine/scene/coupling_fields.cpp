#include "core/omni.h"
#include "scene/fields.h"

namespace palpa {

void visit_coupling_keys(FieldVisitor& v, CouplingDescription& c) {
    choose(v,
           {.key = "mode",
            .meaning = "coupling mode. guarded: the servo itself moves the molecule in the force "
                       "field around it; modes of the paper, which may vibrate: 1 variable force "
                       "and displacement gain, 2 variable force gain, 3 variable displacement "
                       "gain, 4 both gains constant, 5 no force"},
           coupling_mode_names, c.mode);
    v.real({.key = "clamp_N",
            .meaning = "largest force sent to the device",
            .lowest = 0,
            .highest = omni_peak_newton},
           c.clamp_N);
    v.real({.key = "F_h1_N",
            .meaning = "eq. 2: limit of the part of the curve for weak forces",
            .lowest = 1e-3,
            .highest = 100},
           c.F_h1_N);
    v.real({.key = "F_h2_N",
            .meaning = "eq. 2: limit for strong forces, above F_h1_N",
            .lowest = 1e-3,
            .highest = 100},
           c.F_h2_N);
    v.real({.key = "F_0_nN",
            .meaning = "eq. 2: molecular force between weak and strong",
            .lowest = 0,
            .highest = 1e3},
           c.F_0_nN);
    v.real(
        {.key = "A_f_min", .meaning = "eq. 2: gain of strong forces", .lowest = 1, .highest = 1e13},
        c.A_f_min);
    v.real(
        {.key = "A_f_max", .meaning = "eq. 2: gain of weak forces", .lowest = 1, .highest = 1e13},
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
                     .meaning = "guarded: [weakest, strongest] molecular force, felt as at least "
                                "0.3 N and at most 2.7 N, in place of force_law; the stiffness cap "
                                "then shortens the molecule's travel; unset: force_law",
                     .lowest = 1e-3,
                     .highest = 1e6},
                    c.feel_pN);
    v.optional_real(
        {.key = "feel_within_pN",
         .meaning =
             "error limit of the force against complete relaxation; in flexible scenes it sets the "
             "range of exact pairs, the age of the contact model and its evaluations "
             "(second-order), or active joints and steps (quasi-static); unset: as in [statics]",
         .lowest = 1e-6,
         .highest = 1e6},
        c.feel_within_pN);
    choose(
        v,
        {.key = "force_law",
         .meaning =
             "guarded: eq. 2 as printed; eq. 2 calibrated to the slopes A_f_max and A_f_min; "
             "constant A_f; or perceptual: equally many noticeable steps for each decade of force"},
        force_law_names, c.force_law);
    choose(v,
           {.key = "displacement_law",
            .meaning = "guarded: eq. 3 with the stiffness included (repaired); eq. 3 as printed; "
                       "or constant A_d"},
           displacement_law_names, c.displacement_law);
    choose(v,
           {.key = "gain_shape",
            .meaning = "guarded: directions in which A_d is raised to keep the stiffness cap: all "
                       "(scalar), or only the stiff ones (tensor)"},
           gain_shape_names, c.gain_shape);
    choose(v,
           {.key = "workspace",
            .meaning = "guarded: how to reach distant places: with the clutch only, by rate "
                       "control outside a bubble, or with a drift of the handle to its centre"},
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
    v.real({.key = "stop_nN",
            .meaning = "guarded: contact force on the molecule or one of its atoms at which it "
                       "stops (overtravel)",
            .lowest = 1e-3,
            .highest = 1e3},
           c.stop_nN);
    v.integer({.key = "pairs_per_tick",
               .meaning = "guarded: largest number of atom pairs that the servo computes in a tick",
               .lowest = 1000,
               .highest = 10'000'000},
              c.pairs_per_tick);
    choose(v,
           {.key = "engage",
            .meaning = "guarded, headless: the force begins at once, or after quiet ticks with a "
                       "ramp of 2 s, as in a window"},
           engage_names, c.engage);
}

}  // namespace palpa
