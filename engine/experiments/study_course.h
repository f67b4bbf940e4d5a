// One person's way through a study: consent, practice, then trial after trial, by one key.
#pragma once
#include "experiments/study.h"
#include "haptics/servo.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace palpa {

// What the scene's molecules have on their line, Å.
struct StudyLine {
    double rest = 0;  // the place to be found
    double wall = 0;  // who was further in went through
};

class StudyCourse {
public:
    enum class Stage { Consent, Practice, Break, Trial, Done };

    static constexpr double practice_angstrom = 5;  // it begins so far outside

    // `practice`: the mode of the round that is not written down; `seed`: the plan's.
    StudyCourse(std::vector<StudyTrial> trials, CouplingMode practice, const StudyLine& line,
                std::uint64_t seed);

    Stage stage() const noexcept { return stage_; }
    // That the coupling is to be in now.
    CouplingMode mode() const noexcept;
    // Where the molecule is to begin now, Å.
    double start_angstrom() const;
    // What the person reads.
    std::string text() const;

    // Agrees, has practised enough, goes on, is there. In the first second of a trial it is taken
    // for a slip. True where the scene has to begin anew, in mode().
    bool press_key();
    // Every servo tick. A trial's time begins with the first tick of the molecule at its new start.
    void add(const ServoTick& tick);

    // Of the trials done so far.
    const std::vector<StudyResult>& results() const noexcept { return results_; }

private:
    std::vector<StudyTrial> trials_;
    CouplingMode practice_;
    StudyLine line_;
    std::uint64_t seed_;
    Stage stage_ = Stage::Consent;
    StudyResult running_;
    std::vector<StudyResult> results_;
    std::uint32_t start_ = 0;  // of the molecule, as ticks have it
    bool has_begun_ = false;   // the trial: the molecule is at its new start
};

}  // namespace palpa
