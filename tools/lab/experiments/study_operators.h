// Plays the paper's experiment with emulated operators.
#pragma once
#include "experiments/study.h"
#include "experiments/study_scene.h"
#include "tools/lab/experiments/seeking_operator.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace palpa {

struct OperatorStudyOptions : StudyOptions {
    std::size_t operators = 5;
    OperatorManner manner = OperatorManner::Naive;
    double limit_s = 90;  // time limit of a trial
};

// Plays one trial of an emulated operator, independent of all others. Throws LoadError.
StudyResult play_trial(const OperatorStudyOptions& options, const StudyTrial& trial);

// Plays all trials, participant by participant in the order of their plans; calls `on_result` after
// each.
std::vector<StudyResult> play_study(
    const OperatorStudyOptions& options,
    const std::function<void(std::size_t done, std::size_t of)>& on_result = {});

}  // namespace palpa
