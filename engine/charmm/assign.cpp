#include "charmm/assign.h"

#include "charmm/missing.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace palpa {
namespace {

const ResidueAtom* find_atom(const Residue& residue, std::string_view name) {
    const auto atom = std::find_if(residue.atoms.begin(), residue.atoms.end(),
                                   [&](const ResidueAtom& a) { return a.name == name; });
    return atom == residue.atoms.end() ? nullptr : &*atom;
}

// The atom's template, or null with the reason noted.
const ResidueAtom* find_template(const ForceField& force_field, const AtomName& name,
                                 const TextPlace& place, Missing& missing) {
    const Residue* const residue = find_residue(force_field, name.residue, place, missing);
    if (!residue) return nullptr;
    if (const ResidueAtom* const atom = find_atom(*residue, name.atom)) return atom;
    std::vector<std::string_view> known;
    for (const ResidueAtom& a : residue->atoms) known.emplace_back(a.name);
    missing.add(place, fmt::format("residue '{}' of {} has no atom '{}' (only {})", name.residue,
                                   to_string(residue->place), name.atom, fmt::join(known, ", ")));
    missing.advise(rename_advice);
    return nullptr;
}

// A residue that the structure holds only in part would be charged wrongly.
void check_complete(const ForceField& force_field, const Structure& structure,
                    std::string_view segment, Missing& missing) {
    std::map<std::pair<std::string, std::string>, std::set<std::string>> present;
    std::map<std::pair<std::string, std::string>, std::size_t> lines;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        const AtomName& name = structure.names[i];
        if (name.segment != segment) continue;
        present[{name.number, name.residue}].insert(name.atom);
        lines.try_emplace({name.number, name.residue}, structure.lines[i]);
    }
    for (const auto& [residue, atoms] : present) {
        const auto found = force_field.residues.find(residue.second);
        if (found == force_field.residues.end()) continue;
        for (const ResidueAtom& atom : found->second.atoms) {
            if (atoms.contains(atom.name)) continue;
            missing.add({structure.file, lines.at(residue), 0},
                        fmt::format("residue {} {} {} lacks atom '{}'", segment, residue.second,
                                    residue.first, atom.name));
        }
    }
}

std::uint32_t add_type(const std::string& name, AtomTable& table) {
    const auto found = std::find(table.type_names.begin(), table.type_names.end(), name);
    const auto index = static_cast<std::uint32_t>(found - table.type_names.begin());
    if (found == table.type_names.end()) table.type_names.push_back(name);
    return index;
}

struct NewAtom {
    const AtomName& name;
    const Vec3& position;
    const std::string& type;
    double charge;
    double b_factor;
    std::optional<double> mass;  // else the type's
};

// Adds an atom with the numbers of its type, or notes what it lacks. `place`: of its type's name.
void add_atom(const ForceField& force_field, const NewAtom& atom, const TextPlace& place,
              AtomTable& table, Missing& missing) {
    const auto* const type = find_type(force_field, atom.type, place, missing);
    const std::string& name = type ? type->first : atom.type;
    const NonbondedType* const nonbonded = find_nonbonded(force_field, name, place, missing);
    if (!type || !nonbonded) return;
    table.names.push_back(atom.name);
    table.positions.push_back(atom.position);
    table.element.push_back(type->second.element);
    table.mass.push_back(atom.mass.value_or(type->second.mass));
    table.charge.push_back(atom.charge);
    table.sqrt_epsilon.push_back(std::sqrt(nonbonded->epsilon));
    table.half_rmin.push_back(nonbonded->half_rmin);
    table.type.push_back(add_type(name, table));
    table.b_factor.push_back(atom.b_factor);
}

// All of `added` but its bonds behind what the table holds.
AtomRange append(const AtomTable& added, AtomTable& table) {
    const AtomRange range{static_cast<std::uint32_t>(table.size()),
                          static_cast<std::uint32_t>(added.size())};
    const auto behind = [](auto& to, const auto& from) {
        to.write().insert(to.end(), from.begin(), from.end());
    };
    table.positions.insert(table.positions.end(), added.positions.begin(), added.positions.end());
    behind(table.names, added.names);
    behind(table.element, added.element);
    behind(table.mass, added.mass);
    behind(table.charge, added.charge);
    behind(table.sqrt_epsilon, added.sqrt_epsilon);
    behind(table.half_rmin, added.half_rmin);
    behind(table.b_factor, added.b_factor);
    for (const std::uint32_t type : added.type) {
        table.type.push_back(add_type(added.type_names[type], table));
    }
    return range;
}

