#include "formats/pdb_models.h"

#include "core/load_error.h"
#include "core/text.h"
#include "formats/box.h"
#include "formats/lines.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// Lines of a part of a file, one at a time; of longer ones only the beginning, which has all
// columns of the format.
class SourceLines {
public:
    SourceLines(ByteSource& source, std::uint64_t begin, std::uint64_t end)
        : source_(source), next_part_(begin), next_(begin), end_(end) {}

    // Behind the last line nothing.
    std::optional<std::string_view> find_next() {
        line_.clear();
        if (next_ >= end_) return {};
        for (;;) {
            if (in_part_ == part_size_ && !fill()) break;
            const char letter = part_[in_part_++];
            ++next_;
            if (letter == '\n') break;
            if (line_.size() < 128) line_ += letter;
        }
        if (line_.ends_with('\r')) line_.pop_back();
        return line_;
    }

    // Where the line behind that one begins.
    std::uint64_t next_offset() const { return next_; }

private:
    bool fill() {
        part_size_ =
            static_cast<std::size_t>(std::min<std::uint64_t>(part_.size(), end_ - next_part_));
        source_.read(next_part_, std::span(part_).first(part_size_));
        next_part_ += part_size_;
        in_part_ = 0;
        return part_size_ > 0;
    }

    ByteSource& source_;
    std::uint64_t next_part_, next_, end_;
    std::array<char, 1 << 14> part_{};
    std::size_t in_part_ = 0, part_size_ = 0;
    std::string line_;
};

bool is_atom_line(std::string_view line) {
    // A sixth digit of the serial may stand behind ATOM and a blank, as in read_pdb.
    return line.starts_with("HETATM") || line.starts_with("ATOM ");
}

bool is_record(std::string_view line, std::string_view name) {
    return line.starts_with(name) && find_field(line, {0, 6}) == name;
}

std::optional<Mat3> find_cryst1_box(std::string_view line) {
    Vec3 lengths, angles;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto length = find_real(find_field(line, {6 + 9 * i, 9}));
        const auto angle = find_real(find_field(line, {33 + 7 * i, 7}));
        if (!length || !angle) return {};
        lengths[static_cast<Eigen::Index>(i)] = *length;
        angles[static_cast<Eigen::Index>(i)] = *angle;
    }
    if (lengths.maxCoeff() <= 1) return {};
    return find_box_deg(lengths, angles);
}

std::optional<double> find_title_time(std::string_view line) {
    const std::size_t at = line.rfind(" t=");
    if (at == std::string_view::npos) return {};
    const std::vector<std::string_view> words = split_words(line.substr(at + 3));
    return words.empty() ? std::nullopt : find_real(words[0]);
}

class PdbModels final : public Trajectory {
public:
    explicit PdbModels(ByteSource source) : source_(std::move(source)) {
        SourceLines lines(source_, 0, source_.size());
        std::uint64_t begin = 0;
        std::size_t atoms = 0;
        bool in_model = false;
        while (const auto line = lines.find_next()) {
            if (is_atom_line(*line)) {
                ++atoms;
            } else if (is_record(*line, "MODEL")) {
                if (atoms > 0) {
                    fail_frame(source_.name(), frames_.size(),
                               "a MODEL inside another model, or after atoms outside of models; "
                               "expected ENDMDL before it");
                }
                in_model = true;
            } else if (is_record(*line, "ENDMDL") || (is_record(*line, "END") && atoms > 0)) {
                add_frame(begin, lines.next_offset(), atoms);
                begin = lines.next_offset();
                atoms = 0;
                in_model = false;
            } else if (frames_.empty() && !box_ && is_record(*line, "CRYST1")) {
                box_ = find_cryst1_box(*line);
            }
        }
        // A file without END may be whole, but for one that has frames of more atoms before.
        if (atoms > 0 && !in_model && (frames_.empty() || atoms == atoms_)) {
            add_frame(begin, source_.size(), atoms);
            notes_.emplace_back("no END record: the file may be cut off");
        } else if (atoms > 0 || in_model) {
            if (frames_.empty()) throw LoadError({source_.name()}, "ends within its first model");
            notes_.push_back(cut_off_note(frames_.size()));
        }
        if (frames_.empty()) throw LoadError({source_.name()}, "ends without any atom");
    }

    std::size_t atom_count() const noexcept override { return atoms_; }
    std::size_t frame_count() const noexcept override { return frames_.size(); }

    void read_frame(std::size_t frame, TrajectoryFrame& into) override {
        check_frame(source_.name(), frame, frames_.size());
        into.positions.clear();
        into.positions.reserve(atoms_);
        into.velocities.clear();
        into.forces.clear();
        into.box = box_;
        into.time_ps = {};
        into.step = {};
        SourceLines lines(source_, frames_[frame].begin, frames_[frame].end);
        while (const auto line = lines.find_next()) {
            if (is_atom_line(*line)) {
                read_atom(*line, frame, into);
            } else if (is_record(*line, "CRYST1")) {
                into.box = find_cryst1_box(*line);
            } else if (is_record(*line, "TITLE")) {
                into.time_ps = find_title_time(*line);
            }
        }
        if (into.positions.size() != atoms_) {
            fail_frame(source_.name(), frame,
                       "has changed since the file was opened; expected a file that no other "
                       "program changes");
        }
    }

private:
    struct Part {
        std::uint64_t begin, end;
    };

    void add_frame(std::uint64_t begin, std::uint64_t end, std::size_t atoms) {
        if (atoms == 0) {
            fail_frame(source_.name(), frames_.size(), "ends without any atom");
        }
        if (!frames_.empty() && atoms != atoms_) {
            fail_frame(
                source_.name(), frames_.size(),
                fmt::format("has {} atoms; expected {}, as in the frames before", atoms, atoms_));
        }
        atoms_ = atoms;
        frames_.push_back({begin, end});
    }

    void read_atom(std::string_view line, std::size_t frame, TrajectoryFrame& into) const {
        Vec3 position;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Columns columns{30 + 8 * axis, 8};
            const std::string_view text = find_field(line, columns);
            const std::optional<double> value = find_coordinate(text);
            if (!value) {
                fail_frame(source_.name(), frame,
                           fmt::format("atom {} has '{}' in columns {} to {}; expected a "
                                       "coordinate within ±{} Å",
                                       into.positions.size() + 1, text, columns.first + 1,
                                       columns.first + columns.count, farthest_coordinate));
            }
            position[static_cast<Eigen::Index>(axis)] = *value;
        }
        into.positions.push_back(position);
    }

    ByteSource source_;
    std::size_t atoms_ = 0;
    std::vector<Part> frames_;
    std::optional<Mat3> box_;  // before the first frame, for those that have none
};

}  // namespace

std::unique_ptr<Trajectory> open_pdb_models(ByteSource source) {
    return std::make_unique<PdbModels>(std::move(source));
}

}  // namespace palpa
