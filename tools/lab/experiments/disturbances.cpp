#include "tools/lab/experiments/disturbances.h"

#include "core/units.h"
#include "scene/read_scene.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

constexpr double lead_s = 0.3;   // nothing goes wrong before the hand sets out
constexpr double glide_s = 0.5;  // until an edit is felt in full

std::vector<std::string> draw_gains(Draws& draws) {
    constexpr std::array force_laws{"printed", "calibrated", "constant", "perceptual"};
    constexpr std::array displacement_laws{"repaired", "printed", "constant"};
    const double stiffness = draws.scale(0.3, 3);
    return {fmt::format("coupling.force_law={}", force_laws[draws.below(force_laws.size())]),
            fmt::format("coupling.displacement_law={}",
                        displacement_laws[draws.below(displacement_laws.size())]),
            fmt::format("coupling.A_d={}", std::lround(2.5e8 / stiffness)),
            fmt::format("coupling.A_d_max={}", std::lround(2.5e8 / stiffness)),
            fmt::format("coupling.stop_nN={:.3f}", draws.scale(4, 20))};
}

FaultPeriod draw_fault(Draws& draws, double end_s) {
    // A servo in lockstep is never late.
    constexpr std::array kinds{DeviceFault::NotANumber, DeviceFault::Frozen, DeviceFault::Jump,
                               DeviceFault::Invalid};
    FaultPeriod fault;
    fault.fault = kinds[draws.below(kinds.size())];
    fault.begin = static_cast<int>(servo_rate_hz * draws.between(lead_s, end_s));
    fault.end = fault.begin + static_cast<int>(std::lround(draws.scale(1, 500)));
    const double sign = draws.below(2) == 0 ? 1 : -1;
    fault.size_m = sign * draws.scale(0.5e-3, 50e-3);
    return fault;
}

std::vector<EditDescription> draw_edits(Draws& draws, double end_s) {
    constexpr std::array couplings{
        R"({ force_law = "constant" })", R"({ force_law = "perceptual" })", "{ stop_nN = 5.0 }",
        "{ damping_N_s_per_m = 0.2 }", R"({ displacement_law = "constant" })"};
    double first_s = draws.between(lead_s, end_s), second_s = draws.between(lead_s, end_s);
    if (second_s < first_s) std::swap(first_s, second_s);
    const std::string coupling =
        fmt::format("coupling = {}", couplings[draws.below(couplings.size())]);
    const std::array<std::array<std::string, 2>, 4> kinds{
        {{coupling, "undo = true"},
         {"let_go = true", R"(take = "moved")"},
         {R"(pin = ["fixed:1 OH2", "moved:1 OH2"])", coupling},
         {coupling, "reset = true"}}};
    const auto& [first, second] = kinds[draws.below(kinds.size())];
    std::vector<EditDescription> edits;
    for (const auto& [at_s, edit] : {std::pair{first_s, first}, std::pair{second_s, second}}) {
        edits.push_back(parse_edit(fmt::format("[[edits]]\nat_s = {:.4f}\n{}\n", at_s, edit),
                                   {"disturbances"}));
    }
    return edits;
}

}  // namespace

Disturbances draw_disturbances(Draws& draws, double end_s) {
    Disturbances disturbances;
    disturbances.settings = draw_gains(draws);
    if (draws.below(2) == 0) disturbances.faults.push_back(draw_fault(draws, end_s));
    if (draws.below(2) == 0) disturbances.edits = draw_edits(draws, end_s);
    return disturbances;
}

bool is_disturbed(const Disturbances& disturbances, double time_s, double period_s) noexcept {
    const bool is_faulty = std::ranges::any_of(disturbances.faults, [&](const FaultPeriod& fault) {
        // The reading after it may leap.
        return time_s >= fault.begin * servo_tick_s - 1e-9 &&
               time_s < (fault.end + 1) * servo_tick_s;
    });
    return is_faulty || std::ranges::any_of(disturbances.edits, [&](const EditDescription& edit) {
               return time_s >= edit.at_s - servo_tick_s &&
                      time_s < edit.at_s + 2 * period_s + glide_s;
           });
}

DeviceReading WatchedDevice::read() noexcept {
    DeviceReading reading = device_.read();
    if (has_reading_) work_J_ += sent_newton_.dot(reading.position_m - last_m_);
    last_m_ = reading.position_m;
    has_reading_ = true;
    return reading;
}

void WatchedDevice::write(const Vec3& force_newton) noexcept {
    const bool is_number = force_newton.allFinite();
    most_newton_ = std::max(
        most_newton_, is_number ? force_newton.norm() : std::numeric_limits<double>::infinity());
    if (!force_newton.isZero(0))
        most_change_newton_ = std::max(most_change_newton_, (force_newton - sent_newton_).norm());
    sent_newton_ = force_newton;
    device_.write(force_newton);
}

}  // namespace palpa
