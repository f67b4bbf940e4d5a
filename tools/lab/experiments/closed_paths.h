// Plays random hands and devices on closed paths in space, and compares with the continuous law
// along the same path of the handle.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace palpa {

struct ClosedPathOptions {
    std::filesystem::path scene;
    std::vector<std::string> settings;  // "key=value", over the scene file and the path's own
    std::size_t count = 1000, first = 0;
    std::uint64_t seed = 1;
    bool turn = false;  // the handle also turns, and back
};

struct ClosedPathResult {
    std::vector<std::string> settings;  // of the path, for palpa run --set
    bool in_plane = false;
    double period_ms = 0;
    // By the force at the hand, but for the servo's own damping; by the continuous law along the
    // same path. + = generated.
    double work_J = 0, law_J = 0;
    double drift_angstrom =
        0;  // distance between the molecule and that of the continuous law at the end
    // The handle ends so far from where it began; once it is brought home, straight, the law has
    // done this work, and its molecule is so far from where it began.
    double open_mm = 0, closed_law_J = 0, closure_angstrom = 0;
    double farthest_angstrom = 0;  // largest distance of the reference atoms by the continuous law
    double ripple_N = 0;           // above 3 Hz, over the last 4 s, in which the hand rests
    double felt_share = 0;         // largest stiffness felt as a share of the cap
    double largest_N = 0;          // largest force on the hand
    bool was_limited =
        false;  // by the stop or the thermal limit, which the continuous law does not have
    double clipped_mm = 0;       // clipped travel of the handle at the limits of a step
    double clamped_share = 0;    // share of the time at the force limit
    bool was_held_back = false;  // by a safety stage more severe than the thermal limit

    double extra_joule() const noexcept { return work_J - law_J; }
};

// Limits for a path. The limit of drift applies within `near_angstrom` if nothing turned; that of
// energy if nothing turned.
inline constexpr double most_extra_J = 1e-3, most_drift_angstrom = 0.1, near_angstrom = 6,
                        most_closed_path_ripple_N = 0.02, most_felt_share = 1.1;

bool meets_limits(const ClosedPathResult& result, bool turned) noexcept;

// Checks that the scene has a continuous law and that no setting replaces the path. Throws
// LoadError.
void check_closed_paths(const ClosedPathOptions& options);

// Each force is of all pairs in double, some thousands of times a path: how many pairs of atoms
// these are, and how long a path takes, about. Throws LoadError.
struct ClosedPathCost {
    double pairs = 0, seconds = 0;
};
ClosedPathCost find_closed_path_cost(const ClosedPathOptions& options);

// Plays path `number` of a seed, independent of all other paths. Throws LoadError.
ClosedPathResult play_closed_path(const ClosedPathOptions& options, std::size_t number);

// Plays all paths; calls `on_result` after each.
std::vector<ClosedPathResult> play_closed_paths(
    const ClosedPathOptions& options,
    const std::function<void(std::size_t number, const ClosedPathResult&)>& on_result);

}  // namespace palpa
