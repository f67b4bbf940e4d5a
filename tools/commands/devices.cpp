#include "tools/commands/devices.h"

#include "core/interrupt.h"
#include "devices/open_device.h"
#include "haptics/safety.h"
#include "platform/thread.h"
#include "tools/commands/command.h"
#include "tools/commands/latency.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace palpa {
namespace {

using Json = nlohmann::ordered_json;
using SteadyClock = std::chrono::steady_clock;

constexpr std::array<std::string_view, 3> outcome_names{"ok", "unknown", "failed"};

std::string_view name_of(CheckOutcome outcome) {
    return outcome_names[static_cast<std::size_t>(outcome)];
}

// A device of the list, and what its layers said.
struct Examined {
    const DeviceMaker* maker = nullptr;
    std::vector<DeviceCheck> checks;
    bool is_usable = false;
};

// A tick of the servo a millisecond, in which `step` gets the reading and gives the force.
template <class Step>
void run_ticks(Device& device, int ticks, const Step& step) {
    SteadyClock::time_point next = SteadyClock::now();
    for (int i = 0; i < ticks && noted_interrupt() == 0; ++i) {
        device.write(step(i, device.read()));
        next = std::max(next + std::chrono::milliseconds(1), SteadyClock::now());
        sleep_exactly_until(next);
    }
    device.write(Vec3::Zero());
}

DeviceCheck check_readings(Device& device) {
    constexpr int wanted = 50, longest_ticks = 2000;
    int valid = 0;
    for (int looked = 0; looked < longest_ticks && valid < wanted; looked += wanted) {
        run_ticks(device, wanted, [&](int, const DeviceReading& reading) {
            valid += reading.valid ? 1 : 0;
            return Vec3(Vec3::Zero());
        });
    }
    if (valid >= wanted) {
        const Vec3 mm = 1e3 * device.read().position_m;
        return {"readings", CheckOutcome::Ok,
                fmt::format("valid; the handle is at {:.0f}, {:.0f}, {:.0f} mm", mm.x(), mm.y(),
                            mm.z()),
                ""};
    }
    const std::string status(device.status());
    return {"readings", CheckOutcome::Failed,
            fmt::format("only {} valid readings in {} s", valid, longest_ticks / 1000),
            status.empty() ? "plug the device in again, and switch it off and on" : status};
}

constexpr const char* force_warning =
    "Force test: the device pushes the handle to the right with 0.6 N for 0.05 s, up to five times "
    "if\nit does not move. The handle moves by a few centimetres at most. Hold it loosely in the "
    "middle\nof its workspace and keep clear of it. Press Enter to begin, anything else to skip "
    "the test: ";

// Asks on standard error, so that JSON stays alone on the other.
bool is_agreed() {
    fmt::print(stderr, "{}", force_warning);
    std::fflush(stderr);
    const int answer = std::getchar();
    fmt::print(stderr, "\n");
    return answer == '\n';
}

// Through the safety chain, as everything that a hand feels.
DeviceCheck check_force(Device& device) {
    if (!is_agreed()) return {"force", CheckOutcome::Unknown, "skipped", ""};
    note_interrupts();
    constexpr double push_newton = 0.6;
    // The chain lets a force through when the handle has been quiet; a system that was too busy
    // for the servo gets another chance.
    constexpr int still_ticks = 50, push_ticks = 50, coast_ticks = 200, attempts = 5;
    constexpr double least_m = 0.5e-3;
    SafetySettings settings;
    settings.clamp_newton = push_newton;
    settings.ramp_s = 0.01;
    SafetyState state;
    SafetyStage worst = SafetyStage::None;
    double from_m = 0, farthest_m = 0;
    Vec3 last_m = Vec3::Zero();
    bool has_last = false;
    const SteadyClock::time_point start = SteadyClock::now();
    const auto push = [&](int tick, const DeviceReading& reading) {
        SafetyInput input;
        input.reading = reading;
        input.now_s = std::chrono::duration<double>(SteadyClock::now() - start).count();
        const bool pushes = tick >= still_ticks && tick < still_ticks + push_ticks;
        if (pushes) input.wanted_newton.x() = push_newton;
        if (reading.valid) {
            if (tick < still_ticks) from_m = reading.position_m.x();
            if (has_last) input.velocity_m_per_s = (reading.position_m - last_m) / servo_tick_s;
            last_m = reading.position_m;
            has_last = true;
            farthest_m = std::max(farthest_m, reading.position_m.x() - from_m);
        }
        const SafetyResult safe = guard_force(settings, state, input);
        if (safe.stage > SafetyStage::Clamped) worst = std::max(worst, safe.stage);
        return safe.newton;
    };
    for (int i = 0; i < attempts && farthest_m < least_m; ++i) {
        farthest_m = 0;
        run_ticks(device, still_ticks + push_ticks + coast_ticks, push);
    }
    if (farthest_m >= least_m) {
        return {"force", CheckOutcome::Ok,
                fmt::format("0.6 N to the right moved the handle by {:.1f} mm", 1e3 * farthest_m),
                ""};
    }
    return {"force", CheckOutcome::Failed, "the handle did not move",
            worst == SafetyStage::None ? "hold it loosely and try again; check its power supply"
                                       : std::string(describe(worst))};
}

// What the servo's thread is granted; asked for on one that ends.
std::vector<DeviceCheck> check_machine() {
    bool is_real_time = false, is_locked = false;
    std::thread([&] {
        is_real_time = ask_for_real_time();
        is_locked = ask_for_locked_memory();
    }).join();
    const auto say = [&](const char* layer, bool is_granted, const char* without) {
        return is_granted ? DeviceCheck{layer, CheckOutcome::Ok, "granted", ""}
                          : DeviceCheck{layer, CheckOutcome::Failed,
                                        fmt::format("not granted: {}", without),
                                        std::string(real_time_remedy())};
    };
    return {say("real-time", is_real_time, "the servo misses ticks when the machine is busy"),
            say("memory", is_locked, "the servo waits where a page was moved to disk")};
}

Examined examine(const DeviceMaker& maker, const DeviceRequest& request, bool tests_force) {
    Examined examined;
    examined.maker = &maker;
    OpenedDevice opened = maker.open(request);
    examined.checks = std::move(opened.checks);
    if (!opened.device) return examined;
    examined.checks.push_back(check_readings(*opened.device));
    examined.is_usable = examined.checks.back().outcome == CheckOutcome::Ok;
    const bool has_motors = opened.device->spec().peak_force_newton > 0;
    if (tests_force && examined.is_usable && has_motors && !maker.is_emulated) {
        examined.checks.push_back(check_force(*opened.device));
    }
    return examined;
}

const DeviceCheck* find_failed(const Examined& examined) {
    const auto failed = std::find_if(
        examined.checks.begin(), examined.checks.end(),
        [](const DeviceCheck& check) { return check.outcome == CheckOutcome::Failed; });
    return failed == examined.checks.end() ? nullptr : &*failed;
}

// What to do now, a line each.
std::vector<std::string> list_next(const std::vector<Examined>& all, bool is_any_usable) {
    std::vector<std::string> next;
    for (const Examined& examined : all) {
        if (examined.maker->is_emulated) continue;
        if (examined.is_usable) {
            next.push_back(fmt::format("palpa run scenes/water --device {}", examined.maker->name));
        } else if (const DeviceCheck* const failed = find_failed(examined)) {
            next.push_back(fmt::format("{}: {}", examined.maker->name,
                                       failed->remedy.empty() ? failed->found : failed->remedy));
        }
    }
    if (!is_any_usable)
        next.emplace_back("without a device: palpa run scenes/water, with the mouse");
    return next;
}

void print_checks(const std::vector<DeviceCheck>& checks) {
    for (const DeviceCheck& check : checks) {
        fmt::print("  {:<12} {:<8} {}\n", check.layer, name_of(check.outcome), check.found);
        if (!check.remedy.empty()) fmt::print("  {:<12} {:<8} -> {}\n", "", "", check.remedy);
    }
}

void print_text(const std::vector<Examined>& all, const std::vector<DeviceCheck>& machine,
                const std::vector<std::string>& next) {
    for (const Examined& examined : all) {
        fmt::print("{}: {}; {}\n", examined.maker->name, examined.maker->summary,
                   examined.is_usable ? "can be used" : "cannot be used");
        print_checks(examined.checks);
    }
    fmt::print("this machine, for the servo of every device\n");
    print_checks(machine);
    if (!next.empty()) fmt::print("\nnext:\n");
    for (const std::string& line : next) fmt::print("  {}\n", line);
}

Json as_json(const std::vector<DeviceCheck>& checks) {
    Json list = Json::array();
    for (const DeviceCheck& check : checks) {
        list.push_back({{"layer", check.layer},
                        {"outcome", name_of(check.outcome)},
                        {"found", check.found},
                        {"remedy", check.remedy}});
    }
    return list;
}

void print_json(const std::vector<Examined>& all, const std::vector<DeviceCheck>& machine,
                const std::vector<std::string>& next) {
    Json json;
    json["devices"] = Json::array();
    for (const Examined& examined : all) {
        json["devices"].push_back({{"name", examined.maker->name},
                                   {"summary", examined.maker->summary},
                                   {"emulated", examined.maker->is_emulated},
                                   {"usable", examined.is_usable},
                                   {"checks", as_json(examined.checks)}});
    }
    json["machine"] = as_json(machine);
    json["next"] = next;
    fmt::print("{}\n", json.dump(2));
}

}  // namespace

