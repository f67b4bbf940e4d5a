#include "formats/mmcif_models.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "formats/box.h"
#include "formats/cif.h"
#include "formats/lines.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr std::string_view site_prefix = "_ATOM_SITE.", cell_prefix = "_CELL.";
constexpr std::array site_columns =
    std::to_array<std::string_view>({"CARTN_X", "CARTN_Y", "CARTN_Z", "PDBX_PDB_MODEL_NUM"});
constexpr std::array cell_names = std::to_array<std::string_view>(
    {"LENGTH_A", "LENGTH_B", "LENGTH_C", "ANGLE_ALPHA", "ANGLE_BETA", "ANGLE_GAMMA"});

// The rows of one model, where they stand in the text.
struct ModelRows {
    std::uint64_t begin = 0, end = 0;
    std::size_t atoms = 0;
    std::string number;
};

struct ModelTable {
    std::size_t columns = 0;
    std::array<std::size_t, 3> coordinates{};  // their columns
    std::vector<ModelRows> models;
    std::optional<Mat3> box;
};

// Finds the models of a text.
class ModelFinder final : public CifListener {
public:
    ModelFinder(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    void begin_loop() override {
        in_table_ = false;
        is_table_known_ = false;
        loop_columns_ = 0;
    }

    void add_loop_tag(const CifToken& tag) override {
        const std::string name = upper_case(tag.text);
        if (name.starts_with(site_prefix)) {
            if (!in_table_ && table_line_ != 0) {
                fail(tag,
                     fmt::format(
                         "a second table of atoms, first on line {}; expected one table _atom_site",
                         table_line_));
            }
            in_table_ = true;
            if (table_line_ == 0) table_line_ = tag.line;
            const std::string_view column = std::string_view(name).substr(site_prefix.size());
            for (std::size_t i = 0; i < site_columns.size(); ++i) {
                if (column == site_columns[i]) columns_[i] = loop_columns_;
            }
        }
        ++loop_columns_;
    }

    void add_loop_value(const CifToken& value) override {
        if (!in_table_) return;
        if (!is_table_known_) check_table(value);
        const auto begin = static_cast<std::uint64_t>(value.text.data() - text_.data());
        if (filled_ == 0) row_begin_ = begin;
        if (filled_ == columns_[3]) model_ = unquoted(value.text);
        last_line_ = value.line;
        if (++filled_ < loop_columns_) return;
        filled_ = 0;
        add_row(begin + value.text.size());
    }

    void end_loop() override {
        if (!in_table_ || filled_ == 0) return;
        throw LoadError(
            {file_, last_line_},
            fmt::format("a row of _atom_site ends after {} of {} values", filled_, loop_columns_));
    }

    void add_tag(const CifToken& tag) override {
        cell_ = {};
        const std::string name = upper_case(tag.text);
        if (!name.starts_with(cell_prefix)) return;
        const std::string_view column = std::string_view(name).substr(cell_prefix.size());
        for (std::size_t i = 0; i < cell_names.size(); ++i) {
            if (column == cell_names[i]) cell_ = i;
        }
    }

    void add_value(const CifToken& value) override {
        if (cell_) cell_values_[*cell_] = find_real(unquoted(value.text));
    }

    ModelTable take() {
        check_atoms();
        if (table_.models.empty()) {
            throw LoadError({file_}, "ends without any atom in a loop _atom_site");
        }
        Vec3 lengths, angles;
        bool is_cell = true;
        for (std::size_t i = 0; i < cell_values_.size(); ++i) {
            Vec3& into = i < 3 ? lengths : angles;
            into[static_cast<Eigen::Index>(i % 3)] = cell_values_[i].value_or(0);
            is_cell = is_cell && cell_values_[i];
        }
        if (is_cell && lengths.maxCoeff() > 1) table_.box = find_box_deg(lengths, angles);
        return std::move(table_);
    }

private:
    [[noreturn]] void fail(const CifToken& token, const std::string& what) const {
        throw LoadError({file_, token.line, token.column}, what);
    }

    void check_table(const CifToken& value) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (const std::optional<std::size_t> column = columns_[i]) {
                table_.coordinates[i] = *column;
            } else {
                fail(value,
                     "a column _atom_site.Cartn_x, Cartn_y or Cartn_z is missing; expected all "
                     "three");
            }
        }
        table_.columns = loop_columns_;
        is_table_known_ = true;
    }

    void add_row(std::uint64_t end) {
        std::vector<ModelRows>& models = table_.models;
        if (models.empty() || models.back().number != model_) {
            if (!numbers_.insert(std::string(model_)).second) {
                throw LoadError(
                    {file_, last_line_},
                    fmt::format("model {} is repeated; expected all atoms of a model together",
                                model_));
            }
            check_atoms();
            models.push_back({row_begin_, end, 0, std::string(model_)});
        }
        models.back().end = end;
        ++models.back().atoms;
    }

    // Of the last model, once it is complete.
    void check_atoms() const {
        const std::vector<ModelRows>& models = table_.models;
        if (models.empty() || models.back().atoms == models.front().atoms) return;
        throw LoadError({file_, last_line_},
                        fmt::format("frame {}: has {} atoms; expected {}, as in the frames before",
                                    models.size(), models.back().atoms, models.front().atoms));
    }

    std::string_view text_;
    const std::string& file_;
    ModelTable table_;
    bool in_table_ = false, is_table_known_ = false;
    std::size_t table_line_ = 0, last_line_ = 0;
    std::size_t loop_columns_ = 0;                       // of this loop
    std::array<std::optional<std::size_t>, 4> columns_;  // of site_columns
    std::size_t filled_ = 0;                             // values of the row so far
    std::uint64_t row_begin_ = 0;
    std::string_view model_;
    std::set<std::string, std::less<>> numbers_;
    std::optional<std::size_t> cell_;  // of the last tag outside of a loop
    std::array<std::optional<double>, 6> cell_values_;
};

