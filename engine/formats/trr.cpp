#include "formats/trr.h"

#include "core/load_error.h"
#include "core/units.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr std::endian trr_order = std::endian::big;
constexpr std::int32_t trr_magic = 1993;
constexpr std::string_view trr_version = "GMX_trn_file";  // 12 letters: no filling behind it

// 1993, 13 (with the zero of C behind the version), 12, the version; sizes of blocks; atoms, step,
// reserved.
constexpr std::size_t version_at = 12, sizes_at = 24, trr_atoms_at = 64, trr_step_at = 68,
                      reals_at = 76;
// What stands before the blocks of one frame.
struct TrrHead {
    enum Block : std::uint8_t {
        InputRecord,
        Energies,
        Box,
        Virial,
        Pressure,
        Topology,
        Symbols,
        Positions,
        Velocities,
        Forces,
        BlockCount
    };

    std::array<std::uint64_t, BlockCount> bytes{};
    std::size_t atoms = 0;
    std::int32_t step = 0;
    std::uint64_t real = 4;  // bytes of a number

    std::uint64_t blocks_at() const { return reals_at + 2 * real; }
    std::uint64_t offset_of(Block block) const {
        std::uint64_t offset = blocks_at();
        for (std::size_t i = 0; i < block; ++i) offset += bytes[i];
        return offset;
    }
    std::uint64_t length() const { return offset_of(BlockCount); }
};

class TrrTrajectory final : public Trajectory {
public:
    explicit TrrTrajectory(ByteSource source) : source_(std::move(source)) {
        std::uint64_t next = 0;
        std::size_t without = 0, frame = 0;
        for (; next < source_.size(); ++frame) {
            const std::optional<TrrHead> head = find_head(next, frame);
            if (!head || source_.size() - next < head->length()) break;
            if (head->bytes[Positions] > 0) {
                if (!frames_.empty() && head->atoms != atoms_) {
                    fail_frame(source_.name(), frame,
                               fmt::format("has {} atoms; expected {}, as in the frames before",
                                           head->atoms, atoms_));
                }
                atoms_ = head->atoms;
                frames_.push_back({next, frame});
            } else {
                ++without;
            }
            next += head->length();
        }
        if (frames_.empty()) {
            throw LoadError({source_.name()}, source_.size() == 0 ? "is empty; expected a TRR file"
                                              : next < source_.size()
                                                  ? "ends within its first frame with positions"
                                                  : "has no frame with positions");
        }
        if (next < source_.size()) notes_.push_back(cut_off_note(frame));
        if (without > 0) {
            notes_.push_back(fmt::format("{} frame{} without positions ignored", without,
                                         without == 1 ? "" : "s"));
        }
    }

    std::size_t atom_count() const noexcept override { return atoms_; }
    std::size_t frame_count() const noexcept override { return frames_.size(); }

    void read_frame(std::size_t frame, TrajectoryFrame& into) override {
        check_frame(source_.name(), frame, frames_.size());
        const auto& [offset, in_file] = frames_[frame];
        const std::optional<TrrHead> head = find_head(offset, in_file);
        if (!head || head->atoms != atoms_ || source_.size() - offset < head->length()) {
            fail_frame(source_.name(), in_file,
                       "has changed since the file was opened; expected a file that no other "
                       "program changes");
        }
        into.step = head->step;
        into.time_ps = {};
        read_block(offset + reals_at, head->real);
        if (const double time = real(0, head->real); std::isfinite(time)) into.time_ps = time;
        read_block(offset + head->offset_of(Box), head->bytes[Box]);
        into.box = {};
        if (!bytes_.empty()) {
            Mat3 box;
            for (std::size_t i = 0; i < 9; ++i) {
                box(static_cast<Eigen::Index>(i % 3), static_cast<Eigen::Index>(i / 3)) =
                    units::angstrom_per_nm * real(i, head->real);
            }
            if (box.allFinite() && !box.isZero(0)) into.box = box;
        }
        read_vectors(offset, *head, Positions, units::angstrom_per_nm, into.positions);
        read_vectors(offset, *head, Velocities, units::angstrom_per_nm, into.velocities);
        read_vectors(offset, *head, Forces, units::kcal_per_kj / units::angstrom_per_nm,
                     into.forces);
        check_positions(source_.name(), in_file, into.positions);
        for (const auto* const vectors : {&into.velocities, &into.forces}) {
            for (std::size_t atom = 0; atom < vectors->size(); ++atom) {
                if ((*vectors)[atom].allFinite()) continue;
                fail_frame(source_.name(), in_file,
                           fmt::format("atom {} has a {} that is not a finite number", atom + 1,
                                       vectors == &into.forces ? "force" : "velocity"));
            }
        }
    }

private:
    using enum TrrHead::Block;
    using Block = TrrHead::Block;

