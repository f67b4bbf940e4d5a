#include "tools/lab/experiments/rest_poses.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

namespace palpa {
namespace {

constexpr double most_number = 1e9;  // beyond that a number is a slip
constexpr std::size_t most_poses = 1000;

std::string describe(const PosedModel& of) {
    return fmt::format("{} atoms, {} bodies, {} molecules, {} springs and a cutoff of {} Å",
                       of.atoms, of.bodies, of.molecules, of.springs, of.cutoff);
}

class RestPosesParser {
public:
    explicit RestPosesParser(const std::string& file) : place_{file} {}

    void add_line(std::string_view line) {
        ++place_.line;
        words_ = split_words(trimmed(line));
        if (place_.line == 1) {
            if (line != rest_poses_mark)
                fail("is not a file of poses", std::string(rest_poses_mark));
            return;
        }
        if (place_.line == 2) return add_model();
        const std::string_view kind = words_.empty() ? std::string_view() : words_.front();
        if (kind == "pose") return add_pose();
        if (kind == "rest") return add_rest();
        if (kind != "angles" && kind != "base" && kind != "spring" && kind != "move") {
            fail(fmt::format("'{}' is not a kind of line", printable(kind.substr(0, 20))),
                 "pose, rest, angles, base, spring or move");
        }
        if (rest_ == nullptr) fail("stands before any line 'rest'", "pose, then rest");
        if (kind == "angles") return add_angles();
        if (kind == "base") return add_base();
        if (kind == "spring") return add_spring();
        add_move();
    }

    RestPoses take() {
        if (place_.line == 0) fail("is empty", std::string(rest_poses_mark));
        if (place_.line == 1) fail("ends before the line 'scene'", "scene and five numbers");
        if (poses_.poses.empty()) fail("has no poses", "one or more");
        finish_pose();
        return std::move(poses_);
    }

private:
    [[noreturn]] void fail(const std::string& what, const std::string& expected) const {
        throw LoadError(place_, fmt::format("{}; expected {}", what, expected));
    }

    void check_count(std::size_t count, const std::string& expected) const {
        if (words_.size() != count + 1)
            fail(fmt::format("{} words follow '{}'", words_.size() - 1, words_.front()), expected);
    }

    double number(std::size_t word) const {
        const std::optional<double> value = find_real(words_[word]);
        if (!value || std::abs(*value) > most_number) {
            fail(fmt::format("'{}' is not a number", printable(words_[word].substr(0, 40))),
                 "a number of 1e9 at most");
        }
        return *value;
    }

    Vec3 vector(std::size_t word) const {
        return {number(word), number(word + 1), number(word + 2)};
    }

    void add_model() {
        const std::string expected =
            "scene, the numbers of atoms, bodies, molecules and springs, and the cutoff in Å";
        if (words_.empty() || words_.front() != "scene") fail("has no scene", expected);
        check_count(5, expected);
        const auto count = [&](std::size_t word) {
            const std::optional<std::int64_t> value = find_integer(words_[word]);
            if (!value || *value < 0 || static_cast<double>(*value) > most_number)
                fail(fmt::format("'{}' is not a whole number",
                                 printable(words_[word].substr(0, 40))),
                     "a whole number from 0 to 1e9");
            return static_cast<std::size_t>(*value);
        };
        poses_.of = {count(1), count(2), count(3), count(4), number(5)};
        if (poses_.of.cutoff <= 0) fail("the cutoff is not greater than 0", "a length in Å");
    }

    void add_pose() {
        check_count(0, "nothing");
        finish_pose();
        if (poses_.poses.size() == most_poses)
            fail("begins too many poses", fmt::format("{} at most", most_poses));
        poses_.poses.emplace_back();
        rests_ = 0;
        pose_line_ = place_.line;
    }

    void add_rest() {
        constexpr std::string_view expected = "all or cutoff, an energy and a force: five words";
        check_count(5, std::string(expected));
        if (poses_.poses.empty()) fail("stands before any line 'pose'", "pose");
        if (rests_ == 2)
            fail("is the third line 'rest' of its pose", "two, or a line 'pose' before it");
        finish_rest();
        const std::string_view pairs = rests_ == 0 ? "all" : "cutoff";
        if (words_[1] != pairs) {
            fail(fmt::format("names '{}'", printable(words_[1].substr(0, 20))),
                 fmt::format("'{}': all first, then cutoff", pairs));
        }
        RestPosePair& pair = poses_.poses.back();
        rest_ = rests_ == 0 ? &pair.all_pairs : &pair.with_cutoff;
        ++rests_;
        rest_->energy = number(2);
        rest_->force_pN = vector(3);
        rest_->line = place_.line;
        has_angles_ = false;
    }

