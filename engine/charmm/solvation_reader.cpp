#include "charmm/solvation_reader.h"

#include "core/text.h"

#include <fmt/format.h>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace palpa {
namespace {

constexpr std::string_view table_head =
    "type,volume_A3,dG_ref,dG_free,dH_ref,dCp_ref,lambda_A,R_min_half_A,source";
enum SolvationColumn : std::size_t {
    TypeColumn,
    VolumeColumn,
    ReferenceColumn,
    FreeColumn,
    EnthalpyColumn,
    HeatCapacityColumn,
    LambdaColumn,
    RadiusColumn,
    SourceColumn,
    ColumnCount
};

class SolvationTableReader {
public:
    SolvationTableReader(std::string_view text, const std::string& file) : text_(text) {
        table_.file = file;
    }

    SolvationTable read() {
        bool has_head = false;
        for (const std::string_view line : split_lines(text_)) {
            ++line_;
            const std::string_view content = trimmed(line);
            if (content.empty() || content.front() == '#') continue;
            if (has_head) {
                read_row(content);
            } else if (content == table_head) {
                has_head = true;
            } else {
                fail(fmt::format("'{}' is not the header of a solvation table; expected \"{}\"",
                                 shortened_text(content), table_head));
            }
        }
        if (table_.types.empty()) fail("the table has no atom types; expected one line for each");
        return std::move(table_);
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw LoadError({table_.file, line_, 0}, what);
    }

    static std::string shortened_text(std::string_view text) {
        constexpr std::size_t most = 40;
        return printable(text.size() > most ? text.substr(0, most) : text);
    }

    // All fields but the last are without commas.
    std::array<std::string_view, ColumnCount> split_fields(std::string_view line) const {
        std::array<std::string_view, ColumnCount> fields;
        std::size_t count = 0;
        while (count + 1 < ColumnCount) {
            const std::size_t comma = line.find(',');
            if (comma == std::string_view::npos) break;
            fields[count++] = trimmed(line.substr(0, comma));
            line.remove_prefix(comma + 1);
        }
        fields[count++] = trimmed(line);
        if (count < ColumnCount) {
            fail(fmt::format("{} fields; expected {}: {}", count, std::size_t{ColumnCount},
                             table_head));
        }
        return fields;
    }

    double real(std::string_view word, std::string_view what) const {
        const std::optional<double> value = find_real(word);
        if (!value) fail(fmt::format("'{}' is not a {}", shortened_text(word), what));
        return *value;
    }

    std::string unquoted(std::string_view field) const {
        if (field.empty() || field.front() != '"') {
            if (field.find_first_of(",\"") == std::string_view::npos) return std::string(field);
        } else if (field.size() > 1 && field.back() == '"') {
            field = field.substr(1, field.size() - 2);
            if (field.find('"') == std::string_view::npos) return std::string(trimmed(field));
        }
        fail(fmt::format(
            "'{}' is not a valid source; expected text, in quotes if it contains commas",
            shortened_text(field)));
    }

    // The bounds are far from any atom's, and keep all sums finite.
    void check_bounds(const SolvationRow& row) const {
        if (row.volume < 0 || row.volume > 1e4)
            fail(fmt::format("the volume is {} Å^3; expected 0 to 10000", row.volume));
        for (const double energy : {row.dg_ref, row.dg_free}) {
            if (std::abs(energy) > 1e4)
                fail(fmt::format("the energy is {} kcal/mol; expected -10000 to 10000", energy));
        }
        if (row.lambda < 0.1 || row.lambda > 1e3)
            fail(fmt::format("lambda is {} Å; expected 0.1 to 1000", row.lambda));
        if (row.radius < 0.1 || row.radius > 100)
            fail(fmt::format("the radius is {} Å; expected 0.1 to 100", row.radius));
    }

    void read_row(std::string_view line) {
        const auto fields = split_fields(line);
        const std::string type = upper_case(fields[TypeColumn]);
        if (type.empty() || split_words(type).size() != 1)
            fail(fmt::format("'{}' is not an atom type; expected a name", shortened_text(type)));
        SolvationRow row;
        row.volume = real(fields[VolumeColumn], "volume; expected a number, in Å^3");
        row.dg_ref = real(fields[ReferenceColumn], "dG_ref; expected a number, in kcal/mol");
        row.dg_free = real(fields[FreeColumn], "dG_free; expected a number, in kcal/mol");
        (void)real(fields[EnthalpyColumn], "dH_ref; expected a number, in kcal/mol");
        (void)real(fields[HeatCapacityColumn], "dCp_ref; expected a number, in cal/(mol K)");
        row.lambda = real(fields[LambdaColumn], "lambda; expected a number, in Å");
        row.radius = real(fields[RadiusColumn], "radius; expected a number, in Å");
        check_bounds(row);
        row.source = unquoted(fields[SourceColumn]);
        row.is_assigned = row.source.starts_with("ASSIGNED");
        row.place = {table_.file, line_, 0};
        const auto [known, is_new] = table_.types.emplace(type, std::move(row));
        if (!is_new) {
            fail(fmt::format("type {} is repeated, first on line {}", printable(type),
                             known->second.place.line));
        }
    }

    std::string_view text_;
    std::size_t line_ = 0;
    SolvationTable table_;
};

}  // namespace

SolvationTable parse_solvation_table(std::string_view text, const std::string& file) {
    return SolvationTableReader(text, file).read();
}

const SolvationTable& eef1sb_table() {
    static const SolvationTable table = parse_solvation_table(eef1sb_csv(), "eef1sb.csv");
    return table;
}

}  // namespace palpa
