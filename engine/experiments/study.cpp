#include "experiments/study.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

// Rows of draws: a participant's own, then for each round that of its order and one for each mode.
constexpr std::uint64_t rows_per_round = 1 + coupling_mode_names.size();
constexpr std::uint64_t most_rounds = 1000;

std::uint64_t round_number(std::size_t participant, std::size_t round) noexcept {
    return rows_per_round * (most_rounds * participant + round);
}

std::string_view name_of(CouplingMode mode) {
    return coupling_mode_names[static_cast<std::size_t>(mode)];
}

std::string with_deviation(const Spread& spread, int digits) {
    if (!spread.deviation) return fmt::format("{:.{}f}", spread.mean, digits);
    return fmt::format("{:.{}f} ± {:.{}f}", spread.mean, digits, *spread.deviation, digits);
}

}  // namespace

std::vector<StudyTrial> plan_study(std::size_t participant, std::size_t rounds,
                                   std::span<const CouplingMode> modes, std::uint64_t seed) {
    std::vector<StudyTrial> trials;
    for (std::size_t round = 1; round <= rounds; ++round) {
        std::vector<CouplingMode> order(modes.begin(), modes.end());
        Draws draws(seed, round_number(participant, round));
        for (std::size_t left = order.size(); left > 1; --left)
            std::swap(order[left - 1], order[draws.below(left)]);
        for (std::size_t i = 0; i < order.size(); ++i)
            trials.push_back({participant, round, i + 1, order[i]});
    }
    return trials;
}

std::uint64_t trial_number(const StudyTrial& trial) noexcept {
    return round_number(trial.participant, trial.round) + 1 +
           static_cast<std::uint64_t>(trial.mode);
}

std::uint64_t participant_number(std::size_t participant) noexcept {
    return round_number(participant, 0);
}

double draw_start(Draws& draws) { return draws.between(4.0, 6.2); }

Spread find_spread(std::span<const double> values) {
    const auto count = static_cast<double>(values.size());
    Spread spread;
    if (values.empty()) return spread;
    for (const double value : values) spread.mean += value / count;
    std::vector<double> sorted(values.begin(), values.end());
    std::ranges::sort(sorted);
    spread.median = 0.5 * (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]);
    if (values.size() < 2) return spread;
    double squares = 0;
    for (const double value : values) squares += (value - spread.mean) * (value - spread.mean);
    spread.deviation = std::sqrt(squares / (count - 1));
    return spread;
}

std::vector<StudyRow> summarise_study(std::span<const CouplingMode> modes,
                                      std::span<const StudyResult> results) {
    std::vector<StudyRow> rows;
    for (const CouplingMode mode : modes) {
        StudyRow row{.mode = mode};
        std::vector<double> distance, off, time;
        for (const StudyResult& result : results) {
            if (result.trial.mode != mode) continue;
            ++row.trials;
            distance.push_back(std::abs(result.off_angstrom));
            off.push_back(result.off_angstrom);
            time.push_back(result.seconds);
            row.finished_share += result.is_finished ? 1 : 0;
            row.through_share += result.went_through ? 1 : 0;
        }
        if (row.trials == 0) continue;
        row.distance_angstrom = find_spread(distance);
        row.off_angstrom = find_spread(off);
        row.time_s = find_spread(time);
        row.finished_share /= static_cast<double>(row.trials);
        row.through_share /= static_cast<double>(row.trials);
        rows.push_back(row);
    }
    return rows;
}

std::string trial_names() {
    return "participant,round,place,mode,start_angstrom,found_angstrom,off_angstrom,"
           "distance_angstrom,time_s,is_finished,went_through\n";
}

std::string format_trials(std::span<const StudyResult> results) {
    std::string text;
    for (const StudyResult& r : results) {
        text += fmt::format(
            "{},{},{},{},{:.4f},{:.5f},{:.5f},{:.5f},{:.3f},{:d},{:d}\n", r.trial.participant,
            r.trial.round, r.trial.place, name_of(r.trial.mode), r.start_angstrom, r.found_angstrom,
            r.off_angstrom, std::abs(r.off_angstrom), r.seconds, r.is_finished, r.went_through);
    }
    return text;
}

std::string format_study_table(std::span<const StudyRow> rows) {
    std::string text =
        "| mode | trials | distance (Å) | median | inside −, outside + (Å) | time (s) | finished "
        "(%) | "
        "through (%) |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const StudyRow& row : rows) {
        text += fmt::format("| {} | {} | {} | {:.4f} | {} | {} | {:.0f} | {:.0f} |\n",
                            name_of(row.mode), row.trials, with_deviation(row.distance_angstrom, 4),
                            row.distance_angstrom.median, with_deviation(row.off_angstrom, 4),
                            with_deviation(row.time_s, 1), 100 * row.finished_share,
                            100 * row.through_share);
    }
    return text;
}

}  // namespace palpa
