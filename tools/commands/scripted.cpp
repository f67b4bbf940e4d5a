#include "tools/commands/scripted.h"

#include "core/interrupt.h"
#include "core/load_error.h"
#include "devices/emulated_omni.h"
#include "platform/terminal.h"
#include "scene/run_commands.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

// Lines of standard input; what is too long ends one byte after the most that a line may have.
class InputLines {
public:
    // Nothing at the end, and where somebody wants the program to end.
    std::optional<std::string> next() {
        constexpr int between_looks_ms = 50;
        std::string line;
        for (;;) {
            const std::size_t end = std::min(text_.find('\n'), text_.size());
            line.append(text_, 0, std::min(end, most_command_bytes + 1 - line.size()));
            const bool is_whole = end < text_.size();
            text_.erase(0, is_whole ? end + 1 : end);
            if (is_whole) return line;
            if (is_over_) return line.empty() ? std::nullopt : std::optional(line);
            std::array<char, 4096> more{};
            std::optional<std::size_t> count;
            while (!count) {
                if (noted_interrupt() != 0) return std::nullopt;
                count = read_standard_input(more, between_looks_ms);
            }
            is_over_ = *count == 0;
            text_.assign(more.data(), *count);
        }
    }

private:
    std::string text_;  // read, and not yet given
    bool is_over_ = false;
};

void print_answer(const std::string& answer) {
    fmt::print("{}\n", answer);
    if (std::fflush(stdout) == 0) return;  // whoever asked waits for it
    throw std::system_error(errno, std::generic_category(), "standard output");
}

void lead_hand(Device& device, const Vec3& place_m) {
    auto* const emulated = dynamic_cast<EmulatedOmni*>(&device);
    if (!emulated) {
        throw LoadError({"hand_mm"},
                        fmt::format("moves the emulated hand, but this hand uses another device "
                                    "({}); expected a run without --device",
                                    device.spec().name));
    }
    if (!emulated->has_hand()) {
        throw LoadError({"hand_mm"},
                        "has no effect, because nobody holds the handle; expected a grip other "
                        "than \"none\", such as --hand medium");
    }
    emulated->lead_to(place_m);
}

}  // namespace

ScriptEnds standard_ends(std::span<const std::unique_ptr<Device>> devices, bool overwrites) {
    return {
        [lines = InputLines()]() mutable { return lines.next(); }, print_answer,
        [devices](std::size_t hand, const Vec3& place_m) { lead_hand(*devices[hand], place_m); },
        overwrites};
}

SceneDescription without_end(SceneDescription scene) {
    constexpr double days_s = 1e8;
    scene.seconds = days_s;
    return scene;
}

}  // namespace palpa
