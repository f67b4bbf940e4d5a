#include "imd/messages.h"

#include "tests/imd/wire.h"

#include <array>
#include <catch2/catch.hpp>
#include <limits>
#include <string>
#include <vector>

using namespace palpa;
using test::go;
using test::hex;
using test::operator+;
using test::Wire;

namespace {

using Splits = std::vector<std::size_t>;

// All messages of a stream that comes in pieces which end at `splits`.
std::vector<ImdMessage> decode(ImdDecoder& decoder, const Wire& wire, const Splits& splits = {}) {
    std::vector<ImdMessage> messages;
    std::size_t begin = 0;
    Splits ends = splits;
    ends.push_back(wire.size());
    for (const std::size_t end : ends) {
        std::span<const std::byte> piece = std::span(wire).subspan(begin, end - begin);
        while (!piece.empty() && decoder.problem().empty()) {
            piece = piece.subspan(decoder.take(piece));
            if (decoder.message()) messages.push_back(*decoder.message());
        }
        begin = end;
    }
    return messages;
}

Splits every_byte(const Wire& wire) {
    Splits splits;
    for (std::size_t i = 0; i < wire.size(); ++i) splits.push_back(i);
    return splits;
}

struct HandWritten {
    std::endian order;
    Wire wire;
};

// A handshake of version 2; energies of step 7: 300 K, -1.5 in all, 2, 0.5, 1, 10, -2, 4, 0.25;
// coordinates (1, 2, 0.5), (-1.5, 10, 0) of two atoms.
const std::array<HandWritten, 2> version_2{
    {{std::endian::little, hex("00000004 02000000"
                               "00000001 00000001 07000000"
                               "00009643 0000c0bf 00000040 0000003f 0000803f 00002041 000000c0"
                               "00008040 0000803e"
                               "00000002 00000002"
                               "0000803f 00000040 0000003f 0000c0bf 00002041 00000000")},
     {std::endian::big, hex("00000004 00000002"
                            "00000001 00000001 00000007"
                            "43960000 bfc00000 40000000 3f000000 3f800000 41200000 c0000000"
                            "40800000 3e800000"
                            "00000002 00000002"
                            "3f800000 40000000 3f000000 bfc00000 41200000 00000000")}}};

// A handshake of version 3; a session of everything, wrapped; time of step 2^32 + 1: 0.002 ps at
// 1.5 ps; the same energies; a box of 10, 10, 2 Å; one atom with coordinates (1, 2, 0.5),
// velocities (0.5, 0.25, 0) and forces (-2, 4, 10).
const std::array<HandWritten, 2> version_3{
    {{std::endian::little, hex("00000004 03000000"
                               "0000000a 00000007 01010101010101"
                               "0000000c 00000001"
                               "fca9f1d24d62603f 000000000000f83f 0100000001000000"
                               "00000001 00000001 07000000"
                               "00009643 0000c0bf 00000040 0000003f 0000803f 00002041 000000c0"
                               "00008040 0000803e"
                               "0000000d 00000001"
                               "00002041 00000000 00000000 00000000 00002041 00000000 00000000"
                               "00000000 00000040"
                               "00000002 00000001 0000803f 00000040 0000003f"
                               "0000000e 00000001 0000003f 0000803e 00000000"
                               "0000000f 00000001 000000c0 00008040 00002041")},
     {std::endian::big, hex("00000004 00000003"
                            "0000000a 00000007 01010101010101"
                            "0000000c 00000001"
                            "3f60624dd2f1a9fc 3ff8000000000000 0000000100000001"
                            "00000001 00000001 00000007"
                            "43960000 bfc00000 40000000 3f000000 3f800000 41200000 c0000000"
                            "40800000 3e800000"
                            "0000000d 00000001"
                            "41200000 00000000 00000000 00000000 41200000 00000000 00000000"
                            "00000000 40000000"
                            "00000002 00000001 3f800000 40000000 3f000000"
                            "0000000e 00000001 3f000000 3e800000 00000000"
                            "0000000f 00000001 c0000000 40800000 41200000")}}};

const ImdEnergies energies_of_step_7{.step = 7,
                                     .temperature_kelvin = 300,
                                     .total = -1.5F,
                                     .potential = 2,
                                     .van_der_waals = 0.5F,
                                     .coulomb = 1,
                                     .bonds = 10,
                                     .angles = -2,
                                     .dihedrals = 4,
                                     .impropers = 0.25F};

// What a client says: go, forces (1, 2, 0.5) on atom 3 and (-1.5, 10, 0) on atom 0, pause, a rate
// of 5, kill, disconnect, with numbers that mean nothing where there are none.
const std::array<HandWritten, 2> client_of_version_2{
    {{std::endian::little, hex("00000003 0000007f"
                               "00000006 00000002 03000000 00000000"
                               "0000803f 00000040 0000003f 0000c0bf 00002041 00000000"
                               "00000007 ffffffff 00000008 00000005 00000005 00000000"
                               "00000000 00000000")},
     {std::endian::big, hex("00000003 0000007f"
                            "00000006 00000002 00000003 00000000"
                            "3f800000 40000000 3f000000 bfc00000 41200000 00000000"
                            "00000007 ffffffff 00000008 00000005 00000005 00000000"
                            "00000000 00000000")}}};

void check_version_2(const std::vector<ImdMessage>& messages) {
    REQUIRE(messages.size() == 3);
    CHECK(messages[0].type == ImdType::Handshake);
    CHECK(messages[0].number == 2);
    CHECK(messages[1].type == ImdType::Energies);
    CHECK(messages[1].energies == energies_of_step_7);
    CHECK_FALSE(messages[1].completes_frame);
    CHECK(messages[2].type == ImdType::Positions);
    CHECK(messages[2].values == std::vector<float>{1, 2, 0.5F, -1.5F, 10, 0});
    CHECK(messages[2].completes_frame);
}

void check_version_3(const std::vector<ImdMessage>& messages) {
    REQUIRE(messages.size() == 8);
    CHECK(messages[0].number == 3);
    CHECK(messages[1].type == ImdType::Session);
    CHECK(messages[1].session == ImdSession{true, true, true, true, true, true, true});
    CHECK(messages[2].type == ImdType::Time);
    CHECK(messages[2].time == ImdTime{0.002, 1.5, (std::int64_t{1} << 32) + 1});
    CHECK(messages[3].energies == energies_of_step_7);
    CHECK(messages[4].type == ImdType::Box);
    CHECK(messages[4].box == ImdBox{10, 0, 0, 0, 10, 0, 0, 0, 2});
    CHECK(messages[5].values == std::vector<float>{1, 2, 0.5F});
    CHECK(messages[6].type == ImdType::Velocities);
    CHECK(messages[6].values == std::vector<float>{0.5F, 0.25F, 0});
    CHECK_FALSE(messages[6].completes_frame);
    CHECK(messages[7].type == ImdType::Forces);
    CHECK(messages[7].values == std::vector<float>{-2, 4, 10});
    CHECK(messages[7].completes_frame);
}

void check_client(const std::vector<ImdMessage>& messages) {
    REQUIRE(messages.size() == 6);
    CHECK(messages[0].type == ImdType::Go);
    CHECK(messages[1].type == ImdType::ClientForces);
    CHECK(messages[1].atoms == std::vector<std::int32_t>{3, 0});
    CHECK(messages[1].values == std::vector<float>{1, 2, 0.5F, -1.5F, 10, 0});
    CHECK(messages[2].type == ImdType::Pause);
    CHECK(messages[3].type == ImdType::Rate);
    CHECK(messages[3].number == 5);
    CHECK(messages[4].type == ImdType::Kill);
    CHECK(messages[5].type == ImdType::Disconnect);
}

// The same whole, split in two anywhere, and byte by byte.
template <class Make, class Check>
void check_splits(const Wire& wire, const Make& make, const Check& check) {
    std::vector<Splits> all{{}, every_byte(wire)};
    for (std::size_t at = 1; at < wire.size(); ++at) all.push_back({at});
    for (const Splits& splits : all) {
        INFO("first split " << (splits.empty() ? 0 : splits[0]) << " of " << splits.size());
        ImdDecoder decoder = make();
        check(decode(decoder, wire, splits));
        CHECK(decoder.problem().empty());
        CHECK(decoder.find_place() == "between two messages");
    }
}

std::string problem_of(const Wire& wire, const ImdLimits& limits = {}) {
    ImdDecoder decoder = ImdDecoder::of_engine(limits);
    decode(decoder, wire);
    return decoder.problem();
}

std::string problem_of_client(const Wire& wire, int version = 2) {
    ImdDecoder decoder = ImdDecoder::of_client(version, std::endian::big, {.atoms = 4});
    decode(decoder, wire);
    return decoder.problem();
}

const Wire greeting = hex("00000004 00000002");
const Wire greeting_3 = hex("00000004 00000003");

// One atom at (x, 0, 0), big-endian.
Wire atom_at(float x) { return test::vectors(std::endian::big, 2, {x, 0, 0}); }

}  // namespace

