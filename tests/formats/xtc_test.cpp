#include "formats/xtc.h"

#include "formats/xtc_packing.h"
#include "tests/support/load_error_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trajectory_bytes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::Bytes;
using test::load_error_of;

namespace {

constexpr std::endian xdr_order = std::endian::big;

std::unique_ptr<Trajectory> open_xtc_bytes(std::string bytes) {
    return open_xtc(ByteSource(std::move(bytes), "w.xtc"));
}

// The head of a frame up to its coordinates, by GROMACS's manual: a box of 1, 2 and 3 nm.
Bytes xtc_head(std::int32_t atoms, std::int32_t step, double time) {
    Bytes bytes(xdr_order);
    bytes.integer(1995).integer(atoms).integer(step).real(time);
    for (const double edge : {1, 0, 0, 0, 2, 0, 0, 0, 3}) bytes.real(edge);
    return bytes.integer(atoms);
}

// Ten atoms in a row along x, at 0, 1, ... 9 thousandths of a nanometre, packed by hand after the
// description in formats/xtc_packing.h. Ranges are 10, 1 and 1, their product 10 has 4 bits. The
// first i is 9, its size 8 and half of it 4: a difference (dx, 0, 0) is ((dx + 4) 8 + 4) 8 + 4 =
// 64 dx + 292, in 9 bits as the low byte and then the one bit above it.
//   group 1: exchanged, so atom 1 at the whole place x = 1: 0001; change 1; 5 bits, 3*8 + 0 + 1 =
//   25:
//     11001; atom 0 by dx = -1: 228 = 0.11100100: 11100100 0; atom 2 behind atom 0 by dx = 2: 420 =
//     1.10100100: 10100100 1; atoms 3 to 8, dx = 1 each: 356 = 1.01100100: 01100100 1, six times
//   group 2: atom 9 at x = 9: 1001; change 1; 3*0 + 0 + 1 = 1: 00001
// All bits in bytes: 0001 1 11001 111001000 101001001 6 x 011001001 1001 1 00001
std::string packed_by_hand() {
    std::string bits =
        "0001"
        "1"
        "11001"
        "111001000"
        "101001001";
    for (int i = 0; i < 6; ++i) bits += "011001001";
    bits +=
        "1001"
        "1"
        "00001";
    while (bits.size() % 8 != 0) bits += '0';
    std::string bytes;
    for (std::size_t i = 0; i < bits.size(); i += 8) {
        bytes += static_cast<char>(std::stoi(bits.substr(i, 8), nullptr, 2));
    }
    return bytes;
}

Bytes hand_packed_frame(std::int32_t step = 7) {
    Bytes frame = xtc_head(10, step, 0.5).real(1000);
    for (const std::int32_t bound : {0, 0, 0, 9, 0, 0}) frame.integer(bound);
    const std::string packed = packed_by_hand();
    frame.integer(9).integer(static_cast<std::int32_t>(packed.size()));
    frame.text += packed;
    while (frame.text.size() % 4 != 0) frame.text += '\0';
    return frame;
}

Bytes plain_frame(std::int32_t step = 3) {
    Bytes frame = xtc_head(2, step, 1.5);
    for (const double x : {0.5, -0.25, 8.0, 1.0, 0.0, 0.125}) frame.real(x);
    return frame;
}

// Packs, checks the ranges, and unpacks.
std::vector<IntegerPlace> packed_and_back(const std::vector<IntegerPlace>& places) {
    const std::optional<PackedPlaces> packed = pack_places(places);
    REQUIRE(packed);
    std::vector<IntegerPlace> back(places.size());
    CHECK(
        unpack_places(packed->least, packed->greatest, packed->small, packed->bits, back).empty());
    return back;
}

void check_as_text(const std::string& name) {
    INFO(name);
    const auto frames = test::read_text_frames(name + ".txt");
    const auto trajectory =
        open_xtc(ByteSource(std::filesystem::path(test::trajectory_path(name))));

    REQUIRE(trajectory->frame_count() == frames.size());
    CHECK(trajectory->notes().empty());
    // Backwards: every frame is found by its number alone.
    for (std::size_t i = frames.size(); i-- > 0;) {
        TrajectoryFrame frame;
        trajectory->read_frame(i, frame);
        REQUIRE(frame.positions.size() == frames[i].atoms.size());
        CHECK(trajectory->atom_count() == frames[i].atoms.size());
        CHECK(frame.step == frames[i].step);
        CHECK(*frame.time_ps == Approx(frames[i].time).margin(1e-12));
        REQUIRE(frame.box);
        // The text has six digits of nm; the box as well.
        for (Eigen::Index k = 0; k < 9; ++k) {
            const double edge = 10 * frames[i].box[static_cast<std::size_t>(k)];
            CHECK((*frame.box)(k % 3, k / 3) == Approx(edge).epsilon(1e-5).margin(1e-5));
        }
        double worst = 0;
        for (std::size_t atom = 0; atom < frame.positions.size(); ++atom) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double expected = 10 * frames[i].atoms[atom][axis];
                const double is = frame.positions[atom][static_cast<Eigen::Index>(axis)];
                worst = std::max(worst, std::abs(is - expected) / std::max(1.0, std::abs(is)));
            }
        }
        CHECK(worst < 6e-6);
    }
}

