// Makes the scene of a prepared system: plays it to find suitable gains and a period.
#pragma once
#include "core/files.h"
#include "core/stage.h"
#include "prepare/prepare.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace palpa {

// Something that the hand may hold.
struct HandOffer {
    std::string grab;                  // for tune_scene; empty: what it takes by itself
    std::string words;                 // "the whole molecule X"
    std::vector<std::uint32_t> atoms;  // of the system's structure
};
// The first is what tune_scene takes by itself; empty where there is nothing to hold.
std::vector<HandOffer> list_hands(const PreparedSystem& system);

struct TunedScene {
    std::vector<TextFile> files;  // files of the scene, names without folder; empty: no scene
    std::string in_hand;          // "residue PRO 36 of A, on a spring"
    // From the emulated hand's stroke with the gains and the period of the file.
    double felt_newton = 0;     // largest force in any direction
    double moved_angstrom = 0;  // largest move of the centre of what the hand holds
};

// The range of forces (pN) to be felt where 95 % of those on what is held are below `strong_pN`: a
// tenth of that is felt as 0.3 N, a strong one as 1.3 N; what is thrice as strong as 2.7 N. So
// neither friction (0.26 N) hides what is there, nor do motors get warm of it.
std::array<double, 2> choose_range(double strong_pN);

// Leaves room for what else the machine does. In a window the drawing, too, takes cores away, for
// some milliseconds at a time where there is no graphics card; guarded coupling needs no shorter
// period.
double choose_period_ms(double p99_ms);

// The time of all but 1 % of the steps without those in which the model is renewed, which take a
// hundred times as long as others, and come late.
double ordinary_p99(double median, double p99);

// Chooses what the hand holds (prepare/hand_choice.h, `grab`; a residue where a chain that was not
// asked for hardly moves), brings a copy of the system to rest,
// turns it so that the way out is +x unless it `is_aligned`, plays the stroke with constant gains
// to find the forces and how long a step takes, and again with those in the file. Unless it
// `measures` it does so only for a chain, which may be bound too firmly: gains and period are
// guesses then, which the window measures (`run.measured_on`). What was found is added to the
// system's report, or why there is no scene. `title`: as for write_prepared; `name`: the scene's.
// Throws LoadError where there is nothing that `grab` names.
TunedScene tune_scene(PreparedSystem& system, const std::string& grab, bool is_aligned,
                      bool measures, const std::string& name, const std::string& title,
                      const StageFunction& on_stage);

}  // namespace palpa
