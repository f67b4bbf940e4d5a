// The motors of a game pad, which shake with the felt force, for people whose device does not
// render it. Any pad will do that the sound library's game controllers know.
#pragma once
#include <cstdint>

namespace palpa {

// How strongly both motors shake, 0 to 65535.
struct Shake {
    std::uint16_t low = 0, high = 0;  // the heavy motor, the light one

    friend bool operator==(const Shake&, const Shake&) = default;
};

// The light motor is proportional to the norm of the force from `faintest_heard_newton` to
// `strongest_heard_newton` (sound/tone.h). The heavy one shakes for a snap.
Shake shake_of(double force_newton, bool is_snap) noexcept;

// At most one at a time, used by the window's thread.
class PadRumble {
public:
    // Finds pads from now on; without the library's support for pads there will be none.
    PadRumble();
    PadRumble(const PadRumble&) = delete;
    PadRumble& operator=(const PadRumble&) = delete;
    ~PadRumble();  // the motors stop

    // Looks for a pad, at most once a second; true if one with motors is in use.
    bool find();
    // Call for each picture: motors that hear nothing for a fifth of a second stop.
    void play(double force_newton, std::uint64_t snaps) noexcept;

private:
    bool is_ready_ = false;
    void* pad_ = nullptr;  // the library's
    std::uint64_t next_look_ms_ = 0, snaps_ = 0, snap_until_ms_ = 0;
    bool has_snaps_ = false;
};

}  // namespace palpa
