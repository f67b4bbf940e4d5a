#include "formats/dcd.h"

#include "core/load_error.h"
#include "core/text.h"
#include "core/units.h"
#include "formats/box.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr std::uint64_t mark_bytes = 4, header_bytes = 84, cell_bytes = 48;
constexpr std::uint64_t framed(std::uint64_t bytes) { return bytes + 2 * mark_bytes; }

// A record of n floats.
constexpr std::uint64_t floats_bytes(std::uint64_t n) { return framed(4 * n); }

// CHARMM's versions up to this one, and all other programs, write lengths and angles.
constexpr std::int32_t last_version_with_angles = 24;

// A symmetric matrix from its lower triangle, if it is that of a box.
std::optional<Mat3> find_symmetric_box(const std::array<double, 6>& cell) {
    Mat3 box;
    box << cell[0], cell[1], cell[3],  //
        cell[1], cell[2], cell[4],     //
        cell[3], cell[4], cell[5];
    if (!box.allFinite() || Eigen::LLT<Mat3>(box).info() != Eigen::Success) return {};
    return box;
}

std::optional<Mat3> find_dcd_box(const std::array<double, 6>& cell, std::int32_t version) {
    if (version > last_version_with_angles) {
        if (const auto box = find_symmetric_box(cell)) return box;
    }
    const Vec3 lengths(cell[0], cell[2], cell[5]), angles(cell[4], cell[3], cell[1]);
    if (angles.cwiseAbs().maxCoeff() <= 1) return find_box(lengths, angles);
    if (const auto box = find_box_deg(lengths, angles)) return box;
    return find_symmetric_box(cell);
}

class DcdTrajectory final : public Trajectory {
public:
    explicit DcdTrajectory(ByteSource source) : source_(std::move(source)) {
        find_order();
        read_header();
        read_titles();
        read_atoms();
        count_frames();
    }

    std::size_t atom_count() const noexcept override { return atoms_; }
    std::size_t frame_count() const noexcept override { return frames_; }

    void read_frame(std::size_t frame, TrajectoryFrame& into) override {
        check_frame(source_.name(), frame, frames_);
        into.velocities.clear();
        into.forces.clear();
        into.positions.resize(atoms_);
        if (!moving_.empty() && frame > 0) read_positions(0, into);  // of the fixed ones
        read_positions(frame, into);
        into.step = first_step_ + static_cast<std::int64_t>(frame) * steps_between_;
        into.time_ps = {};
        if (timestep_ps_ > 0) into.time_ps = timestep_ps_ * static_cast<double>(*into.step);
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw LoadError({source_.name()}, what);
    }

    [[noreturn]] void fail_end(const char* where) const {
        fail(fmt::format("ends within {}: the file may have been cut off", where));
    }

    template <class T>
    T number(const char* bytes) const {
        return number_from<T>(bytes, order_);
    }

    // `count` bytes at `at_`, which moves behind them.
    void take(std::span<char> into, const char* where) {
        if (source_.size() - at_ < into.size()) fail_end(where);
        source_.read(at_, into);
        at_ += into.size();
    }

    std::int32_t take_integer(const char* where) {
        std::array<char, 4> bytes{};
        take(bytes, where);
        return number<std::int32_t>(bytes.data());
    }

    void take_mark(std::uint64_t expected, const char* where) {
        const std::int32_t mark = take_integer(where);
        if (mark >= 0 && static_cast<std::uint64_t>(mark) == expected) return;
        fail(
            fmt::format("the record length of {} is {} bytes; expected {}", where, mark, expected));
    }

    void find_order() {
        std::array<char, 12> bytes{};
        const std::size_t there = std::min<std::uint64_t>(bytes.size(), source_.size());
        source_.read(0, std::span(bytes).first(there));
        const std::string_view text(bytes.data(), bytes.size());
        for (const std::endian order : {std::endian::little, std::endian::big}) {
            order_ = order;
            if (number<std::int32_t>(bytes.data()) == header_bytes) break;
        }
        if (number<std::int32_t>(bytes.data()) != header_bytes) {
            if (there == bytes.size() && text.substr(8) == "CORD") {
                fail(
                    "has record lengths of 8 bytes; expected 4 bytes, as most programs write them");
            }
            if (there < 8) fail_end("the header");
            fail("is not a DCD file; expected a first record of 84 bytes");
        }
        if (there < 8) fail_end("the header");
        if (text.substr(4, 4) == "VELD") {
            fail("holds velocities (VELD); expected coordinates (CORD)");
        }
        if (text.substr(4, 4) == "CORD") return;
        if (text.substr(8) == "CORD") {
            fail("has record lengths of 8 bytes; expected 4 bytes, as most programs write them");
        }
        fail("is not a DCD file; expected CORD in its first record");
    }

