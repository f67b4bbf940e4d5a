// A live session on disk, journal.txt: what its simulation and its servos were given, from its
// first moment, so that it can be played again to the bit. Lines of words between blanks:
//
//   # Palpa journal 2.2       the version of its format (core/file_versions.h)
//   hand {JSON}             each hand's device, as the session began
//   p POSES                 the simulation: what the last step found goes to the servos
//   s POSES TOOK_US         a step, and its wall time
//   h POSES                 hands are held still
//   c POSES {JSON}          a command
//   d POSES {JSON}          another device
//   a POSES SETTLES         what the long edit before made takes the world's place
//   t NOW_S FLAGS HANDS     the servos: one tick. FLAGS: e the force fades, f servos began anew,
//                           - nothing. HANDS, with | between them: TIME_S VALID X Y Z CONTACT ORDER
//                           BUTTONS TROUBLE W QX QY QZ; = is the tick's before (at first 0, the
//                           turn 1 0 0 0), and = at the end of a hand are left out.
//   record                  trace.csv begins with the next tick
//
// POSES: for each hand the number of the newest pose. CONTACT, ORDER: the numbers of the contact
// model and the order in force. SI.
#pragma once
#include "core/file_versions.h"
#include "core/load_error.h"
#include "session/live_events.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// What a journal begins with; its version follows.
inline constexpr std::string_view journal_mark = "# Palpa journal ";

// The input of one hand's servo in a tick.
struct JournalHand {
    DeviceReading reading;
    std::uint64_t contact = 0, order = 0;
};

struct JournalTick {
    double now_s = 0;
    bool is_ending = false, is_fresh = false;
};

struct Journal {
    FileVersion version = journal_version;  // that it was read in
    std::vector<std::string> notes;         // on reading it, a sentence each
    std::vector<HandDevice> devices;
    std::vector<PlayedEvent> events;
    std::vector<JournalTick> ticks;
    std::vector<JournalHand> hands;  // hands of all ticks, one after the other
    std::optional<std::size_t> first_recorded;

    std::span<const JournalHand> hands_of(std::size_t tick) const {
        return std::span(hands).subspan(tick * devices.size(), devices.size());
    }
};

// Throws LoadError with the line for whatever is not as above, and for another major version. What
// is behind the last whole line of one that was cut off does not count.
Journal parse_journal(std::string_view text, const std::string& file);

// Gives devices of a journal before version 2.1 the scene's viscosity, from which the stiffness cap
// of every device was found then.
void complete_caps(const SceneDescription& scene, Journal& journal);

// Writes a journal line by line.
class JournalWriter {
public:
    explicit JournalWriter(std::span<const HandDevice> devices);

    void add(const PlayedEvent& event);
    void add(std::span<const LiveTick> ticks);  // ticks of all hands
    void begin_recording();

    // The text since the last call.
    std::string take();
    std::size_t size() const noexcept { return text_.size(); }  // size of this text, bytes

private:
    std::string text_;
    std::vector<JournalHand> before_;
};

}  // namespace palpa
