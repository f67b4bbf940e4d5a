// The system's sound output, which plays the newest tone.
#pragma once
#include "core/mailbox.h"
#include "sound/tone.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace palpa {

// No sound output, or one that cannot be opened: a sentence for the user.
class SoundError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// One at a time, used by one thread. Samples are made on a thread of the sound library, which is
// handed the newest tone without locks or allocation.
class Speaker {
public:
    // Silent until the first tone. Throws SoundError. Of the sound library only sound is set up,
    // and no signal is taken.
    Speaker();
    Speaker(const Speaker&) = delete;
    Speaker& operator=(const Speaker&) = delete;
    // The tone fades first, a tenth of a second.
    ~Speaker();

    // From now on, until the next one. One that is not renewed for a second, since nobody says the
    // force any more, fades.
    void play(const Tone& tone) noexcept { tones_.post(tone); }

    // False once the output has gone away; it does not come back.
    bool is_there() const noexcept;

private:
    static void fill(void* speaker, std::uint8_t* bytes, int size) noexcept;

    std::uint32_t output_ = 0;  // the library's number of it
    Mailbox<Tone> tones_;
    std::atomic<bool> is_silent_{true};
    // Of the library's thread.
    ToneState state_;
    std::size_t samples_since_ = 0;  // the newest tone came
};

}  // namespace palpa
