// The engine's side: sends frames to clients that watch, takes forces from one that pulls. Nothing
// that a client does or leaves undone holds the engine up, or takes more memory than about five
// times a frame. No thread and no clock inside, as in client.h.
//
//     ImdServer server({.atoms = 3274});
//     for (each step) {
//         server.poll(now(), server.is_paused() ? 10 : 0);
//         if (server.count_step()) server.send(frame);
//         add(server.pull());
//     }
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

struct ImdServerOptions {
    // Address to listen at; the default admits clients on this machine only. There is no password:
    // everyone who can reach the port can watch and pull.
    std::string address = "127.0.0.1";
    std::uint16_t port = imd_port;  // 0: any free port
    int version = 2;                // or 3
    ImdSession session{};           // for version 3; coordinates are always sent
    std::size_t atoms = 0;
    std::size_t max_clients = 4;      // 60 at most
    int rate = 1;                     // steps between frames, until a client requests others
    std::optional<ImdUnits> units{};  // units of the connection; unset: imd_units_of(version)
    bool may_pull = true, may_pause = true, may_kill = false;
    double go_within_s = 1;     // s after the handshake, by the protocol
    double stuck_after_s = 10;  // s after which a client that receives nothing is dropped
};

// kcal/mol/Å, one per atom; each atom once.
struct ImdPull {
    std::vector<std::int32_t> atoms;
    std::vector<Vec3> forces;
};

class ImdServer {
public:
    explicit ImdServer(ImdServerOptions options);
    ImdServer(const ImdServer&) = delete;
    ImdServer& operator=(const ImdServer&) = delete;

    // Why it cannot listen; empty if it does.
    const std::string& problem() const noexcept { return problem_; }
    std::uint16_t port() const noexcept { return listening_.find_port(); }

    // Accepts clients, reads and writes. Waits at most `at_most_ms`, and returns early if something
    // arrived.
    void poll(double now_s, int at_most_ms);

    // Changes the number of atoms. IMD has no message for this, so clients are dropped and may
    // reconnect.
    void change_atoms(std::size_t atoms);

    // Call once a step: whether a frame is due for a client.
    bool count_step();
    // To all that are due. A client that has not yet taken its last frame goes without this one. A
    // frame of another number of atoms, or with numbers that are not finite, is not sent.
    void send(const ImdFrame& frame);

    // The present forces: the newest ones of the first client that sent some; none after it left.
    // Meanwhile other clients can only watch.
    const ImdPull& pull() const noexcept { return pull_; }
    // Whether the pulling client (or any, if none pulls) has paused; ends when it leaves.
    bool is_paused() const noexcept { return pauser_ != 0; }
    // Whether such a client ended the engine, if allowed.
    bool is_killed() const noexcept { return is_killed_; }
    std::size_t clients() const noexcept;  // number of clients that have sent "go"
    std::uint64_t frames_skipped() const noexcept { return frames_skipped_; }
    // Notes since the last call, one sentence each, on clients that came, left, were dropped or
    // ignored; the newest 100.
    std::vector<std::string> take_notes();

private:
    struct Client {
        std::uint64_t number = 0;  // number of the client, from 1
        Socket socket;
        ImdDecoder decoder;
        ImdBytes outgoing;
        std::size_t sent = 0;     // of those
        double since_s = 0;       // time of its arrival or last transfer
        bool has_gone = false;    // it has sent "go"
        int rate = 1, steps = 0;  // its rate; steps since its last frame
        bool was_noted = false;   // a note on its refused request was made
        bool is_over = false;
    };

    void take_clients();
    void read(Client& client);
    void take(Client& client, const ImdMessage& message);
    void take_forces(Client& client, const ImdMessage& message);
    void take_pause(const Client& client, ImdType type);
    void write(Client& client);
    void judge(Client& client);
    bool may_command(Client& client, bool is_allowed, const char* what);
    void drop(Client& client, const std::string& why);
    void remove_dropped();
    void note(std::string text);
    bool is_sound(const ImdFrame& frame) const;

    ImdServerOptions options_;
    ImdUnits units_;
    std::string problem_;
    double now_s_ = 0;

    Socket listening_;
    std::vector<Client> clients_;
    std::uint64_t next_number_ = 1;
    std::vector<std::string> notes_;

    ImdPull pull_;
    std::uint64_t puller_ = 0, pauser_ = 0;  // numbers of clients; 0: none
    bool is_killed_ = false;
    std::uint64_t frames_skipped_ = 0;
};

}  // namespace palpa
