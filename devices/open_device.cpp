#include "devices/open_device.h"

#include "core/load_error.h"
#include "core/text.h"
#include "core/translate.h"
#include "devices/emulated_hand.h"
#include "devices/emulated_omni.h"
#include "devices/force_dimension.h"
#include "devices/force_joystick.h"
#include "devices/game_pad.h"
#include "devices/mouse_handle.h"
#include "devices/open_haptics.h"
#include "devices/played_handle.h"
#include "devices/sony_pad.h"
#include "devices/space_mouse.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace palpa {
namespace {

OpenedDevice open_emulated(const DeviceRequest& request) {
    EmulatedOmniSettings settings = request.emulated;
    if (request.orders) settings.orders = request.orders;
    return {std::make_unique<EmulatedOmni>(settings),
            {{"emulation", CheckOutcome::Ok, "an emulated Phantom Omni", ""}}};
}

OpenedDevice open_mouse(const DeviceRequest& request) {
    const MouseHandleSettings settings = build_mouse(request.emulated, request.orders);
    return {std::make_unique<MouseHandle>(settings),
            {{"window", CheckOutcome::Ok, "mouse and keys of the window", ""}}};
}

OpenedDevice open_played(PlayedHandleSettings settings, const DeviceRequest& request,
                         std::vector<PlayedRow> (*read)(const std::filesystem::path&)) {
    try {
        settings.rows = read(request.file);
    } catch (const LoadError& error) {
        return {nullptr, {{"file", CheckOutcome::Failed, error.what(), ""}}};
    }
    settings.orders = request.orders;
    settings.viscosity_N_s_per_m = request.emulated.dynamics.viscosity_N_s_per_m;
    const std::string found =
        fmt::format("{} rows in {}", settings.rows.size(), request.file.string());
    return {std::make_unique<PlayedHandle>(std::move(settings)),
            {{"file", CheckOutcome::Ok, found, ""}}};
}

OpenedDevice open_replay(const DeviceRequest& request) {
    return open_played({.name = "replay"}, request, read_trace);
}

OpenedDevice open_script(const DeviceRequest& request) {
    return open_played({.name = "script"}, request, read_script);
}

constexpr std::array makers{
    DeviceMaker{.name = "emulated",
                .summary = for_translation("an emulated Phantom Omni, held by an emulated hand"),
                .is_emulated = true,
                .is_led = true,
                .open = open_emulated},
    DeviceMaker{
        .name = "mouse",
        .summary = for_translation("mouse and keys: the force shows as a lag of the handle"),
        .is_emulated = true,
        .is_led = true,
        .needs_window = true,
        .open = open_mouse},
    DeviceMaker{.name = "omni",
                .summary = for_translation("Phantom Omni or Touch, by its maker's OpenHaptics"),
                .is_there = is_omni_there,
                .open = open_omni},
    DeviceMaker{
        .name = "force-dimension",
        .summary = for_translation("omega, delta, sigma or Falcon, by Force Dimension's SDK"),
        .is_there = is_force_dimension_there,
        .open = open_force_dimension_device},
    DeviceMaker{
        .name = "spacemouse",
        .summary = for_translation("SpaceMouse: its cap sets the speed of the handle; no force"),
        .is_there = [](const DeviceRequest&) { return is_hid_there(SpaceMouseProtocol()); },
        .open = open_space_mouse},
    DeviceMaker{
        .name = "dualsense",
        .summary = for_translation("DualSense game pad: sticks and gyroscope, stiff triggers"),
        .is_there =
            [](const DeviceRequest&) {
                return is_hid_there(SonyPadProtocol(SonyModel::DualSense));
            },
        .open = open_dualsense},
    DeviceMaker{.name = "dualshock4",
                .summary = for_translation("DualShock 4 game pad: sticks and gyroscope, rumble"),
                .is_there =
                    [](const DeviceRequest&) {
                        return is_hid_there(SonyPadProtocol(SonyModel::DualShock4));
                    },
                .open = open_dualshock4},
    DeviceMaker{
        .name = "joystick",
        .summary = for_translation(
            "force-feedback joystick or wheel (HID PID): a force along one axis or two"),
        .is_there = [](const DeviceRequest&) { return is_hid_there(ForceJoystickProtocol()); },
        .open = open_force_joystick},
    DeviceMaker{.name = "gamepad",
                .summary = for_translation(
                    "Xbox-class game pad: its sticks set the speed of the handle; no force"),
                .needs_window = true,
                .is_there = is_game_pad_there,
                .open = open_game_pad},
    DeviceMaker{.name = "replay",
                .summary = for_translation("a recorded hand (a recording of palpa run --record)"),
                .is_emulated = true,
                .file = "FOLDER",
                .open = open_replay},
    DeviceMaker{.name = "script",
                .summary = for_translation("a handle that follows a table of times and positions"),
                .is_emulated = true,
                .file = "FILE",
                .open = open_script},
};

constexpr char before_file = ':';

}  // namespace

std::span<const DeviceMaker> device_makers() noexcept { return makers; }

const DeviceMaker& device_maker_called(const std::string& name) {
    const TextPlace place{fmt::format("--device {}", name)};
    const std::size_t end = std::min(name.find(before_file), name.size());
    const std::string kind = name.substr(0, end);
    const auto* const found = std::find_if(
        makers.begin(), makers.end(), [&](const DeviceMaker& maker) { return maker.name == kind; });
    if (found == makers.end()) {
        std::vector<std::string_view> names;
        for (const DeviceMaker& maker : makers) names.push_back(maker.name);
        throw LoadError(place, fmt::format("expected one of {}{}", fmt::join(names, ", "),
                                           near_name_hint(kind, names)));
    }
    const bool has_file = end + 1 < name.size();
    if (has_file == found->file.empty()) {
        throw LoadError(place, found->file.empty()
                                   ? fmt::format("does not play a file; expected {} alone", kind)
                                   : fmt::format("expected {}:{}", kind, found->file));
    }
    return *found;
}

std::string file_of(const std::string& name) {
    const std::size_t end = name.find(before_file);
    return end == std::string::npos ? "" : name.substr(end + 1);
}

OpenedDevice open_device(const std::string& name, DeviceRequest request) {
    const DeviceMaker& maker = device_maker_called(name);
    if (!maker.file.empty()) request.file = file_of(name);
    OpenedDevice opened = maker.open(request);
    if (opened.device) return opened;
    const DeviceCheck last = opened.checks.empty() ? DeviceCheck{} : opened.checks.back();
    throw LoadError({fmt::format("--device {}", name)},
                    fmt::format("{}: {}{}{}", last.layer, last.found,
                                last.remedy.empty() ? "" : "; ", last.remedy));
}

}  // namespace palpa
