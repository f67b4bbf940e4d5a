#include "sound/speaker.h"

#include <fmt/format.h>
#include <string>

#define SDL_MAIN_HANDLED  // it takes no main of ours
#include <SDL.h>

namespace palpa {
namespace {

constexpr std::uint16_t samples_at_once = 512;  // 11 ms
constexpr int longest_fade_ms = 500;            // of an output that still plays
constexpr std::size_t stale_samples = sound_rate_hz;

}  // namespace

Speaker::Speaker() {
    // The library's events, which sound brings along, would take SIGINT and SIGTERM.
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    SDL_SetHint(SDL_HINT_APP_NAME, "Palpa");
    if (SDL_InitSubSystem(SDL_INIT_AUDIO) != 0) {
        throw SoundError(fmt::format("no sound output was found ({})", SDL_GetError()));
    }
    SDL_AudioSpec wanted{};
    wanted.freq = sound_rate_hz;
    wanted.format = AUDIO_F32SYS;
    wanted.channels = 1;
    wanted.samples = samples_at_once;
    wanted.callback = fill;
    wanted.userdata = this;
    output_ = SDL_OpenAudioDevice(nullptr, 0, &wanted, nullptr, 0);
    if (output_ == 0) {
        const std::string reason = SDL_GetError();
        SDL_QuitSubSystem(SDL_INIT_AUDIO);
        throw SoundError(fmt::format("the sound output cannot be opened ({})", reason));
    }
    SDL_PauseAudioDevice(output_, 0);
}

Speaker::~Speaker() {
    play({});
    for (int waited_ms = 0; !is_silent_ && waited_ms < longest_fade_ms; ++waited_ms) SDL_Delay(1);
    SDL_CloseAudioDevice(output_);
    SDL_QuitSubSystem(SDL_INIT_AUDIO);
}

bool Speaker::is_there() const noexcept {
    return SDL_GetAudioDeviceStatus(output_) != SDL_AUDIO_STOPPED;
}

void Speaker::fill(void* speaker, std::uint8_t* bytes, int size) noexcept {
    Speaker& own = *static_cast<Speaker*>(speaker);
    const std::span samples(reinterpret_cast<float*>(bytes),
                            static_cast<std::size_t>(size) / sizeof(float));
    own.samples_since_ = own.tones_.take() ? 0 : own.samples_since_ + samples.size();
    const bool is_stale = own.samples_since_ > stale_samples;
    Tone tone = own.tones_.taken();
    if (is_stale) tone.amplitude = 0;
    render_tone(tone, own.state_, samples);
    own.is_silent_ = own.state_.amplitude == 0 && own.state_.click_left == 0;
}

}  // namespace palpa
