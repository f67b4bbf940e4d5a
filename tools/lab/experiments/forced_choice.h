// Forced choice: which of two felt molecules is stiffer, or attracts more?
#pragma once
#include "core/draws.h"
#include "tools/lab/experiments/psychometric.h"
#include "tools/lab/experiments/study_operators.h"

#include <array>
#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

namespace palpa {

enum class Question { Stiffer, AttractsMore };
inline constexpr std::array<std::string_view, 2> question_names{"stiffer", "attracts-more"};

struct ForcedChoiceOptions {
    OperatorStudyOptions study;  // rounds, manner and limit are not used
    Question question = Question::Stiffer;
    std::size_t repeats = 10;  // repetitions of every pair
};

// All forces between the molecules of one of a pair are this much larger than of the other, as
// natural logarithms: ratios from 0.45 to 2.2.
inline constexpr std::array choice_levels{-0.8, -0.4, -0.2, -0.1, -0.05, 0.05, 0.1, 0.2, 0.4, 0.8};

// A difference that is noticed in three of four pairs: 9 % of a force, and 0.05 N at least.
double noticeable_newton(double force_newton) noexcept;

// What somebody feels of one molecule: the strongest pull on the way out (N), or on the way in the
// largest push over the travel of the handle until there (N/m); and the force that it is judged by.
struct Impression {
    double value = 0;
    double force_newton = 0;
};

// Feels the scene's molecule with all forces `ratio` times as large: sets out from its rest (Å),
// which is the same for all ratios, by a way and in a time that `draws` gives. Throws LoadError.
Impression feel_molecule(const ForcedChoiceOptions& options, CouplingMode mode, double rest,
                         double ratio, Draws& draws);

struct Choice {
    std::size_t participant = 1;
    CouplingMode mode = CouplingMode::Guarded;
    double level = 0;
    double reference = 0, comparison = 0;  // N or N/m, without the noise of comparing
    bool is_more = false;                  // the answer: the comparison is more
};

// All pairs, in every mode of the study; `on_choice` after each. A pair is the same whatever else
// is played.
std::vector<Choice> play_choices(
    const ForcedChoiceOptions& options,
    const std::function<void(std::size_t done, std::size_t of)>& on_choice = {});

// The answers of a mode by level.
std::vector<AnsweredLevel> count_answers(CouplingMode mode, const std::vector<Choice>& choices);

}  // namespace palpa
