// The course of a study for one person: consent, practice, then trial after trial, by one key.
#pragma once
#include "experiments/study.h"
#include "haptics/servo.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace palpa {

// Places of the scene's molecules on their line, Å.
struct StudyLine {
    double rest = 0;  // the place to be found
    double wall = 0;  // a participant further in than this went through
};

class StudyCourse {
public:
    enum class Stage { Consent, Practice, Break, Trial, Done };

    static constexpr double practice_angstrom =
        5;  // start distance of practice outside of the place

    // `practice`: the mode of the round that is not written down; `seed`: the plan's.
    StudyCourse(std::vector<StudyTrial> trials, CouplingMode practice, const StudyLine& line,
                std::uint64_t seed);

    Stage stage() const noexcept { return stage_; }
    // The present coupling mode.
    CouplingMode mode() const noexcept;
    // Start distance of the present trial, Å.
    double start_angstrom() const;
    // Text for the person.
    std::string text() const;

    // The key: agrees, ends practice, goes on, or reports the place. In the first second of a trial
    // it is ignored. Returns true if the scene must restart in mode().
    bool press_key();
    // Call for every servo tick. The time of a trial begins with the first tick of the molecule at
    // its new start.
    void add(const ServoTick& tick);

    // Results of the trials done so far.
    const std::vector<StudyResult>& results() const noexcept { return results_; }

private:
    std::vector<StudyTrial> trials_;
    CouplingMode practice_;
    StudyLine line_;
    std::uint64_t seed_;
    Stage stage_ = Stage::Consent;
    StudyResult running_;
    std::vector<StudyResult> results_;
    std::uint32_t grip_number_ = 0;  // grip number of the molecule in the ticks
    bool has_begun_ = false;         // the trial has begun: the molecule is at its new start
};

}  // namespace palpa
