#include "formats/mmcif_assemblies.h"

#include "core/load_error.h"
#include "core/text.h"
#include "formats/lines.h"

#include <fmt/format.h>
#include <algorithm>
#include <iterator>
#include <utility>

namespace palpa {
namespace {

enum Generating : std::uint8_t { AssemblyName, Expression, Chains };
constexpr auto generating_names =
    std::to_array<std::string_view>({"assembly_id", "oper_expression", "asym_id_list"});

enum Operating : std::uint8_t { Name, FirstNumber };
constexpr auto operating_names = std::to_array<std::string_view>(
    {"id", "matrix[1][1]", "matrix[1][2]", "matrix[1][3]", "vector[1]", "matrix[2][1]",
     "matrix[2][2]", "matrix[2][3]", "vector[2]", "matrix[3][1]", "matrix[3][2]", "matrix[3][3]",
     "vector[3]"});

constexpr std::size_t generating = 0, operating = 1;  // of the tables

// What bounds memory, however short the expressions that ask for it.
constexpr std::size_t most_operators = 1000;  // that one expression stands for
constexpr std::size_t most_listed = 10'000;   // in all lists of a file
constexpr std::size_t most_lists = 8;         // in a product
constexpr std::size_t most_generations = 1000;

std::string without_blanks(std::string_view text) {
    std::string result;
    std::copy_if(text.begin(), text.end(), std::back_inserter(result),
                 [](char c) { return c > ' '; });
    return result;
}

}  // namespace

MmcifAssemblies::MmcifAssemblies(const std::string& file) : file_(file) {
    tables_[generating].category = "_pdbx_struct_assembly_gen.";
    tables_[generating].names = generating_names;
    tables_[operating].category = "_pdbx_struct_oper_list.";
    tables_[operating].names = operating_names;
    for (Table& table : tables_) {
        table.row.resize(table.names.size());
        table.given.resize(table.names.size());
    }
}

void MmcifAssemblies::fail(const CifToken& token, const std::string& what) const {
    throw LoadError({file_, token.line, token.column}, what);
}

std::int8_t MmcifAssemblies::find_column(const CifToken& tag, std::size_t loop) {
    constexpr std::string_view both = "_PDBX_STRUCT_";
    if (upper_case(tag.text.substr(0, both.size())) != both) return -1;
    const std::string full_name = upper_case(tag.text);
    for (Table& table : tables_) {
        if (!full_name.starts_with(upper_case(table.category)) ||
            (loop != 0 && table_ && table_ != &table)) {
            continue;
        }
        if (table.loop && *table.loop != loop) {
            fail(tag, fmt::format("{} again, first on line {}; expected one such table",
                                  shortened(tag.text), table.line));
        }
        if (!table.loop) table.line = tag.line;
        table.loop = loop;
        table_ = &table;
        const std::string_view name = std::string_view(full_name).substr(table.category.size());
        for (std::size_t i = 0; i < table.names.size(); ++i) {
            if (upper_case(table.names[i]) != name) continue;
            if (table.given[i]) fail(tag, fmt::format("column {} again", tag.text));
            table.given[i] = true;
            return static_cast<std::int8_t>(i);
        }
    }
    return -1;
}

void MmcifAssemblies::begin_loop() {
    ++loop_;
    table_ = nullptr;
    columns_.clear();
    filled_ = 0;
}

void MmcifAssemblies::add_loop_tag(const CifToken& tag) {
    columns_.push_back(find_column(tag, loop_));
}

void MmcifAssemblies::add_loop_value(const CifToken& value) {
    if (!table_) return;
    const std::int8_t column = columns_[filled_];
    if (column >= 0) table_->row[static_cast<std::size_t>(column)] = value;
    last_ = value;
    if (++filled_ < columns_.size()) return;
    filled_ = 0;
    add_row(*table_);
}

void MmcifAssemblies::end_loop() {
    if (table_ && filled_ > 0) {
        fail({{}, last_.line, 0}, fmt::format("a row of {} ends after {} of {} values",
                                              table_->category, filled_, columns_.size()));
    }
    table_ = nullptr;
}

void MmcifAssemblies::add_tag(const CifToken& tag) {
    table_ = nullptr;
    column_ = find_column(tag, 0);
}

void MmcifAssemblies::add_value(const CifToken& value) {
    if (table_ && column_ >= 0) table_->row[static_cast<std::size_t>(column_)] = value;
    table_ = nullptr;
}

void MmcifAssemblies::add_row(const Table& table) {
    for (std::size_t i = 0; i < table.names.size(); ++i) {
        const bool is_empty = unquoted(table.row[i].text).empty();
        if (!is_empty) continue;
        const CifToken place = table.given[i] ? table.row[i] : CifToken{{}, table.line, 0};
        fail(place, fmt::format("no value of {}{}", table.category, table.names[i]));
    }
    if (&table == &tables_[generating]) {
        add_generation();
    } else {
        add_operator();
    }
}

void MmcifAssemblies::add_generation() {
    const std::vector<CifToken>& row = tables_[generating].row;
    if (generations_.size() == most_generations) {
        fail(row[AssemblyName], fmt::format("more than {} rows of assemblies", most_generations));
    }
    generations_.push_back({row[AssemblyName], row[Expression], row[Chains]});
}

double MmcifAssemblies::number(std::size_t column) const {
    const CifToken& token = tables_[operating].row[column];
    const std::string_view name = operating_names[column];
    const bool is_move = name.starts_with('v');
    const std::string_view text = unquoted(token.text);
    const std::optional<double> value = is_move ? find_coordinate(text) : find_real(text);
    if (!value) {
        fail(token, fmt::format("'{}' in _pdbx_struct_oper_list.{} is not a number{}",
                                shortened(token.text), name,
                                is_move ? fmt::format(" within ±{} Å", farthest_coordinate) : ""));
    }
    return *value;
}

void MmcifAssemblies::add_operator() {
    const CifToken& token = tables_[operating].row[Name];
    const std::string name(unquoted(token.text));
    const auto index = static_cast<std::uint32_t>(operators_.size());
    if (!operators_by_name_.emplace(name, index).second) {
        fail(token, fmt::format("operator {} again", shortened(name)));
    }
    SymmetryOperator one{name, Mat3::Zero(), Vec3::Zero(), token.line};
    std::size_t column = FirstNumber;
    for (Eigen::Index row = 0; row < 3; ++row) {
        for (Eigen::Index i = 0; i < 3; ++i) one.rotation(row, i) = number(column++);
        one.translation[row] = number(column++);
    }
    operators_.push_back(std::move(one));
}

std::uint32_t MmcifAssemblies::find_operator(std::string_view name,
                                             const CifToken& expression) const {
    const auto found = operators_by_name_.find(name);
    if (found == operators_by_name_.end()) {
        fail(expression,
             fmt::format("no operator '{}' in _pdbx_struct_oper_list", shortened(name)));
    }
    return found->second;
}

// "1,2,5-9": no longer than an expression may be.
std::vector<std::uint32_t> MmcifAssemblies::build_list(std::string_view list,
                                                       const CifToken& expression) {
    std::vector<std::uint32_t> indices;
    const auto add = [&](std::string_view name) {
        if (indices.size() == most_operators || ++listed_ > most_listed) {
            fail(expression,
                 fmt::format("too many operators; expected at most {}, and {} in all expressions",
                             most_operators, most_listed));
        }
        indices.push_back(find_operator(name, expression));
    };
    while (true) {
        const std::size_t comma = std::min(list.find(','), list.size());
        const std::string_view piece = list.substr(0, comma);
        const std::size_t dash = piece.find('-');
        const auto first = find_integer(piece.substr(0, dash));
        const auto last = dash < piece.size() ? find_integer(piece.substr(dash + 1)) : std::nullopt;
        if (!first || !last) {
            add(piece);
        } else if (*last < *first) {
            fail(expression, fmt::format("'{}' runs backwards; expected the lower number first",
                                         shortened(piece)));
        } else {
            // Ends at the first that is not there, at the latest.
            for (std::int64_t i = *first; i <= *last; ++i) add(fmt::format("{}", i));
        }
        if (comma == list.size()) return indices;
        list.remove_prefix(comma + 1);
    }
}

void MmcifAssemblies::build_part(const Generation& generation) {
    AssemblyPart part;
    const CifToken& token = generation.expression;
    const std::string text = without_blanks(unquoted(token.text));
    std::string_view rest = text;
    const auto check_size = [&] {
        std::size_t product = 1;
        for (const auto& list : part.operators) product *= list.size();
        if (product > most_operators || part.operators.size() > most_lists) {
            fail(token, fmt::format("'{}' stands for too many operators; expected at most {}, of "
                                    "{} lists",
                                    shortened(token.text), most_operators, most_lists));
        }
    };
    if (!rest.starts_with('(')) {
        part.operators.push_back(build_list(rest, token));
        rest = {};
    }
    while (!rest.empty()) {
        const std::size_t end = rest.find(')');
        if (rest[0] != '(' || end == std::string_view::npos) {
            fail(token, fmt::format("'{}' is not an expression of operators; expected one such as "
                                    "1,2 or (1-3)(4,5)",
                                    shortened(token.text)));
        }
        part.operators.push_back(build_list(rest.substr(1, end - 1), token));
        rest = rest.substr(end + 1);
        check_size();
    }
    part.chains = chain_list(unquoted(generation.chains.text));
    const std::string_view name = unquoted(generation.assembly.text);
    const auto [found, is_new] =
        assemblies_by_name_.try_emplace(std::string(name), assemblies_.size());
    if (is_new) assemblies_.push_back({std::string(name), {}});
    assemblies_[found->second].parts.push_back(std::move(part));
}

void MmcifAssemblies::move_into(Structure& structure) {
    for (const Table& table : tables_) {
        if (table.loop == 0) add_row(table);
    }
    for (const Generation& generation : generations_) build_part(generation);
    structure.operators = std::move(operators_);
    structure.assemblies = std::move(assemblies_);
}

}  // namespace palpa