TEST_CASE("frames of version 2 are read in both byte orders, however they are split",
          "[imd][decoder]") {
    for (const HandWritten& written : version_2) {
        check_splits(written.wire, [] { return ImdDecoder::of_engine({}); }, check_version_2);

        ImdDecoder decoder = ImdDecoder::of_engine({.atoms = 2});
        decode(decoder, written.wire);
        CHECK(decoder.version() == 2);
        CHECK((decoder.order() == written.order));
        CHECK(decoder.atoms() == 2);
    }
}

TEST_CASE("frames of version 3 are read in both byte orders, however they are split",
          "[imd][decoder]") {
    for (const HandWritten& written : version_3) {
        check_splits(written.wire, [] { return ImdDecoder::of_engine({}); }, check_version_3);

        ImdDecoder decoder = ImdDecoder::of_engine({});
        decode(decoder, hex("00000004 00000003"));
        CHECK_FALSE(decoder.is_ready());
        decode(decoder, hex("0000000a 00000007 00000001000000"));
        CHECK(decoder.is_ready());
        const ImdSession expected{.coordinates = true};
        CHECK(decoder.message()->session == expected);
    }
}

TEST_CASE("what clients say is read in both byte orders, however it is split", "[imd][decoder]") {
    for (const HandWritten& written : client_of_version_2) {
        const auto make = [&] { return ImdDecoder::of_client(2, written.order, {.atoms = 4}); };
        check_splits(written.wire, make, check_client);
    }

    ImdDecoder decoder = ImdDecoder::of_client(3, std::endian::little, {.atoms = 4});
    const auto messages =
        decode(decoder,
               go + hex("00000006 00000000 0000000b 00000000 00000010 00000001 00000008 ffffffff"));
    REQUIRE(messages.size() == 5);
    CHECK(messages[1].type == ImdType::ClientForces);
    CHECK(messages[1].atoms.empty());
    CHECK(messages[1].values.empty());
    CHECK(messages[2].type == ImdType::Resume);
    CHECK(messages[3].type == ImdType::Wait);
    CHECK(messages[3].number == 1);
    CHECK(messages[4].number == -1);
}

