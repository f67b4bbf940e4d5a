#include "imd/server.h"

#include "tests/imd/peer.h"
#include "tests/imd/wire.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <memory>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Matchers::Contains;
using test::go;
using test::hex;
using test::leave;
using test::native;
using test::operator+;
using test::pause_or_resume;
using test::Peer;
using test::turned;
using test::Wire;

namespace {

const Wire greeting_of_2 = test::handshake(native, 2);

ImdFrame made_frame(double x) {
    ImdFrame frame;
    frame.coordinates = {Vec3(x, 0, 0), Vec3::Zero(), Vec3(0, 0, -x)};
    return frame;
}

Wire wire_at(float x) { return test::vectors(native, 2, {x, 0, 0, 0, 0, 0, 0, 0, -x}); }

// A server of three atoms, in the same thread as its clients. Time stands still unless a test moves
// `now`.
struct Engine {
    std::unique_ptr<ImdServer> server;
    double now = 100;
    std::vector<std::string> notes;

    explicit Engine(ImdServerOptions options = {}) {
        options.port = 0;
        options.atoms = options.atoms == 0 ? 3 : options.atoms;
        server = std::make_unique<ImdServer>(options);
        INFO("the loopback interface: " << server->problem());
        REQUIRE(server->problem().empty());
    }

    void poll() {
        server->poll(now, test::a_moment_ms);
        for (std::string& note : server->take_notes()) notes.push_back(std::move(note));
    }

    template <class Done>
    void until(const Done& is_done) {
        test::until(is_done, [&] { poll(); });
    }

    void expect(Peer& peer, const Wire& wire) {
        until([&] { return peer.has_received(wire); });
        peer.received.clear();
    }

    void expect_end(Peer& peer) {
        until([&] {
            peer.read();
            return peer.is_ended;
        });
    }

    void expect_note(const std::string& text) {
        until([&] {
            return std::ranges::any_of(
                notes, [&](const std::string& note) { return note.find(text) != note.npos; });
        });
        notes.clear();
    }

    Peer connect() { return Peer(test::connect_on_loopback(server->port())); }

    // One that watches.
    Peer join(const Wire& greeting = greeting_of_2) {
        const std::size_t before = server->clients();
        Peer peer = connect();
        expect(peer, greeting);
        peer.send(go);
        until([&] { return server->clients() == before + 1; });
        return peer;
    }

    void step(const ImdFrame& frame) {
        if (server->count_step()) server->send(frame);
    }
};

const Wire a_pull = test::client_forces(native, {2, 0}, {1, 2, 3, -4, 0, 0.5F});

}  // namespace

TEST_CASE("clients that say go are sent frames of version 2", "[imd][server]") {
    Engine engine;
    CHECK_FALSE(engine.server->count_step());
    Peer first = engine.join(), second = engine.join();
    engine.expect_note("client 2 is watching");

    engine.step(made_frame(1));
    ImdFrame with_energies = made_frame(2);
    with_energies.energies = ImdEnergies{.step = 5, .temperature_kelvin = 300, .impropers = 1};
    engine.expect(first, wire_at(1));
    engine.step(with_energies);

    engine.expect(first, test::energies(native, 5, {300, 0, 0, 0, 0, 0, 0, 0, 1}) + wire_at(2));
    engine.expect(
        second, wire_at(1) + test::energies(native, 5, {300, 0, 0, 0, 0, 0, 0, 0, 1}) + wire_at(2));
}

TEST_CASE("clients are sent version 3 as the session says, in its units", "[imd][server]") {
    Engine engine(
        {.version = 3, .session = {.energies = true, .is_wrapped = true, .forces = true}});
    Peer client =
        engine.join(test::handshake(native, 3) + hex("0000000a 00000007 00 01 00 01 01 00 01"));
    ImdFrame frame = made_frame(1);
    frame.energies = ImdEnergies{.step = 5, .total = 10};
    frame.forces = {Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3::Zero()};

    engine.step(frame);

    engine.expect(client, test::energies(native, 5, {0, 41.84F, 0, 0, 0, 0, 0, 0, 0}) + wire_at(1) +
                              test::vectors(native, 15, {4.184F, 0, 0, 0, 8.368F, 0, 0, 0, 0}));
}

