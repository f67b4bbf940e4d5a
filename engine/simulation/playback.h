// A trajectory of another program that moves the atoms of a scene, frame after frame. A frame is
// frozen while it stands: hands feel the forces in it, and move what they hold from where it has
// it, until the next frame.
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

// A resource. The clock of the simulation moves it on.
struct Playback {
    std::shared_ptr<Trajectory> trajectory;  // read by the thread that steps the world alone
    double at = 0;                           // frames; the whole number is what is shown
    double frames_per_s = usual_frames_per_s;
    bool is_paused = false;
    std::optional<std::size_t> shown{};  // nothing: to be put in the atom table anew
    std::optional<double> time_ps{};     // of the frame, where the file says
    std::string problem{};               // why it stands still, though not paused; else empty
    std::string damage{};                // of the frame that was due, until others are asked for
};

// What a person asks of it.
struct PlaybackOrder {
    std::optional<bool> paused{};
    std::optional<double> frames_per_s{};  // above 0
    std::optional<std::size_t> frame{};    // from 0
};

// What is to be played, and how it begins.
struct PlaybackChoice {
    std::filesystem::path file;
    PlaybackOrder order{};
};

// How it stands, for those that show it.
struct PlaybackState {
    std::size_t frame = 0, frames = 1;
    double frames_per_s = usual_frames_per_s;
    bool is_paused = false;
    std::optional<double> time_ps{};
    std::string problem{};
};

// The scene with every molecule in one piece where its frames have it: nothing flexible, nothing
// that moves by itself; hands hold a molecule as a whole.
SceneDescription as_played(SceneDescription scene);

// Puts the first frame, or `frame`, into a world of such a scene. Throws LoadError: as
// open_trajectory does, and where frames have another number of atoms than the world.
void start_playback(World& world, const std::filesystem::path& file,
                    const PlaybackOrder& order = {});

// Nothing where nothing is played.
void order_playback(World& world, const PlaybackOrder& order);
std::optional<PlaybackState> find_playback(const World& world);

// What is wrong with the file that is played, as far as opening it says, a sentence each: that it
// was cut off, above all. Nothing where nothing is played.
std::vector<std::string> list_playback_notes(const World& world);

// What another world, which takes this one's place, goes on with.
void carry_playback(const World& world, World& other);

}  // namespace palpa
