#include "loading/engine_atoms.h"

#include "core/load_error.h"
#include "core/text.h"
#include "formats/gro.h"
#include "formats/index_file.h"
#include "formats/psf.h"
#include "molecule/connectivity.h"
#include "molecule/element.h"
#include "molecule/point_grid.h"
#include "scene/find_scene.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace palpa {
namespace {

struct ElementData {
    const char* symbol;
    double mass;    // amu
    bool can_bond;  // covalently
};

constexpr ElementData elements[] = {
    {"H", 1.008, true},    {"C", 12.011, true},   {"N", 14.007, true},   {"O", 15.999, true},
    {"F", 18.998, true},   {"NA", 22.990, false}, {"MG", 24.305, false}, {"P", 30.974, true},
    {"S", 32.06, true},    {"CL", 35.45, true},   {"K", 39.098, false},  {"CA", 40.078, false},
    {"MN", 54.938, false}, {"FE", 55.845, false}, {"CU", 63.546, false}, {"ZN", 65.38, false},
    {"SE", 78.971, true},  {"BR", 79.904, true},  {"I", 126.904, true}};

const ElementData& element_of(std::string_view symbol) {
    const auto* const found = std::ranges::find(
        elements, symbol, [](const ElementData& e) { return std::string_view(e.symbol); });
    // An unknown element, such as that of a virtual site, has no mass.
    static constexpr ElementData unknown{"", 0, false};
    return found == std::end(elements) ? unknown : *found;
}

std::string element_of_mass(double mass) {
    if (mass < 4.5) return mass > 0 ? "H" : "";
    const auto nearest = std::ranges::min_element(
        elements, {}, [&](const ElementData& element) { return std::abs(element.mass - mass); });
    return nearest->symbol;
}

void add_atom(const AtomName& name, const Vec3& place, std::string element, double mass,
              double charge, const std::string& type, AtomTable& table) {
    table.names.push_back(name);
    table.positions.push_back(place);
    table.element.push_back(std::move(element));
    table.mass.push_back(mass);
    table.charge.push_back(charge);
    table.sqrt_epsilon.push_back(0);
    table.half_rmin.push_back(0);
    table.b_factor.push_back(0);
    const auto found = std::ranges::find(table.type_names, type);
    table.type.push_back(static_cast<std::uint32_t>(found - table.type_names.begin()));
    if (found == table.type_names.end()) table.type_names.push_back(type);
}

// Bonds pairs that are nearer than the sum of their covalent radii and 0.4 Å; no two hydrogens.
void add_bonds_by_distance(AtomRange range, AtomTable& table) {
    constexpr double slack = 0.4, longest = 3.2;  // Å
    const auto first = table.positions.begin() + range.first;
    const PointGrid grid({first, first + range.count}, longest);
    for (std::uint32_t j = 0; j < range.count; ++j) {
        const ElementData& b = element_of(table.element[range.first + j]);
        if (!b.can_bond) continue;
        grid.visit_near(first[j], longest, [&](std::uint32_t i) {
            const ElementData& a = element_of(table.element[range.first + i]);
            if (i >= j || !a.can_bond || (a.mass < 2 && b.mass < 2)) return;
            const double reach = covalent_radius(a.symbol) + covalent_radius(b.symbol) + slack;
            if ((first[i] - first[j]).squaredNorm() < reach * reach)
                table.bonds.push_back({range.first + i, range.first + j});
        });
    }
}

using AtomKey = std::tuple<std::string, std::string, std::string, std::string>;

AtomKey key_of(const AtomName& name, bool has_segments) {
    return {has_segments ? name.segment : "", name.residue, name.number, name.atom};
}

// The engine's atoms in a file; no masses if the file has none.
struct EngineFile {
    std::vector<AtomName> names;
    std::vector<double> masses;
    bool has_segments = false;
};

EngineFile read_engine_file(const std::filesystem::path& path) {
    if (is_topology(path)) {
        Connectivity connectivity = read_psf(path);
        return {std::move(connectivity.names), std::move(connectivity.mass), true};
    }
    return {read_gro(path).names, {}, false};
}

// The file that lists the atoms of all molecules; "the scene" if several files do.
std::string find_list_of_atoms(const SceneDescription& scene) {
    const auto file_of = [](const MoleculeDescription& molecule) {
        return molecule.topology.empty() ? molecule.structure : molecule.topology;
    };
    std::filesystem::path file = scene.engine->atoms;
    if (file.empty()) file = file_of(scene.molecules.front());
    const bool is_one = !scene.engine->atoms.empty() ||
                        std::ranges::all_of(scene.molecules, [&](const auto& molecule) {
                            return file_of(molecule) == file;
                        });
    return is_one ? file.string() : "the scene";
}

EngineAtoms match_names(const SceneDescription& scene, const AtomTable& table) {
    const std::filesystem::path& path = scene.engine->atoms;
    const EngineFile file = read_engine_file(path);
    std::map<AtomKey, std::vector<std::int32_t>> places;
    for (std::size_t i = 0; i < file.names.size(); ++i)
        places[key_of(file.names[i], file.has_segments)].push_back(static_cast<std::int32_t>(i));
    EngineAtoms atoms{
        std::vector<std::int32_t>(file.names.size(), -1), {}, find_list_of_atoms(scene)};
    const bool has_masses =
        !file.masses.empty() &&
        std::ranges::none_of(scene.molecules, [](const MoleculeDescription& molecule) {
            return molecule.topology.empty() && !is_topology(molecule.structure);
        });
    for (std::size_t i = 0; i < table.size(); ++i) {
        const AtomName& name = table.names[i];
        const auto found = places.find(key_of(name, file.has_segments));
        if (found == places.end() || found->second.size() != 1) {
            throw LoadError(
                scene.place_of("engine.atoms"),
                fmt::format("{} has {} atoms named {} {} {}; expected exactly one, to match {} of "
                            "the scene",
                            path.string(), found == places.end() ? 0 : found->second.size(),
                            name.residue, name.number, name.atom, to_string(name)));
        }
        const std::int32_t at = found->second.front();
        constexpr double most_off = 0.1;  // amu
        const auto place = static_cast<std::size_t>(at);
        if (has_masses && std::abs(file.masses[place] - table.mass[i]) > most_off) {
            throw LoadError(
                scene.place_of("engine.atoms"),
                fmt::format("{} has {} with {} amu, but the scene has it with {} amu; expected the "
                            "same atom",
                            path.string(), to_string(name), file.masses[place], table.mass[i]));
        }
        atoms.in_table[place] = static_cast<std::int32_t>(i);
        atoms.in_engine.push_back(at);
    }
    return atoms;
}

EngineAtoms match_index(const SceneDescription& scene, const AtomTable& table) {
    const std::filesystem::path& path = scene.engine->atoms;
    const IndexGroup group = read_index_file(path).front();
    EngineAtoms atoms{std::vector<std::int32_t>(group.atoms.size(), -1),
                      std::vector<std::int32_t>(table.size(), -1), find_list_of_atoms(scene)};
    for (std::size_t i = 0; i < group.atoms.size(); ++i) {
        const std::uint32_t atom = group.atoms[i];
        if (atom >= table.size() || atoms.in_engine[atom] >= 0) {
            throw LoadError(
                {path.string(), group.line},
                fmt::format(
                    "group '{}' has atom {} {}; expected each of the scene's {} atoms at most once",
                    group.name, atom + 1,
                    atom >= table.size() ? "that the scene does not have" : "twice", table.size()));
        }
        atoms.in_table[i] = static_cast<std::int32_t>(atom);
        atoms.in_engine[atom] = static_cast<std::int32_t>(i);
    }
    if (group.atoms.empty())
        throw LoadError({path.string(), group.line}, "has no atoms; expected at least one");
    return atoms;
}

}  // namespace