    void read_header() {
        take_mark(header_bytes, "the header");
        std::array<char, header_bytes> bytes{};
        take(bytes, "the header");
        take_mark(header_bytes, "the header");
        // ICNTRL(i), from 1 as Fortran counts.
        const auto control = [&](std::size_t i) { return number<std::int32_t>(&bytes[4 * i]); };
        told_frames_ = control(1);
        first_step_ = control(2);
        steps_between_ = control(3);
        fixed_ = control(9);
        version_ = control(20);
        const bool is_charmm = version_ != 0;
        // X-PLOR's time step is a double, which takes the place of CHARMM's flags.
        const double timestep =
            is_charmm ? double{number<float>(&bytes[40])} : number<double>(&bytes[40]);
        if (std::isfinite(timestep)) timestep_ps_ = timestep * units::picosecond_per_akma;
        has_cell_ = is_charmm && control(11) != 0;
        has_fourth_ = is_charmm && control(12) == 1;
        if (is_charmm && control(13) != 0) {
            fail("holds charges with every frame (ICNTRL(13)); expected coordinates alone");
        }
        if (fixed_ < 0) fail(fmt::format("has {} fixed atoms; expected 0 or more", fixed_));
    }

    void read_titles() {
        const std::int32_t bytes = take_integer("the titles");
        if (bytes < 4) {
            fail(fmt::format("the record length of the titles is {} bytes; expected 4 or more",
                             bytes));
        }
        if (source_.size() - at_ < static_cast<std::uint64_t>(bytes)) fail_end("the titles");
        at_ += static_cast<std::uint64_t>(bytes);
        take_mark(static_cast<std::uint64_t>(bytes), "the titles");
    }

    void read_atoms() {
        take_mark(4, "the number of atoms");
        const std::int32_t atoms = take_integer("the number of atoms");
        take_mark(4, "the number of atoms");
        constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max() / 4;
        if (atoms < 1 || atoms > most || fixed_ >= atoms) {
            fail(
                fmt::format("has {} atoms, {} of them fixed; expected 1 to {} atoms, not all fixed",
                            atoms, fixed_, most));
        }
        atoms_ = static_cast<std::size_t>(atoms);
        if (fixed_ > 0) read_moving(atoms_ - static_cast<std::size_t>(fixed_));
        first_frame_ = at_;
    }

    void read_moving(std::size_t count) {
        const char* const where = "the list of atoms that move";
        if (source_.size() - at_ < floats_bytes(count)) fail_end(where);
        take_mark(4 * count, where);
        std::vector<char> bytes(4 * count);
        take(bytes, where);
        take_mark(4 * count, where);
        moving_.reserve(count);
        std::int64_t last = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::int64_t atom = number<std::int32_t>(&bytes[4 * i]);
            if (atom <= last || atom > static_cast<std::int64_t>(atoms_)) {
                fail(fmt::format(
                    "atom {} in {} follows atom {}; expected ascending numbers up to {}", atom,
                    where, last, atoms_));
            }
            moving_.push_back(static_cast<std::uint32_t>(atom - 1));
            last = atom;
        }
    }

    std::uint64_t frame_bytes(std::uint64_t atoms) const {
        return (has_cell_ ? framed(cell_bytes) : 0) + (has_fourth_ ? 4 : 3) * floats_bytes(atoms);
    }

    std::uint64_t offset_of(std::size_t frame) const {
        if (frame == 0) return first_frame_;
        const std::uint64_t moving = moving_.empty() ? atoms_ : moving_.size();
        return first_frame_ + frame_bytes(atoms_) + (frame - 1) * frame_bytes(moving);
    }

    void count_frames() {
        const std::uint64_t room = source_.size() - first_frame_;
        if (room == 0) fail("ends before its first frame");
        if (room < frame_bytes(atoms_)) fail_end("its first frame");
        const std::uint64_t each = offset_of(2) - offset_of(1);
        frames_ = 1 + static_cast<std::size_t>((room - frame_bytes(atoms_)) / each);
        if (offset_of(frames_) != source_.size()) notes_.push_back(cut_off_note(frames_));
        if (told_frames_ != 0 && static_cast<std::uint64_t>(told_frames_) != frames_) {
            notes_.push_back(
                fmt::format("announces {} frames and contains {}: the file may be cut off, or its "
                            "writer was interrupted",
                            told_frames_, frames_));
        }
    }

    void read_positions(std::size_t frame, TrajectoryFrame& into) {
        const std::size_t count = frame == 0 || moving_.empty() ? atoms_ : moving_.size();
        bytes_.resize(frame_bytes(count));
        source_.read(offset_of(frame), bytes_);
        const char* at = bytes_.data();
        into.box = {};
        if (has_cell_) {
            const char* const numbers = record(at, cell_bytes, frame, "cell");
            std::array<double, 6> cell{};
            for (std::size_t i = 0; i < 6; ++i) cell[i] = number<double>(numbers + 8 * i);
            into.box = find_dcd_box(cell, version_);
        }
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            const char* const numbers = record(at, 4 * count, frame, "coordinates");
            for (std::size_t i = 0; i < count; ++i) {
                const std::size_t atom = count == atoms_ ? i : moving_[i];
                into.positions[atom][axis] = double{number<float>(numbers + 4 * i)};
            }
        }
        if (has_fourth_) record(at, 4 * count, frame, "fourth dimension");
        check_positions(source_.name(), frame, into.positions);
    }

    // Checks both marks of the record at `at`, which moves behind it; where its content begins.
    const char* record(const char*& at, std::uint64_t bytes, std::size_t frame,
                       const char* what) const {
        const char* const content = at + mark_bytes;
        for (const char* const mark : {at, content + bytes}) {
            const auto length = number<std::int32_t>(mark);
            if (length >= 0 && static_cast<std::uint64_t>(length) == bytes) continue;
            fail_frame(source_.name(), frame,
                       fmt::format("the record length of the {} is {} bytes; expected {}", what,
                                   length, bytes));
        }
        at = content + bytes + mark_bytes;
        return content;
    }

    ByteSource source_;
    std::uint64_t at_ = 0;  // what is read next of all that stands before the frames
    std::endian order_ = std::endian::little;
    std::int32_t told_frames_ = 0, first_step_ = 0, steps_between_ = 0, fixed_ = 0, version_ = 0;
    double timestep_ps_ = 0;
    bool has_cell_ = false, has_fourth_ = false;
    std::size_t atoms_ = 0, frames_ = 0;
    std::vector<std::uint32_t> moving_;  // empty where all do
    std::uint64_t first_frame_ = 0;
    std::vector<char> bytes_;  // of one frame
};

