// A remote engine that moves all atoms of a world, over IMD, in place of relaxation (a scene's
// [engine]). Hands hold their atoms by springs: an end that the hand moves, and the middle of the
// atoms through a low-pass, so that heat does not shake the hand. The force of the spring acts on
// the engine's atoms, by their masses, and the opposite one on the hand.
#pragma once
#include "ecs/world.h"
#include "imd/client.h"
#include "scene/description.h"
#include "simulation/components.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// Which of the engine's atoms are which of the table; -1 where there is none.
struct EngineAtoms {
    std::vector<std::int32_t> in_table;   // of each atom that the engine sends
    std::vector<std::int32_t> in_engine;  // of each atom of the table: others stay where they are
};

// Resource of a world. Copies of a world share the connection.
struct RemoteEngine {
    EngineDescription settings;
    EngineAtoms atoms;
    std::shared_ptr<ImdClient> client;
    std::string listed_in;    // the file that has its atoms, for messages
    bool is_awaited = false;  // a step waits for a frame: no window

    std::uint64_t frames = 0;         // that came so far
    double frame_interval_s = 0;      // between the last ones, wall time, smoothed; 0: not known
    double frame_time_s = 0;          // of the last one, of the same clock
    std::optional<double> lost_at_s;  // since when nothing comes
    std::uint64_t interruptions = 0;  // how often frames ceased to come
    std::string refusal;              // why the last forces were not sent; empty where they were
};

// Component of a hand that holds atoms of the engine.
struct EngineHold {
    std::vector<std::uint32_t> atoms;  // of the table
    std::vector<double> shares;        // of their mass, in the same order
    Vec3 middle = Vec3::Zero();        // Å, in the last frame
    Vec3 smoothed = Vec3::Zero();      // Å, through the low-pass
    bool is_live = false;              // frames come, and the spring acts
};

// Force on the hand's end of a spring, kcal/mol/Å, and its stiffness -dF/dx, kcal/mol/Å^2.
// `stretch` (Å): from that end to the atoms. Beyond `most` (kcal/mol/Å) the force keeps its size.
struct EngineSpring {
    Vec3 force = Vec3::Zero();
    Mat3 stiffness = Mat3::Zero();
};
EngineSpring find_engine_spring(double k, const Vec3& stretch, double most) noexcept;
// Of a hand that holds atoms of the engine; nothing where its hold is not live.
EngineSpring find_engine_spring(const World& world, Entity hand) noexcept;

// The middle of what it holds, Å, where the table has it.
Vec3 find_middle(const AtomTable& table, const EngineHold& hold) noexcept;

// Of the scene's molecule: atoms of its segment with names, masses, charges and bonds, and no
// parameters. Without a topology masses are those of elements, and bonds are found from distances.
// A structure that is a PSF file leaves all atoms at the origin. Throws LoadError as the readers
// do.
AtomRange add_engine_atoms(const Source& source, AtomTable& table);

// By `engine.atoms`. Throws LoadError: atoms of the scene that are not there, or not once, or of
// another mass; an index file that names other atoms than the scene has.
EngineAtoms find_engine_atoms(const SceneDescription& scene, const AtomTable& table);

// Gives a world that has its molecules the resource; nothing is connected to yet.
void set_remote_engine(const SceneDescription& scene, World& world);

// Springs and holds of all hands anew, from what they hold.
void hold_engine_atoms(World& world);

// Takes the newest frame, waiting for one where steps wait: false where none came. Connects at
// first.
bool take_newest_frame(World& world);

// Whether the engine alone knows where atoms are, of a molecule whose structure is a PSF file:
// until its first frame they are at the origin.
bool lacks_coordinates(const SceneDescription& scene);

// Waits for the first frame. Throws EngineLost.
void await_engine(World& world);

class EngineLost : public LoadError {
public:
    using LoadError::LoadError;
};

// Lets go and leaves in order, which takes a second at most.
void leave_engine(World& world);

// Asks the engine to stand still meanwhile; nothing where there is none.
void pause_engine(World& world, bool is_paused);

// Null where the world has none.
const RemoteEngine* find_remote_engine(const World& world) noexcept;
// What would be right, of an engine that does not send: "expected ..."
std::string advise(const RemoteEngine& engine);
// Whether a run without a window is to end: nothing has come for long.
bool is_engine_gone(const World& world) noexcept;
// From the atoms' motion to the force on the hand, s: step, frame and low-pass.
double find_engine_delay(const World& world) noexcept;
// One sentence.
std::string describe_engine(const World& world);

}  // namespace palpa
