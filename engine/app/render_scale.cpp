#include "app/render_scale.h"

#include <algorithm>

namespace palpa {

void RenderScale::add_frame(double ms) noexcept {
    constexpr int settle = 3, frames_between_changes = 12;
    constexpr double worth_it = 0.9;  // of the time before, or what was given up was so in vain
    ++frames_;
    if (frames_ <= settle) return;  // what a change of size itself costs
    mean_ms_ = frames_ == settle + 1 ? ms : mean_ms_ + 0.2 * (ms - mean_ms_);
    if (frames_ < frames_between_changes) return;
    if (patience_ > 0) --patience_;
    const bool is_first_look = frames_ == frames_between_changes;
    const bool lost_effects = is_first_look && last_.effects && !now_.effects;
    const bool lost_pixels = is_first_look && now_.scale < last_.scale;
    if (lost_effects) effects_cost_ = std::max(last_mean_ms_ / mean_ms_, 1.0);
    if (lost_pixels && mean_ms_ > worth_it * last_mean_ms_) {
        patience_ = 600;
        change({last_.scale, effects_cost_ * worth_it < 1});
    } else if (mean_ms_ > slow_ms && patience_ == 0) {
        change(now_.effects ? Level{now_.scale, false}
                            : Level{now_.scale * std::max(0.6, 0.9 * slow_ms / mean_ms_), false});
    } else if (mean_ms_ < quick_ms && now_.scale < largest) {
        change({now_.scale * 1.08, now_.effects});
    } else if (mean_ms_ * effects_cost_ < quick_ms) {
        change({now_.scale, true});
    }
}

void RenderScale::change(const Level& level) noexcept {
    const Level wanted{std::clamp(level.scale, smallest, largest), level.effects};
    if (wanted == now_) return;
    last_ = now_;
    last_mean_ms_ = mean_ms_;
    now_ = wanted;
    frames_ = 0;
}

}  // namespace palpa