TEST_CASE("each client has a rate of its own", "[imd][server]") {
    Engine engine({.rate = 2});
    Peer slow = engine.join(), fast = engine.join();
    fast.send(hex("00000008 00000001"));
    engine.poll();
    slow.send(hex("00000008 00000003"));
    engine.poll();

    for (int i = 1; i <= 7; ++i) {
        engine.step(made_frame(i));
        engine.poll();
        fast.read();
    }
    engine.expect(slow, wire_at(1) + wire_at(4) + wire_at(7));
    Wire all;
    for (int i = 1; i <= 7; ++i) all = std::move(all) + wire_at(static_cast<float>(i));
    engine.expect(fast, all);

    fast.close();
    engine.until([&] { return engine.server->clients() == 1; });
    slow.send(hex("00000008 00000000"));  // the engine's own
    engine.poll();
    for (int i = 1; i <= 4; ++i) {
        CHECK(engine.server->count_step() == (i % 2 == 0));
        if (i % 2 == 0) engine.server->send(made_frame(i));
    }
    engine.expect(slow, wire_at(2) + wire_at(4));
}

TEST_CASE("the first client that sends forces pulls, until it leaves", "[imd][server]") {
    Engine engine({.units = ImdUnits{.force = 2}});
    Peer watcher = engine.join(), puller = engine.join();
    CHECK(engine.server->pull().atoms.empty());

    puller.send(a_pull);
    engine.until([&] { return !engine.server->pull().atoms.empty(); });
    CHECK(engine.server->pull().atoms == std::vector<std::int32_t>{2, 0});
    CHECK(engine.server->pull().forces == std::vector<Vec3>{Vec3(0.5, 1, 1.5), Vec3(-2, 0, 0.25)});
    engine.expect_note("client 2 is pulling");

    watcher.send(test::client_forces(native, {1}, {9, 9, 9}));
    engine.expect_note("client 1 may not pull: client 2 is pulling");
    CHECK(engine.server->pull().atoms == std::vector<std::int32_t>{2, 0});

    puller.send(test::client_forces(native, {0}, {2, 0, 0}));  // in place of the others
    engine.until([&] { return engine.server->pull().atoms.size() == 1; });
    CHECK(engine.server->pull().forces == std::vector<Vec3>{Vec3(1, 0, 0)});

    puller.send(leave);
    engine.expect_note("client 2 disconnected normally");
    CHECK(engine.server->pull().atoms.empty());
    CHECK(engine.server->pull().forces.empty());
    engine.expect_end(puller);
    watcher.send(a_pull);
    engine.expect_note("client 1 is pulling");
    watcher.close();
    engine.expect_note("client 1 ");
    CHECK(engine.server->pull().atoms.empty());
}

TEST_CASE("clients pause and resume as the version has it", "[imd][server]") {
    Engine second;
    Peer client = second.join();
    client.send(pause_or_resume);
    second.until([&] { return second.server->is_paused(); });
    client.send(pause_or_resume);
    second.until([&] { return !second.server->is_paused(); });
    client.send(pause_or_resume);
    second.until([&] { return second.server->is_paused(); });
    client.close();  // nobody else could resume
    second.until([&] { return !second.server->is_paused(); });

    Engine third({.version = 3});
    Peer other = third.join(test::handshake(native, 3) + hex("0000000a 00000007 00000001000000"));
    other.send(pause_or_resume + pause_or_resume);
    third.until([&] { return third.server->is_paused(); });
    third.poll();
    CHECK(third.server->is_paused());
    other.send(hex("0000000b 00000000"));
    third.until([&] { return !third.server->is_paused(); });
}

