#include "devices/space_mouse.h"

#include <algorithm>
#include <cstddef>
#include <memory>

namespace palpa {
namespace {

// Before its own number the maker used another's.
constexpr std::uint16_t old_vendor = 0x046d, new_vendor = 0x256f;
constexpr std::array<std::uint16_t, 12> old_products{
    0xc603, 0xc605, 0xc606, 0xc621, 0xc623, 0xc625, 0xc626, 0xc627, 0xc628, 0xc629, 0xc62b, 0xc640};
constexpr std::array<std::uint16_t, 10> new_products{0xc62e, 0xc62f, 0xc631, 0xc632, 0xc633,
                                                     0xc635, 0xc636, 0xc638, 0xc63a, 0xc652};
// The same makers' mice and keyboards, numbered in between.
constexpr std::array<std::uint16_t, 12> flat_products{
    0xc62c, 0xc641, 0xc650, 0xc651, 0xc654, 0xc655, 0xc656, 0xc657, 0xc658, 0xc664, 0xc665, 0xc668};
// A receiver shows interfaces of several kinds: what speaks is the one with this usage.

constexpr std::size_t three_words = 7, six_words = 13, least_buttons = 2;  // bytes with the number

template <class List>
bool contains(const List& list, std::uint16_t product) {
    return std::find(list.begin(), list.end(), product) != list.end();
}

// Of the cap's axis whose word begins there, -1 to 1.
double deflection_at(HidBytes report, std::size_t byte) noexcept {
    const auto count =
        static_cast<std::int16_t>(static_cast<std::uint16_t>(report[byte] | report[byte + 1] << 8));
    return beyond_dead_zone(count / SpaceMouseProtocol::full_count, SpaceMouseProtocol::dead_zone);
}

// In the handle's axes.
Vec3 deflection(HidBytes report, std::size_t byte) noexcept {
    return {deflection_at(report, byte), -deflection_at(report, byte + 4),
            deflection_at(report, byte + 2)};
}

}  // namespace

bool SpaceMouseProtocol::is_ours(const HidPlace& place) const noexcept {
    const bool is_known =
        (place.id.vendor == old_vendor && contains(old_products, place.id.product)) ||
        (place.id.vendor == new_vendor && contains(new_products, place.id.product));
    return is_known && place.usage_page == hid_usage::generic_desktop_page &&
           place.usage == hid_usage::multi_axis_controller;
}

std::string SpaceMouseProtocol::why_not(const HidPlace& place) const {
    const bool is_makers = place.id.vendor == old_vendor || place.id.vendor == new_vendor;
    return is_makers && contains(flat_products, place.id.product) ? "a mouse or a keyboard" : "";
}

DeviceCheck SpaceMouseProtocol::begin(HidLine& /*line*/, const HidPlace& /*place*/) noexcept {
    is_lit_.reset();
    return {};
}

bool SpaceMouseProtocol::decode(HidBytes report, HidInput& input) noexcept {
    if (report.empty()) return false;
    const std::uint8_t number = report[0];
    const std::size_t size = report.size();
    if (number == 1 && size >= three_words) {
        input.rate.m_per_s = fastest_m_per_s * deflection(report, 1);
        if (size >= six_words) input.rate.rad_per_s = fastest_rad_per_s * deflection(report, 7);
    } else if (number == 2 && size >= three_words) {
        input.rate.rad_per_s = fastest_rad_per_s * deflection(report, 1);
    } else if (number == 3 && size >= least_buttons) {
        input.buttons = report[1] & 3U;
    } else {
        return false;
    }
    return true;
}

HidBytes SpaceMouseProtocol::encode(const HidOutput& output) noexcept {
    if (is_lit_ == output.is_lit) return {};
    is_lit_ = output.is_lit;
    light_ = {4, static_cast<std::uint8_t>(output.is_lit ? 1 : 0)};
    return light_;
}

OpenedDevice open_space_mouse(const DeviceRequest& /*request*/) {
    return open_hid(std::make_unique<SpaceMouseProtocol>());
}

}  // namespace palpa
