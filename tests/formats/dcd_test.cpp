#include "formats/dcd.h"

#include "tests/support/load_error_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trajectory_bytes.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::Bytes;
using test::load_error_of;

namespace {

std::unique_ptr<Trajectory> open_dcd_bytes(std::string bytes) {
    return open_dcd(ByteSource(std::move(bytes), "w.dcd"));
}

// What a hand writes: the header's numbers by their place in ICNTRL, from 1, and all else.
struct DcdByHand {
    std::endian order = std::endian::little;
    std::array<std::int32_t, 21> control{};
    const char* kind = "CORD";
    std::int32_t atoms = 3;
    std::vector<std::int32_t> moving;

    DcdByHand() {
        control[1] = 2;
        control[2] = 100;
        control[3] = 50;
        control[10] = std::bit_cast<std::int32_t>(0.04F);  // AKMA
        control[20] = 24;
    }

    std::string head() const {
        Bytes content(order);
        content.text = kind;
        for (std::size_t i = 1; i < control.size(); ++i) content.integer(control[i]);
        Bytes titles(order);
        titles.integer(2);
        titles.text += std::string("REMARKS one").append(69, ' ') + std::string(80, '*');
        Bytes bytes(order);
        bytes.record(content).record(titles).record(Bytes(order).integer(atoms));
        if (!moving.empty()) {
            Bytes list(order);
            for (const std::int32_t atom : moving) list.integer(atom);
            bytes.record(list);
        }
        return bytes.text;
    }

    // A record for each axis.
    std::string frame(const std::vector<std::vector<double>>& axes,
                      const std::vector<double>& cell = {}) const {
        Bytes bytes(order);
        if (!cell.empty()) {
            Bytes record(order);
            for (const double number : cell) record.add(number);
            bytes.record(record);
        }
        for (const auto& axis : axes) {
            Bytes record(order);
            for (const double x : axis) record.real(x);
            bytes.record(record);
        }
        return bytes.text;
    }
};

const std::vector<std::vector<double>> first{{1, 2, 3}, {-4, -5, -6}, {0.5, 0.25, 0.125}};
const std::vector<std::vector<double>> second{{10, 20, 30}, {-40, -50, -60}, {5, 2.5, 1.25}};
const std::vector<Vec3> first_positions{{1, -4, 0.5}, {2, -5, 0.25}, {3, -6, 0.125}};
const std::vector<Vec3> second_positions{{10, -40, 5}, {20, -50, 2.5}, {30, -60, 1.25}};

Mat3 box_of_cell(const std::vector<double>& cell, std::int32_t version) {
    DcdByHand hand;
    hand.control[11] = 1;
    hand.control[20] = version;
    TrajectoryFrame frame;
    open_dcd_bytes(hand.head() + hand.frame(first, cell))->read_frame(0, frame);
    return frame.box.value_or(Mat3::Zero());
}

}  // namespace

TEST_CASE("DCD frames are read from bytes put together by hand, in either order",
          "[formats][dcd]") {
    DcdByHand hand;
    hand.order = GENERATE(std::endian::little, std::endian::big);
    const auto trajectory = open_dcd_bytes(hand.head() + hand.frame(first) + hand.frame(second));
    TrajectoryFrame frame;

    trajectory->read_frame(1, frame);

    CHECK(trajectory->atom_count() == 3);
    CHECK(trajectory->frame_count() == 2);
    CHECK(trajectory->notes().empty());
    CHECK(frame.positions == second_positions);
    CHECK(frame.step == 150);
    // Steps of 0.04 AKMA units of 48.88821 fs.
    CHECK(*frame.time_ps == Approx(150 * 0.04 * 0.04888821).epsilon(1e-6));
    CHECK_FALSE(frame.box);
    trajectory->read_frame(0, frame);
    CHECK(frame.positions == first_positions);
    CHECK(frame.step == 100);
}

