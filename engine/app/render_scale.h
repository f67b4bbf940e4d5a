// What of the picture is drawn so that a slow machine still shows 30 of them a second. Effects go
// first, then pixels, down to half of them either way. Where that does not help, for the time goes
// elsewhere, nothing is given up.
#pragma once

namespace palpa {

class RenderScale {
public:
    static constexpr double smallest = 0.5, largest = 1;
    static constexpr double slow_ms = 31, quick_ms = 26;

    // One frame took that long to draw, at the present scale.
    void add_frame(double ms) noexcept;

    // Of width and height, against the window's.
    double value() const noexcept { return now_.scale; }
    // Ambient occlusion and the like.
    bool has_effects() const noexcept { return now_.effects; }

private:
    struct Level {
        double scale = largest;
        bool effects = true;

        friend bool operator==(const Level&, const Level&) = default;
    };
    void change(const Level& level) noexcept;

    Level now_, last_;    // last: before it changed
    double mean_ms_ = 0;  // of about the last ten frames
    double last_mean_ms_ = 0;
    double effects_cost_ = 1;  // a frame's time with them against that without
    int frames_ = 0;           // since the level changed
    int patience_ = 0;         // frames until less is tried again after it was in vain
};

}  // namespace palpa