// Takes the coordinates out of the rows of one model.
class ModelReader final : public CifListener {
public:
    ModelReader(const ModelTable& table, const std::string& file, std::size_t frame,
                TrajectoryFrame& into)
        : table_(table), file_(file), frame_(frame), into_(into) {}

    void begin_loop() override {}
    void add_loop_tag(const CifToken& /*tag*/) override {}
    void end_loop() override {}
    void add_tag(const CifToken& /*tag*/) override {}
    void add_value(const CifToken& /*value*/) override {}

    void add_loop_value(const CifToken& value) override {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (filled_ != table_.coordinates[axis]) continue;
            const std::optional<double> coordinate = find_coordinate(unquoted(value.text));
            if (!coordinate) {
                fail_frame(file_, frame_,
                           fmt::format("atom {} has the coordinate '{}'; expected a number within "
                                       "±{} Å",
                                       into_.positions.size() + 1, shortened(value.text),
                                       farthest_coordinate));
            }
            position_[static_cast<Eigen::Index>(axis)] = *coordinate;
        }
        if (++filled_ < table_.columns) return;
        filled_ = 0;
        into_.positions.push_back(position_);
    }

private:
    const ModelTable& table_;
    const std::string& file_;
    std::size_t frame_;
    TrajectoryFrame& into_;
    std::size_t filled_ = 0;  // values of the row so far
    Vec3 position_ = Vec3::Zero();
};

class MmcifModels final : public Trajectory {
public:
    explicit MmcifModels(ByteSource source) : source_(std::move(source)) {
        if (source_.size() > most_file_bytes) {
            throw LoadError({source_.name()},
                            "is too large for a CIF file; expected at most 1 GiB");
        }
        std::string text(static_cast<std::size_t>(source_.size()), '\0');
        source_.read(0, text);
        ModelFinder finder(text, source_.name());
        parse_cif(text, source_.name(), finder);
        table_ = finder.take();
        const ModelRows& last = table_.models.back();
        if (text.find_first_not_of(" \t\r\n", static_cast<std::size_t>(last.end)) ==
            std::string::npos) {
            notes_.emplace_back("ends with its last atom: the file may have been cut off");
        }
    }

    std::size_t atom_count() const noexcept override { return table_.models.front().atoms; }
    std::size_t frame_count() const noexcept override { return table_.models.size(); }

    void read_frame(std::size_t frame, TrajectoryFrame& into) override {
        check_frame(source_.name(), frame, frame_count());
        const ModelRows& model = table_.models[frame];
        std::string text = "data_frame\nloop_\n";
        for (std::size_t i = 0; i < table_.columns; ++i) text += fmt::format("_row.{}\n", i);
        const std::size_t rows = text.size();
        text.resize(rows + static_cast<std::size_t>(model.end - model.begin));
        source_.read(model.begin, std::span(text).subspan(rows));
        text += '\n';
        into.positions.clear();
        into.positions.reserve(atom_count());
        into.velocities.clear();
        into.forces.clear();
        into.box = table_.box;
        into.time_ps = {};
        into.step = {};
        ModelReader reader(table_, source_.name(), frame, into);
        parse_cif(text, source_.name(), reader);
        if (into.positions.size() != atom_count()) {
            fail_frame(source_.name(), frame,
                       "has changed since the file was opened; expected a file that no other "
                       "program changes");
        }
    }

private:
    ByteSource source_;
    ModelTable table_;
};

}  // namespace

std::unique_ptr<Trajectory> open_mmcif_models(ByteSource source) {
    return std::make_unique<MmcifModels>(std::move(source));
}

}  // namespace palpa