AtomRange add_engine_atoms(const Source& source, AtomTable& table) {
    const std::string unknown_type = "X";
    const Structure& structure = *source.structure;
    const Connectivity* const connectivity = source.connectivity.get();
    const std::string& segment = source.segment;
    AtomRange range{static_cast<std::uint32_t>(table.size()), 0};
    std::vector<std::int64_t> at(connectivity ? connectivity->names.size() : 0, -1);
    std::map<std::string, std::size_t> places;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        if (structure.names[i].segment != segment) continue;
        if (connectivity) {
            places.emplace(to_string(structure.names[i]), i);
            continue;
        }
        const AtomName& name = structure.names[i];
        const std::string element = find_element_of_name(name.atom, name.residue);
        add_atom(name, structure.positions[i], element, element_of(element).mass, 0, unknown_type,
                 table);
    }
    for (std::size_t i = 0; i < at.size(); ++i) {
        const AtomName& name = connectivity->names[i];
        if (name.segment != segment) continue;
        const auto found = places.find(to_string(name));
        if (found == places.end()) {
            throw LoadError(
                {connectivity->file, connectivity->lines[i]},
                fmt::format("atom {} has no coordinates in {}", to_string(name), structure.file));
        }
        at[i] = static_cast<std::int64_t>(table.size());
        // Prefers the name: a hydrogen may have been given mass of its neighbour.
        std::string element = find_element_of_name(name.atom, name.residue);
        if (element.empty()) element = element_of_mass(connectivity->mass[i]);
        add_atom(name, structure.positions[found->second], std::move(element),
                 connectivity->mass[i], connectivity->charge[i], connectivity->type[i], table);
    }
    range.count = static_cast<std::uint32_t>(table.size()) - range.first;
    if (range.count == 0) {
        throw LoadError({structure.file}, fmt::format("no segment '{}'", segment));
    }
    if (!connectivity) {
        add_bonds_by_distance(range, table);
        return range;
    }
    for (const auto& [a, b] : connectivity->bonds) {
        if (at[a] < 0 || at[b] < 0) continue;
        table.bonds.push_back(
            {static_cast<std::uint32_t>(at[a]), static_cast<std::uint32_t>(at[b])});
    }
    return range;
}

EngineAtoms find_engine_atoms(const SceneDescription& scene, const AtomTable& table) {
    const std::filesystem::path& path = scene.engine->atoms;
    const std::string ending = upper_case(path.extension().string());
    if (ending == ".NDX") return match_index(scene, table);
    if (!path.empty() && ending != ".PSF" && ending != ".GRO") {
        throw LoadError(
            scene.place_of("engine.atoms"),
            fmt::format(
                "'{}' is not a list of the engine's atoms; expected a .psf, .gro or .ndx file",
                path.string()));
    }
    if (!path.empty()) return match_names(scene, table);
    EngineAtoms atoms;
    for (std::size_t i = 0; i < table.size(); ++i)
        atoms.in_table.push_back(static_cast<std::int32_t>(i));
    atoms.in_engine = atoms.in_table;
    atoms.listed_in = find_list_of_atoms(scene);
    return atoms;
}

bool lacks_coordinates(const SceneDescription& scene) {
    return scene.engine &&
           std::ranges::any_of(scene.molecules, [](const MoleculeDescription& molecule) {
               return is_topology(molecule.structure);
           });
}

}  // namespace palpa