TEST_CASE("what is written has the bytes that were written by hand", "[imd][encoder]") {
    for (const HandWritten& written : version_2) {
        ImdBytes bytes;
        add_imd_handshake(bytes, 2, written.order);
        add_imd_energies(bytes, written.order, energies_of_step_7);
        add_imd_vectors(bytes, written.order, ImdType::Positions,
                        std::array{1.0F, 2.0F, 0.5F, -1.5F, 10.0F, 0.0F});
        CHECK((bytes == written.wire));
    }
    for (const HandWritten& written : version_3) {
        ImdBytes bytes;
        add_imd_handshake(bytes, 3, written.order);
        add_imd_session(bytes, {true, true, true, true, true, true, true});
        add_imd_time(bytes, written.order, {0.002, 1.5, (std::int64_t{1} << 32) + 1});
        add_imd_energies(bytes, written.order, energies_of_step_7);
        add_imd_box(bytes, written.order, {10, 0, 0, 0, 10, 0, 0, 0, 2});
        add_imd_vectors(bytes, written.order, ImdType::Positions, std::array{1.0F, 2.0F, 0.5F});
        add_imd_vectors(bytes, written.order, ImdType::Velocities, std::array{0.5F, 0.25F, 0.0F});
        add_imd_vectors(bytes, written.order, ImdType::Forces, std::array{-2.0F, 4.0F, 10.0F});
        CHECK((bytes == written.wire));
    }
    for (const HandWritten& written : client_of_version_2) {
        ImdBytes bytes;
        add_imd_command(bytes, ImdType::Go, 127);
        add_imd_client_forces(bytes, written.order, std::array<std::int32_t, 2>{3, 0},
                              std::array{1.0F, 2.0F, 0.5F, -1.5F, 10.0F, 0.0F});
        add_imd_command(bytes, ImdType::Pause, -1);
        add_imd_command(bytes, ImdType::Rate, 5);
        add_imd_command(bytes, ImdType::Kill);
        add_imd_command(bytes, ImdType::Disconnect);
        CHECK((bytes == written.wire));
    }
}

