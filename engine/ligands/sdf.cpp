#include "ligands/sdf.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "ligands/file_lines.h"

#include <fmt/format.h>
#include <array>
#include <cstddef>

namespace palpa {
namespace {

constexpr int aromatic = 4;

void check_counts(const FileLines& lines, std::size_t atoms, std::size_t bonds) {
    if (atoms == 0 || atoms > most_ligand_atoms) {
        lines.fail(fmt::format("{} atoms; expected 1 to {}", atoms, most_ligand_atoms));
    }
    if (bonds > 4 * atoms) lines.fail(fmt::format("{} bonds of {} atoms", bonds, atoms));
}

void add_ordered_bond(const FileLines& lines, std::size_t a, std::size_t b, std::size_t order,
                      LigandFile& into) {
    if (order < 1 || order > aromatic) {
        lines.fail(fmt::format("a bond of kind {}; expected 1, 2, 3 or 4 (aromatic)", order));
    }
    lines.add_bond(a, b, order == aromatic ? 1 : static_cast<int>(order), into.graph);
    into.open_bonds.push_back(order == aromatic);
}

// Of V2000's old column; 4 is a radical.
int charge_of_code(std::size_t code) noexcept {
    constexpr std::array charges{0, 3, 2, 1, 0, -1, -2, -3};
    return code < charges.size() ? charges[code] : 0;
}

void set_charge(const FileLines& lines, std::size_t atom, std::string_view text, LigandFile& into) {
    const auto charge = find_integer(text);
    if (!charge || *charge < -8 || *charge > 8) {
        lines.fail(fmt::format("a charge of '{}'; expected -8 to 8", shortened(text)));
    }
    if (atom < 1 || atom > into.graph.size()) {
        lines.fail(fmt::format("a charge of atom {}; expected 1 to {}", atom, into.graph.size()));
    }
    into.graph.atoms[atom - 1].charge = static_cast<int>(*charge);
}

// M  CHG  n  atom charge ...: all others are 0.
void read_charges(const FileLines& lines, std::string_view line, bool is_first, LigandFile& into) {
    if (is_first) {
        for (GraphAtom& atom : into.graph.atoms) atom.charge = 0;
    }
    const std::vector<std::string_view> words = split_words(line);
    for (std::size_t i = 3; i + 1 < words.size(); i += 2) {
        set_charge(lines, lines.count(words[i], "atom's number"), words[i + 1], into);
    }
}

void read_v2000(FileLines& lines, std::size_t atoms, std::size_t bonds, LigandFile& into) {
    check_counts(lines, atoms, bonds);
    for (std::size_t i = 0; i < atoms; ++i) {
        if (lines.at_end()) lines.fail(fmt::format("the file ends here; expected {} atoms", atoms));
        const std::string_view line = lines.line();
        GraphAtom atom;
        atom.position = lines.position(find_field(line, {0, 10}), find_field(line, {10, 10}),
                                       find_field(line, {20, 10}));
        atom.element = lines.element(find_field(line, {31, 3}));
        const std::string_view code = find_field(line, {36, 3});
        if (!code.empty()) atom.charge = charge_of_code(lines.count(code, "code of a charge"));
        into.graph.atoms.push_back(std::move(atom));
        lines.advance();
    }
    for (std::size_t i = 0; i < bonds; ++i) {
        if (lines.at_end()) lines.fail(fmt::format("the file ends here; expected {} bonds", bonds));
        const std::string_view line = lines.line();
        add_ordered_bond(lines, lines.count(find_field(line, {0, 3}), "atom's number"),
                         lines.count(find_field(line, {3, 3}), "atom's number"),
                         lines.count(find_field(line, {6, 3}), "kind of a bond"), into);
        lines.advance();
    }
    bool is_first = true;
    for (; !lines.at_end() && !lines.line().starts_with("M  END"); lines.advance()) {
        if (!lines.line().starts_with("M  CHG")) continue;
        read_charges(lines, lines.line(), is_first, into);
        is_first = false;
    }
    if (lines.at_end()) lines.fail("the file ends here; expected M  END");
}

// The words behind "M  V30".
std::vector<std::string_view> v30_words(const FileLines& lines) {
    constexpr std::string_view start = "M  V30 ";
    if (!lines.line().starts_with(start)) {
        lines.fail(fmt::format("'{}'; expected a line of M  V30", shortened(lines.line())));
    }
    return split_words(lines.line().substr(start.size()));
}

void read_v30_atom(const FileLines& lines, const std::vector<std::string_view>& words,
                   LigandFile& into) {
    if (words.size() < 6) lines.fail("expected number, element, x, y, z and mapping of an atom");
    if (lines.count(words[0], "atom's number") != into.graph.size() + 1) {
        lines.fail(fmt::format("atom number {}; expected {} (atoms count from 1)", words[0],
                               into.graph.size() + 1));
    }
    into.graph.atoms.push_back(
        {"", lines.element(words[1]), 0, lines.position(words[2], words[3], words[4])});
    for (std::size_t i = 6; i < words.size(); ++i) {
        if (words[i].starts_with("CHG=")) {
            set_charge(lines, into.graph.size(), words[i].substr(4), into);
        }
    }
}

void read_v3000(FileLines& lines, LigandFile& into) {
    enum class In : std::uint8_t { Neither, Atoms, Bonds } in = In::Neither;
    std::size_t atoms = 0, bonds = 0;
    for (; !lines.at_end() && !lines.line().starts_with("M  END"); lines.advance()) {
        const std::vector<std::string_view> words = v30_words(lines);
        if (words.empty()) continue;
        if (words[0] == "COUNTS") {
            if (words.size() < 3) lines.fail("expected numbers of atoms and of bonds");
            atoms = lines.count(words[1], "number of atoms");
            bonds = lines.count(words[2], "number of bonds");
            check_counts(lines, atoms, bonds);
        } else if (words[0] == "BEGIN" || words[0] == "END") {
            const bool begins = words[0] == "BEGIN" && words.size() > 1;
            in = begins && words[1] == "ATOM"   ? In::Atoms
                 : begins && words[1] == "BOND" ? In::Bonds
                                                : In::Neither;
        } else if (in == In::Atoms) {
            if (into.graph.size() == atoms) lines.fail(fmt::format("more than {} atoms", atoms));
            read_v30_atom(lines, words, into);
        } else if (in == In::Bonds) {
            if (words.size() < 4) lines.fail("expected number, kind and two atoms of a bond");
            add_ordered_bond(lines, lines.count(words[2], "atom's number"),
                             lines.count(words[3], "atom's number"),
                             lines.count(words[1], "kind of a bond"), into);
        }
    }
    if (lines.at_end()) lines.fail("the file ends here; expected M  END");
    if (atoms == 0 || into.graph.size() != atoms || into.graph.bonds.size() != bonds) {
        lines.fail(fmt::format("{} atoms and {} bonds; expected {} and {}", into.graph.size(),
                               into.graph.bonds.size(), atoms, bonds));
    }
}

}  // namespace

LigandFile parse_sdf(std::string_view text, const std::string& file) {
    FileLines lines(text, file);
    LigandFile result;
    result.graph.name = std::string(trimmed(lines.take("the name of a molecule")));
    (void)lines.take("a line about the program");
    (void)lines.take("a comment");
    if (lines.at_end()) lines.fail("the file ends here; expected the line of counts");
    const std::string_view counts = lines.line();
    if (counts.find("V3000") != std::string_view::npos) {
        lines.advance();
        read_v3000(lines, result);
    } else {
        const std::size_t atoms = lines.count(find_field(counts, {0, 3}), "number of atoms");
        const std::size_t bonds = lines.count(find_field(counts, {3, 3}), "number of bonds");
        check_counts(lines, atoms, bonds);
        lines.advance();
        read_v2000(lines, atoms, bonds, result);
    }
    for (const GraphAtom& atom : result.graph.atoms) {
        result.states_charges = result.states_charges || atom.charge != 0;
    }
    return result;
}

LigandFile read_ligand_file(const std::filesystem::path& path) {
    const std::string ending = upper_case(path.extension().string());
    const bool is_mol2 = ending == ".MOL2";
    if (!is_mol2 && ending != ".SDF" && ending != ".MOL") {
        throw LoadError({path.string()}, "expected a ligand as .sdf, .mol or .mol2");
    }
    const std::string text = read_text_file(path);
    return is_mol2 ? parse_mol2(text, path.string()) : parse_sdf(text, path.string());
}

}  // namespace palpa
