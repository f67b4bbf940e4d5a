// The parameter part of CHARMM's files: sections from ATOMS to NBFIX.
#pragma once
#include "charmm/force_field.h"
#include "charmm/statements.h"

#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

class ParameterReader {
public:
    ParameterReader(const Statements& statements, ForceField& into)
        : statements_(statements), into_(into) {}

    // Whether a keyword begins a section.
    static bool is_section(std::string_view keyword) { return find_section(keyword).has_value(); }

    // Reads the present statement into the force field.
    void read();

    // Whether a section has begun and not ended.
    bool is_open() const noexcept { return section_ != Section::None; }

    // Ends the section; a CMAP map must be whole then.
    void end_part();

private:
    enum class Section {
        None,
        Atoms,
        Bonds,
        Angles,
        Dihedrals,
        Impropers,
        Cmap,
        Nonbonded,
        Nbfix,
        HydrogenBonds
    };
    static std::optional<Section> find_section(std::string_view keyword);

    // A CMAP that is being read.
    struct OpenMap {
        std::array<std::string, 8> types;
        std::size_t count = 0;  // number of values of the complete map
        CmapParameter parameter;
    };

    // Terms of earlier parts and their replacement by this part.
    struct ReplacedDihedral {
        const std::vector<DihedralTerm>* now;
        std::vector<DihedralTerm> terms;
        std::string what;
    };

    void start_section(Section section);
    [[noreturn]] void fail_section() const;
    void read_bond();
    void read_angle();
    void read_dihedral(bool is_improper);
    void add_dihedral(std::vector<DihedralTerm>& terms, const DihedralTerm& term,
                      const std::string& what);
    void note_replaced_dihedrals();
    void read_cmap();
    void read_cmap_energies(OpenMap& map) const;
    bool is_inside_map() const;  // whether the open map is incomplete
    void end_cmap();
    void read_nonbonded();
    void read_nbfix();
    void check_nonbonded_options() const;
    // Reads well depth (kcal/mol) and distance of the minimum (Å) from word `at` on.
    std::array<double, 2> read_well(std::size_t at, const char* distance) const;

    const Statements& statements_;
    ForceField& into_;
    Section section_ = Section::None;
    std::optional<OpenMap> open_map_;  // the open map, if any
    std::set<const std::vector<DihedralTerm>*>
        of_this_part_;  // dihedrals to which this part gave their first terms
    std::vector<ReplacedDihedral> replaced_;
};

}  // namespace palpa