TEST_CASE("who does not pull commands nothing while another does", "[imd][server]") {
    Engine engine({.may_kill = true});
    Peer puller = engine.join(), watcher = engine.join();
    puller.send(a_pull);
    engine.expect_note("client 1 is pulling");

    watcher.send(pause_or_resume + hex("00000005 00000000"));
    engine.expect_note("client 2 may not pause: client 1 is pulling");
    CHECK_FALSE(engine.server->is_paused());
    CHECK_FALSE(engine.server->is_killed());
    puller.send(hex("00000005 00000000"));
    engine.until([&] { return engine.server->is_killed(); });
}

TEST_CASE("what an engine does not allow is not done", "[imd][server]") {
    Engine engine({.may_pull = false, .may_pause = false});
    Peer client = engine.join();
    client.send(hex("00000005 00000000"));
    engine.expect_note("client 1 may not end it: this engine does not allow it");
    client.send(a_pull + pause_or_resume + hex("00000008 00000004"));
    for (int i = 0; i < 5; ++i) engine.poll();

    CHECK_FALSE(engine.server->is_killed());
    CHECK_FALSE(engine.server->is_paused());
    CHECK(engine.server->pull().atoms.empty());
    CHECK(engine.server->clients() == 1);
}

TEST_CASE("who says no go in time, or no IMD, is dropped with a sentence", "[imd][server]") {
    Engine engine;
    Peer silent = engine.connect();
    engine.expect(silent, greeting_of_2);
    engine.now += 1.5;
    engine.expect_note("client 1 was dropped: it did not send IMD_GO within 1 s");
    engine.expect_end(silent);

    Peer web = engine.connect();
    web.send(hex("47455420 2f204854"));  // GET / HT
    engine.expect_note(
        "client 2 was dropped: a message of type 1195725856 came, expected one from 0 to 16");
    engine.expect_end(web);

    Peer wrong = engine.join();
    wrong.send(a_pull + test::client_forces(native, {3}, {0, 0, 0}));
    engine.expect_note("client 3 was dropped: a force on atom 3 came, expected one from 0 to 2");
    CHECK(engine.server->pull().atoms.empty());
    CHECK(engine.server->clients() == 0);

    Peer cut = engine.join();
    cut.send(hex("00000006 00000001 00"));
    engine.poll();
    cut.end_writing();
    engine.expect_note(
        "client 4 closed the connection inside a 'client forces' message, after 1 of 16 bytes");
}

TEST_CASE("more clients than may be are turned away", "[imd][server]") {
    Engine engine({.max_clients = 2});
    Peer first = engine.join(), second = engine.join();
    Peer third = engine.connect();
    engine.expect_note("client 3 was refused: 2 clients are connected, which is the limit");
    engine.expect_end(third);
    CHECK(third.received.empty());
    engine.step(made_frame(1));
    engine.expect(first, wire_at(1));
    engine.expect(second, wire_at(1));
}

TEST_CASE("a client that does not read goes without frames, then is dropped", "[imd][server]") {
    constexpr std::size_t atoms = 100'000;
    Engine engine({.atoms = atoms, .stuck_after_s = 10});
    Peer stuck = engine.join(), reader = engine.join();
    stuck.send(test::client_forces(native, {0}, {1, 0, 0}));
    engine.until([&] { return !engine.server->pull().atoms.empty(); });
    ImdFrame frame;
    frame.coordinates.assign(atoms, Vec3::Zero());

    // 1.2 MB each; the system holds some megabytes.
    constexpr std::size_t frames = 40;
    const std::size_t size = 8 + 12 * atoms;
    for (std::size_t i = 1; i <= frames; ++i) {
        engine.step(frame);
        engine.until([&] {
            reader.read();
            return reader.received.size() == i * size;
        });
    }
    CHECK(engine.server->frames_skipped() > 10);
    CHECK(engine.server->clients() == 2);

    engine.now += 11;
    engine.expect_note("client 1 was dropped: it received nothing for 11.0 s");
    CHECK(engine.server->clients() == 1);
    CHECK(engine.server->pull().atoms.empty());
}

