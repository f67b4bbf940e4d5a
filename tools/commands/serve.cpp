#include "tools/commands/serve.h"

#include "core/interrupt.h"
#include "core/text.h"
#include "simulation/resources.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstdio>
#include <string>
#include <thread>

namespace palpa {
namespace {

// An interrupt takes effect within that time.
constexpr int between_looks_ms = 50;

bool is_of_this_machine(const std::string& address) {
    return address.starts_with("127.") || address == "::1" || address == "localhost";
}

}  // namespace

std::unique_ptr<FrameServer> open_server(const ServeChoice& choice, const World& world,
                                         bool on_standard_output) {
    if (!choice.port) return nullptr;
    ServeOptions options = choice.options;
    options.port = *choice.port;
    auto server = std::make_unique<FrameServer>(options, world);
    fmt::print(on_standard_output ? stdout : stderr, "serving on {}\n", server->place());
    if (!is_of_this_machine(options.address)) {
        fmt::print(stderr,
                   "warning: everyone who can reach {} can watch and pull; there is no password\n",
                   server->place());
    }
    std::fflush(stdout);
    return server;
}

void ServedRun::before_step(World& world) {
    if (waits_) wait_for_client();
    const WallClock::time_point now = WallClock::now();
    poll_until(is_as_fast_ ? now : due_.value_or(now));
    while (server_.is_paused() && noted_interrupt() == 0) {
        server_.poll(between_looks_ms);
        print_notes();
    }
    const std::chrono::duration<double> period(world.resource<Clock>().period_s);
    // Late: the clock goes on from here.
    due_ = std::max(due_.value_or(now), WallClock::now() - std::chrono::milliseconds(1)) +
           std::chrono::duration_cast<WallClock::duration>(period);
    server_.send(world);
    if (std::optional<ClientPull> pull = server_.take_pull()) pull_ = std::move(pull);
    if (pull_) world.set_resource(*pull_);  // what edits brought back has an older one
    print_notes();
}

void ServedRun::poll_until(WallClock::time_point moment) {
    for (;;) {
        const auto left = moment - WallClock::now();
        const auto left_ms = std::chrono::duration_cast<std::chrono::milliseconds>(left).count();
        server_.poll(static_cast<int>(std::clamp<long long>(left_ms, 0, between_looks_ms)));
        print_notes();
        if (noted_interrupt() != 0) return;
        if (left < std::chrono::milliseconds(1)) break;
    }
    std::this_thread::sleep_until(moment);
}

void ServedRun::wait_for_client() {
    while (server_.clients() == 0 && noted_interrupt() == 0) {
        server_.poll(between_looks_ms);
        print_notes();
    }
    waits_ = false;
}

void ServedRun::print_notes() {
    for (const std::string& note : server_.take_notes()) {
        progress_.wipe();
        fmt::print(stderr, "serve: {}\n", printable(note));
    }
}

}  // namespace palpa
