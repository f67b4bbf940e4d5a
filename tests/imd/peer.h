// The other end of a connection over the loopback interface, which says what a test has written by
// hand.
#pragma once
#include "platform/socket.h"
#include "tests/imd/wire.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <system_error>
#include <utility>

namespace palpa::test {

// Calls `step` until `is_done`; fails where that never is.
template <class Done, class Step>
void until(const Done& is_done, const Step& step) {
    bool is_over = is_done();
    for (int i = 0; i < 4000 && !is_over; ++i) {
        step();
        is_over = is_done();
    }
    REQUIRE(is_over);
}

constexpr int a_moment_ms = 5;

// One end of a stream.
class Peer {
public:
    Peer() = default;
    explicit Peer(Socket socket) : socket_(std::move(socket)) {}

    // All of it, while `step` lets the other end read.
    template <class Step>
    void send(const Wire& wire, const Step& step) {
        std::size_t sent = 0;
        until(
            [&] {
                const SocketTransfer part = socket_.write(std::span(wire).subspan(sent));
                sent += part.bytes;
                return sent == wire.size() || part.error;
            },
            step);
    }
    void send(const Wire& wire) {
        send(wire, [] {});
    }

    // What has come, added to `received`.
    void read() {
        std::array<std::byte, 4096> bytes{};
        while (socket_.is_open()) {
            const SocketTransfer got = socket_.read(bytes);
            received.insert(received.end(), bytes.begin(),
                            bytes.begin() + static_cast<std::ptrdiff_t>(got.bytes));
            is_ended = is_ended || got.is_ended || got.error;
            if (got.bytes == 0) return;
        }
    }
    bool has_received(const Wire& wire) {
        read();
        return received == wire;
    }

    bool is_open() const { return socket_.is_open(); }
    void end_writing() const { socket_.end_writing(); }
    void close() { socket_.close(); }

    Wire received;
    bool is_ended = false;  // the other end has closed

private:
    Socket socket_;
};

inline Socket listen_on_loopback() {
    std::error_code error;
    Socket listening = Socket::listen("127.0.0.1", 0, error);
    INFO("the loopback interface: " << error.message());
    REQUIRE(listening.is_open());
    return listening;
}

// Who connects there, while `step` lets it.
template <class Step>
Peer accept_from(const Socket& listening, const Step& step) {
    Socket accepted;
    until(
        [&] {
            std::error_code error;
            accepted = listening.accept(error);
            return accepted.is_open();
        },
        step);
    return Peer(std::move(accepted));
}

inline Socket connect_on_loopback(std::uint16_t port) {
    std::error_code error;
    Socket socket = Socket::connect("127.0.0.1", port, error);
    INFO("the loopback interface: " << error.message());
    REQUIRE(socket.is_open());
    std::array<AwaitedSocket, 1> awaited{{{.socket = &socket, .for_room = true}}};
    wait_for_sockets(awaited, 5000);
    REQUIRE(awaited[0].has_room);
    return socket;
}

}  // namespace palpa::test
