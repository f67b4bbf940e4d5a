// The parts of a lesson step below its text: its value, its question, its plots.
#pragma once
#include "math/vec.h"
#include "session/lesson.h"
#include "session/lesson_meter.h"
#include "session/reading.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

// The goal of a step in words, and how near the person is to it.
struct LessonGoal {
    std::string now;   // "pull on your hand: 0.28 N"
    std::string goal;  // "goal: 0.5 N or more"
    double share = 0;  // 0 to 1; 1: reached
};
// Attraction is a pull and repulsion a push, both above 0, whatever their signs in the scene.
// `start`: the value as the step began.
LessonGoal describe_goal(const LessonStepDescription& step, double value, double start);

// Draws the question and its answers as rows to click on, each with its letter; returns the pressed
// one.
std::optional<std::size_t> draw_lesson_question(const LessonQuestion& question,
                                                std::optional<std::size_t> chosen);
// Explains an answer.
void write_explanation(const LessonQuestion& question, std::size_t answer);

// The map of two dihedrals: visited cells and the present point.
void draw_lesson_map(const LessonMeasures& measures);

// The curve of force on the molecule since the lesson began, over the distance of the reference
// atoms or over the way of what is in hand.
class LessonCurve {
public:
    // Call for every tick; points are stored only when the molecule has moved. The way begins anew
    // with each grip.
    void add(const Reading& reading, const Vec3& place_angstrom, std::uint32_t grip_number);
    void clear() { *this = {}; }
    void draw(LessonPlot plot, float height) const;

private:
    std::vector<double> distance_angstrom_, way_angstrom_, nN_;
    std::optional<Vec3> start_;
    Vec3 last_ = Vec3::Zero();
    std::uint32_t grip_number_ = 0;
};

}  // namespace palpa
