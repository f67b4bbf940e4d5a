// A remote engine that moves all atoms of a world over IMD, in place of relaxation (a scene's
// [engine]). Hands hold atoms by springs between the hand's end and the low-pass filtered centre of
// the atoms, so that thermal motion does not shake the hand. The spring's force acts on the
// engine's atoms in proportion to their masses, and the opposite force on the hand.
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

// The mapping between atoms of the engine and of the table; -1: none.
struct EngineAtoms {
    std::vector<std::int32_t> in_table;  // for each atom that the engine sends
    std::vector<std::int32_t>
        in_engine;          // for each atom of the table; atoms without an index do not move
    std::string listed_in;  // the file that lists the engine's atoms, or "the scene"
};

// The solver of such a world (simulation/solver.h). Copies of a world share the connection.
struct RemoteEngine {
    EngineDescription settings;
    std::shared_ptr<const EngineAtoms> atoms;
    std::shared_ptr<ImdClient> client;
    bool is_awaited = false;  // steps wait for a frame (without a window)

    std::uint64_t frames = 0;         // frames received
    double frame_interval_s = 0;      // smoothed wall time between frames; 0: unknown
    double frame_time_s = 0;          // arrival of the last frame, same clock
    std::optional<double> lost_at_s;  // time since which no frame has arrived
    std::uint64_t interruptions = 0;  // number of times that frames stopped
    std::string refusal;              // why the last forces were not sent; empty if they were
};

// Component of a hand that holds atoms of the engine.
struct EngineHold {
    std::vector<std::uint32_t> atoms;  // indices into the table
    std::vector<double> shares;        // mass fractions, in the same order
    Vec3 middle = Vec3::Zero();        // Å, centre of mass in the last frame
    Vec3 smoothed = Vec3::Zero();      // Å, centre of mass after the low-pass filter
    bool is_live = false;              // frames arrive and the spring acts
};

// Force on the hand's end of a spring, kcal/mol/Å, and its stiffness -dF/dx, kcal/mol/Å^2.
// `stretch` (Å): from that end to the atoms. The force is limited to `most` (kcal/mol/Å).
struct EngineSpring {
    Vec3 force = Vec3::Zero();
    Mat3 stiffness = Mat3::Zero();
};
EngineSpring find_engine_spring(double k, const Vec3& stretch, double most) noexcept;
// For a hand that holds atoms of the engine; zero while its spring does not act.
EngineSpring find_engine_spring(const World& world, Entity hand) noexcept;

// Centre of mass of the held atoms in the table, Å.
Vec3 find_middle(const AtomTable& table, const EngineHold& hold) noexcept;

// Makes it the solver of a world with molecules; does not connect yet.
void set_remote_engine(const EngineDescription& settings, EngineAtoms atoms, World& world);

// Rebuilds the springs of all hands from what they hold.
void hold_engine_atoms(World& world);

// Gives another world the engine, if there is one, and the positions that it sent.
void carry_engine(const World& from, World& to);

// Reads the newest frame, connecting first if needed. Waits for one if steps wait; false if none
// has arrived.
bool take_newest_frame(World& world, RemoteEngine& engine);

// Waits for the first frame. Throws EngineLost.
void await_engine(World& world, RemoteEngine& engine);

class EngineLost : public LoadError {
public:
    using LoadError::LoadError;
};

// Releases the atoms and disconnects; takes at most a second.
void leave_engine(World& world);

// Asks the engine to pause or to continue; does nothing without one.
void pause_engine(World& world, bool is_paused);

// Makes steps wait for frames, for a run without a window.
void make_steps_wait(World& world);
// The newest frame's potential energy, kcal/mol; 0 without one.
double find_engine_energy(const World& world) noexcept;

// The engine's part in a run; report_engine gives nothing without one.
struct EngineReport {
    std::uint64_t frames = 0, interruptions = 0;  // frames received; times that they stopped
    double frames_per_s = 0;                      // 0: unknown
    double delay_s = 0;  // from the atoms' motion to the force on the hand: step, frame and filter
    std::string state;   // in one sentence
    std::string advice;  // where none comes: "expected ..."
};
std::optional<EngineReport> report_engine(const World& world);
// True if a run without a window should end because no frame has arrived for long.
bool is_engine_gone(const World& world) noexcept;
// The state of the engine in one sentence.
std::string describe_engine(const World& world);

}  // namespace palpa
