#include "formats/trr.h"

#include "tests/support/load_error_of.h"
#include "tests/support/trajectory_bytes.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::Bytes;
using test::load_error_of;

namespace {

std::unique_ptr<Trajectory> open_trr_bytes(std::string bytes) {
    return open_trr(ByteSource(std::move(bytes), "w.trr"));
}

// A frame of two atoms by GROMACS's manual, in single or double precision.
struct TrrByHand {
    bool is_double = false;
    bool box = true, virial = false, positions = true, velocities = true, forces = true;
    std::int32_t step = 5;
    std::int32_t atoms = 2;

    std::string text() const {
        const std::int32_t real = is_double ? 8 : 4;
        const auto bytes_if = [&](bool there, std::int32_t numbers) {
            return there ? real * numbers : 0;
        };
        Bytes bytes(std::endian::big);
        bytes.integer(1993).integer(13).integer(12);
        bytes.text += "GMX_trn_file";
        bytes.integer(0).integer(0);  // input record, energies
        bytes.integer(bytes_if(box, 9)).integer(bytes_if(virial, 9)).integer(0);
        bytes.integer(0).integer(0);  // topology, symbols
        for (const bool there : {positions, velocities, forces}) {
            bytes.integer(bytes_if(there, 3 * atoms));
        }
        bytes.integer(atoms).integer(step).integer(0);
        const auto add = [&](const std::vector<double>& numbers) {
            for (const double number : numbers) {
                if (is_double) {
                    bytes.add(number);
                } else {
                    bytes.real(number);
                }
            }
        };
        add({2.5, 0});  // time, lambda
        if (box) add({1, 0, 0, 0.5, 2, 0, 0.25, 0.125, 3});
        if (virial) add({9, 9, 9, 9, 9, 9, 9, 9, 9});
        if (positions) add({0.5, -1, 2, 0.125, 0.25, 0});
        if (velocities) add({1, 2, 4, -0.5, 0, 0});
        if (forces) add({418.4, 0, -41.84, 0, 4184, 0});
        return bytes.text;
    }
};

void check_trr_as_text(const std::string& name) {
    INFO(name);
    const auto frames = test::read_text_frames(name + ".txt");
    const auto trajectory =
        open_trr(ByteSource(std::filesystem::path(test::trajectory_path(name))));
    // nm, nm/ps and kJ/mol/nm.
    const std::array<double, 3> units{10, 10, 1 / 41.84};

    REQUIRE(trajectory->frame_count() == frames.size());
    CHECK(trajectory->notes().empty());
    for (std::size_t i = frames.size(); i-- > 0;) {
        TrajectoryFrame frame;
        trajectory->read_frame(i, frame);
        CHECK(frame.step == frames[i].step);
        CHECK(*frame.time_ps == Approx(frames[i].time).margin(1e-12));
        REQUIRE(frame.box);
        for (Eigen::Index k = 0; k < 9; ++k) {
            const double edge = 10 * frames[i].box[static_cast<std::size_t>(k)];
            CHECK((*frame.box)(k % 3, k / 3) == Approx(edge).epsilon(1e-5).margin(1e-5));
        }
        REQUIRE(frame.positions.size() == frames[i].atoms.size());
        const bool more = frames[i].atoms[0].size() == 9;
        REQUIRE(frame.velocities.size() == (more ? frame.positions.size() : 0));
        REQUIRE(frame.forces.size() == frame.velocities.size());
        const std::array<const std::vector<Vec3>*, 3> all{&frame.positions, &frame.velocities,
                                                          &frame.forces};
        for (std::size_t atom = 0; atom < frame.positions.size(); ++atom) {
            for (std::size_t k = 0; k < (more ? 9U : 3U); ++k) {
                const double is = (*all[k / 3])[atom][static_cast<Eigen::Index>(k % 3)];
                const double expected = units[k / 3] * frames[i].atoms[atom][k];
                // The text has six digits.
                CHECK(is == Approx(expected).epsilon(1e-5).margin(1e-6));
            }
        }
    }
}

}  // namespace

TEST_CASE("TRR frames are read from bytes put together by hand, single and double",
          "[formats][trr]") {
    TrrByHand hand;
    hand.is_double = GENERATE(false, true);
    hand.virial = GENERATE(false, true);
    const auto trajectory = open_trr_bytes(hand.text() + hand.text());
    TrajectoryFrame frame;

    trajectory->read_frame(1, frame);

    CHECK(trajectory->frame_count() == 2);
    CHECK(trajectory->atom_count() == 2);
    CHECK(frame.step == 5);
    CHECK(frame.time_ps == 2.5);
    Mat3 box;
    box << 10, 5, 2.5, 0, 20, 1.25, 0, 0, 30;
    CHECK(frame.box == box);
    CHECK(frame.positions == std::vector<Vec3>{{5, -10, 20}, {1.25, 2.5, 0}});
    CHECK(frame.velocities == std::vector<Vec3>{{10, 20, 40}, {-5, 0, 0}});
    // 418.4 kJ/mol/nm are 10 kcal/mol/Å.
    REQUIRE(frame.forces.size() == 2);
    CHECK((frame.forces[0] - Vec3(10, 0, -1)).norm() < 1e-6);
    CHECK((frame.forces[1] - Vec3(0, 100, 0)).norm() < 1e-5);
}