TEST_CASE("in version 2 messages come in any order, and coordinates complete a frame",
          "[imd][decoder]") {
    ImdDecoder decoder = ImdDecoder::of_engine({});
    const Wire energy = test::energies(std::endian::big, 1, std::vector<float>(9));

    const auto messages =
        decode(decoder, greeting + atom_at(1) + atom_at(2) + energy + energy + atom_at(3));

    CHECK(decoder.problem().empty());
    REQUIRE(messages.size() == 6);
    CHECK(messages[1].completes_frame);
    CHECK(messages[2].completes_frame);
    CHECK_FALSE(messages[4].completes_frame);
    CHECK(messages[5].values[0] == 3);
}

TEST_CASE("a greeting that is not one of version 2 or 3 is refused", "[imd][decoder]") {
    CHECK(problem_of(hex("00000004 00000001")) == "a handshake of version 1 came, expected 2 or 3");
    CHECK(problem_of(hex("00000004 07000000")) == "a handshake of version 7 came, expected 2 or 3");
    CHECK(problem_of(hex("00000004 ffffffff")) ==
          "a handshake of version 4294967295 came, expected 2 or 3");
    CHECK(problem_of(atom_at(0)) == "a 'coordinates' message came first, expected a handshake");
    CHECK(problem_of(hex("04000000 02000000")) ==
          "a message of type 67108864 came, expected one from 0 to 16");
    CHECK(problem_of(hex("48545450 2f312e31")) ==  // HTTP/1.1
          "a message of type 1213486160 came, expected one from 0 to 16");
    CHECK(problem_of(greeting + greeting) == "a 'handshake' message came, expected one of a frame");
    CHECK(problem_of(greeting_3 + atom_at(0)) ==
          "a 'coordinates' message came after the handshake, expected the session");
    CHECK(problem_of(greeting_3 + hex("0000000a 00000008")) ==
          "a 'session' message came with a length of 8, expected 7");
}

TEST_CASE("lengths that are negative, too large or not those of the type are refused",
          "[imd][decoder]") {
    CHECK(problem_of(greeting + hex("00000002 80000000")) ==
          "a 'coordinates' message came with a length of -2147483648, expected 1 to 1000000 atoms");
    CHECK(problem_of(greeting + hex("00000002 ffffffff")) ==
          "a 'coordinates' message came with a length of -1, expected 1 to 1000000 atoms");
    CHECK(problem_of(greeting + hex("00000002 7fffffff"), {.max_atoms = 5000}) ==
          "a 'coordinates' message came with a length of 2147483647, expected 1 to 5000 atoms");
    CHECK(problem_of(greeting + hex("00000002 00000000")) ==
          "a 'coordinates' message came with a length of 0, expected 1 to 1000000 atoms");
    CHECK(problem_of(greeting + hex("00000002 00000003"), {.atoms = 2}) ==
          "a 'coordinates' message came with a length of 3, expected 2 atoms");
    CHECK(problem_of(greeting + hex("00000001 00000000")) ==
          "a 'energies' message came with a length of 0, expected 1");
    CHECK(problem_of_client(go + hex("00000006 80000000")) ==
          "a 'client forces' message came with a length of -2147483648, expected 0 to 4 atoms");
    CHECK(problem_of_client(go + hex("00000006 00000005")) ==
          "a 'client forces' message came with a length of 5, expected 0 to 4 atoms");
}

TEST_CASE("a number of atoms that changes is refused", "[imd][decoder]") {
    CHECK(problem_of(greeting + atom_at(0) + hex("00000002 00000002")) ==
          "a 'coordinates' message came with a length of 2, expected 1 atoms");
    CHECK(problem_of(greeting_3 + hex("0000000a 00000007 00000001000100") + atom_at(0) +
                     hex("0000000e 00000002")) ==
          "a 'velocities' message came with a length of 2, expected 1 atoms");
}

TEST_CASE("types that are unknown, of the other side or of another version are refused",
          "[imd][decoder]") {
    CHECK(problem_of(greeting + hex("00000011 00000000")) ==
          "a message of type 17 came, expected one from 0 to 16");
    CHECK(problem_of(greeting + hex("ffffffff 00000000")) ==
          "a message of type -1 came, expected one from 0 to 16");
    CHECK(problem_of(greeting + hex("00000006 00000001")) ==
          "a 'client forces' message came, expected one of a frame");
    CHECK(problem_of(greeting + hex("0000000e 00000001")) ==
          "a 'velocities' message came, which version 2 does not have");
    CHECK(problem_of_client(hex("00000006 00000001")) ==
          "a 'client forces' message came, expected go");
    CHECK(problem_of_client(go + go) == "a 'go' message came, expected forces or a command");
    CHECK(problem_of_client(go + hex("0000000b 00000000")) ==
          "a 'resume' message came, which version 2 does not have");
    CHECK(problem_of_client(go + atom_at(0)) ==
          "a 'coordinates' message came, expected forces or a command");
}

