// Counts what the other end can make this one allocate.
#include "imd/client.h"
#include "imd/server.h"
#include "tests/imd/hostile_streams.h"
#include "tests/imd/peer.h"
#include "tests/support/count_allocations.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <optional>
#include <vector>

using namespace palpa;
using test::go;
using test::hex;
using test::native;
using test::operator+;
using test::peak_of;
using test::Peer;
using test::Wire;

namespace {

constexpr std::size_t little = 16'384;  // sentences and what is held without atoms

// In pieces as a socket gives them.
void feed(ImdDecoder& decoder, const Wire& wire) {
    for (std::size_t at = 0; at < wire.size(); at += 1000) {
        auto piece = std::span(wire).subspan(at, std::min<std::size_t>(1000, wire.size() - at));
        while (!piece.empty() && decoder.problem().empty())
            piece = piece.subspan(decoder.take(piece));
    }
}

Wire zeros(std::size_t count) { return Wire(count); }

}  // namespace

TEST_CASE("the decoder holds what has come, not what a header promises", "[imd][memory]") {
    const Wire greeting = test::handshake(native, 2);
    const Wire promise = greeting + test::header(2, 1'000'000) + zeros(1000);
    CHECK(peak_of([&] {
              ImdDecoder decoder = ImdDecoder::of_engine({});
              feed(decoder, promise);
          }) < little);

    constexpr std::size_t atoms = 100'000;
    const Wire frame = test::header(2, atoms) + zeros(12 * atoms);
    Wire frames = greeting;
    for (int i = 0; i < 5; ++i) frames = std::move(frames) + frame;
    CHECK(peak_of([&] {
              ImdDecoder decoder = ImdDecoder::of_engine({});
              feed(decoder, frames);
          }) < 36 * atoms + little);

    Wire pull = go + test::header(6, atoms);
    for (std::size_t i = 0; i < atoms; ++i) {
        pull = std::move(pull) + test::number(native, static_cast<std::int32_t>(i));
    }
    pull = std::move(pull) + zeros(12 * atoms);
    CHECK(peak_of([&] {
              ImdDecoder decoder = ImdDecoder::of_client(2, native, {.atoms = atoms});
              feed(decoder, pull);
          }) < 64 * atoms + little);
}

TEST_CASE("hostile streams make the decoder hold little", "[imd][memory]") {
    for (std::uint64_t i = 0; i < 10'000; ++i) {
        INFO("stream " << i);
        test::HostileStreams random(i);
        const Wire engine = random.from_engine(), client = random.from_client(3);
        std::size_t most = 0;
        most = std::max(most, peak_of([&] {
                            ImdDecoder decoder = ImdDecoder::of_engine({});
                            feed(decoder, engine);
                        }));
        most = std::max(most, peak_of([&] {
                            ImdDecoder decoder = ImdDecoder::of_client(3, native, {.atoms = 2});
                            feed(decoder, client);
                        }));
        CHECK(most < little);
    }
}

TEST_CASE("a client holds a few frames, however fast they come and slowly its forces go",
          "[imd][memory]") {
    constexpr std::size_t atoms = 20'000;
    const Socket listening = test::listen_on_loopback();
    ImdClient client({.port = listening.find_port()});
    client.connect(0);
    const auto poll = [&] { client.poll(0, test::a_moment_ms); };
    Peer engine = test::accept_from(listening, poll);
    engine.send(test::handshake(native, 2));
    const Wire frame = test::header(2, atoms) + zeros(12 * atoms);
    std::vector<std::int32_t> all(atoms);
    for (std::size_t i = 0; i < atoms; ++i) all[i] = static_cast<std::int32_t>(i);
    const std::vector<Vec3> forces(atoms, Vec3(1, 2, 3));

    const std::size_t most = peak_of([&] {
        for (int i = 0; i < 100; ++i) {
            engine.send(frame, poll);
            poll();
            for (int k = 0; k < 3; ++k) client.pull(all, forces);
        }
    });

    // Of an atom 12 bytes came: as they are, as floats, and as doubles of two frames; 16 go, and
    // stand in wait as 28.
    CHECK(client.frames() > 50);
    CHECK(most < 300 * atoms);
}

TEST_CASE("a server holds a few frames for a client that takes none", "[imd][memory]") {
    constexpr std::size_t atoms = 20'000;
    ImdServer server({.port = 0, .atoms = atoms});
    INFO("the loopback interface: " << server.problem());
    REQUIRE(server.problem().empty());
    Peer client(test::connect_on_loopback(server.port()));
    client.send(go);
    const auto poll = [&] { server.poll(0, test::a_moment_ms); };
    test::until([&] { return server.clients() == 1; }, poll);
    Wire pull = test::header(6, atoms);
    for (std::size_t i = 0; i < atoms; ++i) {
        pull = std::move(pull) + test::number(native, static_cast<std::int32_t>(i));
    }
    pull = std::move(pull) + zeros(12 * atoms);
    ImdFrame frame;
    frame.coordinates.assign(atoms, Vec3(1, 2, 3));

    const std::size_t most = peak_of([&] {
        for (int i = 0; i < 100; ++i) {
            if (server.count_step()) server.send(frame);
            client.send(pull, poll);
            poll();
        }
    });

    CHECK(server.frames_skipped() > 10);
    CHECK(server.pull().atoms.size() == atoms);
    CHECK(most < 200 * atoms);
}
