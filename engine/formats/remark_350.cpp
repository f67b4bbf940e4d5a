#include "formats/remark_350.h"

#include "core/load_error.h"
#include "core/text.h"
#include "formats/lines.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>

namespace palpa {
namespace {

constexpr std::size_t most_of_part = 1000;  // of one part
constexpr std::array<std::string_view, 3> row_names{"BIOMT1", "BIOMT2", "BIOMT3"};

// What stands behind `beginning`, or nothing where the text begins in another way.
std::optional<std::string_view> find_rest(std::string_view text, std::string_view beginning) {
    if (!text.starts_with(beginning)) return std::nullopt;
    return trimmed(text.substr(beginning.size()));
}

}  // namespace

void Remark350::fail(std::size_t line, const std::string& what) const {
    throw LoadError({file_, line}, what);
}

void Remark350::add_line(std::string_view line, std::size_t number) {
    constexpr std::size_t text_column = 10;
    const std::string_view text = trimmed(line.substr(std::min(text_column, line.size())));
    if (const auto name = find_rest(text, "BIOMOLECULE:")) {
        begin_assembly(*name, number);
    } else if (const auto chains = find_rest(text, "APPLY THE FOLLOWING TO CHAINS:")) {
        begin_part(*chains, number);
    } else if (const auto more = find_rest(text, "AND CHAINS:")) {
        if (part_line_ == 0) fail(number, "AND CHAINS without APPLY THE FOLLOWING TO CHAINS");
        add_chains(*more, number);
    } else if (text.starts_with("BIOMT")) {
        add_row(split_words(text), number);
    }
}

// That a part, if one is open, has operators with all their rows.
void Remark350::check_complete() const {
    if (part_line_ == 0) return;
    if (assemblies_.back().parts.back().operators[0].empty()) {
        fail(part_line_, "chains without an operator; expected BIOMT1, BIOMT2 and BIOMT3");
    }
    if (rows_ < row_names.size()) {
        fail(operators_.back().line,
             fmt::format("operator {} has no row {}", operators_.back().name, row_names[rows_]));
    }
}

void Remark350::begin_assembly(std::string_view name, std::size_t line) {
    check_complete();
    part_line_ = 0;
    if (name.empty()) fail(line, "BIOMOLECULE without a number");
    if (!names_.emplace(name).second) {
        fail(line, fmt::format("biomolecule {} is repeated", shortened(name)));
    }
    assemblies_.push_back({std::string(name), {}});
}

void Remark350::begin_part(std::string_view chains, std::size_t line) {
    check_complete();
    // Files with one assembly alone may leave out its number.
    if (assemblies_.empty()) begin_assembly("1", line);
    assemblies_.back().parts.push_back({"", {{}}});
    part_line_ = line;
    rows_ = row_names.size();
    add_chains(chains, line);
}

void Remark350::add_chains(std::string_view chains, std::size_t line) {
    AssemblyPart& part = assemblies_.back().parts.back();
    if (!part.operators[0].empty())
        fail(line, "the chains follow their operators; expected them before");
    if (chains == "NULL") return;  // the chain without a name
    part.chains += chain_list(chains);
}

void Remark350::add_row(const std::vector<std::string_view>& words, std::size_t line) {
    if (part_line_ == 0) {
        fail(line, "an operator has no chains; expected APPLY THE FOLLOWING TO CHAINS before it");
    }
    constexpr std::size_t word_count = 6;
    if (words.size() != word_count) {
        fail(line,
             fmt::format("{} words after REMARK 350; expected {}, such as BIOMT1 1 1.0 0.0 0.0 0.0",
                         words.size(), word_count));
    }
    std::vector<std::uint32_t>& list = assemblies_.back().parts.back().operators[0];
    if (rows_ == row_names.size()) {
        if (list.size() == most_of_part) {
            fail(line, fmt::format("more than {} operators for the chains of line {}", most_of_part,
                                   part_line_));
        }
        list.push_back(static_cast<std::uint32_t>(operators_.size()));
        operators_.push_back({std::string(words[1]), Mat3::Zero(), Vec3::Zero(), line});
        rows_ = 0;
    }
    SymmetryOperator& one = operators_.back();
    if (words[0] != row_names[rows_] || words[1] != one.name) {
        fail(line, fmt::format("'{} {}'; expected {} {}", shortened(words[0]), shortened(words[1]),
                               row_names[rows_], shortened(one.name)));
    }
    const auto row = static_cast<Eigen::Index>(rows_);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::optional<double> value = find_real(words[2 + i]);
        if (!value) fail(line, fmt::format("'{}' is not a number", shortened(words[2 + i])));
        one.rotation(row, static_cast<Eigen::Index>(i)) = *value;
    }
    const std::optional<double> move = find_coordinate(words[5]);
    if (!move) {
        fail(line, fmt::format("'{}' is not a translation; expected a number within ±{} Å",
                               shortened(words[5]), farthest_coordinate));
    }
    one.translation[row] = *move;
    ++rows_;
}

void Remark350::move_into(Structure& structure) {
    check_complete();
    structure.operators = std::move(operators_);
    structure.assemblies = std::move(assemblies_);
}

}  // namespace palpa
