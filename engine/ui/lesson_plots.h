// The parts of a lesson step below its text: its value, its question, its plots.
#pragma once
#include "session/lesson.h"
#include "session/lesson_meter.h"
#include "session/reading.h"

#include <optional>
#include <string>
#include <vector>

namespace palpa {

// The present value and the target, "distance 4.21 Å (at most 4)".
std::string describe_value(const LessonStepDescription& step, double value);

// Draws buttons for the answers and the explanation of the chosen one; returns the pressed one.
std::optional<std::size_t> draw_lesson_question(const LessonQuestion& question,
                                                std::optional<std::size_t> chosen);

// The map of two dihedrals: visited cells and the present point.
void draw_lesson_map(const LessonMeasures& measures);

// The curve of force on the molecule against distance since the lesson began.
class LessonCurve {
public:
    // Call for every tick; points are stored only when the distance has changed.
    void add(const Reading& reading);
    void clear() { angstrom_.clear(), nN_.clear(); }
    void draw() const;

private:
    std::vector<double> angstrom_, nN_;
};

}  // namespace palpa
