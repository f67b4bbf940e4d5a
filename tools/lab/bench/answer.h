// palpa-lab bench --answer: the error of the force at the hand against the time that was spent on
// it.
#pragma once
#include "core/files.h"
#include "scene/description.h"
#include "tools/lab/bench/row.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

inline constexpr int usual_answer_poses = 10;

// Completely relaxed poses: found, evenly spaced over 3 Å along x, or those of a file
// (tools/lab/experiments/rest_poses.h).
struct AnswerPoseSettings {
    std::optional<int> count;  // unset: all of the file, or the usual number
    std::optional<std::filesystem::path> file;
    std::optional<std::filesystem::path> save_to;  // those found
    Existing existing = Existing::Refuse;          // there
};

struct AnswerBenchSettings {
    AnswerPoseSettings poses;
    bool no_ways = false;
};

// Median and nine of ten over moves: relative to the change of the force, and of it.
struct AnswerErrors {
    double median = 0, ninety = 0;
    double median_pN = 0, ninety_pN = 0;
};

// Behind the name of a method with a cutoff: judged by complete relaxation with that cutoff.
inline constexpr std::string_view own_cutoff_suffix = "/own";

// What a method reaches in time. Nothing but its name and the snaps where all moves are snaps.
struct AnswerCurve {
    struct Point {
        double ms;
        AnswerErrors errors;
    };
    std::string method;
    std::vector<double> step_us = {};  // of each move
    AnswerErrors of_step = {};
    std::vector<Point> in_time = {};  // from where half of the moves have an answer
    std::size_t moves = 0, snaps = 0;

    bool is_own() const;
};

struct Answers {
    std::vector<AnswerCurve> curves;
    double newton_per_pN = 0;  // at the handle, by the gain of weak forces
    std::size_t poses = 0;
};

// At each pose the hand moves by 0.1 Å along x, y and z. Errors are those of the change of the
// force on the hand, against complete relaxation on all pairs in strides of 0.02 Å, relative to
// that change or to 20 pN if it is less. Where strides of 0.01 Å end elsewhere the move is a snap,
// which is counted but not averaged. Throws LoadError where the file's poses are not the scene's.
// Says on standard error how far it is.
Answers measure_answers(const SceneDescription& scene, const AnswerPoseSettings& settings);

// The same as rows, and the error along ways:
//
//   answer/SCENE/METHOD           us of one step, and its error_median and error_90
//   answer/SCENE/METHOD/ms=T      both after so much time; the row's error is the median in pN
//   answer/SCENE/METHOD/own       of methods with a cutoff: against rest with the same cutoff
//   answer/SCENE/METHOD/own/ms=T
//   answer/SCENE/way              3 Å along both directions of each axis by the scene's own steps:
//                                 the force against complete relaxation of the state, each 0.1 Å.
//                                 error_median, error_90, and error_rms relative to the rms force;
//                                 samples are ms of each way
//   answer/SCENE/way/DIRECTION    each of them
//   answer/SCENE/real-time        tools/lab/bench/real_time_way.h
//
// METHOD is `default`, as the scene has it; with all pairs `near=6`, `full-second-order`,
// `paper-40`, `paper-all`; and `near=6/cutoff=C` and `paper-all/cutoff=C`, with the scene's cutoff
// or 12 Å, which begin at rest with that.
Answers bench_answer(const std::string& scene_name, const SceneDescription& scene,
                     const AnswerBenchSettings& settings, std::vector<BenchRow>& rows);

// A line for each method.
std::string format_markdown(const Answers& answers);

}  // namespace palpa
