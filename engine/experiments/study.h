// The paper's experiment: who looks for the place without force in which mode, how far from it and
// how soon they say that they are there, and what that comes to.
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
    std::size_t place = 1;  // in the round's order
    CouplingMode mode = CouplingMode::Guarded;

    friend bool operator==(const StudyTrial&, const StudyTrial&) = default;
};

// Every mode once in each round, in an order of its own; by the seed and the participant, whoever
// else takes part. All counts begin at 1.
std::vector<StudyTrial> plan_study(std::size_t participant, std::size_t rounds,
                                   std::span<const CouplingMode> modes, std::uint64_t seed);

// The row of draws that is this trial's alone, whatever its place in the order; and the
// participant's.
std::uint64_t trial_number(const StudyTrial& trial) noexcept;
std::uint64_t participant_number(std::size_t participant) noexcept;

// How far outside of the place to be found (Å) a trial begins: the first of its draws.
double draw_start(Draws& draws);

struct StudyResult {
    StudyTrial trial;
    double start_angstrom = 0;
    double found_angstrom = 0;  // at the end
    double off_angstrom = 0;    // from the true rest, + outside
    double seconds = 0;
    bool is_finished = false;   // the key was pressed before the time was over
    bool went_through = false;  // further in than any hand could be held
};

struct Spread {
    double mean = 0, median = 0;
    std::optional<double> deviation;  // standard, of a sample; nothing of a single value
};
Spread find_spread(std::span<const double> values);

// All trials of a mode. A trial that was not finished counts with all of its time.
struct StudyRow {
    CouplingMode mode = CouplingMode::Guarded;
    std::size_t trials = 0;
    Spread distance_angstrom{};  // without its sign
    Spread off_angstrom{};
    Spread time_s{};
    double finished_share = 0, through_share = 0;
};

// A row for each mode, in their order; modes without a trial have none.
std::vector<StudyRow> summarise_study(std::span<const CouplingMode> modes,
                                      std::span<const StudyResult> results);

// A table's first line, and one line a trial.
std::string trial_names();
std::string format_trials(std::span<const StudyResult> results);
// In Markdown.
std::string format_study_table(std::span<const StudyRow> rows);

}  // namespace palpa
