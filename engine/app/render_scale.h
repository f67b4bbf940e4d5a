// How large the picture may be drawn so that a slow machine still shows 30 of them a second. Where
// a smaller one takes as long, for other reasons than its pixels, it stays large.
#pragma once

namespace palpa {

class RenderScale {
public:
    static constexpr double smallest = 0.25, largest = 1;
    static constexpr double slow_ms = 31, quick_ms = 26;

    // One frame took that long to draw, at the present scale.
    void add_frame(double ms) noexcept;

    // Of width and height, against the window's.
    double value() const noexcept { return value_; }

private:
    void change(double value) noexcept;

    double value_ = largest;
    double mean_ms_ = 0;                              // of about the last ten frames
    int frames_ = 0;                                  // since the scale changed
    double last_value_ = largest, last_mean_ms_ = 0;  // before it changed
    int patience_ = 0;  // frames until a smaller picture is tried again after it was in vain
};

}  // namespace palpa
