// The text for a participant of a study; nothing else covers the picture.
#pragma once
#include "experiments/study_course.h"

namespace palpa {

// Call between begin and end of the overlay library's frame.
void draw_study_panel(const StudyCourse& course);

}  // namespace palpa