// Of the writer.
constexpr std::endian little = std::endian::little;

void append_record(std::string& text, std::string_view content) {
    const auto mark = static_cast<std::int32_t>(content.size());
    append_number(text, mark, little);
    text += content;
    append_number(text, mark, little);
}

std::string titles_of(const std::string& title) {
    std::string titles;
    std::int32_t count = 0;
    for (const std::string_view line : split_lines(title)) {
        titles += fmt::format("{:<80.80}", line);
        ++count;
    }
    std::string content;
    append_number(content, count, little);
    return content + titles;
}

constexpr std::uint64_t told_frames_offset = 8, told_steps_offset = 20;

std::string dcd_header(std::size_t atom_count, const DcdOptions& options) {
    std::array<std::int32_t, 21> control{};  // from 1
    control[2] = options.first_step;
    control[3] = options.steps_between;
    const auto timestep = static_cast<float>(options.timestep_ps / units::picosecond_per_akma);
    control[10] = std::bit_cast<std::int32_t>(timestep);
    control[11] = options.has_box ? 1 : 0;
    control[20] = last_version_with_angles;
    std::string content = "CORD";
    for (std::size_t i = 1; i < control.size(); ++i) append_number(content, control[i], little);
    std::string text;
    append_record(text, content);
    append_record(text, titles_of(options.title));
    content.clear();
    append_number(content, static_cast<std::int32_t>(atom_count), little);
    append_record(text, content);
    return text;
}

}  // namespace

std::unique_ptr<Trajectory> open_dcd(ByteSource source) {
    return std::make_unique<DcdTrajectory>(std::move(source));
}

DcdWriter::DcdWriter(const std::filesystem::path& path, std::size_t atom_count,
                     const DcdOptions& options)
    : file_(path),
      atom_count_(atom_count),
      has_box_(options.has_box),
      steps_between_(options.steps_between) {
    constexpr std::size_t most = std::numeric_limits<std::int32_t>::max() / 4;
    if (atom_count < 1 || atom_count > most) {
        throw LoadError({file_.name()}, fmt::format("{} atoms do not fit a DCD file; expected 1 to "
                                                    "{}",
                                                    atom_count, most));
    }
    file_.append(dcd_header(atom_count, options));
}

void DcdWriter::add_frame(std::span<const Vec3> positions, const std::optional<Mat3>& box) {
    if (positions.size() != atom_count_) {
        fail_frame(file_.name(), frames_,
                   fmt::format("{} atoms; expected {}", positions.size(), atom_count_));
    }
    if (box.has_value() != has_box_) {
        fail_frame(file_.name(), frames_,
                   has_box_ ? "the frame has no box; expected one, as the header announces"
                            : "the frame has a box; expected none, as the header announces");
    }
    if (box && !is_lower_box(*box)) {
        fail_frame(
            file_.name(), frames_,
            "a DCD file cannot hold this box; expected edge a along x and edge b in the xy plane");
    }
    check_positions(file_.name(), frames_, positions);
    std::string text, content;
    if (box) {
        const Vec3 lengths = lengths_of(*box), cosines = cosines_of(*box);
        for (const double value :
             {lengths.x(), cosines.z(), lengths.y(), cosines.y(), cosines.x(), lengths.z()}) {
            append_number(content, value, little);
        }
        append_record(text, content);
    }
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        content.clear();
        for (const Vec3& position : positions) {
            append_number(content, static_cast<float>(position[axis]), little);
        }
        append_record(text, content);
    }
    // The count last: a reader that goes by it never looks for what is not there yet.
    file_.append(text);
    ++frames_;
    std::string count, steps;
    append_number(count, static_cast<std::int32_t>(frames_), little);
    append_number(steps,
                  static_cast<std::int32_t>(static_cast<std::int64_t>(frames_) * steps_between_),
                  little);
    file_.replace(told_steps_offset, steps);
    file_.replace(told_frames_offset, count);
}

}  // namespace palpa
