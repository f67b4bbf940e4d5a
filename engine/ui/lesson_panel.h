// What a step of a lesson shows below its text: its value, its question, its plot.
#pragma once
#include "session/lesson.h"
#include "session/lesson_meter.h"
#include "session/reading.h"

#include <optional>
#include <string>
#include <vector>

namespace palpa {

// The value now and what is wanted, "distance 4.21 Å (at most 4)".
std::string describe_value(const LessonStepDescription& step, double value);

// Buttons for the answers, and why the chosen one is right or wrong; the one that was pressed.
std::optional<std::size_t> draw_lesson_question(const LessonQuestion& question,
                                                std::optional<std::size_t> chosen);

// The map of two dihedrals: cells that were visited, and where it is now.
void draw_lesson_map(const LessonMeasures& measures);

// The force on the molecule over the distance, since the lesson began.
class LessonCurve {
public:
    // Every tick; few of them are kept, where the distance has changed.
    void add(const Reading& reading);
    void clear() { angstrom_.clear(), nN_.clear(); }
    void draw() const;

private:
    std::vector<double> angstrom_, nN_;
};

}  // namespace palpa
