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
    // Of this machine alone, unless another address is given. There is no password: who reaches the
    // port can watch and pull.
    std::string address = "127.0.0.1";
    std::uint16_t port = imd_port;  // 0: any that is free
    int version = 2;                // or 3
    ImdSession session{};           // of version 3; coordinates are always sent
    std::size_t atoms = 0;
    std::size_t max_clients = 4;      // 60 at most
    int rate = 1;                     // steps between frames, until a client asks for another
    std::optional<ImdUnits> units{};  // of the wire; nothing: imd_units_of(version)
    bool may_pull = true, may_pause = true, may_kill = false;
    double go_within_s = 1;     // after the handshake, as the protocol has it
    double stuck_after_s = 10;  // a client that takes nothing of what is sent to it
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

    // Why it does not listen; empty where it does.
    const std::string& problem() const noexcept { return problem_; }
    std::uint16_t port() const noexcept { return listening_.find_port(); }

    // Takes new clients and what clients say, and writes on. Waits for at most so long, and returns
    // early where something came.
    void poll(double now_s, int at_most_ms);

    // Frames have another number of atoms from now on, which no message can tell: who is here is
    // dropped, and may come back.
    void change_atoms(std::size_t atoms);

    // To be called once a step: whether a client is due for a frame.
    bool count_step();
    // To all that are due. A client that has not yet taken its last frame goes without this one. A
    // frame of another number of atoms, or with numbers that are not finite, is not sent.
    void send(const ImdFrame& frame);

    // What acts now: the newest forces of the first client that has sent some, none once it has
    // left or was dropped. While it is there the others watch, and their forces are not taken.
    const ImdPull& pull() const noexcept { return pull_; }
    // By the client that pulls, or by any where none does; over when that client leaves.
    bool is_paused() const noexcept { return pauser_ != 0; }
    bool is_killed() const noexcept { return is_killed_; }  // by the same, where it may
    std::size_t clients() const noexcept;                   // that have sent "go"
    std::uint64_t frames_skipped() const noexcept { return frames_skipped_; }
    // One sentence each on who came, left, was dropped or not heard, since the last call; of many
    // the newest 100.
    std::vector<std::string> take_notes();

private:
    struct Client {
        std::uint64_t number = 0;  // from 1, in the order of their coming
        Socket socket;
        ImdDecoder decoder;
        ImdBytes outgoing;
        std::size_t sent = 0;     // of those
        double since_s = 0;       // it came, or last took bytes
        bool has_gone = false;    // it said Go
        int rate = 1, steps = 0;  // since its last frame
        bool was_noted = false;   // that what it asks for is not done
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
