#include "app/render_scale.h"

#include <algorithm>

namespace palpa {

void RenderScale::add_frame(double ms) noexcept {
    constexpr int settle = 3, frames_between_changes = 12;
    ++frames_;
    if (frames_ <= settle) return;  // what a change of size itself costs
    mean_ms_ = frames_ == settle + 1 ? ms : mean_ms_ + 0.2 * (ms - mean_ms_);
    if (frames_ < frames_between_changes) return;
    if (patience_ > 0) --patience_;
    const bool was_lowered = value_ < last_value_ && frames_ == frames_between_changes;
    if (was_lowered && mean_ms_ > 0.9 * last_mean_ms_) {
        patience_ = 600;
        change(last_value_);
    } else if (mean_ms_ > slow_ms && patience_ == 0) {
        change(value_ * std::max(0.6, 0.9 * slow_ms / mean_ms_));
    } else if (mean_ms_ < quick_ms) {
        change(value_ * 1.08);
    }
}

void RenderScale::change(double value) noexcept {
    const double wanted = std::clamp(value, smallest, largest);
    if (wanted == value_) return;
    last_value_ = value_;
    last_mean_ms_ = mean_ms_;
    value_ = wanted;
    frames_ = 0;
}

}  // namespace palpa
