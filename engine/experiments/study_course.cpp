#include "experiments/study_course.h"

#include <fmt/format.h>
#include <utility>

namespace palpa {
namespace {

constexpr double slip_s = 1;

}  // namespace

StudyCourse::StudyCourse(std::vector<StudyTrial> trials, CouplingMode practice,
                         const StudyLine& line, std::uint64_t seed)
    : trials_(std::move(trials)), practice_(practice), line_(line), seed_(seed) {}

CouplingMode StudyCourse::mode() const noexcept {
    return stage_ == Stage::Trial ? trials_[results_.size()].mode : practice_;
}

double StudyCourse::start_angstrom() const {
    if (stage_ != Stage::Trial) return line_.rest + practice_angstrom;
    Draws draws(seed_, trial_number(trials_[results_.size()]));
    return line_.rest + draw_start(draws);
}

std::string StudyCourse::text() const {
    switch (stage_) {
        case Stage::Consent:
            return "You will look for the place where two molecules neither attract nor repel each "
                   "other, several times, with different forces. It takes about twenty "
                   "minutes.\n\nPalpa stores a random number in place of your name, how near you "
                   "came, and how long it took. It stores nothing else. You may stop at any time "
                   "with Esc; the trials that you have finished stay in the table.\n\nPress Enter "
                   "if you agree and want to take part, Esc if not.";
        case Stage::Practice:
            return "Practice. Move the handle (with a mouse: hold Space and move it), and the "
                   "molecule follows. Bring it near the other molecule: first it is attracted, "
                   "then repelled. In between is the place without force. Take your time; practice "
                   "is not recorded.\n\nPress Enter when you are ready.";
        case Stage::Break:
            return fmt::format(
                "Trial {} of {}. Find the place without force, as exactly as you can, and press "
                "Enter when you are there.\n\nRest as long as you like. Press Enter to begin.",
                results_.size() + 1, trials_.size());
        case Stage::Trial:
            return fmt::format(
                "Trial {} of {}. Find the place without force. Press Enter when you are there.",
                results_.size() + 1, trials_.size());
        case Stage::Done:
            break;
    }
    return "That was all: thank you. Press Enter or Esc to close the window.";
}

bool StudyCourse::press_key() {
    switch (stage_) {
        case Stage::Consent:
            stage_ = Stage::Practice;
            return true;
        case Stage::Practice:
            stage_ = trials_.empty() ? Stage::Done : Stage::Break;
            return false;
        case Stage::Break:
            stage_ = Stage::Trial;
            running_ = {};
            running_.trial = trials_[results_.size()];
            has_begun_ = false;
            return true;
        case Stage::Trial:
            if (running_.seconds < slip_s) return false;
            running_.off_angstrom = running_.found_angstrom - line_.rest;
            running_.is_finished = true;
            results_.push_back(running_);
            stage_ = results_.size() == trials_.size() ? Stage::Done : Stage::Break;
            return false;
        case Stage::Done:
            break;
    }
    return false;
}

void StudyCourse::add(const ServoTick& tick) {
    const bool is_new =
        std::exchange(grip_number_, tick.contact.grip_number) != tick.contact.grip_number;
    if (stage_ != Stage::Trial) return;
    const double distance = tick.contact.molecule.place_angstrom.x();
    if (!has_begun_ && is_new) {
        has_begun_ = true;
        running_.start_angstrom = distance;
    }
    if (!has_begun_) return;
    running_.seconds += servo_tick_s;
    running_.found_angstrom = distance;
    running_.went_through = running_.went_through || distance < line_.wall;
}

}  // namespace palpa