void check_segment(const std::string& file, const std::vector<AtomName>& names,
                   std::string_view segment) {
    std::set<std::string_view> segments;
    for (const AtomName& name : names) segments.insert(name.segment);
    if (!segments.contains(segment)) {
        throw LoadError(
            {file}, fmt::format("no segment '{}' (only {})", segment, fmt::join(segments, ", ")));
    }
}

// The bonds inside each residue. A residue's atoms stand together in the table.
void add_bonds(const ForceField& force_field, AtomRange range, AtomTable& table) {
    const std::uint32_t end = range.first + range.count;
    for (std::uint32_t first = range.first, next = first; first < end; first = next) {
        const AtomName& residue = table.names[first];
        std::map<std::string, std::uint32_t, std::less<>> by_name;
        for (; next < end && table.names[next].number == residue.number &&
               table.names[next].residue == residue.residue;
             ++next) {
            by_name[table.names[next].atom] = next;
        }
        for (const auto& [a, b] : force_field.residues.at(residue.residue).bonds) {
            const auto from = by_name.find(a), to = by_name.find(b);
            if (from != by_name.end() && to != by_name.end()) {
                table.bonds.push_back({from->second, to->second});
            }
        }
    }
}

}  // namespace

AtomRange add_segment_atoms(const ForceField& force_field, const Structure& structure,
                            std::string_view segment, AtomTable& table) {
    check_segment(structure.file, structure.names, segment);
    Missing missing;
    AtomTable added;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        const AtomName& name = structure.names[i];
        if (name.segment != segment) continue;
        const ResidueAtom* const atom =
            find_template(force_field, name, {structure.file, structure.lines[i], 0}, missing);
        if (!atom) continue;
        add_atom(
            force_field,
            {name, structure.positions[i], atom->type, atom->charge, b_factor_of(structure, i), {}},
            atom->place, added, missing);
    }
    check_complete(force_field, structure, segment, missing);
    missing.throw_if_any();
    const AtomRange range = append(added, table);
    add_bonds(force_field, range, table);
    return range;
}

AtomRange add_segment_atoms(const ForceField& force_field, const Connectivity& connectivity,
                            const Structure& structure, std::string_view segment,
                            AtomTable& table) {
    check_segment(connectivity.file, connectivity.names, segment);
    std::map<std::string, std::size_t> places;  // of what the structure has and is not yet used
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        if (structure.names[i].segment == segment) places[to_string(structure.names[i])] = i;
    }
    Missing missing;
    AtomTable added;
    std::map<std::uint32_t, std::uint32_t> new_index;  // of the connectivity's atoms
    for (std::uint32_t i = 0; i < connectivity.names.size(); ++i) {
        const AtomName& name = connectivity.names[i];
        if (name.segment != segment) continue;
        const TextPlace place{connectivity.file, connectivity.lines[i], 0};
        const auto found = places.find(to_string(name));
        if (found == places.end()) {
            missing.add(place, fmt::format("atom {} has no coordinates in {}", to_string(name),
                                           structure.file));
            continue;
        }
        new_index[i] = static_cast<std::uint32_t>(table.size() + added.size());
        add_atom(
            force_field,
            {name, structure.positions[found->second], connectivity.type[i], connectivity.charge[i],
             b_factor_of(structure, found->second), connectivity.mass[i]},
            place, added, missing);
        places.erase(found);
    }
    for (const auto& [name, i] : places) {
        missing.add({structure.file, structure.lines[i], 0},
                    fmt::format("atom {} is not in {}", name, connectivity.file));
    }
    missing.throw_if_any();
    const AtomRange range = append(added, table);
    for (const auto& [a, b] : connectivity.bonds) {
        const auto from = new_index.find(a), to = new_index.find(b);
        if (from != new_index.end() && to != new_index.end()) {
            table.bonds.push_back({from->second, to->second});
        }
    }
    return range;
}

}  // namespace palpa
