#include "tools/lab/experiments/rest_poses.h"

#include "core/files.h"
#include "tests/support/load_error_of.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;

namespace {

// What else stands in the file below, the line that is told then, and what of it.
struct WrongLine {
    std::string old, now;
    int line;
    std::string told;
};

const std::string rest_lines =
    "angles 0.5 -0.25\n"
    "base 0.6 0.8 0 0 1 -2 3e-5\n"
    "spring 1 2 3\n"
    "move 0.1 0 0 10 -2 0.5 0\n"
    "move 0 0.1 0 1 2 3 1\n";

const std::string good = "# Palpa poses 1\nscene 12 2 1 1 12.5\npose\nrest all -1.5 1 2 3\n" +
                         rest_lines + "rest cutoff -1.25 4 5 6\n" + rest_lines;

// The first occurrence alone.
std::string with(const WrongLine& wrong) {
    std::string text = good;
    const std::size_t at = text.find(wrong.old);
    REQUIRE(at != std::string::npos);
    return text.replace(at, wrong.old.size(), wrong.now);
}

std::string error_of(const std::string& text) {
    return test::load_error_of([&] { (void)parse_rest_poses(text, "poses.txt"); });
}

}  // namespace

TEST_CASE("a file of poses reads as it was written", "[experiments][rest_poses]") {
    RestPoses poses;
    poses.of = {12, 2, 1, 1, 12.5};
    RestPosePair pair;
    pair.all_pairs.energy = -1.5;
    pair.all_pairs.force_pN = {1, 2, 3};
    pair.all_pairs.angles = {0.5, -1.0 / 3};
    pair.all_pairs.turns = {Quat(0.6, 0.8, 0, 0)};
    pair.all_pairs.shifts = {{1.0 / 3, -2, 5e-7}};
    pair.all_pairs.springs = {{0.1 + 0.2, 0, 1e5}};
    pair.all_pairs.moves = {{{0.1, 0, 0}, {10, -2, 0.5}, true}, {{0, 0.1, 0}, {1, 2, 3}, false}};
    pair.with_cutoff = pair.all_pairs;
    pair.with_cutoff.energy = 2.25;
    poses.poses = {pair, pair};

    const std::string text = format_rest_poses(poses);
    const RestPoses back = parse_rest_poses(text, "poses.txt");

    CHECK(back.of == poses.of);
    REQUIRE(back.poses.size() == 2);
    const RestPose &written = pair.all_pairs, &read = back.poses[1].all_pairs;
    CHECK(read.energy == written.energy);
    CHECK(read.force_pN == written.force_pN);
    CHECK(read.angles[0] == 0.5);
    CHECK(read.angles[1] == Approx(-1.0 / 3).margin(1e-10));
    CHECK(read.turns[0].coeffs() == written.turns[0].coeffs());
    CHECK(read.shifts[0] == written.shifts[0]);
    CHECK(read.springs[0] == written.springs[0]);
    REQUIRE(read.moves.size() == 2);
    CHECK(read.moves[0].by == written.moves[0].by);
    CHECK(read.moves[0].change_pN == written.moves[0].change_pN);
    CHECK(read.moves[0].is_snap);
    CHECK_FALSE(read.moves[1].is_snap);
    CHECK(back.poses[0].with_cutoff.energy == 2.25);
    CHECK(format_rest_poses(back) == text);
}

TEST_CASE("a file of poses may have the line ends of Windows", "[experiments][rest_poses]") {
    std::string text;
    for (const char letter : good) {
        if (letter == '\n') text += '\r';
        text += letter;
    }

    const RestPoses poses = parse_rest_poses(text, "poses.txt");

    CHECK(poses.poses.at(0).all_pairs.angles == std::vector<double>{0.5, -0.25});
    CHECK(poses.poses.at(0).all_pairs.line == 4);
}

