// Draws labels and the legend on pictures made without a window.
#pragma once
#include "render/frame_scene.h"
#include "render/picture.h"
#include "render/text.h"
#include "view/atom_colours.h"
#include "view/signs.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

struct PictureWords {
    std::vector<ViewLabel> labels;
    std::vector<LegendEntry> legend;
};

// Texts without room: visible labels (ticks not counted), and the legend.
struct LeftOutWords {
    std::size_t labels = 0;
    bool has_legend = false;
};

// The room for labels: the size of the picture, the gap between labels, and the areas to leave
// free.
struct LabelRoom {
    std::uint32_t width = 0, height = 0;
    int gap = 0;
    std::vector<PixelBox> taken{};
};

struct PlacedLabel {
    std::size_t label = 0;  // index of the label
    PixelBox box;
};
struct PlacedLabels {
    std::vector<PlacedLabel> placed;  // in the order of placement
    std::size_t unplaced = 0;         // see LeftOutWords::labels
};

// Places labels of these `sizes` beside their points, if these are visible: the nearest to the
// camera first, ticks last. A label without room has no box.
PlacedLabels place_labels(std::span<const ViewLabel> labels, std::span<const TextSize> sizes,
                          const FrameCamera& camera, LabelRoom room);

// Draws them on a picture of the frame, the legend in the lower left corner.
LeftOutWords write_words(const PictureWords& words, const FrameScene& frame, TextPainter& painter,
                         Picture& picture);

}  // namespace palpa
