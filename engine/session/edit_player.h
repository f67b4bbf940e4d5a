// The edits of a scene, each until its time.
#pragma once
#include "scene/description.h"

#include <vector>

namespace palpa {

class EditPlayer {
public:
    explicit EditPlayer(const SceneDescription& scene) : waiting_(scene.edits) {}

    // Those to be made before the step that begins at that time, in the order of the file; each
    // once.
    std::vector<EditDescription> take_due(double time_s);

private:
    std::vector<EditDescription> waiting_;
};

}  // namespace palpa