TEST_CASE("a TRR frame has what its sizes tell", "[formats][trr]") {
    TrrByHand hand;
    hand.is_double = GENERATE(false, true);
    hand.velocities = hand.box = false;
    TrajectoryFrame frame;
    frame.velocities.resize(9);

    open_trr_bytes(hand.text())->read_frame(0, frame);

    CHECK_FALSE(frame.box);
    CHECK(frame.positions[0] == Vec3(5, -10, 20));
    CHECK(frame.velocities.empty());
    CHECK(frame.forces.size() == 2);
}

TEST_CASE("frames without positions are left out and counted", "[formats][trr]") {
    TrrByHand hand, without;
    without.positions = false;
    const auto trajectory =
        open_trr_bytes(without.text() + hand.text() + without.text() + hand.text());

    CHECK(trajectory->frame_count() == 2);
    CHECK(test::positions_of(*trajectory, 1)[0] == Vec3(5, -10, 20));
    CHECK(trajectory->notes() == std::vector<std::string>{"2 frames without positions ignored"});
    CHECK(load_error_of([&] { open_trr_bytes(without.text()); }) ==
          "w.trr: has no frame with positions");
}

TEST_CASE("TRR files of MDAnalysis and GROMACS are read as gmx dump prints them",
          "[formats][trr]") {
    check_trr_as_text("waters.trr");
    check_trr_as_text("waters_double.trr");  // with GROMACS in double precision
}

TEST_CASE("a TRR file cut anywhere is noted, and its whole frames are read", "[formats][trr]") {
    TrrByHand hand;
    hand.is_double = GENERATE(false, true);
    const std::string one = hand.text(), whole = one + one;
    std::size_t refused = 0, noted = 0;

    for (std::size_t length = 0; length < whole.size(); ++length) {
        INFO(length);
        const std::string error = load_error_of([&] {
            const auto cut = open_trr_bytes(whole.substr(0, length));
            REQUIRE(cut->frame_count() == 1);
            REQUIRE(cut->notes().empty() == (length == one.size()));
            REQUIRE(test::positions_of(*cut, 0)[1] == Vec3(1.25, 2.5, 0));
            ++noted;
        });
        if (error != "no error") {
            ++refused;
            REQUIRE_THAT(error, Contains("w.trr: ends within its first frame") ||
                                    Contains("w.trr: is empty"));
        }
    }

    CHECK(refused == one.size());
    CHECK(noted == one.size());
}

TEST_CASE("every damaged byte of a TRR file is a frame or a sentence", "[formats][trr]") {
    TrrByHand hand;
    hand.is_double = GENERATE(false, true);
    const std::string whole = hand.text() + hand.text();
    test::expect_frames_or_errors(whole, {0, 4, 7}, open_trr_bytes);
}

TEST_CASE("what is wrong with a TRR file is reported with its frame", "[formats][trr]") {
    const std::string one = TrrByHand{}.text();
    const auto open_error = [](std::string bytes) {
        return load_error_of([&] { open_trr_bytes(std::move(bytes)); });
    };
    const auto with = [&](std::size_t at, std::int32_t value) {
        return std::string(one).replace(at, 4, Bytes(std::endian::big).integer(value).text);
    };

    CHECK(open_error(one + with(0, 1995)) ==
          "w.trr: frame 2: begins with 1995; expected 1993, as every frame of a TRR file");
    CHECK_THAT(open_error(with(12, 0)), Contains("frame 1: has a different TRR version"));
    CHECK_THAT(open_error(with(24, -4)), Contains("frame 1: has a block of -4 bytes"));
    CHECK_THAT(open_error(with(64, 0)), Contains("frame 1: has 0 atoms"));
    CHECK_THAT(open_error(with(52, 28)),
               Contains("frame 1: has a block of 28 bytes for 6 numbers"));
    CHECK_THAT(open_error(with(64, 1'000'000'000)), Contains("a block of 24 bytes for 3000000000"));
    TrrByHand more;
    more.atoms = 3;
    more.box = more.positions = more.velocities = more.forces = false;
    std::string three = more.text();
    three.replace(52, 4, Bytes(std::endian::big).integer(36).text).append(36, '\0');
    CHECK_THAT(open_error(one + three), Contains("frame 2: has 3 atoms; expected 2"));
    const std::string nan = with(one.size() - 4, 0x7fc00000);
    CHECK(load_error_of([&] { test::positions_of(*open_trr_bytes(nan), 0); }) ==
          "w.trr: frame 1: atom 2 has a force that is not a finite number");
}
