#include "devices/hid_bus.h"

#include <hidapi/hidapi.h>
#include <algorithm>
#include <cwchar>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <set>

namespace palpa {
namespace {

// hidapi keeps one error text for all that has no handle yet.
std::mutex& hidapi_mutex() {
    static std::mutex mutex;
    return mutex;
}

// The paths to which lines are open.
class OpenPaths {
public:
    static OpenPaths& all() {
        static OpenPaths paths;
        return paths;
    }
    bool add(const std::string& path) {
        const std::lock_guard lock(mutex_);
        return paths_.insert(path).second;
    }
    void remove(const std::string& path) {
        const std::lock_guard lock(mutex_);
        paths_.erase(path);
    }
    bool contains(const std::string& path) {
        const std::lock_guard lock(mutex_);
        return paths_.contains(path);
    }

private:
    std::mutex mutex_;
    std::set<std::string> paths_;
};

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

std::vector<std::uint8_t> read_report_descriptor(const std::string& path) {
    const std::filesystem::path node = std::filesystem::path(path).filename();
    std::ifstream file("/sys/class/hidraw" / node / "device/report_descriptor", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

bool is_in_use(const std::string& path) { return OpenPaths::all().contains(path); }

bool HidLine::open(const std::string& path) {
    close();
    if (!OpenPaths::all().add(path)) {
        why_ = "the other hand uses it";
        return false;
    }
    const std::lock_guard lock(hidapi_mutex());
    handle_ = {hid_open_path(path.c_str()), Closer{path}};
    why_ = handle_ ? "" : plain(hid_error(nullptr));
    if (!handle_) OpenPaths::all().remove(path);
    return is_open();
}

int HidLine::read(std::span<std::uint8_t> into, int wait_ms) noexcept {
    return hid_read_timeout(handle_.get(), into.data(), into.size(), wait_ms);
}

bool HidLine::write(HidBytes report) noexcept {
    return hid_write(handle_.get(), report.data(), report.size()) >= 0;
}

bool HidLine::write_feature(HidBytes report) noexcept {
    return hid_send_feature_report(handle_.get(), report.data(), report.size()) >= 0;
}

int HidLine::read_feature(std::uint8_t number, std::span<std::uint8_t> into) noexcept {
    std::fill(into.begin(), into.end(), std::uint8_t{0});
    if (into.empty()) return -1;
    into[0] = number;
    return hid_get_feature_report(handle_.get(), into.data(), into.size());
}

void HidLine::Closer::operator()(hid_device_* handle) const noexcept {
    hid_close(handle);
    OpenPaths::all().remove(path);
}

}  // namespace palpa
