// How often somebody says "more", over how much more it was: a curve through such answers.
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
    std::size_t answers = 0, more = 0;  // all, and "more" of them
};

// Of this share of the answers nobody looked at what was asked: half of them say "more".
inline constexpr double lapse_share = 0.02;

// P("more") = lapse/2 + (1 - lapse) Φ((level - middle)/width), Φ the normal distribution's.
struct PsychometricCurve {
    double middle = 0;  // where both answers are as likely: 0 without a bias
    double width = 1;

    double share(double level) const noexcept;
    // From the middle to where 3 of 4 say "more", but for lapses.
    double threshold() const noexcept;
    // Of Φ in its middle, for each unit of the level.
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

// By maximum likelihood. Without answers, or with all at one level, it is TooFlat.
PsychometricFit fit_psychometric(std::span<const AnsweredLevel> levels);

}  // namespace palpa