TEST_CASE("X-PLOR's DCD has a time step in double and no number of frames", "[formats][dcd]") {
    DcdByHand hand;
    hand.order = GENERATE(std::endian::little, std::endian::big);
    hand.control[1] = 0;
    hand.control[20] = 0;
    // A double where CHARMM has a float and the flag of the cell, which stays unread.
    const std::string bytes = hand.head().replace(4 + 40, 8, Bytes(hand.order).add(0.02).text) +
                              hand.frame(first) + hand.frame(second);
    const auto trajectory = open_dcd_bytes(bytes);
    TrajectoryFrame frame;

    trajectory->read_frame(0, frame);

    CHECK(trajectory->frame_count() == 2);
    CHECK(trajectory->notes().empty());
    CHECK(frame.positions == first_positions);
    CHECK(*frame.time_ps == Approx(100 * 0.02 * 0.04888821).epsilon(1e-6));
}

TEST_CASE("atoms that are fixed stay where the first frame has them", "[formats][dcd]") {
    DcdByHand hand;
    hand.order = GENERATE(std::endian::little, std::endian::big);
    hand.control[1] = 3;
    hand.control[9] = 1;
    hand.moving = {1, 3};
    const auto trajectory = open_dcd_bytes(hand.head() + hand.frame(first) +
                                           hand.frame({{7, 8}, {7.5, 8.5}, {7.25, 8.25}}) +
                                           hand.frame({{-7, -8}, {-7.5, -8.5}, {0, 1}}));

    CHECK(trajectory->frame_count() == 3);
    CHECK(test::positions_of(*trajectory, 2) ==
          std::vector<Vec3>{{-7, -7.5, 0}, first_positions[1], {-8, -8.5, 1}});
    CHECK(test::positions_of(*trajectory, 1) ==
          std::vector<Vec3>{{7, 7.5, 7.25}, first_positions[1], {8, 8.5, 8.25}});
    CHECK(test::positions_of(*trajectory, 0) == first_positions);
}

TEST_CASE("a fourth dimension is left out", "[formats][dcd]") {
    DcdByHand hand;
    hand.control[12] = 1;
    auto four = first;
    four.push_back({9, 9, 9});
    const auto trajectory = open_dcd_bytes(hand.head() + hand.frame(four) + hand.frame(four));

    CHECK(trajectory->frame_count() == 2);
    CHECK(test::positions_of(*trajectory, 1) == first_positions);
}

TEST_CASE("the cell is read as NAMD, CHARMM and older programs write it", "[formats][dcd]") {
    // a = (20, 0, 0), b = 30 at 60 degrees from a, c = (0, 0, 40).
    Mat3 expected;
    expected << 20, 15, 0, 0, 30 * std::sqrt(0.75), 0, 0, 0, 40;
    const Mat3 right = Vec3(20, 30, 40).asDiagonal();

    CHECK(box_of_cell({20, 0.5, 30, 0, 0, 40}, 24).isApprox(expected, 1e-12));   // cosines
    CHECK(box_of_cell({20, 60, 30, 90, 90, 40}, 24).isApprox(expected, 1e-12));  // degrees
    CHECK(box_of_cell({20, 60, 30, 90, 90, 40}, 24)(2, 0) == 0);
    CHECK(box_of_cell({20, 90, 30, 90, 90, 40}, 24) == right);
    CHECK(box_of_cell({20, 0, 30, 0, 0, 40}, 24) == right);
    // CHARMM's lower triangle of a symmetric matrix, in all versions that can be recognised and in
    // some that cannot: no angles could be negative.
    CHECK(box_of_cell({20, 0, 30, 0, 0, 40}, 39) == right);
    Mat3 symmetric;
    symmetric << 48, 13, 0.5, 13, 47, 2, 0.5, 2, 51;
    CHECK(box_of_cell({48, 13, 47, 0.5, 2, 51}, 39) == symmetric);
    symmetric << 48, -13, -0.5, -13, 47, -2, -0.5, -2, 51;
    CHECK(box_of_cell({48, -13, 47, -0.5, -2, 51}, 24) == symmetric);
    // No box at all.
    CHECK(box_of_cell({0, 0, 0, 0, 0, 0}, 24).isZero(0));
    CHECK(box_of_cell({0, 90, 0, 90, 90, 0}, 24).isZero(0));
    CHECK(box_of_cell({1, std::nan(""), 1, 0, 0, 1}, 24).isZero(0));
    CHECK(box_of_cell({10, 0.99, 10, -0.99, 0.99, 10}, 24).isZero(0));
}

