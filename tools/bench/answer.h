// palpa bench --answer: the error of the force at the hand against the time that was spent on it.
#pragma once
#include "scene/description.h"
#include "tools/bench/row.h"

#include <string>
#include <vector>

namespace palpa {

struct AnswerBenchSettings {
    int poses = 10;  // completely relaxed, evenly spaced over 3 Å along x
    bool no_ways = false;
};

// At each pose the hand moves by 0.1 Å along x, y and z. Errors are those of the change of the
// force on the hand, against complete relaxation on all pairs in strides of 0.02 Å, relative to
// that change or to 20 pN if it is less. Where strides of 0.01 Å end elsewhere the pose is a snap,
// which is counted but not averaged.
//
//   answer/SCENE/METHOD        us of one step, and its error_median and error_90
//   answer/SCENE/METHOD/ms=T   error_median and error_90 after so much time, as error of the row in
//   pN answer/SCENE/way           3 Å along both directions of each axis by the scene's own steps:
//   the
//                              force against complete relaxation of the state, each 0.1 Å.
//                              error_median, error_90, and error_rms relative to the rms force;
//                              samples are ms of each way
//   answer/SCENE/way/DIRECTION each of them
//
// METHOD is `default`, as the scene has it, `near=R`, `full-second-order`, `bfgs`, `paper-40`,
// `paper-all`, and some with a cutoff of 12 Å. Returns a table in Markdown. Says on standard error
// how far it is.
std::string bench_answer(const std::string& scene_name, const SceneDescription& scene,
                         const AnswerBenchSettings& settings, std::vector<BenchRow>& rows);

}  // namespace palpa
