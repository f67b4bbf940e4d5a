// Reads bonds between residues from structure files: LINK, SSBOND, struct_conn.
#pragma once
#include "formats/cif.h"
#include "molecule/atoms.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace palpa {

// The bond of a LINK or SSBOND line; nothing if it cannot be parsed, or names a symmetry copy. The
// caller must check the atoms.
std::optional<StructureLink> find_pdb_link(std::string_view line, std::size_t number);

// Gathers the rows of _struct_conn that are covalent bonds, disulphides or bonds to metals. The
// tokens must live until `take` has been called. Rows that say nothing of use are left out.
class MmcifLinks final : public CifListener {
public:
    void begin_loop() override;
    void add_loop_tag(const CifToken& tag) override;
    void add_loop_value(const CifToken& value) override;
    void end_loop() override;
    void add_tag(const CifToken& tag) override;
    void add_value(const CifToken& value) override;

    std::vector<StructureLink> take();

private:
    // The type of bond, and seven of each atom.
    static constexpr std::size_t columns = 1 + 2 * 7;

    static std::optional<std::size_t> find_column(std::string_view tag);
    void add_row();

    std::vector<std::optional<std::size_t>> columns_;  // columns of this loop
    bool is_table_ = false;
    std::size_t filled_ = 0;  // number of values of the present row
    std::optional<std::size_t> column_;
    bool has_single_row_ = false;  // a single row of tags outside of loops
    std::array<CifToken, columns> row_{};
    std::vector<StructureLink> links_;
};

}  // namespace palpa
