// palpa loops: random hands and devices on closed ways in space. What the coupling did around them
// is held against the continuous law along the same way of the handle.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace palpa {

struct LoopOptions {
    std::filesystem::path scene;
    std::vector<std::string> settings;  // "key=value", over the scene file and the loop
    std::size_t count = 1000, first = 0;
    std::uint64_t seed = 1;
    bool turn = false;  // the handle turns as well, and back
    bool json = false;
};

struct LoopResult {
    std::vector<std::string> settings;  // of the loop, for palpa run --set
    bool in_plane = false;
    double period_ms = 0;
    // By the force at the hand, but for the servo's own damping; by the continuous law along the
    // same way. + = generated.
    double work_J = 0, law_J = 0;
    double drift_angstrom = 0;  // from where the law's molecule ends to where the molecule is
    // The handle ends so far from where it began; once it is brought home, straight, the law has
    // done this work, and its molecule is so far from where it began.
    double open_mm = 0, closed_law_J = 0, closure_angstrom = 0;
    double farthest_angstrom = 0;  // of the reference atoms, by the continuous law
    double ripple_N = 0;           // above 3 Hz, over the last 4 s, which are at rest
    double felt_share =
        0;  // of the cap: the largest stiffness felt of the field where the molecule was
    double largest_N = 0;  // felt
    bool was_limited =
        false;              // by the stop or warm motors, of which the continuous law knows nothing
    double dropped_mm = 0;  // handle travel that the limits of a step did away with
    double clamped_share = 0;    // of the time
    bool was_held_back = false;  // by a stage of the safety chain graver than warm motors

    double extra_joule() const noexcept { return work_J - law_J; }
};

// Bars of a loop. Drift has one where the way is inside of `near_angstrom` and nothing turned;
// energy where nothing turned.
inline constexpr double most_extra_J = 1e-3, most_drift_angstrom = 0.1, near_angstrom = 6,
                        most_loop_ripple_N = 0.02, most_felt_share = 1.1;

bool meets_bars(const LoopResult& result, bool turned) noexcept;

// Whether the scene has such loops and a continuous law, and leaves them their ways. Throws
// LoadError.
void check_loops(const LoopOptions& options);

// Loop `number` of a seed; the same whatever the others are. Throws LoadError.
LoopResult play_loop(const LoopOptions& options, std::size_t number);

// All of them; `on_result` after each.
std::vector<LoopResult> play_loops(
    const LoopOptions& options,
    const std::function<void(std::size_t number, const LoopResult&)>& on_result);

// Throws LoadError on bad input. Returns the exit code: 1 where a bar is missed.
int loops_command(const LoopOptions& options);

}  // namespace palpa
