#include "devices/hid_device.h"

#include "platform/system.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr std::uint32_t view_button = 2;
constexpr int wait_ms = 1;                  // for a report, before the newest force is looked at
constexpr std::uint64_t most_at_once = 64;  // reports that Linux keeps for a reader

std::chrono::duration<double> seconds(double s) { return std::chrono::duration<double>(s); }

std::uint8_t level_of(double share) noexcept {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

// A trigger must not stay stiff after exit(), which destroys nothing that lives on a stack.
class OpenHids {
public:
    static OpenHids& all() {
        static OpenHids devices;
        return devices;
    }
    ~OpenHids() {
        for (HidDevice* const device : std::exchange(devices_, {})) device->close();
    }
    void add(HidDevice* device) {
        const std::lock_guard lock(mutex_);
        devices_.push_back(device);
    }
    void remove(HidDevice* device) {
        const std::lock_guard lock(mutex_);
        std::erase(devices_, device);
    }

private:
    std::mutex mutex_;
    std::vector<HidDevice*> devices_;
};

std::string describe(const HidPlace& place) {
    return fmt::format("{}{:04x}:{:04x} by {}, {}",
                       place.product.empty() ? "" : place.product + ", ", place.id.vendor,
                       place.id.product, place.is_bluetooth ? "Bluetooth" : "cable", place.path);
}

// Those that are not ours but could be taken for it, once each.
std::string list_others(const HidProtocol& protocol, const std::vector<HidPlace>& places) {
    std::vector<std::string> others;
    for (const HidPlace& place : places) {
        const std::string why = protocol.why_not(place);
        if (why.empty()) continue;
        std::string words =
            fmt::format("{:04x}:{:04x} is {}", place.id.vendor, place.id.product, why);
        if (std::find(others.begin(), others.end(), words) == others.end()) {
            others.push_back(std::move(words));
        }
    }
    return fmt::format("{}", fmt::join(others, ", "));
}

// The first that nobody here uses; where all are used, the first.
const HidPlace* find_ours(const HidProtocol& protocol, const std::vector<HidPlace>& places) {
    const HidPlace* taken = nullptr;
    for (const HidPlace& place : places) {
        if (!protocol.is_ours(place)) continue;
        if (!is_in_use(place.path)) return &place;
        if (!taken) taken = &place;
    }
    return taken;
}

DeviceCheck check_bus(const HidProtocol& protocol, const std::vector<HidPlace>& places,
                      const HidPlace* ours) {
    if (ours) return {"bus", CheckOutcome::Ok, describe(*ours), ""};
    const std::string others = list_others(protocol, places);
    return {"bus", CheckOutcome::Failed,
            fmt::format("no {} among the {} input devices of the system{}{}", protocol.name(),
                        places.size(), others.empty() ? "" : "; ", others),
            fmt::format("plug it in, or pair it and switch it on; {} shows what is there",
                        usb_list_name())};
}

DeviceCheck check_permission(const HidPlace& place) {
    if (is_open_to_user(place.path)) {
        return {"permission", CheckOutcome::Ok, place.path + " can be read and written", ""};
    }
    return {"permission", CheckOutcome::Failed,
            place.path + " may not be read and written by this user", permission_remedy()};
}

DeviceCheck check_first_report(const HidDevice& device, bool is_talkative) {
    constexpr int longest_ms = 300;
    for (int i = 0; i < longest_ms && is_talkative && device.reports() == 0; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (device.understood() > 0)
        return {"reports", CheckOutcome::Ok, "its reports can be read", ""};
    if (!is_talkative) {
        return {"reports", CheckOutcome::Unknown, "none yet: it sends none until it is touched",
                ""};
    }
    return {"reports", CheckOutcome::Failed,
            device.reports() > 0 ? "none of its reports can be read" : "it sent no report",
            "switch it off and on; close other programs that use it"};
}

}  // namespace

HidDevice::HidDevice(std::unique_ptr<HidProtocol> protocol, HidLine line, const HidPlace& place,
                     const HidSettings& settings)
    : protocol_(std::move(protocol)), settings_(settings), line_(std::move(line)) {
    spec_.name = place.product.empty() ? std::string(protocol_->name()) : place.product;
    spec_.half_workspace_m.setConstant(RateHandle::half_box_m);
    lost_ = fmt::format(
        "The {} does not answer: check its cable or battery. Palpa keeps looking for it.",
        protocol_->name());
    protocol_->describe(spec_);
    start();
    OpenHids::all().add(this);
    thread_ = std::thread([this] { run(); });
}

HidDevice::~HidDevice() {
    OpenHids::all().remove(this);
    close();
}

void HidDevice::close() noexcept {
    if (is_closing_.exchange(true)) return;
    {
        const std::lock_guard lock(mutex_);  // so that it is not between its look and its sleep
    }
    wake_.notify_one();
    thread_.join();
}

DeviceReading HidDevice::read() noexcept {
    inputs_.read(last_);
    DeviceReading reading;
    reading.time_s = static_cast<double>(ticks_++) * servo_tick_s;
    reading.valid = is_plugged_;
    has_motors() ? read_place(reading) : read_rate(reading);
    return reading;
}

void HidDevice::read_rate(DeviceReading& reading) noexcept {
    const bool is_heard = reading.valid && is_meant_;
    reading.buttons = is_heard ? last_.buttons : 0;
    if (is_pressed(reading.buttons, Button::Clutch)) {
        handle_.return_to_middle(servo_tick_s);
    } else if (is_heard) {
        handle_.move(last_.rate, servo_tick_s);
    }
    reading.position_m = handle_.position_m();
    reading.orientation = handle_.orientation();
}

// The handle is where it is, whoever is meant: without the window's focus the clutch holds the
// molecule, so that it does not jump afterwards.
void HidDevice::read_place(DeviceReading& reading) noexcept {
    constexpr double share = servo_tick_s / (glide_s + servo_tick_s);
    constexpr double longest_m = glide_m_per_s * servo_tick_s;
    reading.valid = reading.valid && last_.place_m;
    if (!reading.valid) {
        place_m_.reset();
        return;
    }
    if (!place_m_) place_m_ = last_.place_m;
    const Vec3 way = share * (*last_.place_m - *place_m_);
    *place_m_ += way * (longest_m / std::max(way.norm(), longest_m));
    reading.position_m = *place_m_;
    reading.buttons = is_meant_ ? last_.buttons : static_cast<std::uint32_t>(Button::Clutch);
}

void HidDevice::write(const Vec3& force_newton) noexcept {
    const double newton = force_newton.stableNorm();
    const double share = std::isfinite(newton) ? std::min(newton / full_newton, 1.0) : 0;
    slow_share_ += (share - slow_share_) * servo_tick_s / contact_s;
    HidOutput output{level_of(share), level_of(share - slow_share_)};
    if (has_motors() && share > 0) output.newton = share * full_newton / newton * force_newton;
    outputs_.post(output);
}

std::string_view HidDevice::status() const noexcept {
    if (!is_plugged_) return lost_;
    if (has_motors() && !is_placed_)
        return "Move the stick a little: it has not sent its position yet.";
    if (moves_view_) {
        return "The device moves the camera now; its second button returns it to the molecule.";
    }
    return {};
}

HandRate HidDevice::view_rate() const noexcept {
    views_.read(view_);
    return is_plugged_ && is_meant_ ? view_ : HandRate{};
}

void HidDevice::run() noexcept {
    while (!is_closing_) {
        line_.is_open() ? serve() : find();
    }
    play_last();
    if (line_.is_open()) protocol_->end(line_);
    line_.close();
}

void HidDevice::play_last() noexcept {
    constexpr std::chrono::milliseconds longest(100), pause(1);
    const Clock::time_point begun = Clock::now();
    for (;;) {
        written_ = {};
        play({});
        const bool is_done = has_played_ && played_ == HidOutput{};
        if (is_done || !line_.is_open() || Clock::now() - begun > longest) return;
        std::this_thread::sleep_for(pause);
    }
}

void HidDevice::serve() noexcept {
    std::array<std::uint8_t, longest_hid_report> bytes{};
    std::uint64_t reports = 0;
    int size = 0;
    // All that came while a report was written, or they would queue up.
    while (reports < most_at_once && (size = line_.read(bytes, reports > 0 ? 0 : wait_ms)) > 0) {
        take({bytes.data(), static_cast<std::size_t>(size)});
        ++reports;
    }
    if (size < 0) return lose();
    // Reports that are not understood renew no rate.
    if (Clock::now() - heard_ > seconds(settings_.silent_s)) {
        input_.rate = {};
        post(input_);
    }
    play(newest_output());
    reports_ += reports;
}

void HidDevice::lose() noexcept {
    line_.close();
    is_plugged_ = false;
}

void HidDevice::take(HidBytes report) noexcept {
    const bool was_pressed = (input_.buttons & view_button) != 0;
    if (!protocol_->decode(report, input_)) return;
    heard_ = Clock::now();
    ++understood_;
    const bool is_press = (input_.buttons & view_button) != 0 && !was_pressed;
    if (is_press && is_meant_) moves_view_ = !moves_view_;
    post(input_);
}

void HidDevice::post(const HidInput& input) noexcept {
    const HandRate rate = input.rate;
    inputs_.post({moves_view_ ? HandRate{} : rate, input.buttons, input.place_m});
    views_.post(moves_view_ ? rate : HandRate{});
    is_placed_ = input.place_m.has_value();
}

HidOutput HidDevice::newest_output() noexcept {
    if (outputs_.read(wanted_)) {
        renewed_ = Clock::now();
    } else if (Clock::now() - renewed_ > seconds(settings_.stale_s)) {
        wanted_ = {};
    }
    if (!is_meant_) return {};
    HidOutput output = wanted_;
    output.is_lit = !moves_view_;
    return output;
}

void HidDevice::play(const HidOutput& output) noexcept {
    if (!line_.is_open() || (has_played_ && output == played_)) return;
    const Clock::time_point now = Clock::now();
    if (settings_.is_paced && now - written_ < seconds(protocol_->least_s())) return;
    HidBytes report = protocol_->encode(output);
    for (; !report.empty(); report = protocol_->encode_next()) {
        if (line_.write(report)) continue;
        protocol_->forget();
        has_played_ = false;
        written_ = now;
        // The next read says that it is gone; a motor must not keep its force until then. At the
        // end there is no next one.
        if (has_motors() && !is_closing_) lose();
        return;
    }
    played_ = output;
    has_played_ = true;
    written_ = now;
}

void HidDevice::find() noexcept {
    for (const HidPlace& place : list_hids()) {
        if (protocol_->is_ours(place) && line_.open(place.path) && begin(place)) return;
    }
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, seconds(settings_.retry_s), [&] { return is_closing_.load(); });
}

