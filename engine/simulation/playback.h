// Plays a trajectory of another program on the atoms of a scene. Between frames the atoms are
// frozen: hands feel their forces and move what they hold; the next frame puts it back.
#pragma once
#include "core/load_error.h"
#include "ecs/world.h"
#include "scene/description.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

class Trajectory;

inline constexpr double usual_frames_per_s = 25;

// A resource, advanced by the clock of the simulation.
struct Playback {
    std::shared_ptr<Trajectory> trajectory;  // read only by the thread that steps the world
    double at = 0;  // position in frames; its whole part is the frame shown
    double frames_per_s = usual_frames_per_s;
    bool is_paused = false;
    std::optional<std::size_t>
        shown{};                      // nothing: the frame has to be put into the atom table again
    std::optional<double> time_ps{};  // time of the frame, if the file states it
    std::string problem{};            // why it has stopped without being paused; else empty
    std::string damage{};  // what is damaged in the frame that was due, until another is requested
};

// A person's request to the playback.
struct PlaybackOrder {
    std::optional<bool> paused{};
    std::optional<double> frames_per_s{};  // above 0
    std::optional<std::size_t> frame{};    // from 0
};

// The trajectory to play, and how playback begins.
struct PlaybackChoice {
    std::filesystem::path file;
    PlaybackOrder order{};
};

// The state of the playback, for display.
struct PlaybackState {
    std::size_t frame = 0, frames = 1;
    double frames_per_s = usual_frames_per_s;
    bool is_paused = false;
    std::optional<double> time_ps{};
    std::string problem{};
};

// The scene for playback: every molecule rigid at the positions of the frames, nothing flexible or
// mobile; hands hold molecules as a whole.
SceneDescription as_played(SceneDescription scene);

// Puts the first frame, or `frame`, into a world of such a scene. Throws LoadError as
// open_trajectory does, and if the frames have another number of atoms than the world.
void start_playback(World& world, const std::filesystem::path& file,
                    const PlaybackOrder& order = {});

// Does nothing without playback.
void order_playback(World& world, const PlaybackOrder& order);
std::optional<PlaybackState> find_playback(const World& world);

// Problems of the trajectory file found at opening, one sentence each, for example that it is
// truncated. Empty without playback.
std::vector<std::string> list_playback_notes(const World& world);

// Transfers the playback to a world that replaces this one.
void carry_playback(const World& world, World& other);

}  // namespace palpa
