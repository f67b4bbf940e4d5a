// What a person reads who takes part in a study: nothing else stands over the picture.
#pragma once
#include "experiments/study_course.h"

namespace palpa {

// Between begin and end of the overlay library's frame.
void draw_study_panel(const StudyCourse& course);

}  // namespace palpa