TEST_CASE("a DCD file of MDAnalysis is read with the places that it was given", "[formats][dcd]") {
    const auto frames = test::read_text_frames("waters.dcd.txt");
    const auto trajectory =
        open_dcd(ByteSource(std::filesystem::path(test::trajectory_path("waters.dcd"))));

    REQUIRE(trajectory->frame_count() == frames.size());
    CHECK(trajectory->notes().empty());
    for (std::size_t i = frames.size(); i-- > 0;) {
        TrajectoryFrame frame;
        trajectory->read_frame(i, frame);
        REQUIRE(frame.positions.size() == frames[i].atoms.size());
        CHECK(frame.step == frames[i].step);
        CHECK(*frame.time_ps == Approx(frames[i].time).epsilon(1e-6));
        REQUIRE(frame.box);
        for (Eigen::Index k = 0; k < 9; ++k) {
            const double edge = frames[i].box[static_cast<std::size_t>(k)];
            CHECK((*frame.box)(k % 3, k / 3) == Approx(edge).epsilon(1e-5).margin(2e-5));
        }
        for (std::size_t atom = 0; atom < frame.positions.size(); ++atom) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                // Nine digits tell a float.
                CHECK(static_cast<float>(frame.positions[atom][static_cast<Eigen::Index>(axis)]) ==
                      static_cast<float>(frames[i].atoms[atom][axis]));
            }
        }
    }
}

TEST_CASE("what is written is to the byte what MDAnalysis has read", "[formats][dcd]") {
    // make_trajectories.py lets MDAnalysis read written.dcd and compares it with waters.dcd.
    const auto frames = test::read_text_frames("waters.dcd.txt");
    const test::TemporaryFolder folder;
    DcdOptions options;
    options.title = "written by palpa\nwaters";
    options.has_box = true;
    options.first_step = options.steps_between = 1250;
    options.timestep_ps = 0.002;

    DcdWriter writer(folder.path() / "w.dcd", frames[0].atoms.size(), options);
    for (const test::TextFrame& frame : frames) {
        std::vector<Vec3> positions;
        for (const auto& atom : frame.atoms) positions.emplace_back(atom[0], atom[1], atom[2]);
        Mat3 box;
        for (Eigen::Index k = 0; k < 9; ++k) {
            box(k % 3, k / 3) = frame.box[static_cast<std::size_t>(k)];
        }
        writer.add_frame(positions, box);
    }
    writer.close();

    const std::string is = test::bytes_of((folder.path() / "w.dcd").string());
    std::string expected = test::bytes_of(test::trajectory_path("written.dcd"));
    CHECK(is.size() == expected.size());
    // Cosines may differ in their last digits on other machines.
    const auto box_of = [](const std::string& bytes) {
        TrajectoryFrame frame;
        open_dcd_bytes(bytes)->read_frame(2, frame);
        return *frame.box;
    };
    CHECK(box_of(is).isApprox(box_of(expected), 1e-12));
    for (const std::size_t i : {0U, 1U, 2U}) {
        CHECK(test::positions_of(*open_dcd_bytes(is), i) ==
              test::positions_of(*open_dcd_bytes(expected), i));
    }
    CHECK(is.substr(0, 280) == expected.substr(0, 280));
}

