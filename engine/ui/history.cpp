#include "ui/history.h"

#include <algorithm>

namespace palpa {
namespace {

constexpr auto most =
    static_cast<std::size_t>(History::seconds * servo_rate_hz / History::ticks_per_sample);

}  // namespace

void History::add(const Reading& reading) {
    if (ticks_++ % ticks_per_sample != 0) return;
    if (!samples_.empty() && reading.time_s < samples_.back().time_s) samples_.clear();
    // The older half is dropped at once: most samples cost nothing.
    if (samples_.size() >= 2 * most) {
        samples_.erase(samples_.begin(), samples_.end() - static_cast<std::ptrdiff_t>(most));
    }
    samples_.push_back(reading);
}

std::span<const Reading> History::samples() const noexcept {
    return std::span(samples_).last(std::min(samples_.size(), most));
}

}  // namespace palpa
