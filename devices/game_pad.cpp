#include "devices/game_pad.h"

#include <memory>

namespace palpa {
namespace {

HandRate rate_of(const PadInput& input) noexcept {
    const auto stick = [](double deflection) {
        return beyond_dead_zone(deflection, GamePad::dead_zone);
    };
    return {GamePad::fastest_m_per_s *
                Vec3(stick(input.left_x), -stick(input.left_y), stick(input.right_y)),
            GamePad::fastest_rad_per_s * Vec3(0, -stick(input.right_x), 0)};
}

}  // namespace

GamePad::GamePad(PadLink& link) : link_(link) {
    spec_.name = "game pad";
    spec_.half_workspace_m = Vec3::Constant(RateHandle::half_box_m);
}

DeviceReading GamePad::read() noexcept {
    silent_for_ticks_ = link_.inputs.read(input_) ? 0 : silent_for_ticks_ + 1;
    if (silent_for_ticks_ > silent_ticks) input_ = {.is_there = input_.is_there};
    if (input_.clutch) {
        handle_.return_to_middle(servo_tick_s);
    } else if (input_.is_there) {
        handle_.move(rate_of(input_), servo_tick_s);
    }
    const auto buttons = input_.clutch ? static_cast<std::uint32_t>(Button::Clutch) : 0U;
    return {static_cast<double>(ticks_++) * servo_tick_s, handle_.position_m(), buttons,
            input_.is_there, handle_.orientation()};
}

std::string_view GamePad::status() const noexcept {
    if (link_.is_there) return {};
    return "No game pad with known buttons is connected; plug one in.";
}

bool is_game_pad_there(const DeviceRequest& request) {
    return request.pads && request.pads->is_there;
}

OpenedDevice open_game_pad(const DeviceRequest& request) {
    if (!request.pads) {
        return {nullptr,
                {{"window", CheckOutcome::Failed, "only the window sees game pads",
                  "palpa run scenes/water --device gamepad"}}};
    }
    return {std::make_unique<GamePad>(*request.pads),
            {{"window", CheckOutcome::Ok, "game pads of the window", ""}}};
}

}  // namespace palpa
