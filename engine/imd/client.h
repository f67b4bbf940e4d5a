// A client of a remote engine: takes its newest frame, pulls its atoms. No thread and no clock
// inside: `poll` waits no longer than its argument says, so that a caller may keep the client on a
// thread of its own, and times are the caller's, in seconds of any clock that never goes back.
//
//     ImdClient client({.port = 8888, .limits = {.atoms = 3274}});
//     client.connect(now());
//     for (;;) {
//         if (client.poll(now(), 10)) show(*client.frame());
//         if (client.state() == ImdState::Connected) client.pull(atoms, forces);
//     }
//
// What engines do with forces: GROMACS (-imdpull) and LAMMPS replace their whole list by each
// message; NAMD replaces that of each atom named, and forgets an atom that is given zero. So atoms
// that are let go are sent zeros once, which every engine takes; also before an orderly end, since
// GROMACS and NAMD go on with the last forces of a client that has left. LAMMPS in version 2
// applies forces only at steps of which it sends no coordinates: with a rate of 1, never.
#pragma once
#include "imd/frame.h"
#include "platform/socket.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

enum class ImdState : std::uint8_t {
    Closed,     // not connected, or disconnected normally
    Waiting,    // connecting, waiting for the handshake or first frame, retrying, or disconnecting
    Connected,  // frames arrive, or the client has paused them
    Late,       // no frame for some time; zero forces were sent
    Lost,       // connection lost; why() gives the reason
};

// Why no frames arrive, or arrived last.
enum class ImdLack : std::uint8_t {
    Answer,     // answer to the connection
    Handshake,  // no handshake
    Frame,      // no frame after the handshake
    Version,    // another IMD version than required
    Atoms,      // another number of atoms than expected
    Order,      // anything else: it ended, or sent invalid data
};

struct ImdClientOptions {
    std::string address = "127.0.0.1";  // numeric, or "localhost"
    std::uint16_t port = imd_port;
    // With limits.atoms of 0, what the engine sends first; the same after it was lost.
    ImdLimits limits{};
    std::optional<ImdUnits> units{};  // units of the connection; unset: imd_units_of its version
    int rate = 0;                     // steps between frames; 0: the engine's setting
    std::optional<int> version{};     // required version; unset: any
    bool pulls_in_version_3 = false;  // experimental: engines differ in version 3
    double answer_within_s = 5;       // s until the connection and until the handshake
    double late_after_s = 1;          // without a frame
    double lost_after_s = 30;         // without a frame
    std::optional<double> retry_after_s{};  // s after a loss; unset: never
};

class ImdClient {
public:
    explicit ImdClient(ImdClientOptions options);
    ImdClient(const ImdClient&) = delete;
    ImdClient& operator=(const ImdClient&) = delete;
    // Disconnects as far as possible without waiting.
    ~ImdClient();

    void connect(double now_s);
    // Reads, writes and judges what is late; true where a newer frame has come, of which only the
    // newest stands. Waits for at most so long, and returns early where something came. Reads a
    // bounded number of bytes, however fast they come.
    bool poll(double now_s, int at_most_ms);
    // Lets go, resumes what was paused, and leaves; poll until the state is Closed, which it is
    // a second later at the latest.
    void disconnect(double now_s);

    ImdState state() const noexcept { return state_; }
    // The state as one sentence, lower case, no full stop.
    const std::string& why() const noexcept { return why_; }
    // The cause; if it cannot be connected to any more, the earlier cause.
    ImdLack lack() const noexcept { return phase_ == Phase::Greeting ? ImdLack::Handshake : lack_; }
    // The number of atoms that it sends if that is wrong; else 0.
    std::size_t other_atoms() const noexcept { return decoder_.other_atoms(); }
    // The newest one, also once the engine was lost; null before the first.
    const ImdFrame* frame() const noexcept { return frames_ == 0 ? nullptr : &frame_; }
    std::uint64_t frames() const noexcept { return frames_; }  // number of complete frames
    int version() const noexcept { return decoder_.version(); }
    // Content of frames in version 3.
    const ImdSession& session() const noexcept { return session_; }

    // Replaces all forces of this client: kcal/mol/Å, one per atom, atoms from 0 and each once.
    // They act until the next call, and none are sent unless frames come. Empty, or a sentence why
    // these were not taken; what acted before then still does. While there is no room to send, the
    // newest stand in for older ones.
    std::string pull(std::span<const std::int32_t> atoms, std::span<const Vec3> forces);
    void release_atoms();
    // Number of pulls sent, without releases.
    std::uint64_t pulls_sent() const noexcept { return pulls_sent_; }

    void pause() noexcept { is_paused_ = true; }
    void resume() noexcept { is_paused_ = false; }
    bool is_paused() const noexcept { return is_paused_; }
    // Steps between frames; less than 1 for the engine's default.
    void set_rate(int rate) noexcept { rate_ = rate; }

private:
    enum class Phase : std::uint8_t { Closed, Connecting, Greeting, Running, Leaving, Lost };
    struct Pull {
        std::vector<std::int32_t> atoms;
        std::vector<Vec3> forces;
    };

    void begin();
    bool is_tried_again() const noexcept;
    void wait(int at_most_ms);
    bool read();
    bool take(std::span<const std::byte> bytes);
    void take_greeting();
    void write();
    void fill_outgoing();
    void add_pull(const Pull& pull);
    void say_farewell(Phase next);
    void check_delay();
    void drop();
    void lose(const std::string& why, ImdLack lack, bool is_ended = false);
    void finish_leaving(const char* how);
    void set_state(ImdState state, std::string why);
    std::string find_pull_problem(std::span<const std::int32_t> atoms,
                                  std::span<const Vec3> forces) const;

    ImdClientOptions options_;
    ImdUnits units_;
    Phase phase_ = Phase::Closed;
    ImdState state_ = ImdState::Closed;
    std::string why_ = "no engine is connected to", loss_;
    ImdLack lack_ = ImdLack::Answer;
    double now_s_ = 0,
           since_s_ = 0;  // time of the last call; since the phase began or a frame arrived
    bool has_input_ = false, has_room_ = false;

    Socket socket_;
    ImdDecoder decoder_;
    ImdFrameBuilder builder_;
    ImdSession session_;
    ImdFrame frame_;
    std::uint64_t frames_ = 0, frames_of_session_ = 0;

    ImdBytes outgoing_;
    std::size_t sent_ = 0;              // bytes already sent
    std::optional<Pull> pull_;          // pull not yet in `outgoing_`
    std::vector<std::int32_t> pulled_;  // what the engine pulls, or will by outgoing_
    std::uint64_t pulls_sent_ = 0;
    bool is_paused_ = false, was_paused_ = false;  // requested, and sent
    bool was_paused_at_check_ = false;             // state at the last poll
    int rate_, sent_rate_ = 0;
};

}  // namespace palpa
