#include "platform/socket.h"

#include <array>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace palpa;

namespace {

constexpr int long_ms = 5000;

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

AwaitedSocket awaited_once(const Socket& socket, bool for_room) {
    std::array<AwaitedSocket, 1> list{{{.socket = &socket, .for_room = for_room}}};
    wait_for_sockets(list, long_ms);
    return list[0];
}

// Both ends of a connection over the loopback interface.
struct Connected {
    Socket waiting, near, far;

    Connected() {
        std::error_code error;
        waiting = Socket::listen("127.0.0.1", 0, error);
        REQUIRE_FALSE(error);
        near = Socket::connect("localhost", waiting.find_port(), error);
        REQUIRE_FALSE(error);
        REQUIRE(awaited_once(waiting, false).has_input);
        far = waiting.accept(error);
        REQUIRE_FALSE(error);
        REQUIRE(far.is_open());
        REQUIRE(awaited_once(near, true).has_room);
        REQUIRE_FALSE(near.find_error());
    }
};

std::string read_all(const Socket& socket, std::size_t count) {
    std::string text;
    std::array<std::byte, 5> part{};
    while (text.size() < count && awaited_once(socket, false).has_input) {
        const SocketTransfer got = socket.read(part);
        REQUIRE_FALSE(got.error);
        if (got.is_ended) break;
        text.append(reinterpret_cast<const char*>(part.data()), got.bytes);
    }
    return text;
}

}  // namespace

TEST_CASE("what is written at one end of a connection comes at the other", "[platform][socket]") {
    const Connected both;

    CHECK(both.near.write(bytes_of("over there")).bytes == 10);
    CHECK(read_all(both.far, 10) == "over there");
    CHECK(both.far.write(bytes_of("and back")).bytes == 8);
    CHECK(read_all(both.near, 8) == "and back");
}

TEST_CASE("nobody waits for bytes, room or others that connect", "[platform][socket]") {
    const Connected both;
    std::array<std::byte, 8> into{};
    std::error_code error;

    const SocketTransfer nothing = both.near.read(into);
    CHECK(nothing.bytes == 0);
    CHECK_FALSE(nothing.is_ended);
    CHECK_FALSE(nothing.error);
    CHECK_FALSE(both.waiting.accept(error).is_open());
    CHECK_FALSE(error);

    // The system holds some megabytes at most for who does not read.
    const std::vector<std::byte> much(1 << 20);
    std::size_t sent = 0;
    SocketTransfer last;
    for (int i = 0; i < 100; ++i) {
        last = both.near.write(much);
        REQUIRE_FALSE(last.error);
        sent += last.bytes;
    }
    CHECK(last.bytes == 0);
    CHECK(sent > 0);
    CHECK(sent < 100 * much.size());
}

TEST_CASE("the end of a stream is told once all of it was read", "[platform][socket]") {
    Connected both;
    std::array<std::byte, 8> into{};
    both.near.write(bytes_of("last"));
    both.near.end_writing();

    CHECK(read_all(both.far, 100) == "last");
    CHECK(both.far.read(into).is_ended);
    CHECK(both.far.write(bytes_of("still")).bytes == 5);
    CHECK(read_all(both.near, 5) == "still");

    both.far.close();
    CHECK_FALSE(both.far.is_open());
    CHECK(awaited_once(both.near, false).has_input);
    CHECK(both.near.read(into).is_ended);
}

TEST_CASE("writing to who has gone is an error and no signal", "[platform][socket]") {
    Connected both;
    both.far.close();

    std::error_code error;
    for (int i = 0; i < 100 && !error; ++i) {
        error = both.near.write(bytes_of("x")).error;
        awaited_once(both.near, false);
    }
    CHECK(error);
    CHECK_FALSE(error.message().empty());
}

TEST_CASE("a connection to nobody, or to no address of numbers, is an error",
          "[platform][socket]") {
    std::error_code error;
    std::uint16_t port = 0;
    {
        const Socket gone = Socket::listen("127.0.0.1", 0, error);
        REQUIRE_FALSE(error);
        port = gone.find_port();
    }

    const Socket refused = Socket::connect("127.0.0.1", port, error);
    if (!error) {
        REQUIRE(awaited_once(refused, true).has_room);
        error = refused.find_error();
    }
    CHECK(error == std::errc::connection_refused);

    CHECK_FALSE(Socket::connect("engine.example", 1, error).is_open());
    CHECK(error == std::errc::invalid_argument);
    CHECK_FALSE(Socket::listen("", 0, error).is_open());
    CHECK(error == std::errc::invalid_argument);
}

TEST_CASE("a port has one owner", "[platform][socket]") {
    std::error_code error;
    const Socket first = Socket::listen("127.0.0.1", 0, error);
    REQUIRE_FALSE(error);
    REQUIRE(first.find_port() != 0);

    CHECK_FALSE(Socket::listen("127.0.0.1", first.find_port(), error).is_open());
    CHECK(error == std::errc::address_in_use);
}
