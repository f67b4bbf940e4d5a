#include "imd/client.h"

#include "tests/imd/peer.h"
#include "tests/imd/wire.h"

#include <catch2/catch.hpp>
#include <limits>
#include <memory>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
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

Wire frame_of(const std::vector<float>& coordinates, std::endian order = native) {
    return test::vectors(order, 2, coordinates);
}

// Two atoms, the first at (x, 0, 0).
Wire frame_at(float x, std::endian order = native) { return frame_of({x, 0, 0, 0, 0, 0}, order); }

// A client and the engine that it connects to, in one thread. Time stands still unless a test moves
// `now`.
struct Session {
    Socket listening = test::listen_on_loopback();
    std::unique_ptr<ImdClient> client;
    Peer engine;
    double now = 100;

    explicit Session(ImdClientOptions options = {}) {
        options.port = listening.find_port();
        client = std::make_unique<ImdClient>(options);
        client->connect(now);
    }

    bool poll() { return client->poll(now, test::a_moment_ms); }

    template <class Done>
    void until(const Done& is_done) {
        test::until(is_done, [&] { poll(); });
    }

    void accept() {
        engine = test::accept_from(listening, [&] { poll(); });
    }

    void greet(const Wire& greeting, const Wire& more = {}) {
        accept();
        engine.send(greeting);
        expect(go + more);
    }

    // And waits until the client has it.
    void send_frame(const Wire& frame) {
        const std::uint64_t before = client->frames();
        engine.send(frame, [&] { poll(); });
        until([&] { return client->frames() > before; });
    }

    void expect(const Wire& wire) {
        until([&] { return engine.has_received(wire); });
        engine.received.clear();
    }

    void expect_lost(const std::string& why) {
        until([&] { return client->state() == ImdState::Lost; });
        CHECK_THAT(client->why(), EndsWith(why));
        CHECK_THAT(client->why(), Contains("the engine at 127.0.0.1:"));
    }
};

const std::vector<std::int32_t> both_atoms{1, 0};
const std::vector<Vec3> two_forces{Vec3(1, 2, 3), Vec3(-4, 0, 0.5)};

}  // namespace

TEST_CASE("a client greets an engine and gives its frames, in both byte orders", "[imd][client]") {
    for (const std::endian order : {native, turned}) {
        Session session({.limits = {.atoms = 2}});
        CHECK(session.client->state() == ImdState::Waiting);
        CHECK_FALSE(session.client->frame());
        session.greet(test::handshake(order, 2));
        CHECK(session.client->version() == 2);
        CHECK(session.client->state() == ImdState::Waiting);
        CHECK_THAT(session.client->why(), EndsWith("has not sent a frame yet"));

        session.send_frame(test::energies(order, 9, {300, 1, 2, 3, 4, 5, 6, 7, 8}) +
                           frame_of({1, 2, 3, -4, 5, 6.5F}, order));

        CHECK(session.client->state() == ImdState::Connected);
        REQUIRE(session.client->frame());
        CHECK(session.client->frame()->coordinates ==
              std::vector<Vec3>{Vec3(1, 2, 3), Vec3(-4, 5, 6.5)});
        CHECK(session.client->frame()->find_step() == 9);
        CHECK(session.client->frame()->energies->impropers == 8);
    }
}

TEST_CASE("a client takes version 3 and all that its frames have", "[imd][client]") {
    Session session;
    session.greet(test::handshake(turned, 3) + hex("0000000a 00000007 00 00 00 01 01 01 01"));

    session.send_frame(test::vectors(turned, 2, {1, 2, 3}) + test::vectors(turned, 14, {4, 5, 6}) +
                       test::vectors(turned, 15, {8.368F, 0, 0}));

    CHECK(session.client->session().is_wrapped);
    CHECK(session.client->frame()->velocities == std::vector<Vec3>{Vec3(4, 5, 6)});
    CHECK((session.client->frame()->forces[0] - Vec3(2, 0, 0)).norm() < 1e-6);
}

