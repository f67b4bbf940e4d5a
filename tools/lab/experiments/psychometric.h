// Fits a psychometric curve to answers: the share of "more" over the true difference.
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace palpa {

// Answers to pairs whose second is by `level` more than the first, on a scale on which equal steps
// are to be equally hard: for ratios their logarithm.
struct AnsweredLevel {
    double level = 0;
    std::size_t answers = 0, more = 0;  // number of answers, and of those that are "more"
};

// Share of lapses, answers without attention; half of them are "more".
inline constexpr double lapse_share = 0.02;

// P("more") = lapse/2 + (1 - lapse) Φ((level - middle)/width), Φ the normal distribution's.
struct PsychometricCurve {
    double middle = 0;  // level at which both answers are equally likely: 0 without bias
    double width = 1;

    double share(double level) const noexcept;
    // Difference from the middle to the level with 3 of 4 answers "more", without lapses.
    double threshold() const noexcept;
    // Slope of Φ at the middle, per unit of the level.
    double slope() const noexcept;
};

// Logarithm of the answers' likelihood, without what the curve does not change, and its derivatives
// by `middle` and by the logarithm of `width`.
struct LogLikelihood {
    double value = 0;
    std::array<double, 2> gradient{};
};
LogLikelihood find_log_likelihood(const PsychometricCurve& curve,
                                  std::span<const AnsweredLevel> levels) noexcept;

// Found; or the answers turn round between two levels, so that the curve can be as steep as one
// likes; or they hardly depend on the
// level, less than that 3 of 4 answer alike at any, or lie all to one side of their middle.
enum class PsychometricEnd { Found, TooSteep, TooFlat };
inline constexpr std::array<std::string_view, 3> psychometric_end_names{"found", "too-steep",
                                                                        "too-flat"};

struct PsychometricFit {
    PsychometricEnd end = PsychometricEnd::TooFlat;
    // The most likely; where none was found the limit that it ran into. Errors are standard errors
    // by the information of the answers, and 0 where nothing was found.
    PsychometricCurve curve;
    double middle_error = 0, threshold_error = 0;
};

// Fits by maximum likelihood. Without answers, or with all at one level, the result is TooFlat.
PsychometricFit fit_psychometric(std::span<const AnsweredLevel> levels);

}  // namespace palpa
