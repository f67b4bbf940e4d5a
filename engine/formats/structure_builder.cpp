#include "formats/structure_builder.h"

#include "core/load_error.h"
#include "molecule/element.h"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// "chain A residue ALA 27A atom CA": names of PDB files may be blank in part.
std::string describe(const AtomName& name, const AtomRecord& record) {
    std::string text = record.chain.empty() ? "" : fmt::format("chain {} ", record.chain);
    if (!name.segment.empty() && name.segment != record.chain) {
        text += fmt::format("segment {} ", name.segment);
    }
    text += fmt::format("{} {} {}", name.residue, name.number, name.atom);
    if (record.alternate != ' ') text += fmt::format(" (location {})", record.alternate);
    return text;
}

// "44 atoms in alternate locations, the first on line 12: chain A PHE 53 N (location A)"; nothing
// where no atom is `wanted`.
template <class Wanted>
void add_note_on_atoms(const char* what, const Wanted& wanted, Structure& structure) {
    std::size_t count = 0, first = 0;
    for (std::size_t i = structure.records.size(); i-- > 0;) {
        if (!wanted(structure.records[i])) continue;
        ++count;
        first = i;
    }
    if (count == 0) return;
    structure.notes.push_back(fmt::format(
        "{} atom{} {}, the first on line {}: {}", count, count == 1 ? "" : "s", what,
        structure.lines[first], describe(structure.names[first], structure.records[first])));
}

void add_notes(Structure& structure) {
    std::set<std::int32_t> models;
    std::map<std::string, std::size_t> hetero;  // atoms by residue name
    for (std::size_t i = 0; i < structure.records.size(); ++i) {
        models.insert(structure.records[i].model);
        if (structure.records[i].hetero) ++hetero[structure.names[i].residue];
    }
    if (models.size() > 1) {
        structure.notes.push_back(fmt::format("{} models, numbers {} to {}", models.size(),
                                              *models.begin(), *models.rbegin()));
    }
    add_note_on_atoms(
        "in alternate locations", [](const AtomRecord& atom) { return atom.alternate != ' '; },
        structure);
    add_note_on_atoms(
        "in residues with insertion codes",
        [](const AtomRecord& atom) { return atom.insertion_code != ' '; }, structure);
    for (const auto& [residue, count] : hetero) {
        structure.notes.push_back(
            fmt::format("{} HETATM atom{} of {}", count, count == 1 ? "" : "s", residue));
    }
    add_note_on_atoms(
        "without an element symbol (element guessed from the atom name)",
        [](const AtomRecord& atom) { return atom.element_guessed; }, structure);
}

}  // namespace

StructureBuilder::StructureBuilder(std::string file, std::size_t atoms) {
    structure_.file = std::move(file);
    structure_.names.reserve(atoms);
    structure_.positions.reserve(atoms);
    structure_.lines.reserve(atoms);
    structure_.records.reserve(atoms);
    atoms_.reserve(atoms);
}

void StructureBuilder::add_atom(AtomName name, const Vec3& position, AtomRecord record,
                                std::size_t line) {
    const TextPlace place{structure_.file, line};
    const auto [first, is_new] =
        atoms_.try_emplace(fmt::format("{} {} {} {} {}{}", record.model, record.chain, name.segment,
                                       name.number, name.atom, record.alternate),
                           atom_count());
    if (!is_new) return leave_out(name, record, line, first->second);
    if (record.element.empty()) {
        record.element = find_element_of_name(name.atom, name.residue);
        record.element_guessed = true;
        if (record.element.empty()) {
            throw LoadError(place, fmt::format("atom {} has no element, and its name gives none; "
                                               "expected a symbol such as C",
                                               describe(name, record)));
        }
    } else if (!is_element(record.element)) {
        throw LoadError(place,
                        fmt::format("'{}' is not an element; expected a symbol such as C or MG",
                                    record.element));
    }
    structure_.names.push_back(std::move(name));
    structure_.positions.push_back(position);
    structure_.lines.push_back(line);
    structure_.records.push_back(std::move(record));
}

void StructureBuilder::leave_out(const AtomName& name, const AtomRecord& record, std::size_t line,
                                 std::size_t first) {
    const std::size_t first_line = structure_.lines[first];
    if (structure_.names[first].residue != name.residue || repeated_ == most_repeated) {
        throw LoadError({structure_.file, line},
                        fmt::format("atom {} is repeated, first on line {}; expected a different "
                                    "name, alternate location, chain or model",
                                    describe(name, record), first_line));
    }
    if (++repeated_ == 1) {
        first_repeated_ = fmt::format("atom {} of line {} is repeated on line {}",
                                      describe(name, record), first_line, line);
    }
}

void StructureBuilder::add_link(StructureLink link) {
    constexpr std::size_t most = 100'000;
    if (structure_.links.size() < most) structure_.links.push_back(std::move(link));
}

void StructureBuilder::add_component_name(std::string_view residue, std::string_view name) {
    constexpr std::size_t most_names = 1000, longest = 200;
    auto& names = structure_.component_names;
    if (residue.empty() || name.empty()) return;
    if (names.size() == most_names && !names.contains(std::string(residue))) return;
    std::string& all = names[std::string(residue)];
    if (all.size() < longest) all += name.substr(0, longest - all.size());
}

void StructureBuilder::end_chain() {
    std::vector<std::size_t>& ends = structure_.chain_ends;
    if (atom_count() > 0 && (ends.empty() || ends.back() < atom_count())) {
        ends.push_back(atom_count());
    }
}

void StructureBuilder::add_doubt(std::string note) {
    structure_.notes.push_back(note);
    structure_.doubts.push_back(std::move(note));
}

Structure StructureBuilder::build(std::size_t line) {
    if (atom_count() == 0) throw LoadError({structure_.file, line}, "ends without any atom");
    if (repeated_ > 0) {
        first_repeated_ +=
            repeated_ == 1 ? "; the first is used"
                           : fmt::format(", and {} more repeated atoms; the first of each is used",
                                         repeated_ - 1);
        add_doubt(std::move(first_repeated_));
    }
    add_notes(structure_);
    return std::move(structure_);
}

}  // namespace palpa
