// Applies the edits of a scene at their times.
#pragma once
#include "scene/description.h"

#include <vector>

namespace palpa {

class EditPlayer {
public:
    explicit EditPlayer(const SceneDescription& scene) : waiting_(scene.edits) {}

    // The edits due before the step at this time, in the order of the file, each once.
    std::vector<EditDescription> take_due(double time_s);

private:
    std::vector<EditDescription> waiting_;
};

}  // namespace palpa