TEST_CASE("frames are written as bytes put together by hand, and counted after each",
          "[formats][dcd]") {
    const test::TemporaryFolder folder;
    const auto path = folder.path() / "w.dcd";
    DcdOptions options;
    options.title = "REMARKS one\n" + std::string(100, '*');  // of which 80 are written
    options.first_step = 100;
    options.steps_between = 50;
    options.timestep_ps = 0.04 * 4.888821290839616e-2;
    DcdByHand hand;
    DcdWriter writer(path, 3, options);

    for (const int count : {0, 1, 2}) {
        if (count > 0) writer.add_frame(count == 1 ? first_positions : second_positions);
        hand.control[1] = count;
        hand.control[4] = 50 * count;
        // While the writer is open, as after a crash.
        CHECK(test::bytes_of(path.string()) == hand.head() + (count > 0 ? hand.frame(first) : "") +
                                                   (count > 1 ? hand.frame(second) : ""));
        CHECK(writer.frame_count() == static_cast<std::size_t>(count));
    }
    writer.close();
}

TEST_CASE("a DCD file cut anywhere is noted, and its whole frames are read", "[formats][dcd]") {
    DcdByHand hand;
    hand.control[11] = 1;
    if (GENERATE(false, true)) {
        hand.control[9] = 1;
        hand.moving = {1, 3};
    }
    const std::vector<double> cell{20, 0.5, 30, 0, 0, 40};
    const std::string whole =
        hand.head() + hand.frame(first, cell) +
        hand.frame(
            hand.moving.empty() ? second : std::vector<std::vector<double>>{{7, 8}, {7, 8}, {7, 8}},
            cell);
    const auto all = open_dcd_bytes(whole);
    std::size_t refused = 0, noted = 0;

    for (std::size_t length = 0; length < whole.size(); ++length) {
        INFO(length);
        const std::string error = load_error_of([&] {
            const auto cut = open_dcd_bytes(whole.substr(0, length));
            REQUIRE(cut->frame_count() == 1);
            REQUIRE_FALSE(cut->notes().empty());  // the header says of two
            REQUIRE_THAT(cut->notes().back(), Contains("announces 2 frames and contains 1"));
            REQUIRE(test::positions_of(*cut, 0) == test::positions_of(*all, 0));
            ++noted;
        });
        if (error != "no error") {
            ++refused;
            REQUIRE_THAT(error, Contains("w.dcd: ends"));
        }
    }

    CHECK(refused == hand.head().size() + hand.frame(first, cell).size());
    CHECK(noted == whole.size() - refused);
}

TEST_CASE("every damaged byte of a DCD file is a frame or a sentence", "[formats][dcd]") {
    DcdByHand hand;
    hand.control[9] = 1;
    hand.control[11] = 1;
    hand.moving = {1, 3};
    const std::string whole = hand.head() + hand.frame(first, {20, 0.5, 30, 0, 0, 40}) +
                              hand.frame({{7, 8}, {7, 8}, {7, 8}}, {20, 0.5, 30, 0, 0, 40});
    test::expect_frames_or_errors(whole, {0, 4, 7}, open_dcd_bytes);
}

