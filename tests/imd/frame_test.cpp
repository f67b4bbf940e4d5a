#include "imd/frame.h"

#include "tests/imd/wire.h"

#include <catch2/catch.hpp>
#include <vector>

using namespace palpa;
using test::hex;
using test::operator+;
using test::Wire;

namespace {

constexpr std::endian little = std::endian::little;

std::vector<ImdFrame> frames_of(const Wire& wire, const ImdUnits& units) {
    ImdDecoder decoder = ImdDecoder::of_engine({});
    ImdFrameBuilder builder(units);
    std::vector<ImdFrame> frames;
    std::span<const std::byte> left = wire;
    ImdFrame frame;
    while (!left.empty()) {
        left = left.subspan(decoder.take(left));
        REQUIRE(decoder.problem().empty());
        if (decoder.message() && builder.add(*decoder.message(), frame)) frames.push_back(frame);
    }
    return frames;
}

}  // namespace

TEST_CASE("a frame of version 2 has the energies that came before its coordinates",
          "[imd][frame]") {
    const Wire first = test::vectors(little, 2, {1, 2, 3});
    const Wire second = test::energies(little, 12, {300, 41.84F, 4.184F, 1, 1, 1, 1, 1, 1}) +
                        test::vectors(little, 2, {4, 5, 6});

    const auto frames =
        frames_of(test::handshake(little, 2) + first + second + first, imd_units_of_gromacs);

    REQUIRE(frames.size() == 3);
    CHECK_FALSE(frames[0].energies);
    CHECK_FALSE(frames[0].find_step());
    CHECK(frames[0].coordinates == std::vector<Vec3>{Vec3(1, 2, 3)});
    REQUIRE(frames[1].energies);
    CHECK(frames[1].find_step() == 12);
    CHECK(frames[1].energies->temperature_kelvin == 300);
    CHECK_THAT(frames[1].energies->total, Catch::WithinRel(10.0, 1e-6));  // kJ/mol to kcal/mol
    CHECK_THAT(frames[1].energies->potential, Catch::WithinRel(1.0, 1e-6));
    CHECK(frames[1].coordinates == std::vector<Vec3>{Vec3(4, 5, 6)});
    CHECK_FALSE(frames[2].energies);
}

TEST_CASE("a frame of version 3 is in kcal/mol, Å and ps", "[imd][frame]") {
    const Wire wire = test::handshake(little, 3) + hex("0000000a 00000007 01 00 01 01 00 01 01") +
                      test::header(12, 1) + test::number(little, 0.001) +
                      test::number(little, 2.5) + test::number(little, std::int64_t{2500}) +
                      test::header(13, 1) + test::floats(little, {9, 0, 0, 0, 8, 0, 0, 0, 7}) +
                      test::vectors(little, 2, {1, 2, 3}) + test::vectors(little, 14, {4, 5, 6}) +
                      test::vectors(little, 15, {41.84F, 0, -4.184F});

    const auto frames = frames_of(wire, imd_units_of(3));

    REQUIRE(frames.size() == 1);
    CHECK(frames[0].find_step() == 2500);
    CHECK(frames[0].time->now_ps == 2.5);
    CHECK((*frames[0].box)[4] == 8);
    CHECK(frames[0].velocities == std::vector<Vec3>{Vec3(4, 5, 6)});
    REQUIRE(frames[0].forces.size() == 1);
    CHECK((frames[0].forces[0] - Vec3(10, 0, -1)).norm() < 1e-5);
}

TEST_CASE("a written frame has the bytes that were written by hand", "[imd][frame]") {
    ImdFrame frame;
    frame.time = ImdTime{0.002, 1.5, 750};
    frame.energies = ImdEnergies{.step = 750, .temperature_kelvin = 300, .total = 10};
    frame.coordinates = {Vec3(1, 2, 3)};
    frame.velocities = {Vec3(4, 5, 6)};
    frame.forces = {Vec3(10, 0, 0)};
    const ImdUnits units{.energy = 4, .force = 8};

    ImdBytes second;
    add_imd_frame(second, 2, std::endian::big, {}, units, frame);
    CHECK((second == test::energies(std::endian::big, 750, {300, 40, 0, 0, 0, 0, 0, 0, 0}) +
                         test::vectors(std::endian::big, 2, {1, 2, 3})));

    ImdBytes third;
    add_imd_frame(
        third, 3, little,
        {.time = true, .box = true, .coordinates = true, .velocities = true, .forces = true}, units,
        frame);
    CHECK((third == test::header(12, 1) + test::number(little, 0.002) + test::number(little, 1.5) +
                        test::number(little, std::int64_t{750}) + test::header(13, 1) +
                        test::floats(little, std::vector<float>(9)) +
                        test::vectors(little, 2, {1, 2, 3}) + test::vectors(little, 14, {4, 5, 6}) +
                        test::vectors(little, 15, {80, 0, 0})));
}

TEST_CASE("forces of clients go out in the wire's unit", "[imd][frame]") {
    const std::vector<Vec3> forces{Vec3(1, -2, 0.5)};
    CHECK(to_imd_forces(forces, imd_units_of_namd) == std::vector<float>{1, -2, 0.5F});
    CHECK(to_imd_forces(forces, imd_units_of_gromacs) == std::vector<float>{1, -2, 0.5F});
    CHECK(to_imd_forces(forces, imd_units_of_version_3) ==
          std::vector<float>{4.184F, -8.368F, 2.092F});
}