// Places of a text that GROMACS wrote, Å.
std::vector<std::vector<Vec3>> text_positions(const std::string& name) {
    std::vector<std::vector<Vec3>> all;
    for (const test::TextFrame& frame : test::read_text_frames(name)) {
        auto& positions = all.emplace_back();
        for (const auto& atom : frame.atoms) {
            positions.push_back(10 * Vec3(atom[0], atom[1], atom[2]));
        }
    }
    return all;
}

Mat3 text_box(const test::TextFrame& frame) {
    Mat3 box;
    for (Eigen::Index k = 0; k < 9; ++k) {
        box(k % 3, k / 3) = 10 * frame.box[static_cast<std::size_t>(k)];
    }
    return box;
}

}  // namespace

TEST_CASE("an XTC frame of few atoms is read from bytes put together by hand", "[formats][xtc]") {
    const auto trajectory = open_xtc_bytes(plain_frame(3).text + plain_frame(4).text);
    TrajectoryFrame frame;

    trajectory->read_frame(1, frame);

    CHECK(trajectory->frame_count() == 2);
    CHECK(trajectory->atom_count() == 2);
    CHECK(frame.step == 4);
    CHECK(frame.time_ps == 1.5);
    CHECK(frame.box == Mat3(Vec3(10, 20, 30).asDiagonal()));
    CHECK(frame.positions == std::vector<Vec3>{{5, -2.5, 80}, {10, 0, 1.25}});
    CHECK(frame.velocities.empty());
    CHECK(frame.forces.empty());
}

TEST_CASE("packed coordinates are read from bits put together by hand", "[formats][xtc]") {
    const auto trajectory = open_xtc_bytes(hand_packed_frame().text);

    const std::vector<Vec3> positions = test::positions_of(*trajectory, 0);

    REQUIRE(positions.size() == 10);
    for (int i = 0; i < 10; ++i) {
        INFO(i);
        CHECK((positions[static_cast<std::size_t>(i)] - Vec3(0.01 * i, 0, 0)).norm() < 1e-12);
    }
}

TEST_CASE("GROMACS's XTC files are read as gmx dump prints them", "[formats][xtc]") {
    check_as_text("waters.xtc");
    check_as_text("four_atoms.xtc");
    check_as_text("chain.xtc");  // sizes of differences change, up and down
    check_as_text("far.xtc");    // each coordinate in bits of its own
}

TEST_CASE("what is written is to the byte what GROMACS has read", "[formats][xtc]") {
    // make_trajectories.py lets gmx check and gmx dump read written.xtc and written_chain.xtc.
    const auto [source, written] = GENERATE(table<std::string, std::string>(
        {{"waters.xtc.txt", "written.xtc"}, {"chain.xtc.txt", "written_chain.xtc"}}));
    const auto frames = test::read_text_frames(source);
    const auto positions = text_positions(source);
    const test::TemporaryFolder folder;

    XtcWriter writer(folder.path() / "w.xtc", positions[0].size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        writer.add_frame(positions[i], static_cast<std::int32_t>(frames[i].step), frames[i].time,
                         text_box(frames[i]));
    }
    writer.close();

    const std::string is = test::bytes_of((folder.path() / "w.xtc").string());
    CHECK(is == test::bytes_of(test::trajectory_path(written)));
    // No longer than GROMACS's own by more than a twentieth.
    const std::string theirs =
        test::bytes_of(test::trajectory_path(source.substr(0, source.size() - 4)));
    CHECK(static_cast<double>(is.size()) < 1.05 * static_cast<double>(theirs.size()));
}

