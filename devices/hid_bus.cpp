#include "devices/hid_bus.h"

#include <hidapi/hidapi.h>
#include <array>
#include <cwchar>
#include <mutex>

namespace palpa {
namespace {

// hidapi keeps one error text for all that has no handle yet.
std::mutex& hidapi_mutex() {
    static std::mutex mutex;
    return mutex;
}

// Letters beyond ASCII are of no use in a name here.
std::string plain(const wchar_t* text) {
    std::string out;
    for (; text && *text; ++text) out += *text >= L' ' && *text <= L'~' ? char(*text) : '?';
    return out;
}

}  // namespace

std::vector<HidPlace> list_hids() {
    const std::lock_guard lock(hidapi_mutex());
    std::vector<HidPlace> places;
    const std::unique_ptr<hid_device_info, decltype(&hid_free_enumeration)> first(
        hid_enumerate(0, 0), hid_free_enumeration);
    for (const hid_device_info* info = first.get(); info; info = info->next) {
        places.push_back({info->path,
                          {info->vendor_id, info->product_id},
                          info->usage_page,
                          info->usage,
                          info->bus_type == HID_API_BUS_BLUETOOTH,
                          plain(info->product_string)});
    }
    return places;
}

std::string hidapi_version() {
    const std::lock_guard lock(hidapi_mutex());
    return hid_init() == 0 ? hid_version_str() : "";
}

bool HidLine::open(const std::string& path) {
    const std::lock_guard lock(hidapi_mutex());
    handle_.reset(hid_open_path(path.c_str()));
    why_ = handle_ ? "" : plain(hid_error(nullptr));
    return is_open();
}

int HidLine::read(std::span<std::uint8_t> into, int wait_ms) noexcept {
    return hid_read_timeout(handle_.get(), into.data(), into.size(), wait_ms);
}

bool HidLine::write(HidBytes report) noexcept {
    return hid_write(handle_.get(), report.data(), report.size()) >= 0;
}

void HidLine::ask_for_feature(std::uint8_t number, std::size_t size) noexcept {
    std::array<std::uint8_t, longest_hid_report> report{number};
    (void)hid_get_feature_report(handle_.get(), report.data(), size);
}

void HidLine::Closer::operator()(hid_device_* handle) const noexcept { hid_close(handle); }

}  // namespace palpa
