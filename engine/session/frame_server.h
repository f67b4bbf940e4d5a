// Serves a running scene by IMD: sends frames to clients and receives their pulls. Used by the
// simulation thread between two steps; never waits for a client.
#pragma once
#include "ecs/world.h"
#include "imd/server.h"
#include "simulation/client_pull.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct ServeOptions {
    // Address to listen at; the default admits clients on this machine only. There is no password.
    std::string address = "127.0.0.1";
    std::uint16_t port = imd_port;  // 0: any free port
    int version = 2;                // IMD version, 2 or 3
    int rate = 0;  // steps between frames; 0: about 30 frames a second of the scene
    bool may_pause = true;
};

class FrameServer {
public:
    // Throws LoadError where it cannot listen.
    FrameServer(const ServeOptions& options, const World& world);

    std::string place() const;  // "127.0.0.1:8888"
    std::size_t clients() const noexcept { return server_.clients(); }
    bool is_paused() const noexcept { return server_.is_paused(); }  // paused by a client

    // Waits for at most so long, and returns early where something came.
    void poll(int at_most_ms);

    // Before each step: the atom table's positions, in its order, to all clients that are due. Step
    // and time are the clock's, energies in version 2 kcal/mol; potential and total are both
    // potential_kcal_per_mol of a trace, without which nothing is mobile or in hand 0. Where the
    // table has another number of atoms than before clients are dropped: IMD cannot tell it.
    void send(const World& world);

    // What acts from the next step on, within the bounds of client_pull.h; nothing where that is as
    // at the last call.
    std::optional<ClientPull> take_pull();

    // One sentence each on who came and left, and what was not done, since the last call.
    std::vector<std::string> take_notes();

private:
    void note_without_effect(const World& world);
    void note_once(bool& was_noted, std::string text);

    ServeOptions options_;
    std::size_t atoms_;
    ImdServer server_;
    ClientPull pull_;
    std::vector<std::string> notes_;
    bool noted_strong_ = false, noted_many_ = false, noted_without_effect_ = false;
};

}  // namespace palpa
