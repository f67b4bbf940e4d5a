// 10,000 streams each to the decoder, a client and a server: in pieces of any size, cut off at any
// byte. Always a sentence; no force acts that was not asked for by good bytes.
#include "imd/client.h"
#include "imd/server.h"
#include "tests/imd/hostile_streams.h"
#include "tests/imd/peer.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

using namespace palpa;
using test::go;
using test::HostileStreams;
using test::leave;
using test::native;
using test::operator+;
using test::Peer;
using test::Wire;

namespace {

constexpr std::uint64_t streams = 10'000;

struct Outcome {
    std::size_t messages = 0, frames = 0;
    std::string problem;

    bool operator==(const Outcome&) const = default;
};

bool is_sound(const ImdMessage& message) {
    const bool has_two = message.type != ImdType::ClientForces || message.atoms.size() <= 2;
    return has_two && std::ranges::all_of(message.values, [&](float value) {
               return std::isfinite(value) &&
                      (message.type != ImdType::Positions || std::abs(value) <= 1e6F);
           });
}

bool is_one_line(const std::string& sentence) {
    return !sentence.empty() && sentence.size() < 300 && sentence.find('\n') == sentence.npos;
}

Outcome outcome_of(ImdDecoder decoder, const Wire& wire, const std::vector<std::size_t>& ends) {
    Outcome outcome;
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
        auto piece = std::span(wire).subspan(begin, end - begin);
        begin = end;
        while (!piece.empty() && decoder.problem().empty()) {
            piece = piece.subspan(decoder.take(piece));
            if (!decoder.message()) continue;
            ++outcome.messages;
            if (!is_sound(*decoder.message())) outcome.problem = "NOT SOUND";
            if (decoder.message()->completes_frame) ++outcome.frames;
        }
    }
    REQUIRE(is_one_line(decoder.find_place()));
    outcome.problem += decoder.problem();
    return outcome;
}

// Of a stream whole, which is that of its pieces.
Outcome checked_outcome(const ImdDecoder& decoder, const Wire& wire,
                        const std::vector<std::size_t>& ends) {
    const Outcome whole = outcome_of(decoder, wire, {wire.size()});
    CHECK((whole == outcome_of(decoder, wire, ends)));
    CHECK((whole.problem.empty() || is_one_line(whole.problem)));
    CHECK(whole.problem.find("NOT SOUND") == std::string::npos);
    return whole;
}

// What a client has said, read by hand: Go, then forces in the byte order of `is_turned`, then
// Disconnect, whole.
struct Said {
    bool is_orderly = false;  // nothing but these, in this order, as far as it came
    bool has_gone = false, has_left = false;
    std::size_t pulls = 0;      // messages with a force that is not zero
    bool ends_in_zeros = true;  // of the last message of forces
};

Said listen(const Wire& wire, std::size_t atoms) {
    Said said;
    std::size_t at = 0;
    const auto starts_with = [&](const Wire& words) {
        return wire.size() - at >= words.size() &&
               std::equal(words.begin(), words.end(),
                          wire.begin() + static_cast<std::ptrdiff_t>(at));
    };
    if (starts_with(go)) {
        said.has_gone = true;
        at += go.size();
        for (std::size_t count = atoms; count > 0;) {
            const Wire head = test::header(6, static_cast<std::int32_t>(count));
            if (!starts_with(head) || wire.size() - at < 8 + 16 * count) break;
            const auto forces = std::span(wire).subspan(at + 8 + 4 * count, 12 * count);
            said.ends_in_zeros =
                std::ranges::all_of(forces, [](std::byte byte) { return byte == std::byte{0}; });
            if (!said.ends_in_zeros) ++said.pulls;
            at += 8 + 16 * count;
        }
        said.has_left = starts_with(leave);
        if (said.has_left) at += leave.size();
    }
    said.is_orderly = at == wire.size();
    return said;
}

}  // namespace

TEST_CASE("no stream of an engine breaks the decoder, and splits change nothing",
          "[imd][hostile]") {
    std::size_t refused = 0, frames = 0;
    for (std::uint64_t i = 0; i < streams; ++i) {
        INFO("stream " << i);
        HostileStreams random(i);
        const Wire wire = random.from_engine();

        const Outcome whole =
            checked_outcome(ImdDecoder::of_engine({}), wire, random.splits(wire.size()));
        refused += whole.problem.empty() ? 0 : 1;
        frames += whole.frames;
    }
    // Both are many, or this shows nothing.
    CHECK(refused > streams / 4);
    CHECK(frames > streams / 4);
}

TEST_CASE("no stream of a client breaks the decoder, and splits change nothing", "[imd][hostile]") {
    std::size_t refused = 0, messages = 0;
    for (std::uint64_t i = 0; i < streams; ++i) {
        INFO("stream " << i);
        HostileStreams random(i);
        const int version = i % 2 == 0 ? 2 : 3;
        const Wire wire = random.from_client(version);
        const Outcome whole = checked_outcome(ImdDecoder::of_client(version, native, {.atoms = 2}),
                                              wire, random.splits(wire.size()));
        refused += whole.problem.empty() ? 0 : 1;
        messages += whole.messages;
    }
    CHECK(refused > streams / 4);
    CHECK(messages > streams);
}

