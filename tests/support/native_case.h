// Cases of CHARMM's own files: the force field files of PALPA_DATA, and structures to type with
// them.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"
#include "tests/support/reference_case.h"

#include <fmt/format.h>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace palpa::test {

inline ForceField read_charmm(const std::filesystem::path& folder,
                              const std::vector<std::string>& names) {
    std::vector<std::filesystem::path> files;
    for (const std::string& name : names) files.push_back(folder / name);
    return read_force_field(files);
}

struct TypedAtom {
    std::string type;
    double charge;
};

// GROMACS's residues ACE and CT3 are patches of the residue between them.
inline void rename_blocks(AtomName& name) {
    static const std::map<std::string, std::map<std::string, std::string>> blocks{
        {"ACE",
         {{"CH3", "CAY"},
          {"HH31", "HY1"},
          {"HH32", "HY2"},
          {"HH33", "HY3"},
          {"C", "CY"},
          {"O", "OY"}}},
        {"CT3",
         {{"N", "NT"},
          {"HN", "HNT"},
          {"CH3", "CAT"},
          {"HH31", "HT1"},
          {"HH32", "HT2"},
          {"HH33", "HT3"}}}};
    const auto block = blocks.find(name.residue);
    if (block == blocks.end()) return;
    name = {"S1", "ALA", "1", block->second.at(name.atom)};
}

// The atoms of CASE.ff.json as CHARMM calls them, at the origin, and what they should become. Files
// from GROMACS number residues anew where a chain begins and call some atoms otherwise.
struct ReferenceAtoms {
    Structure structure;
    std::vector<TypedAtom> typed;
};

inline ReferenceAtoms read_reference_atoms(const std::filesystem::path& path) {
    const nlohmann::json json = read_json(path);
    ReferenceAtoms result;
    Structure& structure = result.structure;
    structure.file = path.string();
    int residue = 0, chain = 0;
    bool is_end = true;
    for (const auto& row : json["atoms"]["rows"]) {
        AtomName name{"", row[1], "", row[0]};
        if (row.size() > 8) {
            name.segment = row[8];
            name.number = std::to_string(row[2].get<int>());
        } else {
            if (name.atom == "N") {
                ++residue;
                chain += is_end ? 1 : 0;
                is_end = false;
            }
            is_end = is_end || name.atom == "OT2";
            name.segment = fmt::format("S{}", chain);
            name.number = std::to_string(residue);
            if (name.residue == "HIS") name.residue = "HSE";
            if (name.atom == "H1" || name.atom == "H2" || name.atom == "H3")
                name.atom = fmt::format("{}{}", name.residue == "PRO" ? "HN" : "HT", name.atom[1]);
        }
        rename_blocks(name);
        structure.names.push_back(name);
        structure.positions.push_back(Vec3::Zero());
        structure.lines.push_back(structure.names.size());
        result.typed.push_back({row[3], row[5]});
    }
    return result;
}

}  // namespace palpa::test
