// Lowers effects and resolution until a slow machine shows 30 frames per second: first the effects,
// then pixels, down to half the width and height. If that does not help, because the time is spent
// elsewhere, nothing is reduced.
#pragma once

namespace palpa {

class RenderScale {
public:
    static constexpr double smallest = 0.5, largest = 1;
    static constexpr double slow_ms = 31, quick_ms = 26;

    // Records the drawing time of a frame at the present scale, ms.
    void add_frame(double ms) noexcept;

    // Scale of width and height relative to the window.
    double value() const noexcept { return now_.scale; }
    // Whether ambient occlusion and similar effects are on.
    bool has_effects() const noexcept { return now_.effects; }

private:
    struct Level {
        double scale = largest;
        bool effects = true;

        friend bool operator==(const Level&, const Level&) = default;
    };
    void change(const Level& level) noexcept;

    Level now_, last_;    // present level, and the one before the last change
    double mean_ms_ = 0;  // mean over about ten frames
    double last_mean_ms_ = 0;
    double effects_cost_ = 1;  // ratio of the frame time with effects to that without
    int frames_ = 0;           // frames since the level changed
    int patience_ = 0;         // frames until a reduction is tried again after one without success
};

}  // namespace palpa