TEST_CASE("few atoms are written as bytes put together by hand", "[formats][xtc]") {
    const test::TemporaryFolder folder;
    XtcWriter writer(folder.path() / "w.xtc", 2);
    const Mat3 box = Vec3(10, 20, 30).asDiagonal();

    for (const int step : {3, 4}) {
        writer.add_frame(std::vector<Vec3>{{5, -2.5, 80}, {10, 0, 1.25}}, step, 1.5, box);
        // As a whole, however the program ends.
        CHECK(test::bytes_of((folder.path() / "w.xtc").string()).size() ==
              plain_frame().text.size() * static_cast<std::size_t>(step - 2));
    }

    CHECK(test::bytes_of((folder.path() / "w.xtc").string()) ==
          plain_frame(3).text + plain_frame(4).text);
}

TEST_CASE("whole-number places survive packing, whatever they are", "[formats][xtc]") {
    std::mt19937 random(3);
    const auto draw = [&](std::int64_t from, std::int64_t to) {
        return static_cast<std::int32_t>(
            std::uniform_int_distribution<std::int64_t>(from, to)(random));
    };
    std::vector<IntegerPlace> places;
    SECTION("one atom") { places = {{5, -7, 2147483640}}; }
    SECTION("all at one place") { places.assign(100, {1, 2, 3}); }
    SECTION("as far apart as can be") {
        for (int i = 0; i < 50; ++i) {
            const std::int32_t far = i % 2 == 0 ? -1073741822 : 1073741821;
            places.push_back({far, -far, i});
        }
    }
    SECTION("steps of every size") {
        for (int size = 0; size < 24; ++size) {
            for (int i = 0; i < 40; ++i) {
                const std::int32_t step = 1 << size;
                IntegerPlace place = places.empty() ? IntegerPlace{} : places.back();
                for (std::int32_t& x : place) x += draw(-step, step);
                places.push_back(place);
            }
        }
    }
    SECTION("steps whose size changes at every atom") {
        for (int i = 0; i < 2000; ++i) {
            const std::int32_t step = 1 << draw(0, 18);
            IntegerPlace place = places.empty() ? IntegerPlace{} : places.back();
            for (std::int32_t& x : place) x += draw(-step, step);
            places.push_back(place);
        }
    }
    SECTION("ranges around 2^24") {
        for (const std::int32_t range : {0xfffffe, 0xffffff, 0x1000000}) {
            for (int i = 0; i < 30; ++i) {
                places.push_back({i == 0 ? 0 : i == 1 ? range : draw(0, range), draw(0, 5), 7});
            }
        }
    }

    CHECK(packed_and_back(places) == places);
}

TEST_CASE("places too far apart for other readers are not packed", "[formats][xtc]") {
    CHECK_FALSE(pack_places(std::vector<IntegerPlace>{{0, 0, 0}, {0, 2147483645, 0}}));
    CHECK(pack_places(std::vector<IntegerPlace>{{0, 0, 0}, {0, 2147483644, 0}}));
    CHECK_FALSE(pack_places(std::vector<IntegerPlace>{{-2147483647, 0, 0}, {2147483647, 0, 0}}));
}

TEST_CASE("an XTC file cut anywhere is noted, and its whole frames are read", "[formats][xtc]") {
    const std::string whole = GENERATE(plain_frame(3).text + plain_frame(4).text,
                                       hand_packed_frame(3).text + hand_packed_frame(4).text,
                                       test::bytes_of(test::trajectory_path("waters.xtc")));
    const auto all = open_xtc_bytes(whole);
    std::size_t refused = 0, noted = 0, between = 0;

    for (std::size_t length = 0; length < whole.size(); ++length) {
        const std::string error = load_error_of([&] {
            const auto cut = open_xtc_bytes(whole.substr(0, length));
            REQUIRE(cut->frame_count() < all->frame_count());
            for (std::size_t i = 0; i < cut->frame_count(); ++i) {
                REQUIRE(test::positions_of(*cut, i) == test::positions_of(*all, i));
            }
            (cut->notes().empty() ? between : noted) += 1;
        });
        if (error != "no error") {
            ++refused;
            REQUIRE_THAT(error, Contains("w.xtc: ends within its first frame") ||
                                    Contains("w.xtc: is empty"));
        }
    }

    CHECK(refused > 0);
    CHECK(noted > 0);
    CHECK(between == all->frame_count() - 1);
}

