// The system's sound output; plays the newest tone.
#pragma once
#include "core/mailbox.h"
#include "sound/tone.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace palpa {

// Thrown if there is no sound output or it cannot be opened; a sentence for the user.
class SoundError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// At most one at a time, used by one thread. The sound library's thread makes the samples and gets
// the newest tone without locks or allocation.
class Speaker {
public:
    // Silent until the first tone. Throws SoundError. Initialises only the sound part of the
    // library, without its signal handlers.
    Speaker();
    Speaker(const Speaker&) = delete;
    Speaker& operator=(const Speaker&) = delete;
    // Fades the tone over a tenth of a second.
    ~Speaker();

    // Plays this tone until the next. A tone that is not renewed within a second fades, because the
    // force is then unknown.
    void play(const Tone& tone) noexcept { tones_.post(tone); }

    // False once the output is lost; it does not return.
    bool is_there() const noexcept;

private:
    static void fill(void* speaker, std::uint8_t* bytes, int size) noexcept;

    std::uint32_t output_ = 0;  // the library's identifier of the output
    Mailbox<Tone> tones_;
    std::atomic<bool> is_silent_{true};
    // Used by the library's thread.
    ToneState state_;
    std::size_t samples_since_ = 0;  // samples since the newest tone arrived
};

}  // namespace palpa
