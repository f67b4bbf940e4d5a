#include "imd/server.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace palpa {
namespace {

constexpr std::size_t most_clients = 60;
constexpr std::size_t most_notes = 100;
constexpr std::size_t reads_of_a_poll = 16;
constexpr double largest_sent = 1e30;  // a float in any unit

bool is_sound_beside_atoms(const ImdFrame& frame) {
    const auto is_small = [](double number) { return std::abs(number) <= largest_sent; };
    const ImdEnergies of = frame.energies.value_or(ImdEnergies{});
    const ImdTime time = frame.time.value_or(ImdTime{});
    const ImdBox box = frame.box.value_or(ImdBox{});
    const std::array energies{of.temperature_kelvin,
                              of.total,
                              of.potential,
                              of.van_der_waals,
                              of.coulomb,
                              of.bonds,
                              of.angles,
                              of.dihedrals,
                              of.impropers};
    return std::ranges::all_of(energies, is_small) && is_small(time.now_ps) &&
           is_small(time.step_ps) &&
           std::ranges::all_of(box, [](float edge) { return std::abs(edge) <= imd_farthest; });
}

}  // namespace

ImdServer::ImdServer(ImdServerOptions options)
    : options_(std::move(options)),
      units_(options_.units.value_or(imd_units_of(options_.version))) {
    options_.max_clients = std::min(options_.max_clients, most_clients);
    options_.session.coordinates = true;
    std::error_code error;
    listening_ = Socket::listen(options_.address, options_.port, error);
    if (error == std::errc::invalid_argument) {
        problem_ = fmt::format("'{}' is not a numeric address such as 127.0.0.1", options_.address);
    } else if (error) {
        problem_ = fmt::format("cannot listen at {}:{}: {}", options_.address, options_.port,
                               error.message());
    }
}

void ImdServer::poll(double now_s, int at_most_ms) {
    now_s_ = now_s;
    std::vector<AwaitedSocket> awaited;
    awaited.reserve(clients_.size() + 1);
    for (const Client& client : clients_) {
        awaited.push_back(
            {.socket = &client.socket, .for_room = client.sent < client.outgoing.size()});
    }
    if (listening_.is_open()) awaited.push_back({.socket = &listening_});
    wait_for_sockets(awaited, at_most_ms);
    for (std::size_t i = 0; i < clients_.size(); ++i) {
        if (awaited[i].has_room) write(clients_[i]);
        if (awaited[i].has_input) read(clients_[i]);
        judge(clients_[i]);
    }
    remove_dropped();
    if (listening_.is_open() && awaited.back().has_input) take_clients();
}

void ImdServer::take_clients() {
    for (std::size_t i = 0; i <= most_clients; ++i) {
        std::error_code error;
        Socket socket = listening_.accept(error);
        if (error) note(fmt::format("a client could not be accepted: {}", error.message()));
        if (!socket.is_open()) return;
        const std::uint64_t number = next_number_++;
        if (clients_.size() >= options_.max_clients) {
            note(fmt::format("client {} was refused: {} clients are connected, which is the limit",
                             number, clients_.size()));
            continue;
        }
        Client client{.number = number,
                      .socket = std::move(socket),
                      .decoder = ImdDecoder::of_client(options_.version, std::endian::native,
                                                       {.atoms = options_.atoms}),
                      .outgoing = {},
                      .since_s = now_s_,
                      .rate = std::max(options_.rate, 1)};
        add_imd_handshake(client.outgoing, options_.version, std::endian::native);
        if (options_.version == 3) add_imd_session(client.outgoing, options_.session);
        clients_.push_back(std::move(client));
        write(clients_.back());
    }
}

void ImdServer::read(Client& client) {
    std::array<std::byte, 1 << 14> bytes;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled
    for (std::size_t i = 0; i < reads_of_a_poll && !client.is_over; ++i) {
        const SocketTransfer got = client.socket.read(bytes);
        if (got.is_ended) {
            return drop(client,
                        fmt::format("closed the connection {}", client.decoder.find_place()));
        }
        if (got.error)
            return drop(client, fmt::format("lost the connection: {}", got.error.message()));
        if (got.bytes == 0) return;
        std::span<const std::byte> left = std::span(bytes).first(got.bytes);
        while (!left.empty() && !client.is_over) {
            left = left.subspan(client.decoder.take(left));
            if (!client.decoder.problem().empty()) {
                return drop(client, fmt::format("was dropped: {}", client.decoder.problem()));
            }
            if (client.decoder.message()) take(client, *client.decoder.message());
        }
    }
}

void ImdServer::take(Client& client, const ImdMessage& message) {
    switch (message.type) {
        case ImdType::Go:
            client.has_gone = true;
            client.steps = client.rate;  // the next frame is its first
            return note(fmt::format("client {} is watching", client.number));
        case ImdType::Disconnect:
            return drop(client, "disconnected normally");
        case ImdType::ClientForces:
            return take_forces(client, message);
        case ImdType::Pause:
        case ImdType::Resume:
            if (may_command(client, options_.may_pause, "pause")) take_pause(client, message.type);
            return;
        case ImdType::Kill:
            if (may_command(client, options_.may_kill, "end it")) is_killed_ = true;
            return;
        case ImdType::Rate:
            client.rate = std::max(message.number < 1 ? options_.rate : message.number, 1);
            return;
        default:
            return;  // Wait: this engine never waits for clients
    }
}