TEST_CASE("a slow client gets whole frames, the newest when it has room", "[imd][server]") {
    constexpr std::size_t atoms = 100'000;
    Engine engine({.atoms = atoms});
    Peer slow = engine.join();
    ImdFrame frame;
    for (int i = 1; i <= 40; ++i) {
        frame.coordinates.assign(atoms, Vec3(i, 0, 0));
        engine.step(frame);
        engine.poll();
    }
    REQUIRE(engine.server->frames_skipped() > 0);

    const std::size_t size = 8 + 12 * atoms;
    std::size_t before = 0;
    engine.until([&] {
        slow.read();
        return std::exchange(before, slow.received.size()) == slow.received.size();
    });
    const Wire start = test::header(2, atoms);
    REQUIRE(slow.received.size() % size == 0);
    float last = 0;
    for (std::size_t at = 0; at < slow.received.size(); at += size) {
        REQUIRE(std::equal(start.begin(), start.end(),
                           slow.received.begin() + static_cast<std::ptrdiff_t>(at)));
        float x = 0;
        std::memcpy(&x, slow.received.data() + at + 8, sizeof x);
        CHECK(x > last);
        last = x;
    }
    slow.received.clear();
    frame.coordinates.assign(atoms, Vec3(99, 0, 0));
    engine.step(frame);
    engine.until([&] {
        slow.read();
        return slow.received.size() == size;
    });
}

TEST_CASE("another number of atoms drops who knows the old one", "[imd][server]") {
    Engine engine;
    Peer first = engine.join(), silent = engine.connect();
    engine.expect(silent, greeting_of_2);
    first.send(a_pull);
    engine.expect_note("client 1 is pulling");
    engine.server->change_atoms(3);
    CHECK(engine.server->clients() == 1);

    engine.server->change_atoms(1);
    CHECK(engine.server->clients() == 0);
    CHECK(engine.server->pull().atoms.empty());
    engine.expect_end(first);
    engine.expect_end(silent);
    engine.expect_note("client 1 was dropped: the number of atoms is now 1, no longer 3");
    Peer again = engine.join();
    again.send(test::client_forces(native, {0}, {1, 0, 0}));
    engine.until([&] { return engine.server->pull().atoms.size() == 1; });
    ImdFrame frame;
    frame.coordinates = {Vec3(7, 0, 0)};
    engine.step(frame);
    engine.expect(again, test::vectors(native, 2, {7, 0, 0}));
    again.send(test::client_forces(native, {1}, {1, 0, 0}));
    engine.expect_note("client 3 was dropped: a force on atom 1 came");
}

TEST_CASE("a frame that is not sound is not sent", "[imd][server]") {
    Engine engine;
    Peer client = engine.join();
    ImdFrame few = made_frame(1);
    few.coordinates.pop_back();
    engine.step(few);
    engine.step(made_frame(std::numeric_limits<double>::quiet_NaN()));
    engine.step(made_frame(2e6));
    ImdFrame hot = made_frame(1);
    hot.energies = ImdEnergies{.temperature_kelvin = std::numeric_limits<float>::infinity()};
    engine.step(hot);
    engine.expect_note("a frame was not sent: expected 3 atoms, finite numbers and coordinates");
    engine.step(made_frame(4));
    engine.expect(client, wire_at(4));
}

TEST_CASE(
    "a server listens on this machine alone unless it gets an address, and says where it cannot",
    "[imd][server]") {
    CHECK(ImdServerOptions{}.address == "127.0.0.1");
    const Engine engine;
    const ImdServer second({.port = engine.server->port(), .atoms = 1});
    CHECK_THAT(second.problem(), Contains("cannot listen at "));
    const ImdServer named({.address = "engine.example", .atoms = 1});
    CHECK(named.problem() == "'engine.example' is not a numeric address such as 127.0.0.1");
}
