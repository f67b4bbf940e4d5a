// Cases of CHARMM's own files: the force field files of PALPA_DATA, and structures to type with
// them.
#pragma once
#include "charmm/force_field.h"
#include "core/files.h"
#include "core/text.h"
#include "molecule/atoms.h"
#include "tests/support/reference_case.h"

#include <fmt/format.h>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::test {

inline ForceField read_charmm(const std::filesystem::path& folder,
                              const std::vector<std::string>& names) {
    std::vector<std::filesystem::path> files;
    for (const std::string& name : names) files.push_back(folder / name);
    return read_force_field(files);
}

// ATOM records in fixed columns, all in one segment "A"; for files that are known to be sound.
inline Structure read_plain_pdb(const std::filesystem::path& path) {
    const std::string text = read_text_file(path);
    Structure structure{.file = path.string(), .names = {}, .positions = {}, .lines = {}};
    const std::vector<std::string_view> lines = split_lines(text);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (!lines[i].starts_with("ATOM")) continue;
        const auto column = [&](std::size_t first, std::size_t count) {
            return std::string(trimmed(lines[i].substr(first, count)));
        };
        structure.names.push_back({"A", column(17, 4), column(22, 5), column(12, 4)});
        structure.positions.emplace_back(find_real(column(30, 8)).value(),
                                         find_real(column(38, 8)).value(),
                                         find_real(column(46, 8)).value());
        structure.lines.push_back(i + 1);
    }
    return structure;
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
