#include "sound/pad_rumble.h"

#include "sound/tone.h"

#include <algorithm>
#include <cmath>
#include <limits>

#define SDL_MAIN_HANDLED  // it takes no main of ours
#include <SDL.h>

namespace palpa {
namespace {

constexpr std::uint32_t lasts_ms = 200, snap_ms = 80, between_looks_ms = 1000;

SDL_GameController* as_pad(void* pad) { return static_cast<SDL_GameController*>(pad); }

}  // namespace

Shake shake_of(double force_newton, bool is_snap) noexcept {
    constexpr double full = std::numeric_limits<std::uint16_t>::max();
    Shake shake;
    if (is_snap) shake.low = static_cast<std::uint16_t>(full);
    if (!std::isfinite(force_newton)) return shake;
    const double share =
        (force_newton - faintest_heard_newton) / (strongest_heard_newton - faintest_heard_newton);
    shake.high = static_cast<std::uint16_t>(std::lround(full * std::clamp(share, 0.0, 1.0)));
    return shake;
}

PadRumble::PadRumble() {
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    // The window is not the library's own, and raw reports of pads are for devices (devices/).
    SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
    SDL_SetHint(SDL_HINT_JOYSTICK_HIDAPI, "0");
    is_ready_ = SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER) == 0;
}

PadRumble::~PadRumble() {
    if (pad_) {
        SDL_GameControllerRumble(as_pad(pad_), 0, 0, 0);
        SDL_GameControllerClose(as_pad(pad_));
    }
    if (is_ready_) SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
}

bool PadRumble::find() {
    if (!is_ready_) return false;
    SDL_GameControllerUpdate();
    if (pad_ && !SDL_GameControllerGetAttached(as_pad(pad_))) {
        SDL_GameControllerClose(as_pad(pad_));
        pad_ = nullptr;
    }
    const std::uint64_t now = SDL_GetTicks64();
    if (pad_ || now < next_look_ms_) return pad_ != nullptr;
    next_look_ms_ = now + between_looks_ms;
    for (int i = 0; i < SDL_NumJoysticks() && !pad_; ++i) {
        SDL_GameController* const pad =
            SDL_IsGameController(i) ? SDL_GameControllerOpen(i) : nullptr;
        if (pad && SDL_GameControllerHasRumble(pad))
            pad_ = pad;
        else if (pad)
            SDL_GameControllerClose(pad);
    }
    return pad_ != nullptr;
}

void PadRumble::play(double force_newton, std::uint64_t snaps) noexcept {
    const std::uint64_t now = SDL_GetTicks64();
    if (has_snaps_ && snaps > snaps_) snap_until_ms_ = now + snap_ms;
    snaps_ = snaps;
    has_snaps_ = true;
    if (!pad_) return;
    const Shake shake = shake_of(force_newton, now < snap_until_ms_);
    SDL_GameControllerRumble(as_pad(pad_), shake.low, shake.high, lasts_ms);
}

}  // namespace palpa
