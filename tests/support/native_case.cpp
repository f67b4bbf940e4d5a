#include "tests/support/native_case.h"

#include "tests/support/reference_case.h"

#include <fmt/format.h>
#include <map>

namespace palpa::test {

namespace {

// GROMACS's residues ACE and CT3 are patches of the residue between them.
void rename_blocks(AtomName& name) {
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

}  // namespace

ForceField read_charmm(const std::filesystem::path& folder, const std::vector<std::string>& names) {
    std::vector<std::filesystem::path> files;
    for (const std::string& name : names) files.push_back(folder / name);
    return read_force_field(files);
}

NativeAtoms read_native_atoms(const std::filesystem::path& path) {
    NativeAtoms result;
    Structure& structure = result.structure;
    structure.file = path.string();
    int residue = 0, chain = 0;
    bool is_end = true;
    const ReferenceCase reference = read_reference_case(path);
    for (const ReferenceAtom& atom : reference.atoms) {
        AtomName name{atom.segment, atom.residue, "", atom.name};
        if (!atom.segment.empty()) {
            name.number = std::to_string(atom.number);
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
        result.typed.push_back({atom.type, atom.charge});
    }
    return result;
}

}  // namespace palpa::test