TEST_CASE("in version 3 frames have what was announced, in that order", "[imd][decoder]") {
    const Wire with_velocities = hex("0000000a 00000007 00000001000100");
    CHECK(problem_of(greeting_3 + with_velocities + hex("0000000e 00000001")) ==
          "a 'velocities' message came, expected coordinates");
    CHECK(problem_of(greeting_3 + with_velocities + atom_at(0) + atom_at(0)) ==
          "a 'coordinates' message came, expected velocities");
    CHECK(problem_of(greeting_3 + hex("0000000a 00000007 00000000000000") + atom_at(0)) ==
          "a 'coordinates' message came, expected none, as the session announced");
}

TEST_CASE("numbers that are not finite or absurd are refused", "[imd][decoder]") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinite = std::numeric_limits<float>::infinity();
    CHECK(problem_of(greeting + atom_at(1e6F)).empty());
    CHECK(problem_of(greeting + atom_at(-1.1e6F)) ==
          "a 'coordinates' message came with -1100000 for its atom 0, expected numbers "
          "within a million Å");
    for (const float bad : {nan, infinite, -infinite}) {
        CHECK(!problem_of(greeting + atom_at(bad)).empty());
        CHECK(!problem_of(greeting +
                          test::energies(std::endian::big, 0, {1, 1, 1, 1, bad, 1, 1, 1, 1}))
                   .empty());
        CHECK(!problem_of_client(go + test::client_forces(std::endian::big, {0}, {0, 0, bad}))
                   .empty());
        CHECK(!problem_of(greeting_3 + hex("0000000a 00000007 00000001000001") + atom_at(0) +
                          test::vectors(std::endian::big, 15, {0, bad, 0}))
                   .empty());
        CHECK(!problem_of(greeting_3 + hex("0000000a 00000007 00000101000000") +
                          hex("0000000d 00000001") +
                          test::floats(std::endian::big, {1, 0, 0, 0, bad, 0, 0, 0, 1}))
                   .empty());
        CHECK(!problem_of(greeting_3 + hex("0000000a 00000007 01000001000000") +
                          hex("0000000c 00000001") + test::number(std::endian::big, double{bad}) +
                          test::number(std::endian::big, 1.0) +
                          test::number(std::endian::big, std::int64_t{1}))
                   .empty());
    }
    CHECK(problem_of_client(go + test::client_forces(std::endian::big, {0}, {0, 0, 2e6F})) ==
          "a 'client forces' message came with 2000000 for its atom 0, expected numbers "
          "within a million");
}

TEST_CASE("forces on atoms that are not there, or twice on one, are refused", "[imd][decoder]") {
    CHECK(problem_of_client(go + test::client_forces(std::endian::big, {4}, {0, 0, 0})) ==
          "a force on atom 4 came, expected one from 0 to 3");
    CHECK(problem_of_client(go + test::client_forces(std::endian::big, {-1}, {0, 0, 0})) ==
          "a force on atom -1 came, expected one from 0 to 3");
    CHECK(problem_of_client(
              go + test::client_forces(std::endian::big, {2, 1, 2}, std::vector<float>(9))) ==
          "two forces on atom 2 came, expected one at most");
}

TEST_CASE("nothing is taken after a problem, and a stream that is cut has a place",
          "[imd][decoder]") {
    ImdDecoder broken = ImdDecoder::of_engine({});
    decode(broken, hex("00000004 00000009"));
    CHECK(broken.take(greeting) == 0);
    CHECK_FALSE(broken.message());

    ImdDecoder cut = ImdDecoder::of_engine({});
    decode(cut, greeting + hex("00000002 00000002 3f800000 40"));
    CHECK(cut.find_place() == "inside a 'coordinates' message, after 5 of 24 bytes");
    ImdDecoder early = ImdDecoder::of_engine({});
    decode(early, hex("000000"));
    CHECK(early.find_place() == "inside a header, after 3 of 8 bytes");
}
