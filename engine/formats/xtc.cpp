#include "formats/xtc.h"

#include "core/load_error.h"
#include "core/units.h"
#include "formats/xtc_packing.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr std::endian xdr = std::endian::big;
constexpr std::int32_t xtc_magic = 1995, wide_xtc_magic = 2023;
constexpr std::size_t most_plain_atoms = 9;

// Where the numbers of a frame stand.
constexpr std::size_t atoms_at = 4, step_at = 8, time_at = 12, box_at = 16, size_at = 52,
                      plain_at = 56;
constexpr std::size_t precision_at = 56, least_at = 60, greatest_at = 72, small_at = 84,
                      length_at = 88, packed_at = 92;

// XDR fills up to whole words.
constexpr std::uint64_t padded(std::uint64_t bytes) { return (bytes + 3) / 4 * 4; }

class XtcTrajectory final : public Trajectory {
public:
    explicit XtcTrajectory(ByteSource source) : source_(std::move(source)) {
        while (next_ < source_.size() && find_frame()) {
        }
        if (offsets_.empty()) {
            throw LoadError({source_.name()}, source_.size() == 0 ? "is empty; expected an XTC file"
                                                                  : "ends within its first frame");
        }
        if (next_ < source_.size()) notes_.push_back(cut_off_note(offsets_.size()));
        offsets_.push_back(next_);
    }

    std::size_t atom_count() const noexcept override { return atoms_; }
    std::size_t frame_count() const noexcept override { return offsets_.size() - 1; }

    void read_frame(std::size_t frame, TrajectoryFrame& into) override {
        check_frame(source_.name(), frame, frame_count());
        bytes_.resize(static_cast<std::size_t>(offsets_[frame + 1] - offsets_[frame]));
        source_.read(offsets_[frame], bytes_);
        into.velocities.clear();
        into.forces.clear();
        into.positions.resize(atoms_);
        into.step = integer(step_at);
        into.time_ps = {};
        if (const float time = real(time_at); std::isfinite(time)) into.time_ps = double{time};
        read_box(into);
        if (atoms_ <= most_plain_atoms) {
            for (std::size_t i = 0; i < 3 * atoms_; ++i) {
                into.positions[i / 3][static_cast<Eigen::Index>(i % 3)] =
                    units::angstrom_per_nm * double{real(plain_at + 4 * i)};
            }
        } else {
            unpack(frame, into);
        }
        check_positions(source_.name(), frame, into.positions);
    }

private:
    std::int32_t integer(std::size_t at) const {
        return number_from<std::int32_t>(&bytes_[at], xdr);
    }
    float real(std::size_t at) const { return number_from<float>(&bytes_[at], xdr); }

    [[noreturn]] void fail(const std::string& what) const {
        fail_frame(source_.name(), offsets_.size(), what);
    }

    // Notes the frame at `next_`, which moves behind it; nothing if the file ends before.
    bool find_frame() {
        const std::uint64_t room = source_.size() - next_;
        // Reads as much of the frame's header as the file has, so that an error can name the
        // damage.
        bytes_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(room, packed_at)));
        source_.read(next_, bytes_);
        if (room < 4) return false;
        if (integer(0) == wide_xtc_magic) {
            fail(
                "has the XTC format of 2023 (more than 298 million atoms); expected the format of "
                "1995");
        }
        if (integer(0) != xtc_magic) {
            fail(fmt::format("begins with {}; expected {}, as every frame of an XTC file",
                             integer(0), xtc_magic));
        }
        if (room < plain_at) return false;
        const std::int32_t atoms = integer(atoms_at);
        if (atoms < 1 || integer(size_at) != atoms) {
            fail(fmt::format("has {} atoms and coordinates of {}; expected the same number from 1",
                             atoms, integer(size_at)));
        }
        const auto count = static_cast<std::size_t>(atoms);
        if (!offsets_.empty() && count != atoms_) {
            fail(fmt::format("has {} atoms; expected {}, as in the frames before", count, atoms_));
        }
        atoms_ = count;
        std::uint64_t length = plain_at + 12 * count;
        if (count > most_plain_atoms) {
            if (room < packed_at) return false;
            const std::int32_t packed = integer(length_at);
            if (packed < 0 || count > most_packed_places(static_cast<std::uint64_t>(packed))) {
                fail(
                    fmt::format("has {} atoms in {} bytes, which is too few bytes", count, packed));
            }
            length = packed_at + padded(static_cast<std::uint64_t>(packed));
        }
        if (room < length) return false;
        offsets_.push_back(next_);
        next_ += length;
        return true;
    }

    void read_box(TrajectoryFrame& into) const {
        Mat3 box;
        for (std::size_t i = 0; i < 9; ++i) {
            box(static_cast<Eigen::Index>(i % 3), static_cast<Eigen::Index>(i / 3)) =
                units::angstrom_per_nm * double{real(box_at + 4 * i)};
        }
        into.box = {};
        if (box.allFinite() && !box.isZero(0)) into.box = box;
    }

    void unpack(std::size_t frame, TrajectoryFrame& into) {
        const float precision = real(precision_at);
        if (!(precision > 0) || !std::isfinite(precision)) {
            fail_frame(source_.name(), frame,
                       fmt::format("has the precision {}; expected a positive number, often 1000",
                                   precision));
        }
        IntegerPlace least{}, greatest{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            least[axis] = integer(least_at + 4 * axis);
            greatest[axis] = integer(greatest_at + 4 * axis);
        }
        places_.resize(atoms_);
        const std::string_view packed(&bytes_[packed_at],
                                      static_cast<std::size_t>(integer(length_at)));
        const std::string wrong =
            unpack_places(least, greatest, integer(small_at), packed, places_);
        if (!wrong.empty()) fail_frame(source_.name(), frame, wrong);
        const double unit = units::angstrom_per_nm / double{precision};
        for (std::size_t atom = 0; atom < atoms_; ++atom) {
            const IntegerPlace& place = places_[atom];
            into.positions[atom] = unit * Vec3(place[0], place[1], place[2]);
        }
    }

    ByteSource source_;
    std::size_t atoms_ = 0;
    std::uint64_t next_ = 0;              // behind the last frame
    std::vector<std::uint64_t> offsets_;  // of frames, and behind the last
    std::string bytes_;                   // of one frame
    std::vector<IntegerPlace> places_;    // of one frame
};

