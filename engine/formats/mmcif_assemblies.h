// Biological assemblies of macromolecular CIF files.
#pragma once
#include "formats/cif.h"
#include "molecule/atoms.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Gathers the assemblies of one file: _pdbx_struct_assembly_gen says which chains (label_asym_id)
// are copied by which operators, _pdbx_struct_oper_list the operators. Expressions are "1", "1,2",
// "1-60", "P" and products of such lists, "(1-3)(4,5)". Every call throws LoadError with the line
// of what is wrong. The tokens must live until `move_into` has been called.
class MmcifAssemblies final : public CifListener {
public:
    explicit MmcifAssemblies(const std::string& file);

    void begin_loop() override;
    void add_loop_tag(const CifToken& tag) override;
    void add_loop_value(const CifToken& value) override;
    void end_loop() override;
    void add_tag(const CifToken& tag) override;
    void add_value(const CifToken& value) override;

    // Call after the last token. Refuses operators that the file does not define, and expressions
    // with more than 1,000 operators.
    void move_into(Structure& structure);

private:
    // One of the two tables with its present row.
    struct Table {
        std::string_view category;                // "_pdbx_struct_oper_list."
        std::span<const std::string_view> names;  // names of its columns
        std::vector<CifToken> row;
        std::vector<bool> given;
        std::optional<std::size_t> loop;  // number of its loop, 0 outside of loops
        std::size_t line = 0;
    };
    struct Generation {
        CifToken assembly, expression, chains;
    };

    [[noreturn]] void fail(const CifToken& token, const std::string& what) const;
    // Sets `table_` and returns the column; -1 for what is not read.
    std::int8_t find_column(const CifToken& tag, std::size_t loop);
    void add_row(const Table& table);
    void add_generation();
    void add_operator();
    double number(std::size_t column) const;
    void build_part(const Generation& generation);
    std::vector<std::uint32_t> build_list(std::string_view list, const CifToken& expression);
    std::uint32_t find_operator(std::string_view name, const CifToken& expression) const;

    const std::string& file_;
    std::array<Table, 2> tables_;
    std::size_t loop_ = 0;              // number of the loop, from 1
    Table* table_ = nullptr;            // table of the present loop or tag
    std::vector<std::int8_t> columns_;  // of this loop
    std::size_t filled_ = 0;            // values of the row so far
    CifToken last_;                     // last value of the row
    std::int8_t column_ = -1;           // column of the last tag outside of loops

    std::vector<Generation> generations_;
    std::vector<SymmetryOperator> operators_;
    std::map<std::string, std::uint32_t, std::less<>> operators_by_name_;
    std::vector<Assembly> assemblies_;
    std::map<std::string, std::size_t, std::less<>> assemblies_by_name_;
    std::size_t listed_ = 0;  // number of operators in all expressions
};

}  // namespace palpa
