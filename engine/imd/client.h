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
    Closed,     // not asked to connect, or left in order
    Waiting,    // connects, greets, awaits its first frame, tries again, or leaves
    Connected,  // frames come, or the client has paused them
    Late,       // no frame for some time; the engine has been sent zero forces
    Lost,       // over, and why() says what came and what was expected
};

// What keeps frames from coming, or last did.
enum class ImdLack : std::uint8_t {
    Answer,     // to the connection
    Handshake,  // after it
    Frame,      // after the handshake
    Version,    // it speaks another than the options ask for
    Atoms,      // it sends another number than the options have
    Order,      // anything else: it ended, or sent nonsense
};

struct ImdClientOptions {
    std::string address = "127.0.0.1";  // of numbers, or "localhost"
    std::uint16_t port = imd_port;
    // With limits.atoms of 0, what the engine sends first; the same after it was lost.
    ImdLimits limits{};
    std::optional<ImdUnits> units{};        // of the wire; nothing: imd_units_of its version
    int rate = 0;                           // steps between frames; 0: as the engine has it
    std::optional<int> version{};           // that it must speak; nothing: any
    bool pulls_in_version_3 = false;        // an experiment: engines do not agree on its forces
    double answer_within_s = 5;             // to the connection and with the handshake
    double late_after_s = 1;                // without a frame
    double lost_after_s = 30;               // without a frame
    std::optional<double> retry_after_s{};  // once it was lost; nothing: never
};

class ImdClient {
public:
    explicit ImdClient(ImdClientOptions options);
    ImdClient(const ImdClient&) = delete;
    ImdClient& operator=(const ImdClient&) = delete;
    // Tells the engine what `disconnect` would, as far as that is possible without waiting.
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
    // One sentence of the state, in lower case without a full stop.
    const std::string& why() const noexcept { return why_; }
    // Of one that cannot be connected to any more, what came before.
    ImdLack lack() const noexcept { return phase_ == Phase::Greeting ? ImdLack::Handshake : lack_; }
    // How many atoms it sends, where their number is what is wrong; else 0.
    std::size_t other_atoms() const noexcept { return decoder_.other_atoms(); }
    // The newest one, also once the engine was lost; null before the first.
    const ImdFrame* frame() const noexcept { return frames_ == 0 ? nullptr : &frame_; }
    std::uint64_t frames() const noexcept { return frames_; }  // that came whole
    int version() const noexcept { return decoder_.version(); }
    // What frames of version 3 have.
    const ImdSession& session() const noexcept { return session_; }

    // Replaces all forces of this client: kcal/mol/Å, one per atom, atoms from 0 and each once.
    // They act until the next call, and none are sent unless frames come. Empty, or a sentence why
    // these were not taken; what acted before then still does. While there is no room to send, the
    // newest stand in for older ones.
    std::string pull(std::span<const std::int32_t> atoms, std::span<const Vec3> forces);
    void let_go();
    std::uint64_t pulls_sent() const noexcept { return pulls_sent_; }  // that were not all let go

    void pause() noexcept { is_paused_ = true; }
    void resume() noexcept { is_paused_ = false; }
    bool is_paused() const noexcept { return is_paused_; }
    // Steps between frames; less than 1 for the engine's own.
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
    double now_s_ = 0, since_s_ = 0;  // of the last call; since the phase began or a frame came
    bool has_input_ = false, has_room_ = false;

    Socket socket_;
    ImdDecoder decoder_;
    ImdFrameBuilder builder_;
    ImdSession session_;
    ImdFrame frame_;
    std::uint64_t frames_ = 0, frames_of_session_ = 0;

    ImdBytes outgoing_;
    std::size_t sent_ = 0;              // of those
    std::optional<Pull> pull_;          // not yet among them
    std::vector<std::int32_t> pulled_;  // what the engine pulls, or will by outgoing_
    std::uint64_t pulls_sent_ = 0;
    bool is_paused_ = false, was_paused_ = false;  // asked for, and sent
    bool was_paused_at_check_ = false;             // at the last poll
    int rate_, sent_rate_ = 0;
};

}  // namespace palpa
