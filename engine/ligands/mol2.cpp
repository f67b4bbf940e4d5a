#include "core/text.h"
#include "ligands/file_lines.h"
#include "ligands/sdf.h"

#include <fmt/format.h>
#include <cstddef>
#include <set>

namespace palpa {
namespace {

void read_atom(const FileLines& lines, LigandFile& into, std::set<std::string>& names) {
    const std::vector<std::string_view> words = split_words(lines.line());
    if (words.size() < 6) lines.fail("expected number, name, x, y, z and type of an atom");
    if (lines.count(words[0], "atom's number") != into.graph.size() + 1) {
        lines.fail(fmt::format("atom number {}; expected {} (atoms count from 1)",
                               shortened(words[0]), into.graph.size() + 1));
    }
    if (into.graph.size() == most_ligand_atoms) {
        lines.fail(fmt::format("more than {} atoms", most_ligand_atoms));
    }
    GraphAtom atom;
    atom.name = upper_case(words[1]);
    atom.position = lines.position(words[2], words[3], words[4]);
    const std::string_view type = words[5];
    atom.element = lines.element(type.substr(0, type.find('.')));
    if (type == "N.4") atom.charge = 1;
    // Names that repeat ("C") are none.
    into.names_atoms = names.insert(atom.name).second && into.names_atoms;
    into.graph.atoms.push_back(std::move(atom));
}

void read_bond(const FileLines& lines, LigandFile& into) {
    const std::vector<std::string_view> words = split_words(lines.line());
    if (words.size() < 4) lines.fail("expected number, two atoms and kind of a bond");
    const std::string_view kind = words[3];
    const bool is_open = kind == "ar" || kind == "un";
    if (!is_open && kind != "1" && kind != "2" && kind != "3" && kind != "am") {
        lines.fail(
            fmt::format("a bond of kind '{}'; expected 1, 2, 3, am, ar or un", shortened(kind)));
    }
    lines.add_bond(lines.count(words[1], "atom's number"), lines.count(words[2], "atom's number"),
                   kind == "2"   ? 2
                   : kind == "3" ? 3
                                 : 1,
                   into.graph);
    into.open_bonds.push_back(is_open);
}

}  // namespace

LigandFile parse_mol2(std::string_view text, const std::string& file) {
    constexpr std::string_view section = "@<TRIPOS>";
    FileLines lines(text, file);
    LigandFile result;
    result.names_atoms = true;
    std::set<std::string> names;
    std::string in;
    std::size_t molecules = 0, line_of_section = 0;
    for (; !lines.at_end(); lines.advance()) {
        const std::string_view line = trimmed(lines.line());
        if (line.starts_with(section)) {
            in = upper_case(line.substr(section.size()));
            line_of_section = lines.number();
            if (in == "MOLECULE" && ++molecules > 1) break;
        } else if (line.empty() || line.front() == '#') {
            continue;
        } else if (in == "MOLECULE") {
            if (lines.number() == line_of_section + 1) result.graph.name = std::string(line);
        } else if (in == "ATOM") {
            read_atom(lines, result, names);
        } else if (in == "BOND") {
            read_bond(lines, result);
        }
    }
    if (result.graph.atoms.empty())
        lines.fail("the file has no atoms; expected a section @<TRIPOS>ATOM");
    for (const GraphAtom& atom : result.graph.atoms) {
        result.states_charges = result.states_charges || atom.charge != 0;
    }
    return result;
}

}  // namespace palpa
