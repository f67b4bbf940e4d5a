// What a person adds to how everything is drawn, and can undo.
#pragma once
#include "scene/description.h"

#include <string>
#include <vector>

namespace palpa {

struct ViewAdditions {
    std::vector<ViewLayer> layers{};
    std::vector<std::string> labels{};  // selections that are named
    std::vector<std::string> hidden{};  // selections that layers alone draw

    friend bool operator==(const ViewAdditions&, const ViewAdditions&) = default;
};

inline ViewAdditions additions_of(const ViewDescription& view) {
    return {view.layers, view.labels, view.hidden};
}

}  // namespace palpa
