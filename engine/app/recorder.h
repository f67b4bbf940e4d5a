// The files that a person takes out of the window: screenshots, films, recordings, coordinates,
// readings.
#pragma once
#include "app/window_session.h"
#include "core/stage.h"
#include "ecs/world.h"
#include "gpu/swapchain.h"

#include <string>

namespace palpa {

// The next picture of the window is saved.
void take_screenshot(World& app);
// Saves it, also as a picture of the film.
void save_shot(World& app, const WindowShot& shot);
// True if the next picture is to be read back for one of them.
bool wants_shot(const World& app);

void film_or_end(World& app);
void record_or_end(World& app);
// "12 MB, 48 GB left" while something is recorded, "compressing: 40 %" after that, else empty.
std::string describe_recording(const World& app);
// Ends what is recorded, and waits until it is compressed.
void finish_recording(WindowSession& session, const StageFunction& on_stage);
// Tells how far a film is, and what a recording and servers have to say; call once a frame.
void tell_of_recording(World& app);

// Asks in what format, and of what, coordinates are saved.
void ask_for_export(World& app);

}  // namespace palpa