TEST_CASE(
    "a client of a hostile engine is left with a sentence, and pulls nothing unless frames come",
    "[imd][hostile][slow]") {
    const Socket listening = test::listen_on_loopback();
    std::size_t pulled = 0, left = 0;
    for (std::uint64_t i = 0; i < streams; ++i) {
        INFO("stream " << i);
        HostileStreams random(i);
        const Wire wire = random.from_engine();
        ImdClient client({.port = listening.find_port(),
                          .limits = {.max_atoms = 1000},
                          .pulls_in_version_3 = true});
        client.connect(0);
        const auto poll = [&] {
            client.poll(0, 0);
            if (!client.frame()) return;
            const std::size_t atoms = client.frame()->coordinates.size();
            std::vector<std::int32_t> all(atoms);
            for (std::size_t k = 0; k < atoms; ++k) all[k] = static_cast<std::int32_t>(k);
            client.pull(all, std::vector<Vec3>(atoms, Vec3(1, 2, 3)));
        };
        Peer engine = test::accept_from(listening, poll);
        std::size_t begin = 0;
        for (const std::size_t end : random.splits(wire.size())) {
            engine.send(Wire(wire.begin() + static_cast<std::ptrdiff_t>(begin),
                             wire.begin() + static_cast<std::ptrdiff_t>(end)),
                        poll);
            begin = end;
            poll();
        }
        engine.end_writing();
        test::until([&] { return client.state() == ImdState::Lost; },
                    [&] { client.poll(0, test::a_moment_ms); });
        test::until(
            [&] {
                engine.read();
                return engine.is_ended;
            },
            [&] { client.poll(0, 1); });

        CHECK(is_one_line(client.why()));
        const std::size_t atoms = client.frame() ? client.frame()->coordinates.size() : 0;
        const Said said = listen(engine.received, atoms);
        CHECK(said.is_orderly);
        CHECK(said.pulls == client.pulls_sent());
        CHECK((client.frame() || said.pulls == 0));
        CHECK(said.ends_in_zeros);
        CHECK(said.has_left == said.has_gone);
        pulled += said.pulls > 0 ? 1 : 0;
        left += said.has_left ? 1 : 0;
    }
    CHECK(pulled > streams / 20);
    CHECK(left > streams / 4);
}

TEST_CASE("a server of hostile clients goes on, and no force of theirs outlives them",
          "[imd][hostile][slow]") {
    constexpr double started = 0;
    ImdServer server({.port = 0, .atoms = 2, .max_clients = 2});
    INFO("the loopback interface: " << server.problem());
    REQUIRE(server.problem().empty());
    const auto wait = [&] { server.poll(started, test::a_moment_ms); };
    Peer watcher(test::connect_on_loopback(server.port()));
    watcher.send(go);
    test::until([&] { return server.clients() == 1; }, wait);
    watcher.read();
    watcher.received.clear();
    server.take_notes();

    std::size_t pulled = 0;
    for (std::uint64_t i = 0; i < streams; ++i) {
        INFO("stream " << i);
        HostileStreams random(i);
        const Wire wire = random.from_client(2);
        Peer client(test::connect_on_loopback(server.port()));
        bool has_pulled = false;
        const auto poll = [&] {
            server.poll(started, 0);
            const ImdPull& pull = server.pull();
            has_pulled = has_pulled || !pull.atoms.empty();
            REQUIRE(pull.atoms.size() == pull.forces.size());
            REQUIRE(
                std::ranges::all_of(pull.atoms, [](auto atom) { return atom == 0 || atom == 1; }));
            REQUIRE(std::ranges::all_of(pull.forces,
                                        [](const Vec3& force) { return force.allFinite(); }));
        };
        std::size_t begin = 0;
        for (const std::size_t end : random.splits(wire.size())) {
            client.send(Wire(wire.begin() + static_cast<std::ptrdiff_t>(begin),
                             wire.begin() + static_cast<std::ptrdiff_t>(end)),
                        poll);
            begin = end;
            poll();
        }
        if (random.below(2) == 0) {
            client.end_writing();
        } else {
            client.close();
        }

        // A note says what became of it, whatever that was.
        std::vector<std::string> notes;
        const std::string name = "client " + std::to_string(i + 2) + " ";
        const auto is_end = [&](const std::string& note) {
            return note.starts_with(name) && note != name + "is watching" &&
                   note != name + "is pulling" && note.find(" may not ") == note.npos;
        };
        test::until(
            [&] {
                for (std::string& note : server.take_notes()) notes.push_back(std::move(note));
                return std::ranges::any_of(notes, is_end);
            },
            wait);
        CHECK(std::ranges::all_of(notes, is_one_line));
        CHECK(server.pull().atoms.empty());
        CHECK_FALSE(server.is_paused());
        CHECK_FALSE(server.is_killed());
        CHECK(server.clients() == 1);
        pulled += has_pulled ? 1 : 0;
        if (i % 100 != 0) continue;
        ImdFrame frame;
        frame.coordinates = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
        REQUIRE(server.count_step());
        server.send(frame);
        test::until(
            [&] { return watcher.has_received(test::vectors(native, 2, {1, 2, 3, 4, 5, 6})); },
            wait);
        watcher.received.clear();
    }
    CHECK(pulled > streams / 20);
}