TEST_CASE("what is wrong with a DCD file is reported", "[formats][dcd]") {
    const auto error_of_bytes = [](const std::string& bytes) {
        return load_error_of([&] { open_dcd_bytes(bytes); });
    };
    DcdByHand hand;
    const std::string frames = hand.frame(first) + hand.frame(second);

    CHECK_THAT(error_of_bytes(std::string(200, 'x')), Contains("w.dcd: is not a DCD file"));
    hand.kind = "VELD";
    CHECK_THAT(error_of_bytes(hand.head() + frames), Contains("velocities (VELD)"));
    hand.kind = "CORR";
    CHECK_THAT(error_of_bytes(hand.head() + frames), Contains("expected CORD"));
    hand = {};
    hand.control[13] = 1;
    CHECK_THAT(error_of_bytes(hand.head() + frames), Contains("charges"));
    hand = {};
    hand.atoms = 0;
    CHECK_THAT(error_of_bytes(hand.head() + frames), Contains("has 0 atoms"));
    hand = {};
    hand.control[9] = 3;
    CHECK_THAT(error_of_bytes(hand.head() + frames), Contains("3 of them fixed"));
    hand.control[9] = 1;
    hand.moving = {3, 1};
    CHECK_THAT(error_of_bytes(hand.head() + frames),
               Contains("atom 1") && Contains("follows atom 3"));
    hand.moving = {1, 4};
    CHECK_THAT(error_of_bytes(hand.head() + frames), Contains("atom 4"));
    hand = {};
    hand.atoms = 500'000'000;  // no memory for what the file has no room for
    CHECK(error_of_bytes(hand.head() + frames) ==
          "w.dcd: ends within its first frame: the file may have been cut off");
    hand = {};
    Bytes wide(std::endian::little);
    wide.add(std::int64_t{84}).text += "CORD" + std::string(80, '\0');
    CHECK_THAT(error_of_bytes(wide.text), Contains("record lengths of 8 bytes"));

    std::string damaged = hand.head() + frames;
    damaged[damaged.size() - 4] = 13;
    CHECK(load_error_of([&] { test::positions_of(*open_dcd_bytes(damaged), 1); }) ==
          "w.dcd: frame 2: the record length of the coordinates is 13 bytes; expected 12");
    CHECK(test::positions_of(*open_dcd_bytes(damaged), 0) == first_positions);
    auto infinite = second;
    infinite[1][2] = std::numeric_limits<double>::infinity();
    CHECK_THAT(load_error_of([&] {
                   const auto trajectory =
                       open_dcd_bytes(hand.head() + hand.frame(first) + hand.frame(infinite));
                   test::positions_of(*trajectory, 1);
               }),
               Contains("frame 2: atom 3 has the coordinate inf"));
    hand.control[1] = 7;
    CHECK(open_dcd_bytes(hand.head() + frames)->notes() ==
          std::vector<std::string>{"announces 7 frames and contains 2: the file may be cut off, or "
                                   "its writer was interrupted"});
}

TEST_CASE("what cannot be written to a DCD file is told", "[formats][dcd]") {
    const test::TemporaryFolder folder;
    const auto path = folder.path() / "w.dcd";
    DcdWriter writer(path, 3, {});
    DcdOptions with_box;
    with_box.has_box = true;
    DcdWriter boxed(folder.path() / "b.dcd", 3, with_box);
    const Mat3 box = Vec3(1, 2, 3).asDiagonal();
    Mat3 turned = box;
    turned(1, 0) = 0.5;
    auto positions = first_positions;

    CHECK_THAT(load_error_of([&] { DcdWriter(path, 3, {}); }), Contains("already exists"));
    CHECK_THAT(load_error_of([&] { DcdWriter(folder.path() / "no" / "w.dcd", 3, {}); }),
               Contains("cannot be written"));
    CHECK_THAT(load_error_of([&] { DcdWriter(folder.path() / "z.dcd", 0, {}); }),
               Contains("0 atoms"));
    CHECK_THAT(load_error_of([&] { writer.add_frame(positions, box); }),
               Contains("frame 1: the frame has a box; expected none"));
    CHECK_THAT(load_error_of([&] { boxed.add_frame(positions); }), Contains("no box"));
    CHECK_THAT(load_error_of([&] { boxed.add_frame(positions, turned); }),
               Contains("a DCD file cannot hold this box"));
    positions[1].z() = 1e6;
    CHECK_THAT(load_error_of([&] { writer.add_frame(positions); }),
               Contains("frame 1: atom 2 has the coordinate 1000000"));
    positions.pop_back();
    CHECK_THAT(load_error_of([&] { writer.add_frame(positions); }),
               Contains("2 atoms; expected 3"));
    CHECK(writer.frame_count() == 0);
    // Nothing of it is in the file.
    writer.add_frame(first_positions);
    writer.close();
    CHECK(test::positions_of(*open_dcd(ByteSource(path)), 0) == first_positions);
}