bool HidDevice::begin(const HidPlace& place) noexcept {
    if (protocol_->begin(line_, place).outcome == CheckOutcome::Failed) {
        line_.close();
        return false;
    }
    start();
    return true;
}

void HidDevice::start() noexcept {
    input_ = {};
    has_played_ = false;
    heard_ = Clock::now();
    post(input_);
    is_plugged_ = true;
}

bool is_hid_there(const HidProtocol& protocol) {
    const std::vector<HidPlace> places = list_hids();
    return std::any_of(places.begin(), places.end(),
                       [&](const HidPlace& place) { return protocol.is_ours(place); });
}

OpenedDevice open_hid(std::unique_ptr<HidProtocol> protocol, const HidSettings& settings) {
    OpenedDevice opened;
    std::vector<DeviceCheck>& checks = opened.checks;
    const std::string version = hidapi_version();
    if (version.empty()) {
        checks.push_back({"library", CheckOutcome::Failed, "the library hidapi cannot be started",
                          std::string(hidapi_remedy())});
        return opened;
    }
    checks.push_back({"library", CheckOutcome::Ok, "hidapi " + version, ""});
    const std::vector<HidPlace> places = list_hids();
    const HidPlace* const ours = find_ours(*protocol, places);
    checks.push_back(check_bus(*protocol, places, ours));
    if (!ours) return opened;
    checks.push_back(check_permission(*ours));
    if (checks.back().outcome == CheckOutcome::Failed) return opened;
    HidLine line;
    const bool is_taken = is_in_use(ours->path);
    if (!line.open(ours->path)) {
        checks.push_back({"open", CheckOutcome::Failed, line.why(),
                          is_taken ? "plug in a second one, or choose another device"
                                   : "plug it in again; close other programs that use it"});
        return opened;
    }
    checks.push_back({"open", CheckOutcome::Ok, "this program uses it", ""});
    DeviceCheck begun = protocol->begin(line, *ours);
    if (!begun.layer.empty()) checks.push_back(std::move(begun));
    if (checks.back().outcome == CheckOutcome::Failed) return opened;
    const bool is_talkative = protocol->is_talkative();
    auto device =
        std::make_unique<HidDevice>(std::move(protocol), std::move(line), *ours, settings);
    checks.push_back(check_first_report(*device, is_talkative));
    opened.device = std::move(device);
    return opened;
}

}  // namespace palpa
