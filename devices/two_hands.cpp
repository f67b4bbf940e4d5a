#include "devices/two_hands.h"

#include <fmt/format.h>
#include <algorithm>
#include <utility>

namespace palpa {
namespace {

// Of two limits, of which 0 is not known.
double tighter(double first, double second) noexcept {
    if (first <= 0 || second <= 0) return std::max(first, second);
    return std::min(first, second);
}

}  // namespace

double in_series(double first, double second) noexcept {
    return first > 0 && second > 0 ? first * second / (first + second) : 0;
}

TwoHands::TwoHands(std::unique_ptr<Device> first, Device& second)
    : first_(std::move(first)), second_(second) {
    const DeviceSpec &one = first_->spec(), &other = second_.spec();
    spec_ = one;
    spec_.name = fmt::format("{} and {}", one.name, other.name);
    spec_.is_real = one.is_real || other.is_real;
    spec_.peak_force_newton = tighter(one.peak_force_newton, other.peak_force_newton);
    spec_.continuous_force_newton =
        tighter(one.continuous_force_newton, other.continuous_force_newton);
    spec_.viscosity_N_s_per_m = in_series(one.viscosity_N_s_per_m, other.viscosity_N_s_per_m);
    spec_.half_workspace_m += other.half_workspace_m;
}

DeviceReading TwoHands::read() noexcept {
    DeviceReading reading = first_->read();
    const DeviceReading other = second_.read();
    reading.position_m -= other.position_m;
    reading.buttons |= other.buttons;
    reading.valid = reading.valid && other.valid;
    reading.trouble = std::max(reading.trouble, other.trouble);
    return reading;
}

void TwoHands::write(const Vec3& force_newton) noexcept {
    first_->write(force_newton);
    second_.write(-force_newton);
}

void TwoHands::show(const TouchModel& touch) noexcept {
    first_->show(touch);
    second_.show(touch);
}

std::string_view TwoHands::status() const noexcept {
    const std::string_view first = first_->status();
    return first.empty() ? second_.status() : first;
}

void TwoHands::attend(bool is_meant) noexcept {
    first_->attend(is_meant);
    second_.attend(is_meant);
}

HandRate TwoHands::view_rate() const noexcept {
    const HandRate one = first_->view_rate(), other = second_.view_rate();
    return {one.m_per_s + other.m_per_s, one.rad_per_s + other.rad_per_s};
}

}  // namespace palpa