    struct FramePlace {
        std::uint64_t offset;
        std::size_t in_file;  // its number among all frames, for messages
    };

    // Nothing where the file ends before.
    std::optional<TrrHead> find_head(std::uint64_t offset, std::size_t frame) {
        const std::uint64_t room = source_.size() - offset;
        bytes_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(room, reals_at)));
        source_.read(offset, bytes_);
        if (room < 4) return {};
        const auto integer = [&](std::size_t at) {
            return number_from<std::int32_t>(&bytes_[at], trr_order);
        };
        const auto fail = [&](const std::string& what) { fail_frame(source_.name(), frame, what); };
        if (integer(0) != trr_magic) {
            fail(fmt::format("begins with {}; expected {}, as every frame of a TRR file",
                             integer(0), trr_magic));
        }
        if (room < sizes_at) return {};
        if (std::string_view(bytes_).substr(version_at, trr_version.size()) != trr_version ||
            integer(8) != static_cast<std::int32_t>(trr_version.size())) {
            fail(fmt::format("has a different TRR version; expected {}", trr_version));
        }
        if (room < reals_at) return {};
        TrrHead head;
        for (std::size_t i = 0; i < BlockCount; ++i) {
            const std::int32_t bytes = integer(sizes_at + 4 * i);
            if (bytes < 0) fail(fmt::format("has a block of {} bytes", bytes));
            head.bytes[i] = static_cast<std::uint64_t>(bytes);
        }
        const std::int32_t atoms = integer(trr_atoms_at);
        if (atoms < 1) fail(fmt::format("has {} atoms; expected 1 or more", atoms));
        head.atoms = static_cast<std::size_t>(atoms);
        head.step = integer(trr_step_at);
        // The first block that is there says how wide a number is; the others have to agree.
        const std::uint64_t count = 3 * static_cast<std::uint64_t>(atoms);
        const std::array<std::pair<Block, std::uint64_t>, 6> blocks{{{Box, 9},
                                                                     {Virial, 9},
                                                                     {Pressure, 9},
                                                                     {Positions, count},
                                                                     {Velocities, count},
                                                                     {Forces, count}}};
        bool known = false;
        for (const auto& [block, numbers] : blocks) {
            if (head.bytes[block] == 0) continue;
            if (!known && head.bytes[block] == 8 * numbers) head.real = 8;
            known = true;
            if (head.bytes[block] != head.real * numbers) {
                fail(
                    fmt::format("has a block of {} bytes for {} numbers; expected {} bytes for "
                                "each, as in all blocks of the frame",
                                head.bytes[block], numbers, head.real));
            }
        }
        return head;
    }

    void read_block(std::uint64_t offset, std::uint64_t bytes) {
        bytes_.resize(static_cast<std::size_t>(bytes));
        source_.read(offset, bytes_);
    }

    // The i-th number of the block that was read.
    double real(std::size_t i, std::uint64_t width) const {
        if (width == 8) return number_from<double>(&bytes_[8 * i], trr_order);
        return double{number_from<float>(&bytes_[4 * i], trr_order)};
    }

    void read_vectors(std::uint64_t frame_offset, const TrrHead& head, Block block, double unit,
                      std::vector<Vec3>& into) {
        into.clear();
        if (head.bytes[block] == 0) return;
        read_block(frame_offset + head.offset_of(block), head.bytes[block]);
        into.resize(atoms_);
        for (std::size_t i = 0; i < 3 * atoms_; ++i) {
            into[i / 3][static_cast<Eigen::Index>(i % 3)] = unit * real(i, head.real);
        }
    }

    ByteSource source_;
    std::size_t atoms_ = 0;
    std::vector<FramePlace> frames_;  // those with positions
    std::string bytes_;               // of one block
};

}  // namespace

std::unique_ptr<Trajectory> open_trr(ByteSource source) {
    return std::make_unique<TrrTrajectory>(std::move(source));
}

}  // namespace palpa
