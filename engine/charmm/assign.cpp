#include "charmm/assign.h"

#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// All that an atom lacks, in the order in which it was found; thrown as one error.
class Missing {
public:
    void add(const TextPlace& place, std::string what) {
        if (!seen_.insert(what).second) return;
        if (problems_.empty()) {
            place_ = place;
        } else {
            what = to_string(place) + ": " + what;
        }
        problems_.push_back(std::move(what));
    }

    void throw_if_any() const {
        if (!problems_.empty())
            throw LoadError(place_, fmt::format("{}", fmt::join(problems_, "; ")));
    }

private:
    TextPlace place_;
    std::vector<std::string> problems_;
    std::set<std::string> seen_;
};

template <class Map>
std::vector<std::string_view> keys(const Map& map) {
    std::vector<std::string_view> names;
    for (const auto& entry : map) names.emplace_back(entry.first);
    return names;
}

const ResidueAtom* find_atom(const Residue& residue, std::string_view name) {
    const auto atom = std::find_if(residue.atoms.begin(), residue.atoms.end(),
                                   [&](const ResidueAtom& a) { return a.name == name; });
    return atom == residue.atoms.end() ? nullptr : &*atom;
}

// The atom's template, or null with the reason noted.
const ResidueAtom* find_template(const ForceField& force_field, const AtomName& name,
                                 const TextPlace& place, Missing& missing) {
    const auto residue = force_field.residues.find(name.residue);
    if (residue == force_field.residues.end()) {
        missing.add(place, fmt::format("no residue '{}' in {}{}", name.residue,
                                       fmt::join(force_field.files, ", "),
                                       near_name_hint(name.residue, keys(force_field.residues))));
        return nullptr;
    }
    if (const ResidueAtom* const atom = find_atom(residue->second, name.atom)) return atom;
    std::vector<std::string_view> known;
    for (const ResidueAtom& a : residue->second.atoms) known.emplace_back(a.name);
    missing.add(place,
                fmt::format("residue '{}' of {} has no atom '{}' (only {})", name.residue,
                            to_string(residue->second.place), name.atom, fmt::join(known, ", ")));
    return nullptr;
}

// A template whose atoms do not add up to its own charge has a slip in one of them.
void check_charge(const std::string& name, const Residue& residue, Missing& missing) {
    double sum = 0;
    for (const ResidueAtom& atom : residue.atoms) sum += atom.charge;
    if (std::abs(sum - residue.charge) > 1e-3) {
        missing.add(residue.place,
                    fmt::format("residue '{}' is given {} e, but its atoms add up to "
                                "{:.4f} e",
                                name, residue.charge, sum));
    }
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
        check_charge(found->first, found->second, missing);
        for (const ResidueAtom& atom : found->second.atoms) {
            if (atoms.contains(atom.name)) continue;
            missing.add({structure.file, lines.at(residue), 0},
                        fmt::format("residue {} {} {} lacks atom '{}'", segment, residue.second,
                                    residue.first, atom.name));
        }
    }
}

// Molecules act on each other, so the types of those in the table count as well as the new ones.
void check_nbfix(const ForceField& force_field, const AtomTable& table, std::set<std::string> used,
                 Missing& missing) {
    for (const AtomName& name : table.names) {
        const auto residue = force_field.residues.find(name.residue);
        if (residue == force_field.residues.end()) continue;
        if (const ResidueAtom* const atom = find_atom(residue->second, name.atom)) {
            used.insert(atom->type);
        }
    }
    for (const NbfixPair& pair : force_field.nbfix) {
        if (used.contains(pair.a) && used.contains(pair.b)) {
            missing.add(pair.place, fmt::format("NBFIX of '{}' and '{}' is needed here, and is not "
                                                "supported yet",
                                                pair.a, pair.b));
        }
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
    Missing missing;
    std::set<std::string> used_types, segments;
    AtomTable added;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        const AtomName& name = structure.names[i];
        segments.insert(name.segment);
        if (name.segment != segment) continue;
        const ResidueAtom* const atom =
            find_template(force_field, name, {structure.file, structure.lines[i], 0}, missing);
        if (!atom) continue;
        const auto type = force_field.types.find(atom->type);
        if (type == force_field.types.end()) {
            missing.add(atom->place,
                        fmt::format("unknown atom type '{}': no MASS line{}", atom->type,
                                    near_name_hint(atom->type, keys(force_field.types))));
        }
        const auto nonbonded = force_field.nonbonded.find(atom->type);
        if (nonbonded == force_field.nonbonded.end()) {
            missing.add(atom->place, fmt::format("atom type '{}' has no NONBONDED parameters in {}",
                                                 atom->type, fmt::join(force_field.files, ", ")));
        }
        if (type == force_field.types.end() || nonbonded == force_field.nonbonded.end()) continue;
        used_types.insert(atom->type);
        added.names.push_back(name);
        added.positions.push_back(structure.positions[i]);
        added.element.push_back(type->second.element);
        added.mass.push_back(type->second.mass);
        added.charge.push_back(atom->charge);
        added.sqrt_epsilon.push_back(std::sqrt(nonbonded->second.epsilon));
        added.half_rmin.push_back(nonbonded->second.half_rmin);
    }
    if (!segments.contains(std::string(segment))) {
        const std::vector<std::string_view> known(segments.begin(), segments.end());
        throw LoadError({structure.file},
                        fmt::format("no segment '{}' (only {})", segment, fmt::join(known, ", ")));
    }
    check_complete(force_field, structure, segment, missing);
    check_nbfix(force_field, table, std::move(used_types), missing);
    missing.throw_if_any();

    const AtomRange range{static_cast<std::uint32_t>(table.size()),
                          static_cast<std::uint32_t>(added.size())};
    const auto append = [](auto& to, auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(table.names, added.names);
    append(table.positions, added.positions);
    append(table.element, added.element);
    append(table.mass, added.mass);
    append(table.charge, added.charge);
    append(table.sqrt_epsilon, added.sqrt_epsilon);
    append(table.half_rmin, added.half_rmin);
    add_bonds(force_field, range, table);
    return range;
}

}  // namespace palpa
