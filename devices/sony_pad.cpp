#include "devices/sony_pad.h"

#include <zlib.h>
#include <algorithm>
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>

namespace palpa {
namespace {

constexpr std::uint16_t sony = 0x054c;
constexpr std::array<std::uint16_t, 2> dualsenses{0x0ce6, 0x0df2};  // the second is the Edge
constexpr std::array<std::uint16_t, 2> dualshocks{0x05c4, 0x09cc};
// Its touchpad and sensors are inputs of their own elsewhere; the pad is this one.

constexpr std::uint8_t crc_in = 0xa1, crc_out = 0xa2;
constexpr std::size_t crc_bytes = 4;

std::uint32_t crc_of(std::uint8_t kind, HidBytes bytes) noexcept {
    const uLong first = crc32(0, &kind, 1);
    return static_cast<std::uint32_t>(crc32(first, bytes.data(), static_cast<uInt>(bytes.size())));
}

bool has_sound_crc(HidBytes report) noexcept {
    const HidBytes end = report.last(crc_bytes);
    const std::uint32_t given = end[0] | end[1] << 8 | end[2] << 16 | std::uint32_t{end[3]} << 24;
    return given == crc_of(crc_in, report.first(report.size() - crc_bytes));
}

void seal(std::span<std::uint8_t> report) noexcept {
    const std::uint32_t crc = crc_of(crc_out, report.first(report.size() - crc_bytes));
    for (std::size_t i = 0; i < crc_bytes; ++i) {
        report[report.size() - crc_bytes + i] = static_cast<std::uint8_t>(crc >> (8 * i));
    }
}

// Where a report has what, from its first byte; sticks are four bytes, x and y of the left, then
// of the right one.
struct Layout {
    std::size_t sticks, buttons, gyro;  // 0: no gyroscope
};

// By Bluetooth a pad that nobody has asked for more sends ten bytes, the same on both models.
constexpr std::size_t short_size = 10;
constexpr Layout short_layout{1, 5, 0};

std::optional<Layout> find_layout(SonyModel model, bool is_bluetooth, HidBytes report) noexcept {
    constexpr std::size_t cable_size = 64, bluetooth_size = 78;
    if (report.empty()) return {};
    const bool is_dualsense = model == SonyModel::DualSense;
    if (!is_bluetooth) {
        if (report[0] != 1 || report.size() != cable_size) return {};
        return is_dualsense ? Layout{1, 8, 16} : Layout{1, 5, 13};
    }
    if (report[0] == 1 && report.size() == short_size) return short_layout;
    const std::uint8_t number = is_dualsense ? 0x31 : 0x11;
    if (report[0] != number || report.size() != bluetooth_size || !has_sound_crc(report)) return {};
    return is_dualsense ? Layout{2, 9, 17} : Layout{3, 7, 15};
}

double stick(std::uint8_t byte) noexcept {
    return beyond_dead_zone((byte - 127.5) / 127.5, SonyPadProtocol::dead_zone);
}

// The pad's own axes are the handle's.
Vec3 turn_rate(HidBytes words) noexcept {
    Vec3 rad_per_s;
    for (Eigen::Index i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(2 * i);
        const auto word =
            static_cast<std::int16_t>(static_cast<std::uint16_t>(words[at] | words[at + 1] << 8));
        rad_per_s(i) = word * SonyPadProtocol::gyro_deg_per_s * std::numbers::pi / 180;
    }
    constexpr double least = SonyPadProtocol::gyro_dead_deg_per_s * std::numbers::pi / 180;
    return rad_per_s.norm() > least ? rad_per_s : Vec3(Vec3::Zero());
}

}  // namespace

std::string_view SonyPadProtocol::name() const noexcept {
    return model_ == SonyModel::DualSense ? "DualSense" : "DualShock 4";
}

bool SonyPadProtocol::is_ours(const HidPlace& place) const noexcept {
    const auto& products = model_ == SonyModel::DualSense ? dualsenses : dualshocks;
    return place.id.vendor == sony && place.usage_page == hid_usage::generic_desktop_page &&
           place.usage == hid_usage::game_pad &&
           std::find(products.begin(), products.end(), place.id.product) != products.end();
}

DeviceCheck SonyPadProtocol::begin(HidLine& line, const HidPlace& place) noexcept {
    use_bluetooth(place.is_bluetooth);
    // Its calibration, on both models: by Bluetooth a pad that was asked for it sends long reports.
    constexpr std::uint8_t calibration = 5;
    constexpr std::size_t calibration_size = 41;
    std::array<std::uint8_t, calibration_size> unread{};
    if (place.is_bluetooth) (void)line.read_feature(calibration, unread);
    return {};
}

bool SonyPadProtocol::decode(HidBytes report, HidInput& input) noexcept {
    const std::optional<Layout> layout = find_layout(model_, is_bluetooth_, report);
    if (!layout) return false;
    constexpr std::uint8_t triangle = 0x80, l1 = 0x01, r1 = 0x02;
    const HidBytes sticks = report.subspan(layout->sticks, 4);
    const std::uint8_t shapes = report[layout->buttons], shoulders = report[layout->buttons + 1];
    input.rate.m_per_s =
        fastest_m_per_s * Vec3(stick(sticks[0]), -stick(sticks[1]), stick(sticks[3]));
    input.rate.rad_per_s = fastest_rad_per_s * Vec3(0, -stick(sticks[2]), 0);
    if ((shoulders & l1) != 0 && layout->gyro != 0) {
        input.rate.rad_per_s += turn_rate(report.subspan(layout->gyro, 6));
    }
    input.buttons = ((shoulders & r1) != 0 ? 1U : 0U) | ((shapes & triangle) != 0 ? 2U : 0U);
    return true;
}

HidBytes SonyPadProtocol::encode(const HidOutput& output) noexcept {
    report_.fill(0);
    return model_ == SonyModel::DualSense ? encode_dualsense(output) : encode_dualshock(output);
}

HidBytes SonyPadProtocol::encode_dualsense(const HidOutput& output) noexcept {
    constexpr std::size_t cable_size = 63, right_trigger = 10, left_trigger = 21;
    constexpr std::uint8_t rumble_and_triggers = 0x0f;
    constexpr std::uint8_t resist = 1, none = 5;
    std::size_t at = 1;
    report_[0] = 0x02;
    if (is_bluetooth_) {
        report_[0] = 0x31;
        report_[1] = static_cast<std::uint8_t>(sequence_ << 4);
        report_[2] = 0x10;
        sequence_ = (sequence_ + 1) & 0x0f;
        at = 3;
    }
    report_[at] = rumble_and_triggers;
    report_[at + 3] = output.contact;  // the left motor
    for (const std::size_t trigger : {right_trigger, left_trigger}) {
        report_[at + trigger] = output.force > 0 ? resist : none;
        report_[at + trigger + 2] = output.force;
    }
    if (!is_bluetooth_) return HidBytes(report_).first(cable_size);
    seal(report_);
    return report_;
}

HidBytes SonyPadProtocol::encode_dualshock(const HidOutput& output) noexcept {
    constexpr std::size_t cable_size = 32;
    constexpr std::uint8_t rumble = 1;
    std::size_t at = 1;
    report_[0] = 0x05;
    if (is_bluetooth_) {
        report_[0] = 0x11;
        report_[1] = 0xc4;  // a HID report with CRC; one in every 4 ms back
        at = 3;
    }
    report_[at] = rumble;
    report_[at + 3] = output.force;    // the small, right motor
    report_[at + 4] = output.contact;  // the large, left one
    if (!is_bluetooth_) return HidBytes(report_).first(cable_size);
    seal(report_);
    return report_;
}

// A cable has room for a report in every 4 ms; by Bluetooth more than a hundred a second queue up.
double SonyPadProtocol::least_s() const noexcept { return is_bluetooth_ ? 0.012 : 0.004; }

OpenedDevice open_dualsense(const DeviceRequest& /*request*/) {
    return open_hid(std::make_unique<SonyPadProtocol>(SonyModel::DualSense));
}

OpenedDevice open_dualshock4(const DeviceRequest& /*request*/) {
    return open_hid(std::make_unique<SonyPadProtocol>(SonyModel::DualShock4));
}

}  // namespace palpa
