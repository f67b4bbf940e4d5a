#include "app/render_scale.h"

#include <algorithm>

namespace palpa {

void RenderScale::add_frame(double ms) noexcept {
    constexpr int settle = 3, frames_between_changes = 12;
    ++frames_;
    if (frames_ <= settle) return;  // what a change of size itself costs
    mean_ms_ = frames_ == settle + 1 ? ms : mean_ms_ + 0.2 * (ms - mean_ms_);
    if (frames_ < frames_between_changes) return;
    double wanted = value_;
    if (mean_ms_ > slow_ms) wanted = value_ * std::max(0.6, 0.9 * slow_ms / mean_ms_);
    if (mean_ms_ < quick_ms) wanted = value_ * 1.08;
    wanted = std::clamp(wanted, smallest, largest);
    if (wanted == value_) return;
    value_ = wanted;
    frames_ = 0;
}

}  // namespace palpa