// The one that pulls commands; where none does, each.
bool ImdServer::may_command(Client& client, bool is_allowed, const char* what) {
    const bool is_first = puller_ == 0 || puller_ == client.number;
    if (is_allowed && is_first) return true;
    if (!std::exchange(client.was_noted, true)) {
        note(is_allowed ? fmt::format("client {} may not {}: client {} is pulling", client.number,
                                      what, puller_)
                        : fmt::format("client {} may not {}: this engine does not allow it",
                                      client.number, what));
    }
    return false;
}

void ImdServer::take_forces(Client& client, const ImdMessage& message) {
    if (!may_command(client, options_.may_pull, "pull")) return;
    if (puller_ == 0) note(fmt::format("client {} is pulling", client.number));
    puller_ = client.number;
    pull_.atoms = message.atoms;
    pull_.forces.resize(message.atoms.size());
    for (std::size_t i = 0; i < pull_.forces.size(); ++i) {
        const float* const force = message.values.data() + 3 * i;
        pull_.forces[i] = Vec3(force[0], force[1], force[2]) / units_.force;
    }
}

// In version 2 a second pause resumes.
void ImdServer::take_pause(const Client& client, ImdType type) {
    const bool resumes = type == ImdType::Resume || (options_.version == 2 && is_paused());
    if (resumes) {
        pauser_ = 0;
    } else if (!is_paused()) {
        pauser_ = client.number;
    }
}

void ImdServer::judge(Client& client) {
    if (client.is_over) return;
    const double passed_s = now_s_ - client.since_s;
    if (!client.has_gone && passed_s > options_.go_within_s) {
        drop(client,
             fmt::format("was dropped: it did not send IMD_GO within {} s", options_.go_within_s));
    } else if (client.sent < client.outgoing.size() && passed_s > options_.stuck_after_s) {
        drop(client, fmt::format("was dropped: it received nothing for {:.1f} s", passed_s));
    }
}

void ImdServer::drop(Client& client, const std::string& why) {
    note(fmt::format("client {} {}", client.number, why));
    client.is_over = true;
    // What it held is let go at once.
    if (puller_ == client.number) {
        puller_ = 0;
        pull_ = {};
    }
    if (pauser_ == client.number) pauser_ = 0;
}

void ImdServer::remove_dropped() {
    std::erase_if(clients_, [](const Client& client) { return client.is_over; });
}

void ImdServer::change_atoms(std::size_t atoms) {
    if (atoms == options_.atoms) return;
    for (Client& client : clients_) {
        drop(client, fmt::format("was dropped: the number of atoms is now {}, no longer {}, and "
                                 "IMD has no message for this",
                                 atoms, options_.atoms));
    }
    remove_dropped();
    options_.atoms = atoms;
}

bool ImdServer::count_step() {
    bool is_due = false;
    for (Client& client : clients_) {
        if (!client.has_gone) continue;
        client.steps = std::min(client.steps, client.rate - 1) + 1;
        is_due |= client.steps == client.rate;
    }
    return is_due;
}

// As clients check it: see ImdDecoder.
bool ImdServer::is_sound(const ImdFrame& frame) const {
    const auto fits = [&](const std::vector<Vec3>& vectors, double largest) {
        return vectors.size() == options_.atoms &&
               std::ranges::all_of(vectors, [&](const Vec3& vector) {
                   return vector.allFinite() && vector.cwiseAbs().maxCoeff() <= largest;
               });
    };
    const auto may_lack = [&](const std::vector<Vec3>& vectors) {
        return vectors.empty() || fits(vectors, largest_sent);
    };
    return fits(frame.coordinates, imd_farthest) && may_lack(frame.velocities) &&
           may_lack(frame.forces) && is_sound_beside_atoms(frame);
}

void ImdServer::send(const ImdFrame& frame) {
    if (!is_sound(frame)) {
        return note(
            fmt::format("a frame was not sent: expected {} atoms, finite numbers and "
                        "coordinates within a million Å",
                        options_.atoms));
    }
    ImdBytes bytes;
    for (Client& client : clients_) {
        if (!client.has_gone || client.steps < client.rate) continue;
        client.steps = 0;
        if (client.sent < client.outgoing.size()) {
            ++frames_skipped_;
            continue;
        }
        if (bytes.empty()) {
            add_imd_frame(bytes, options_.version, std::endian::native, options_.session, units_,
                          frame);
        }
        client.outgoing = bytes;
        client.sent = 0;
        client.since_s = now_s_;
        write(client);
    }
    remove_dropped();
}

void ImdServer::write(Client& client) {
    while (!client.is_over && client.sent < client.outgoing.size()) {
        const SocketTransfer sent =
            client.socket.write(std::span(client.outgoing).subspan(client.sent));
        if (sent.error)
            return drop(client, fmt::format("lost the connection: {}", sent.error.message()));
        if (sent.bytes == 0) return;
        client.sent += sent.bytes;
        if (client.has_gone) client.since_s = now_s_;
    }
}

std::size_t ImdServer::clients() const noexcept {
    return static_cast<std::size_t>(std::ranges::count_if(clients_, &Client::has_gone));
}

void ImdServer::note(std::string text) {
    if (notes_.size() == most_notes) notes_.erase(notes_.begin());
    notes_.push_back(std::move(text));
}

std::vector<std::string> ImdServer::take_notes() { return std::exchange(notes_, {}); }

}  // namespace palpa
