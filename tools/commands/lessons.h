// The lessons of Palpa's own scenes: which there are, and how an emulated operator does one.
#pragma once
#include "scene/description.h"

#include <string>
#include <vector>

namespace palpa {

struct LessonEntry {
    std::string name;  // of its scene, as `palpa run` takes it
    SceneDescription scene;
};

// Of Palpa's own scenes, those that have a lesson, by name.
std::vector<LessonEntry> list_lessons();

}  // namespace palpa