int devices_command(const DevicesOptions& options) {
    if (options.times_latency) return latency_command();
    if (options.wake_up_s > 0) return wake_up_command(options.wake_up_s, options.json);
    std::vector<Examined> all;
    const DeviceMaker* const only =
        options.name.empty() ? nullptr : &device_maker_called(options.name);
    DeviceRequest request;
    request.file = file_of(options.name);
    for (const DeviceMaker& maker : device_makers()) {
        const bool is_meant = only ? only == &maker : maker.file.empty();
        if (is_meant) all.push_back(examine(maker, request, options.tests_force));
    }
    const bool is_any_usable = std::any_of(all.begin(), all.end(), [&](const Examined& examined) {
        return examined.is_usable && (only || !examined.maker->is_emulated);
    });
    const std::vector<std::string> next = list_next(all, is_any_usable);
    const std::vector<DeviceCheck> machine = check_machine();
    options.json ? print_json(all, machine, next) : print_text(all, machine, next);
    return exit_code_after(is_any_usable ? 0 : 1);
}

void print_device_list() {
    const DeviceRequest request;
    for (const DeviceMaker& maker : device_makers()) {
        if (!maker.file.empty()) {
            fmt::print("{:<10} {}; --device {}:{}\n", maker.name, maker.summary, maker.name,
                       maker.file);
            continue;
        }
        const OpenedDevice opened = maker.open(request);
        const DeviceCheck last = opened.checks.empty() ? DeviceCheck{} : opened.checks.back();
        fmt::print("{:<10} {}; {}\n", maker.name, maker.summary,
                   opened.device ? "found: " + opened.device->spec().name
                                 : fmt::format("not found: {}: {}", last.layer, last.found));
    }
    fmt::print("'palpa devices' shows all checks\n");
}

void add_devices(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& devices = *program.add_subcommand(
        "devices", "Check devices: what is connected, what works, and how to fix what does not");
    DevicesOptions& options = own_options<DevicesOptions>(devices, chosen, devices_command);
    describe(devices, {"palpa devices", "palpa devices omni --force-test"},
             "Exit code 0 if a device other than the emulated ones can be used, else 1.");
    devices.add_option("device", options.name,
                       "device to check, a name as for --device of palpa run (default: all)");
    devices.add_flag("--force-test", options.tests_force,
                     "push the handle with a small force, after a question");
    CLI::Option* const json = devices.add_flag("--json", options.json, "print the result as JSON");
    devices
        .add_option("--wake-up", options.wake_up_s,
                    "time instead how late the servo's thread wakes, for so long with real-time "
                    "priority and as long without")
        ->type_name("SECONDS")
        ->check(in_range(0.01, 3600.0));
    devices
        .add_flag("--latency", options.times_latency,
                  "instead: measure the latency of emulated devices, from report to force")
        ->excludes(json);
}

}  // namespace palpa
