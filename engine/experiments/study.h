// The paper's experiment: participants search for the place without force in each mode; plan,
// results and their summary.
#pragma once
#include "core/draws.h"
#include "scene/description.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

struct StudyTrial {
    std::size_t participant = 1;
    std::size_t round = 1;
    std::size_t place = 1;  // position in the order of the round, from 1
    CouplingMode mode = CouplingMode::Guarded;

    friend bool operator==(const StudyTrial&, const StudyTrial&) = default;
};

// Every mode once in each round, in an order of its own; by the seed and the participant, whoever
// else takes part. All counts begin at 1.
std::vector<StudyTrial> plan_study(std::size_t participant, std::size_t rounds,
                                   std::span<const CouplingMode> modes, std::uint64_t seed);

// The random sequence of this trial, independent of its position in the order.
std::uint64_t trial_number(const StudyTrial& trial) noexcept;
std::uint64_t participant_number(std::size_t participant) noexcept;

// Start distance outside of the place to be found, Å: the first draw of the trial.
double draw_start(Draws& draws);

struct StudyResult {
    StudyTrial trial;
    double start_angstrom = 0;
    double found_angstrom = 0;  // final distance
    double off_angstrom = 0;    // deviation from the true place, + outside
    double seconds = 0;
    bool is_finished = false;   // the key was pressed in time
    bool went_through = false;  // further in than the repulsive wall
};

struct Spread {
    double mean = 0, median = 0;
    std::optional<double> deviation;  // standard deviation of the sample; unset for a single value
};
Spread find_spread(std::span<const double> values);

// All trials of a mode. A trial that was not finished counts with all of its time.
struct StudyRow {
    CouplingMode mode = CouplingMode::Guarded;
    std::size_t trials = 0;
    Spread distance_angstrom{};  // absolute distance
    Spread off_angstrom{};
    Spread time_s{};
    double finished_share = 0, through_share = 0;
};

// One row for each mode with trials, in the given order.
std::vector<StudyRow> summarise_study(std::span<const CouplingMode> modes,
                                      std::span<const StudyResult> results);

// Header line of a table, and one line for each trial.
std::string trial_names();
std::string format_trials(std::span<const StudyResult> results);
// The table in Markdown.
std::string format_study_table(std::span<const StudyRow> rows);

}  // namespace palpa