void append_xdr(std::string& text, double value) {
    append_number(text, static_cast<float>(value), xdr);
}
void append_xdr(std::string& text, std::int32_t value) { append_number(text, value, xdr); }

// Nothing where a coordinate has no room.
bool append_packed(std::string& text, std::span<const Vec3> positions, float precision) {
    std::vector<IntegerPlace> places(positions.size());
    for (std::size_t atom = 0; atom < places.size(); ++atom) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double value = std::round(positions[atom][static_cast<Eigen::Index>(axis)] *
                                            double{precision} / units::angstrom_per_nm);
            // As other writers have it.
            if (std::abs(value) > std::numeric_limits<std::int32_t>::max() - 2) return false;
            places[atom][axis] = static_cast<std::int32_t>(value);
        }
    }
    const std::optional<PackedPlaces> packed = pack_places(places);
    if (!packed) return false;
    append_xdr(text, double{precision});
    for (const std::int32_t least : packed->least) append_xdr(text, least);
    for (const std::int32_t greatest : packed->greatest) append_xdr(text, greatest);
    append_xdr(text, packed->small);
    append_xdr(text, static_cast<std::int32_t>(packed->bits.size()));
    text += packed->bits;
    text.append(padded(packed->bits.size()) - packed->bits.size(), '\0');
    return true;
}

}  // namespace

std::unique_ptr<Trajectory> open_xtc(ByteSource source) {
    return std::make_unique<XtcTrajectory>(std::move(source));
}

XtcWriter::XtcWriter(const std::filesystem::path& path, std::size_t atom_count, float precision)
    : file_(path), atom_count_(atom_count), precision_(precision) {
    constexpr std::size_t most = 298'261'617;  // GROMACS writes another form beyond
    if (atom_count < 1 || atom_count > most) {
        throw LoadError(
            {file_.name()},
            fmt::format("{} atoms do not fit an XTC file; expected 1 to {}", atom_count, most));
    }
    if (!(precision >= 1 && precision <= 1e6F)) {
        throw LoadError(
            {file_.name()},
            fmt::format("the precision is {}; expected 1 to 1000000 steps per nm", precision));
    }
}

void XtcWriter::add_frame(std::span<const Vec3> positions, std::int32_t step, double time_ps,
                          const std::optional<Mat3>& box) {
    if (positions.size() != atom_count_) {
        fail_frame(file_.name(), frames_,
                   fmt::format("{} atoms; expected {}", positions.size(), atom_count_));
    }
    check_positions(file_.name(), frames_, positions);
    const auto atoms = static_cast<std::int32_t>(atom_count_);
    std::string text;
    append_xdr(text, xtc_magic);
    append_xdr(text, atoms);
    append_xdr(text, step);
    append_xdr(text, time_ps);
    for (Eigen::Index i = 0; i < 9; ++i) {
        append_xdr(text, box ? (*box)(i % 3, i / 3) / units::angstrom_per_nm : 0.0);
    }
    append_xdr(text, atoms);
    if (atom_count_ <= most_plain_atoms) {
        for (const Vec3& position : positions) {
            for (const double value : position) append_xdr(text, value / units::angstrom_per_nm);
        }
    } else if (!append_packed(text, positions, precision_)) {
        fail_frame(file_.name(), frames_,
                   fmt::format("the coordinates are too large for a precision of {} steps per nm; "
                               "expected a lower precision",
                               precision_));
    }
    file_.append(text);
    ++frames_;
}

}  // namespace palpa