TEST_CASE("the newest frame that is whole stands", "[imd][client]") {
    Session session;
    session.greet(test::handshake(native, 2));
    session.engine.send(frame_at(1) + frame_at(2) + frame_at(3) + hex("00000002 00000002 00"));

    session.until([&] { return session.client->frames() == 3; });

    CHECK(session.client->frame()->coordinates[0].x() == 3);
    CHECK_FALSE(session.poll());
}

TEST_CASE("one poll reads a bounded part of what comes", "[imd][client]") {
    Session session;
    session.greet(test::handshake(native, 2));
    session.send_frame(frame_at(0));
    Wire many;
    for (int i = 0; i < 50'000; ++i) many = std::move(many) + frame_at(1);  // 1.6 MB

    std::uint64_t most = 0;
    std::size_t polls = 0;
    const auto poll = [&] {
        const std::uint64_t before = session.client->frames();
        session.poll();
        ++polls;
        most = std::max(most, session.client->frames() - before);
    };
    session.engine.send(many, poll);
    test::until([&] { return session.client->frames() == 50'001; }, poll);

    CHECK(most <= (1024 * 1024 + 64 * 1024 + 320) / 32 + 1);
    CHECK(polls > 1);
}

TEST_CASE("each frame is answered by forces, in the engine's byte order and unit",
          "[imd][client]") {
    for (const std::endian order : {native, turned}) {
        Session session({.units = ImdUnits{.force = 2}});
        session.greet(test::handshake(order, 2));
        for (int i = 1; i < 4; ++i) {
            const auto step = static_cast<float>(i);
            session.send_frame(frame_at(step, order));

            const Vec3 force = session.client->frame()->coordinates[0];
            CHECK(session.client->pull(both_atoms, std::vector<Vec3>{force, Vec3(0, 0.25, 0)}) ==
                  "");

            session.expect(test::client_forces(order, {1, 0}, {2 * step, 0, 0, 0, 0.5F, 0}));
        }
        CHECK(session.client->pulls_sent() == 3);
    }
}

TEST_CASE("atoms that are let go are sent zeros once", "[imd][client]") {
    Session session;
    session.greet(test::handshake(native, 2));
    session.send_frame(frame_at(0));

    CHECK(session.client->pull(both_atoms, two_forces) == "");
    session.expect(test::client_forces(native, {1, 0}, {1, 2, 3, -4, 0, 0.5F}));
    CHECK(session.client->pull(std::vector<std::int32_t>{1}, std::vector<Vec3>{Vec3(7, 0, 0)}) ==
          "");
    session.expect(test::client_forces(native, {1, 0}, {7, 0, 0, 0, 0, 0}));
    session.client->release_atoms();
    session.client->release_atoms();
    session.client->set_rate(3);
    session.expect(test::client_forces(native, {1}, {0, 0, 0}) + hex("00000008 00000003"));
}

TEST_CASE("a client pauses, resumes and sets the rate as the version has it", "[imd][client]") {
    Session second({.rate = 5});
    second.greet(test::handshake(native, 2), hex("00000008 00000005"));
    second.client->pause();
    second.expect(pause_or_resume);
    second.client->pause();
    second.client->resume();
    second.expect(pause_or_resume);  // which toggles
    second.client->set_rate(-1);
    second.expect(hex("00000008 ffffffff"));

    Session third;
    third.greet(test::handshake(native, 3) + hex("0000000a 00000007 00000001000000"));
    third.client->pause();
    third.expect(pause_or_resume);
    third.client->resume();
    third.expect(hex("0000000b 00000000"));
}

TEST_CASE("an orderly end lets go, resumes and leaves", "[imd][client]") {
    Session session;
    session.greet(test::handshake(native, 2));
    session.send_frame(frame_at(0));
    CHECK(session.client->pull(both_atoms, two_forces) == "");
    session.client->pause();
    session.expect(test::client_forces(native, {1, 0}, {1, 2, 3, -4, 0, 0.5F}) + pause_or_resume);

    // What is still under way must not take back the last words.
    session.engine.send(frame_at(1));
    session.client->disconnect(session.now);
    CHECK(session.client->state() == ImdState::Waiting);
    session.expect(test::client_forces(native, {0, 1}, {0, 0, 0, 0, 0, 0}) + pause_or_resume +
                   leave);
    session.engine.close();
    session.until([&] { return session.client->state() == ImdState::Closed; });

    CHECK_THAT(session.client->why(), EndsWith("was disconnected normally"));
    CHECK(session.client->pull(both_atoms, two_forces) == session.client->why());
}

TEST_CASE("an engine that does not close is left all the same", "[imd][client]") {
    Session session;
    session.greet(test::handshake(native, 2));
    session.client->disconnect(session.now);
    session.expect(leave);
    CHECK(session.client->state() == ImdState::Waiting);
    session.now += 1.5;
    session.poll();
    CHECK(session.client->state() == ImdState::Closed);
}

TEST_CASE("a client that goes out of scope lets go and leaves", "[imd][client]") {
    Session session;
    session.greet(test::handshake(native, 2));
    session.send_frame(frame_at(0));
    CHECK(session.client->pull(both_atoms, two_forces) == "");
    session.client.reset();

    test::until(
        [&] {
            return session.engine.has_received(
                test::client_forces(native, {1, 0}, {1, 2, 3, -4, 0, 0.5F}) +
                test::client_forces(native, {0, 1}, {0, 0, 0, 0, 0, 0}) + leave);
        },
        [] { wait_for_sockets({}, test::a_moment_ms); });
}

TEST_CASE("an engine that is late is let go, and lost in the end", "[imd][client]") {
    Session session({.late_after_s = 1, .lost_after_s = 10});
    session.greet(test::handshake(native, 2));
    session.now += 1000;  // before its first frame an engine may take its time
    session.poll();
    CHECK(session.client->state() == ImdState::Waiting);
    session.send_frame(frame_at(0));
    CHECK(session.client->pull(both_atoms, two_forces) == "");
    session.expect(test::client_forces(native, {1, 0}, {1, 2, 3, -4, 0, 0.5F}));

    session.now += 2;
    session.poll();
    CHECK(session.client->state() == ImdState::Late);
    CHECK_THAT(session.client->why(), EndsWith("has not sent a frame for 2.0 s"));
    session.expect(test::client_forces(native, {0, 1}, {0, 0, 0, 0, 0, 0}));
    CHECK(session.client->pull(both_atoms, two_forces) == session.client->why());

    session.send_frame(frame_at(5));
    CHECK(session.client->state() == ImdState::Connected);
    CHECK(session.client->pull(both_atoms, two_forces) == "");

    session.now += 11;
    session.poll();
    session.expect_lost("has not sent a frame for 11.0 s");
    CHECK(session.client->frame()->coordinates[0].x() == 5);
}

TEST_CASE("while it is paused an engine is not late", "[imd][client]") {
    Session session;
    session.greet(test::handshake(native, 2));
    session.send_frame(frame_at(0));
    session.client->pause();
    session.now += 1000;
    session.poll();
    CHECK(session.client->state() == ImdState::Connected);
    CHECK_THAT(session.client->why(), EndsWith("is paused"));
    session.now += 1000;
    session.client->resume();
    session.poll();
    session.now += 0.5;
    session.poll();
    CHECK_THAT(session.client->why(), EndsWith("sends frames"));
}

TEST_CASE("an engine that says what is no IMD is left with a sentence", "[imd][client]") {
    const Wire greeting = test::handshake(native, 2);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    {
        Session session;
        session.accept();
        session.engine.send(test::handshake(native, 5));
        session.expect_lost("was disconnected: a handshake of version 5 came, expected 2 or 3");
        session.engine.read();
        CHECK(session.engine.received.empty());
    }
    {
        Session session;
        session.accept();
        session.engine.send(test::handshake(native, 3) + hex("0000000a 00000007 01010100000000"));
        session.expect_lost("its frames have no coordinates, expected coordinates");
    }
    {
        Session session({.limits = {.atoms = 3}});
        session.accept();
        session.engine.send(greeting + frame_at(0));
        session.expect_lost("a 'coordinates' message came with a length of 2, expected 3 atoms");
        CHECK(session.client->lack() == ImdLack::Atoms);
        CHECK(session.client->other_atoms() == 2);
    }
    {
        Session session;
        session.greet(greeting);
        session.send_frame(frame_at(0));
        CHECK(session.client->pull(both_atoms, two_forces) == "");
        session.expect(test::client_forces(native, {1, 0}, {1, 2, 3, -4, 0, 0.5F}));
        session.engine.send(frame_at(nan));
        session.expect_lost("for its atom 0, expected numbers within a million Å");
        // The engine goes on, so it needs the message.
        session.expect(test::client_forces(native, {0, 1}, {0, 0, 0, 0, 0, 0}) + leave);
    }
    {
        Session session;
        session.greet(greeting);
        session.engine.send(frame_at(1) + hex("00000002 00000002 0000"));
        session.until([&] { return session.client->frames() == 1; });
        session.engine.end_writing();
        session.expect_lost(
            "closed the connection inside a 'coordinates' message, after 2 of 24 bytes");
    }
    {
        Session session;
        session.greet(greeting);
        session.engine.send(hex("00000005 00000000"));
        session.expect_lost("ended the session by a 'kill' message");
    }
}

TEST_CASE("an engine that is not there, or says nothing, is lost in time", "[imd][client]") {
    std::uint16_t port = test::listen_on_loopback().find_port();  // closed again
    ImdClient refused({.port = port});
    refused.connect(0);
    test::until([&] { return refused.state() == ImdState::Lost; },
                [&] { refused.poll(0, test::a_moment_ms); });
    CHECK_THAT(refused.why(), Contains(" does not accept the connection: "));

    ImdClient named({.address = "engine.example"});
    named.connect(0);
    CHECK(named.state() == ImdState::Lost);
    CHECK(named.why() ==
          "the engine at engine.example:8888 is not a numeric address such as 127.0.0.1");

    Session silent({.answer_within_s = 5});
    silent.accept();
    silent.now += 6;
    silent.poll();
    silent.expect_lost("did not send its handshake within 5 s");
}

// As LAMMPS, which ends when a client leaves at once.
TEST_CASE("an engine that ended over an error is reported with its first error", "[imd][client]") {
    Session session({.version = 3, .retry_after_s = 2});
    session.accept();
    session.engine.send(test::handshake(native, 2), [&] { session.poll(); });
    session.expect_lost("was disconnected: it uses IMD version 2, expected 3");
    CHECK(session.client->lack() == ImdLack::Version);
    session.engine.close();
    session.listening = Socket();
    session.now += 3;
    session.poll();
    session.until([&] { return session.client->state() == ImdState::Lost; });
    CHECK_THAT(session.client->why(), Contains("does not accept the connection"));
    CHECK_THAT(session.client->why(),
               EndsWith("before, it was disconnected: it uses IMD version 2, expected 3"));
    CHECK(session.client->lack() == ImdLack::Version);
}

TEST_CASE("a lost engine is tried again where that was asked for", "[imd][client]") {
    Session session({.retry_after_s = 2});
    session.greet(test::handshake(native, 2));
    session.send_frame(frame_at(1));
    session.client->pause();
    session.engine.close();
    session.expect_lost("closed the connection between two messages");

    session.now += 1;
    session.poll();
    CHECK(session.client->state() == ImdState::Lost);
    session.now += 1.5;
    session.poll();
    CHECK(session.client->state() == ImdState::Waiting);
    CHECK_THAT(session.client->why(), Contains("; before, it closed the connection"));
    CHECK_FALSE(session.client->is_paused());
    session.greet(test::handshake(turned, 2));
    session.send_frame(frame_at(2, turned));
    CHECK(session.client->state() == ImdState::Connected);
    CHECK(session.client->frame()->coordinates[0].x() == 2);
    session.engine.close();
    session.expect_lost("closed the connection between two messages");

    // The same molecule has to come back.
    session.now += 3;
    session.accept();
    session.engine.send(test::handshake(native, 2) + frame_of({1, 2, 3}));
    session.expect_lost("came with a length of 1, expected 2 atoms");
}

TEST_CASE("a connection that is not asked for again stays lost", "[imd][client]") {
    Session session;
    session.greet(test::handshake(native, 2));
    session.engine.close();
    session.expect_lost("closed the connection between two messages");
    session.now += 1e6;
    session.poll();
    CHECK(session.client->state() == ImdState::Lost);
}

TEST_CASE("forces in version 3 are an experiment, in kJ/mol/Å", "[imd][client]") {
    const Wire greeting = test::handshake(native, 3) + hex("0000000a 00000007 00000001000000");
    Session plain;
    plain.greet(greeting);
    plain.send_frame(frame_at(0));
    CHECK_THAT(plain.client->pull(both_atoms, two_forces), Contains("experiment"));

    Session session({.pulls_in_version_3 = true});
    session.greet(greeting);
    session.send_frame(frame_at(0));
    CHECK(session.client->pull(both_atoms, two_forces) == "");
    session.expect(
        test::client_forces(native, {1, 0}, {4.184F, 8.368F, 12.552F, -16.736F, 0, 2.092F}));
    plain.engine.read();
    CHECK(plain.engine.received.empty());
}

TEST_CASE("forces that no engine could use are not sent", "[imd][client]") {
    Session session;
    session.greet(test::handshake(native, 2));
    CHECK_THAT(session.client->pull(both_atoms, two_forces), EndsWith("has not sent a frame yet"));
    session.send_frame(frame_at(0));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto pull = [&](const std::vector<std::int32_t>& atoms, const std::vector<Vec3>& forces) {
        return session.client->pull(atoms, forces);
    };

    CHECK(pull({2}, {Vec3::Zero()}) == "a force on atom 2, expected one from 0 to 1");
    CHECK(pull({-1}, {Vec3::Zero()}) == "a force on atom -1, expected one from 0 to 1");
    CHECK(pull({1, 1}, two_forces) == "two forces on atom 1, expected one at most");
    CHECK(pull({1}, two_forces) == "2 forces for 1 atoms, expected one for each atom");
    CHECK_THAT(pull({1}, {Vec3(0, nan, 0)}), EndsWith("expected a million at most"));
    CHECK_THAT(pull({1}, {Vec3(0, 2e6, 0)}), EndsWith("expected a million at most"));
    for (int i = 0; i < 5; ++i) session.poll();
    session.engine.read();
    CHECK(session.engine.received.empty());
    CHECK(session.client->pulls_sent() == 0);
}

TEST_CASE("of forces that find no room the newest are sent", "[imd][client]") {
    constexpr std::int32_t atoms = 50'000;
    Session session({.limits = {.atoms = atoms}});
    session.greet(test::handshake(native, 2));
    session.send_frame(frame_of(std::vector<float>(std::size_t{3} * atoms)));
    std::vector<std::int32_t> all(atoms);
    for (std::int32_t i = 0; i < atoms; ++i) all[static_cast<std::size_t>(i)] = i;

    // Each 800 kB; nobody reads, and the system holds some megabytes.
    constexpr int pulls = 60;
    for (int i = 1; i <= pulls; ++i) {
        REQUIRE(session.client->pull(all, std::vector<Vec3>(atoms, Vec3(i, 0, 0))) == "");
        session.client->set_rate(i);
        session.poll();
    }
    CHECK(session.client->pulls_sent() < pulls);
    Wire last = test::header(6, atoms);
    const Wire x = test::number(native, static_cast<float>(pulls)),
               zero = test::number(native, 0.0F);
    for (const std::int32_t atom : all) last = std::move(last) + test::number(native, atom);
    for (std::int32_t i = 0; i < atoms; ++i) last = ((std::move(last) + x) + zero) + zero;

    const auto ends_with_last = [&] {
        session.engine.read();
        const Wire& got = session.engine.received;
        return got.size() > last.size() &&
               std::equal(last.begin(), last.end(),
                          got.end() - static_cast<std::ptrdiff_t>(last.size()));
    };
    session.until(ends_with_last);
    CHECK(session.engine.received.size() < (pulls / 2) * last.size());
}
