#include "molecule/residue_kinds.h"

#include "molecule/component_tables.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <string>

namespace palpa {
namespace {

using Name = std::string_view;

constexpr auto waters =
    std::to_array<Name>({"HOH", "WAT", "H2O", "DOD", "SOL", "TIP", "TIP2", "TIP3", "TIP4", "TIP5",
                         "TP3M", "SPC", "SPCE", "OH2", "TP3", "T3P", "WTR", "HHO", "OHH"});

// With the protonation states of CHARMM and AMBER, and caps.
constexpr auto plain_amino_acids = std::to_array<Name>(
    {"ALA", "ARG", "ASN", "ASP", "CYS", "GLN", "GLU", "GLY", "HIS", "ILE", "LEU", "LYS",
     "MET", "PHE", "PRO", "SER", "THR", "TRP", "TYR", "VAL", "HSD", "HSE", "HSP", "HID",
     "HIE", "HIP", "CYX", "CYM", "ASH", "GLH", "LYN", "LSN", "ACE", "NME", "NMA", "NH2"});

// CHARMM36 names most phospholipids by two letters for their tails and two for their head.
constexpr auto lipid_tails =
    std::to_array<Name>({"DL", "DM", "DP", "DS", "DO", "DA", "DE", "DU", "DG", "DB", "DN", "DY",
                         "PO", "SO", "SD", "SL", "PL", "SA", "PA", "PY", "YO", "LP", "LL"});
constexpr auto lipid_heads = std::to_array<Name>({"PC", "PE", "PS", "PG", "PA", "PI"});
constexpr auto other_lipids =
    std::to_array<Name>({"PSM", "SSM", "LSM", "NSM", "OSM", "CER160", "CER180", "CER181", "TOCL1",
                         "TOCL2", "TMCL1", "TLCL1", "PALM", "SAPI", "POPI", "PLPI"});

constexpr auto protein_backbone =
    std::to_array<Name>({"N", "CA", "C", "O", "OT1", "OT2", "OXT", "CY", "OY", "NT"});
constexpr auto nucleic_backbone =
    std::to_array<Name>({"P", "O1P", "O2P", "OP1", "OP2", "OP3", "O5T", "O5'", "C5'", "C4'", "C3'",
                         "O3'", "O5*", "C5*", "C4*", "C3*", "O3*"});

bool contains(std::span<const Name> names, Name name) noexcept {
    return std::ranges::find(names, name) != names.end();
}

bool contains(std::span<const Component> table, Name name) noexcept {
    return std::ranges::any_of(
        table, [&](const Component& one) { return one.name == name || one.charmm == name; });
}

bool is_lipid(Name name) noexcept {
    if (contains(lipids(), name) || contains(other_lipids, name)) return true;
    return name.size() == 4 && contains(lipid_tails, name.substr(0, 2)) &&
           contains(lipid_heads, name.substr(2));
}

bool is_glycan(Name name) noexcept {
    return contains(sugars(), name) || !find_ring_oxygens(name).empty();
}

class KindFinder {
public:
    KindFinder(const AtomTable& atoms, std::span<const AtomRange> residues)
        : atoms_(atoms), residues_(residues) {
        find_links();
    }

    ResidueKind kind_of(std::size_t residue) const {
        const AtomRange& range = residues_[residue];
        const Name name = atoms_.names[range.first].residue;
        if (is_water(name) || has_atoms_of_water(range)) return ResidueKind::Water;
        if (is_ion(range)) return ResidueKind::Ion;
        if (has_atoms(range, {"N", "CA", "C"}) || contains(plain_amino_acids, name) ||
            contains(amino_acids(), name)) {
            return ResidueKind::Protein;
        }
        const bool has_ribose = has_atoms(range, {"C1'", "C3'", "C4'", "C5'", "O4'"}) ||
                                has_atoms(range, {"C1*", "C3*", "C4*", "C5*", "O4*"});
        if (contains(nucleotides(), name) || (has_ribose && is_linked_[residue]))
            return ResidueKind::Nucleic;
        if (is_glycan(name)) return ResidueKind::Glycan;
        if (is_lipid(name)) return ResidueKind::Lipid;
        return ResidueKind::Ligand;
    }

private:
    // Which residues are bonded to others by an ester of their ribose, O3' to P.
    void find_links() {
        std::vector<std::uint32_t> residue_of(atoms_.size(), 0);
        for (std::uint32_t i = 0; i < residues_.size(); ++i)
            std::fill_n(residue_of.begin() + residues_[i].first, residues_[i].count, i);
        is_linked_.assign(residues_.size(), false);
        for (const auto& [a, b] : atoms_.bonds) {
            if (residue_of[a] == residue_of[b]) continue;
            const Name one = atoms_.names[a].atom, other = atoms_.names[b].atom;
            const auto is_ester = [](Name oxygen, Name phosphorus) {
                return (oxygen == "O3'" || oxygen == "O3*") && phosphorus == "P";
            };
            if (!is_ester(one, other) && !is_ester(other, one)) continue;
            is_linked_[residue_of[a]] = is_linked_[residue_of[b]] = true;
        }
    }

    bool has_atoms(const AtomRange& range, std::initializer_list<Name> names) const {
        return std::ranges::all_of(names, [&](Name name) {
            for (std::uint32_t i = range.first; i < range.first + range.count; ++i)
                if (atoms_.names[i].atom == name) return true;
            return false;
        });
    }

    // What stands beside an oxygen in other models of water has hardly any mass.
    bool has_atoms_of_water(const AtomRange& range) const {
        if (range.count < 3 || range.count > 6) return false;
        int oxygens = 0, hydrogens = 0;
        for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
            if (i < atoms_.mass.size() && atoms_.mass[i] < 0.9) continue;
            const std::string element = find_element(atoms_, i);
            const bool is_hydrogen = element == "H" || element == "D";
            if (element != "O" && !is_hydrogen) return false;
            ++(is_hydrogen ? hydrogens : oxygens);
        }
        return oxygens == 1 && hydrogens == 2;
    }

    // Neither a trace of a chain (CA or P alone) nor a noble gas is one.
    bool is_ion(const AtomRange& range) const {
        if (range.count != 1) return false;
        constexpr auto others = std::to_array<Name>(
            {"", "H", "D", "C", "N", "O", "P", "S", "HE", "NE", "AR", "KR", "XE"});
        return !contains(others, find_element(atoms_, range.first));
    }

    const AtomTable& atoms_;
    std::span<const AtomRange> residues_;
    std::vector<bool> is_linked_;
};

}  // namespace

bool is_water(std::string_view residue) noexcept { return contains(waters, residue); }

bool is_plain_amino_acid(std::string_view residue) noexcept {
    return contains(plain_amino_acids, residue);
}

std::vector<ResidueKind> find_residue_kinds(const AtomTable& atoms,
                                            std::span<const AtomRange> residues) {
    const KindFinder finder(atoms, residues);
    std::vector<ResidueKind> kinds;
    kinds.reserve(residues.size());
    for (std::size_t i = 0; i < residues.size(); ++i) kinds.push_back(finder.kind_of(i));
    return kinds;
}

bool is_of_backbone(ResidueKind kind, std::string_view atom) noexcept {
    if (kind == ResidueKind::Protein) return contains(protein_backbone, atom);
    return kind == ResidueKind::Nucleic && contains(nucleic_backbone, atom);
}

}  // namespace palpa