    void add_angles() {
        if (has_angles_) fail("repeats the angles of this pose", "one line of angles");
        check_count(poses_.of.bodies, fmt::format("{} angles, one of each body", poses_.of.bodies));
        has_angles_ = true;
        for (std::size_t i = 1; i < words_.size(); ++i) rest_->angles.push_back(number(i));
    }

    void add_base() {
        check_count(7, "a turn as a quaternion, real part first, and a shift: seven numbers");
        const Quat turn(number(1), number(2), number(3), number(4));
        if (std::abs(turn.norm() - 1) > 1e-6)
            fail(fmt::format("the turn has the length {:.6g}", turn.norm()), "1");
        rest_->turns.push_back(turn);
        rest_->shifts.push_back(vector(5));
    }

    void add_spring() {
        check_count(3, "a place: three numbers");
        rest_->springs.push_back(vector(1));
    }

    void add_move() {
        check_count(7, "a move, a change of the force, and 1 for a snap or 0: seven numbers");
        if (words_[7] != "0" && words_[7] != "1")
            fail(fmt::format("'{}' does not say whether this move is a snap",
                             printable(words_[7].substr(0, 20))),
                 "0 or 1");
        rest_->moves.push_back({vector(1), vector(4), words_[7] == "1"});
    }

    // What stands between a line `rest` and the next, or the end of its pose.
    void finish_rest() const {
        if (rest_ == nullptr) return;
        const auto check = [&](std::size_t found, std::size_t expected, const char* what) {
            if (found == expected) return;
            throw LoadError({place_.file, rest_->line},
                            fmt::format("has {} of {}; expected {}", found, what, expected));
        };
        if (!has_angles_)
            throw LoadError({place_.file, rest_->line}, "has no angles; expected a line of them");
        check(rest_->turns.size(), poses_.of.molecules, "the lines 'base'");
        check(rest_->springs.size(), poses_.of.springs, "the lines 'spring'");
        if (rest_->moves.empty())
            throw LoadError({place_.file, rest_->line}, "has no moves; expected one or more");
    }

    void finish_pose() {
        finish_rest();
        rest_ = nullptr;
        if (!poses_.poses.empty() && rests_ != 2) {
            throw LoadError(
                {place_.file, pose_line_},
                fmt::format(
                    "the pose has {} of two lines 'rest'; expected rest all and rest cutoff",
                    rests_));
        }
    }

    TextPlace place_;
    std::vector<std::string_view> words_;
    RestPoses poses_;
    RestPose* rest_ = nullptr;  // that lines are added to
    std::size_t rests_ = 0;     // of the last pose
    std::size_t pose_line_ = 0;
    bool has_angles_ = false;  // the last one
};

std::string words_of(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }
std::string micro_words_of(const Vec3& v) {
    return fmt::format("{:.6f} {:.6f} {:.6f}", v.x(), v.y(), v.z());
}

void write_rest(const char* pairs, const RestPose& pose, std::string& text) {
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "rest {} {:.6f} {}\nangles", pairs, pose.energy,
                   micro_words_of(pose.force_pN));
    for (const double angle : pose.angles) fmt::format_to(out, " {:.10f}", angle);
    text += '\n';
    for (std::size_t i = 0; i < pose.turns.size(); ++i) {
        const Quat& q = pose.turns[i];
        fmt::format_to(out, "base {} {} {} {} {}\n", q.w(), q.x(), q.y(), q.z(),
                       words_of(pose.shifts[i]));
    }
    for (const Vec3& spring : pose.springs) fmt::format_to(out, "spring {}\n", words_of(spring));
    for (const RestMove& move : pose.moves) {
        fmt::format_to(out, "move {} {} {}\n", words_of(move.by), micro_words_of(move.change_pN),
                       move.is_snap ? 1 : 0);
    }
}

}  // namespace

RestPoses parse_rest_poses(std::string_view text, const std::string& file) {
    RestPosesParser parser(file);
    for (const std::string_view line : split_lines(text)) parser.add_line(line);
    return parser.take();
}

RestPoses read_rest_poses(const std::filesystem::path& path, const PosedModel& of) {
    RestPoses poses = parse_rest_poses(read_text_file(path), path.string());
    if (poses.of != of) {
        throw LoadError({path.string(), 2},
                        fmt::format("holds poses of another scene, of {}; expected {}",
                                    describe(poses.of), describe(of)));
    }
    return poses;
}

std::string format_rest_poses(const RestPoses& poses) {
    const PosedModel& of = poses.of;
    std::string text = fmt::format("{}\nscene {} {} {} {} {}\n", rest_poses_mark, of.atoms,
                                   of.bodies, of.molecules, of.springs, of.cutoff);
    for (const RestPosePair& pose : poses.poses) {
        text += "pose\n";
        write_rest("all", pose.all_pairs, text);
        write_rest("cutoff", pose.with_cutoff, text);
    }
    return text;
}

}  // namespace palpa