TEST_CASE("every damaged byte of an XTC file is a frame or a sentence", "[formats][xtc]") {
    const std::string whole = hand_packed_frame(3).text + hand_packed_frame(4).text;
    test::expect_frames_or_errors(whole, {0, 3, 7}, open_xtc_bytes);
}

TEST_CASE("what is wrong with an XTC file is reported with its frame", "[formats][xtc]") {
    const auto open_error = [](std::string bytes) {
        return load_error_of([&] { open_xtc_bytes(std::move(bytes)); });
    };
    const auto read_error = [](std::string bytes) {
        return load_error_of([&] { test::positions_of(*open_xtc_bytes(std::move(bytes)), 0); });
    };
    const auto with = [](Bytes frame, std::size_t at, std::int32_t value) {
        return frame.text.replace(at, 4, Bytes(xdr_order).integer(value).text);
    };
    const std::string plain = plain_frame().text;

    CHECK(open_error(plain + with(plain_frame(), 0, 1993)) ==
          "w.xtc: frame 2: begins with 1993; expected 1995, as every frame of an XTC file");
    CHECK_THAT(open_error(with(plain_frame(), 0, 2023)), Contains("298 million atoms"));
    CHECK_THAT(open_error(with(plain_frame(), 4, 3)),
               Contains("frame 1: has 3 atoms and coordinates of 2"));
    CHECK_THAT(open_error(plain + hand_packed_frame().text),
               Contains("frame 2: has 10 atoms; expected 2"));
    CHECK_THAT(open_error(with(hand_packed_frame(), 88, 2)), Contains("has 10 atoms in 2 bytes"));
    CHECK_THAT(read_error(with(hand_packed_frame(), 84, 8)),
               Contains("frame 1: differences of 8 bits"));
    CHECK_THAT(read_error(with(hand_packed_frame(), 56, 0)),
               Contains("frame 1: has the precision"));
    CHECK_THAT(read_error(with(hand_packed_frame(), 72, -1)),
               Contains("frame 1: coordinates from 0 to -1"));
    CHECK_THAT(read_error(with(hand_packed_frame(), 84, 40)),
               Contains("frame 1: packed coordinates end in atom"));
    CHECK_THAT(read_error(with(plain_frame(), 56, 0x7fc00000)),
               Contains("frame 1: atom 1 has the coordinate nan; expected a number within"));
    CHECK(load_error_of([&] { test::positions_of(*open_xtc_bytes(plain), 1); }) ==
          "w.xtc: has no frame 2; expected one of its 1 frame");
}

TEST_CASE("what cannot be written to an XTC file is reported", "[formats][xtc]") {
    const test::TemporaryFolder folder;
    const auto path = folder.path() / "w.xtc";
    XtcWriter writer(path, 10, 1e6F);
    std::vector<Vec3> positions(10, Vec3::Zero());

    CHECK_THAT(load_error_of([&] { XtcWriter(path, 10); }), Contains("already exists"));
    CHECK_THAT(load_error_of([&] { XtcWriter(folder.path() / "x.xtc", 0); }),
               Contains("0 atoms do not fit"));
    CHECK_THAT(load_error_of([&] { XtcWriter(folder.path() / "y.xtc", 1, 0.5F); }),
               Contains("the precision is 0.5"));
    CHECK_THAT(load_error_of([&] { writer.add_frame(std::vector<Vec3>(9, Vec3::Zero()), 0, 0); }),
               Contains("frame 1: 9 atoms; expected 10"));
    positions[3].y() = 30000;
    CHECK_THAT(load_error_of([&] { writer.add_frame(positions, 0, 0); }),
               Contains("frame 1: the coordinates are too large for a precision") &&
                   Contains("precision"));
    positions[3].y() = std::nan("");
    CHECK_THAT(load_error_of([&] { writer.add_frame(positions, 0, 0); }),
               Contains("frame 1: atom 4 has the coordinate nan"));
    CHECK(test::bytes_of(path.string()).empty());
}
