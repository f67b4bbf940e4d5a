// A person's additions to the picture, which can be undone.
#pragma once
#include "scene/description.h"

#include <string>
#include <vector>

namespace palpa {

struct ViewAdditions {
    std::vector<ViewLayer> layers{};
    std::vector<std::string> labels{};    // selections with labels
    std::vector<std::string> hidden{};    // selections that only layers draw
    std::vector<std::string> measures{};  // two to four selections each, with ';' between them

    friend bool operator==(const ViewAdditions&, const ViewAdditions&) = default;
};

inline ViewAdditions additions_of(const ViewDescription& view) {
    return {view.layers, view.labels, view.hidden, view.marks.measures};
}

}  // namespace palpa
