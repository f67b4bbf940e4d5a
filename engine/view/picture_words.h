// The words on pictures that are made without a window: labels and the legend.
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

// Words that found no place: labels whose place is seen, ticks not counted; and the legend.
struct LeftOutWords {
    std::size_t labels = 0;
    bool has_legend = false;
};

// Where labels may go: in a picture of that size, so many pixels from each other, and not there.
struct LabelRoom {
    std::uint32_t width = 0, height = 0;
    int gap = 0;
    std::vector<PixelBox> taken{};
};

struct PlacedLabel {
    std::size_t label = 0;  // which of them
    PixelBox box;
};
struct PlacedLabels {
    std::vector<PlacedLabel> placed;  // those that were first to choose first
    std::size_t unplaced = 0;         // as LeftOutWords::labels
};

// Finds room of their `sizes` for labels whose places are seen, beside these: the nearest to the
// camera chooses first, ticks last. Where none is left a label has no box.
PlacedLabels place_labels(std::span<const ViewLabel> labels, std::span<const TextSize> sizes,
                          const FrameCamera& camera, LabelRoom room);

// Writes them on a picture of the frame, the legend into the lower left corner.
LeftOutWords write_words(const PictureWords& words, const FrameScene& frame, TextPainter& painter,
                         Picture& picture);

}  // namespace palpa
