// Takes a molecule out of its pocket and back, for several hands, periods, modes and numbers of
// active joints; or for random ones.
#pragma once
#include "scene/description.h"
#include "session/statistics.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct UnbindingOptions {
    std::filesystem::path scene;
    std::vector<std::string> settings;  // "key=value", over the scene file and the choices below
    std::vector<std::string> grips{"medium", "firm"}, modes{"guarded", "4"};
    std::vector<double> periods_ms{1, 14, 83};
    bool fastest = false;  // also at the shortest period that this machine keeps
    std::vector<std::int64_t> active{StaticsDescription{}.active};  // active degrees of freedom
    std::size_t random = 0;  // number of random cases in place of the lists
    std::uint64_t seed = 1;
};

inline constexpr double most_unbinding_ripple_N = 0.02;

struct UnbindingResult {
    std::vector<std::string> settings;  // for palpa run --set
    std::string grip, mode;
    double period_ms = 0;
    std::int64_t active = 0;
    Summary summary;
    // rms of the force on the hand, but for the servo's damping, minus the force law, clamped, of
    // the force that the simulation then found for that very pose.
    double error_N = 0;
    // Work on the hand by the force felt, but for the servo's damping, minus that of the law along
    // the same way, of the force that the simulation found at its poses (trapezia), unclutched. And
    // the same while at the stop or the thermal limit, unknown to the law.
    double off_J = 0, off_at_limits_J = 0;
    std::optional<double> ripple_N;  // ripple at rest, after the molecule came back
    // Share of the ticks with the force at the clamp though the molecule felt 3 nN or less.
    double cut_share = 0;
    std::size_t clutches = 0;
    std::optional<double> out_s;   // time when its reference atom was 10 Å from its start
    std::optional<double> back_s;  // time when it was back within 0.3 Å
    double wall_s = 0;

    // Out: its centre of mass went 10 Å and more, and there no heavy atom was within 4 Å of others.
    bool is_out() const noexcept;
    // And back: its heavy atoms end within 1.5 Å rms of where they began.
    bool is_back() const noexcept;

    // The stroke leads the molecule 10 Å or farther, and all degrees of freedom answer the hand.
    bool is_to_leave = false;
    // Ripple, nothing cut at 3 nN or less, finite, none through, and out where it is to leave. Bars
    // of guarded coupling.
    bool meets_limits() const noexcept;
    bool is_guarded() const noexcept;
};

// Settings of each that is to be played, beside the options' own. Plays some seconds where the
// fastest period is to be found. Throws LoadError where the scene does not take them.
std::vector<std::vector<std::string>> list_unbindings(const UnbindingOptions& options);

// Throws LoadError.
UnbindingResult play_unbinding(const UnbindingOptions& options, std::vector<std::string> settings);

}  // namespace palpa
