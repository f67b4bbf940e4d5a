// palpa run --serve: the run as an engine of IMD.
#pragma once
#include "ecs/world.h"
#include "session/frame_server.h"
#include "tools/commands/progress.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace palpa {

struct ServeChoice {
    std::optional<std::uint16_t> port;  // nothing: it does not serve
    ServeOptions options;
    bool waits = false;       // for the first client that says go
    bool is_as_fast = false;  // as it computes, not in real time
};

// Listens, and prints where: on standard output, or else on standard error. Null where it does not
// serve. Throws LoadError where it cannot.
std::unique_ptr<FrameServer> open_server(const ServeChoice& choice, const World& world,
                                         bool on_standard_output);

// Between the steps of a run without a window. Where it serves, a period takes its time, unless it
// is to be as fast as it can; a client's pause lasts, and what comes and goes is printed to
// standard error.
class ServedRun {
public:
    // Both outlive it.
    ServedRun(FrameServer& server, const ServeChoice& choice, ProgressLine& progress)
        : server_(server),
          waits_(choice.waits),
          is_as_fast_(choice.is_as_fast),
          progress_(progress) {}

    void before_step(World& world);

private:
    using WallClock = std::chrono::steady_clock;

    void poll_until(WallClock::time_point moment);
    void wait_for_client();
    void print_notes();

    FrameServer& server_;
    bool waits_, is_as_fast_;
    ProgressLine& progress_;
    std::optional<WallClock::time_point> due_;  // of the next step
    std::optional<ClientPull> pull_;
};

}  // namespace palpa