TEST_CASE("what is wrong with a file of poses is said with its line", "[experiments][rest_poses]") {
    CHECK(error_of(good) == "no error");
    const std::vector<WrongLine> wrong_lines{
        {"# Palpa poses 1", "# Palpa poses 2", 1,
         "is not a file of poses; expected # Palpa poses 1"},
        {"scene 12", "scenes 12", 2, "has no scene; expected scene, the numbers of atoms"},
        {"scene 12 2 1 1 12.5", "scene 12 2 1 12.5", 2, "4 words follow 'scene'"},
        {"scene 12", "scene -1", 2, "'-1' is not a whole number; expected a whole number"},
        {"scene 12", "scene 1e3", 2, "'1e3' is not a whole number"},
        {"1 12.5", "1 0", 2, "the cutoff is not greater than 0"},
        {"pose\nrest", "pose 1\nrest", 3, "1 words follow 'pose'; expected nothing"},
        {"pose\nrest", "rest", 3, "stands before any line 'pose'"},
        {"pose\nrest all -1.5 1 2 3", "pose", 4, "stands before any line 'rest'"},
        {"rest all", "rest cutoff", 4, "names 'cutoff'; expected 'all'"},
        {"rest all -1.5", "rest all x", 4, "'x' is not a number; expected a number of 1e9 at most"},
        {"rest all -1.5", "rest all nan", 4, "'nan' is not a number"},
        {"rest all -1.5", "rest all 1e10", 4, "'1e10' is not a number"},
        {"rest all -1.5 1 2 3", "rest all -1.5 1 2", 4, "4 words follow 'rest'"},
        {"angles 0.5 -0.25", "angles 0.5", 5, "expected 2 angles, one of each body"},
        {"angles 0.5 -0.25\n", "", 4, "has no angles"},
        {"base", "angles 0.5 -0.25\nbase", 6, "repeats the angles of this pose"},
        {"base 0.6", "base 0.7", 6, "the turn has the length 1.06301; expected 1"},
        {"base 0.6 0.8 0 0 1 -2 3e-5\n", "", 4, "has 0 of the lines 'base'; expected 1"},
        {"spring 1 2 3", "spring 1 2", 7, "expected a place: three numbers"},
        {"spring 1 2 3\n", "", 4, "has 0 of the lines 'spring'; expected 1"},
        {"spring", "springs", 7, "'springs' is not a kind of line; expected pose, rest, angles"},
        {"spring", "\x1b[31m", 7, "'\\x1b[31m' is not a kind of line"},
        {"spring", "\nspring", 7, "'' is not a kind of line"},
        {"0.5 0\n", "0.5 2\n", 8, "'2' does not say whether this move is a snap; expected 0 or 1"},
        {"0.5 0\n", "0.5\n", 8, "6 words follow 'move'"},
        {"rest cutoff", "rest all", 10, "names 'all'; expected 'cutoff': all first, then cutoff"},
        {"rest cutoff -1.25 4 5 6\n", "pose\nrest cutoff -1.25 4 5 6\n", 3,
         "the pose has 1 of two lines 'rest'"},
    };
    for (const WrongLine& wrong : wrong_lines) {
        INFO(wrong.old << " -> " << wrong.now);

        const std::string error = error_of(with(wrong));

        CHECK_THAT(error, Contains("poses.txt:" + std::to_string(wrong.line) + ": "));
        CHECK_THAT(error, Contains(wrong.told));
    }
}

TEST_CASE("a file of poses that ends within a pose is refused", "[experiments][rest_poses]") {
    CHECK_THAT(error_of(""), Contains("poses.txt: is empty; expected # Palpa poses 1"));
    CHECK_THAT(error_of("# Palpa poses 1\n"), Contains(":1: ends before the line 'scene'"));
    CHECK_THAT(error_of(good.substr(0, good.find("pose\n"))), Contains("has no poses"));
    // Lines end whole: a digit less is another number, which nobody can see.
    for (std::size_t end = good.find('\n'); end + 1 < good.rfind("move 0.1");
         end = good.find('\n', end + 1)) {
        INFO(good.substr(0, end));
        CHECK(error_of(good.substr(0, end)) != "no error");
    }
    CHECK_THAT(error_of(good + "rest all 1 2 3 4\n"),
               Contains(":16: is the third line 'rest' of its pose"));
    CHECK_THAT(error_of(good.substr(0, good.rfind("move 0.1"))), Contains(":10: has no moves"));
}

TEST_CASE("poses of another scene are refused", "[experiments][rest_poses]") {
    const test::TemporaryFolder folder;
    const auto path = folder.path() / "poses.txt";
    write_text_file(path, good);
    const PosedModel of{12, 2, 1, 1, 12.5};

    CHECK(read_rest_poses(path, of).poses.size() == 1);
    for (const PosedModel& other : {PosedModel{13, 2, 1, 1, 12.5}, PosedModel{12, 3, 1, 1, 12.5},
                                    PosedModel{12, 2, 2, 1, 12.5}, PosedModel{12, 2, 1, 0, 12.5},
                                    PosedModel{12, 2, 1, 1, 10}}) {
        CHECK_THAT(test::load_error_of([&] { (void)read_rest_poses(path, other); }),
                   Contains("poses.txt:2: holds poses of another scene, of 12 atoms, 2 bodies, 1 "
                            "molecules, 1 springs and a cutoff of 12.5 Å; expected "));
    }
    CHECK_THAT(test::load_error_of([&] { (void)read_rest_poses(folder.path() / "no.txt", of); }),
               Contains("no.txt"));
}
