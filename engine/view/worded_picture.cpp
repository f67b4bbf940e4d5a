#include "view/worded_picture.h"

#include "core/load_error.h"
#include "view/legend.h"

#include <fmt/format.h>
#include <cmath>

namespace palpa {

std::optional<TextPainter> open_words(std::vector<std::string>& warnings) {
    try {
        return open_text_painter();
    } catch (const LoadError& error) {
        warnings.push_back(fmt::format("pictures are drawn without words: {}", error.what()));
        return std::nullopt;
    }
}

WordedFrame build_worded_frame(FrameBuilder& builder, const World& world,
                               const ViewSettings& view) {
    WordedFrame frame;
    frame.scene = builder.build(world, find_contacts(world), view, &frame.words.labels);
    frame.words.legend = find_legend(world, view);
    return frame;
}

std::uint32_t PictureSize::side() const {
    return static_cast<std::uint32_t>(std::lround(std::sqrt(samples)));
}

Picture draw_worded(Renderer& renderer, const PictureSize& size, WordedFrame& frame,
                    std::optional<TextPainter>& painter, LeftOutWords* left_out) {
    frame.scene.outline *= static_cast<int>(size.side());
    const auto [width, height] = size.drawn();
    const Picture drawn = renderer.draw(frame.scene, width, height, PictureContent::Colours);
    Picture picture = size.side() == 1 ? drawn : average_down(drawn, size.side());
    if (!painter) return picture;
    const LeftOutWords lacking = write_words(frame.words, frame.scene, *painter, picture);
    if (left_out) *left_out = lacking;
    return picture;
}

}  // namespace palpa
