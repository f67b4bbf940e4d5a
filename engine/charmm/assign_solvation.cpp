#include "charmm/assign_solvation.h"

#include "charmm/missing.h"
#include "core/assertion.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string_view>

namespace palpa {
namespace {

constexpr double lightest_heavy = 3.5;  // amu

constexpr const char* uncovered_advice =
    "EEF1-SB has parameters for proteins and for some CGenFF types only; leave this molecule out, "
    "declare waters that belong to the structure as structural (structural_water = true, "
    "--structural-water), or use no solvent (solvent = \"none\", --solvent none)";

// An atom as the table is asked for it.
struct TypedAtom {
    const AtomName& name;
    std::string_view type;
    double mass, half_rmin;
    TextPlace place;
};

class SolvationAssigner {
public:
    SolvationAssigner(const SolvationTable& table, std::span<const AtomName> names,
                      std::span<const double> mass, std::span<const std::uint8_t> is_structural)
        : table_(table) {
        PALPA_ASSERT(is_structural.empty() || is_structural.size() == names.size());
        counts_for_nothing_.assign(names.size(), 0);
        if (is_structural.empty()) return;
        const std::vector<std::uint8_t> is_water = find_water_atoms(names, mass);
        for (std::size_t i = 0; i < names.size(); ++i)
            counts_for_nothing_[i] = is_structural[i] != 0 && is_water[i] != 0 ? 1 : 0;
    }

    void add(const TypedAtom& atom) {
        const bool is_left_out =
            atom.mass < lightest_heavy || counts_for_nothing_[solvation_.volume.size()] != 0;
        SolvationRow row;
        row.lambda = 1;  // of atoms without energies; nothing divides by 0
        const auto found = is_left_out ? table_.types.end() : table_.types.find(atom.type);
        if (found != table_.types.end()) row = found->second;
        if (found == table_.types.end() && !is_left_out &&
            told_.insert(std::string(atom.type)).second) {
            missing_.add(atom.place, fmt::format("no solvation parameters in {} for type {} of {}",
                                                 table_.file, atom.type, to_string(atom.name)));
            missing_.advise(uncovered_advice);
        }
        solvation_.volume.push_back(row.volume);
        solvation_.dg_ref.push_back(row.dg_ref);
        solvation_.dg_free.push_back(row.dg_free);
        solvation_.lambda.push_back(row.lambda);
        solvation_.radius.push_back(atom.half_rmin);
    }

    Missing& missing() noexcept { return missing_; }

    Solvation take() {
        missing_.throw_if_any();
        return std::move(solvation_);
    }

private:
    const SolvationTable& table_;
    std::vector<std::uint8_t> counts_for_nothing_;
    std::set<std::string> told_;  // types
    Missing missing_;
    Solvation solvation_;
};

}  // namespace

std::vector<std::uint8_t> find_water_atoms(std::span<const AtomName> names,
                                           std::span<const double> mass) {
    std::vector<std::uint8_t> is_water(names.size(), 0);
    for (std::size_t first = 0, next = 0; first < names.size(); first = next) {
        std::size_t oxygens = 0, hydrogens = 0;
        for (; next < names.size() && is_same_residue(names[first], names[next]); ++next) {
            if (mass[next] < lightest_heavy) ++hydrogens;
            if (mass[next] > 15 && mass[next] < 17) ++oxygens;
        }
        if (oxygens != 1 || hydrogens != 2 || next - first != 3) continue;
        std::fill(is_water.begin() + static_cast<std::ptrdiff_t>(first),
                  is_water.begin() + static_cast<std::ptrdiff_t>(next), std::uint8_t{1});
    }
    return is_water;
}

Solvation assign_solvation(const AtomTable& atoms, const SolvationTable& table,
                           std::span<const std::uint8_t> is_structural, const TextPlace& place) {
    SolvationAssigner assigner(table, atoms.names, atoms.mass, is_structural);
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        assigner.add({atoms.names[i], atoms.type_names[atoms.type[i]], atoms.mass[i],
                      atoms.half_rmin[i], place});
    }
    return assigner.take();
}

Solvation assign_solvation(const Connectivity& connectivity, const ForceField& force_field,
                           const SolvationTable& table,
                           std::span<const std::uint8_t> is_structural) {
    SolvationAssigner assigner(table, connectivity.names, connectivity.mass, is_structural);
    for (std::size_t i = 0; i < connectivity.names.size(); ++i) {
        const TextPlace place{connectivity.file, connectivity.lines[i], 0};
        const auto* const type =
            find_type(force_field, connectivity.type[i], place, assigner.missing());
        const std::string& name = type ? type->first : connectivity.type[i];
        const NonbondedType* const nonbonded =
            find_nonbonded(force_field, name, place, assigner.missing());
        assigner.add({connectivity.names[i], name, connectivity.mass[i],
                      nonbonded ? nonbonded->half_rmin : 0, place});
    }
    return assigner.take();
}

std::vector<std::string> find_uncovered_types(const Connectivity& connectivity,
                                              const SolvationTable& table,
                                              std::span<const std::uint8_t> is_structural) {
    const std::vector<std::uint8_t> is_water =
        find_water_atoms(connectivity.names, connectivity.mass);
    std::set<std::string_view> seen;
    std::vector<std::string> uncovered;
    for (std::size_t i = 0; i < connectivity.names.size(); ++i) {
        const bool is_left_out = connectivity.mass[i] < lightest_heavy ||
                                 (!is_structural.empty() && is_structural[i] && is_water[i]);
        const std::string& type = connectivity.type[i];
        if (is_left_out || table.types.contains(type) || !seen.insert(type).second) continue;
        uncovered.push_back(fmt::format("{} ({})", type, to_string(connectivity.names[i])));
    }
    return uncovered;
}

std::vector<std::string> find_other_radii(const Connectivity& connectivity,
                                          const Solvation& solvation, const SolvationTable& table) {
    constexpr double alike = 0.02;  // Å
    std::set<std::string_view> seen;
    std::vector<std::string> others;
    for (std::size_t i = 0; i < connectivity.type.size(); ++i) {
        const auto row = table.types.find(connectivity.type[i]);
        const bool is_counted = solvation.volume[i] != 0 && row != table.types.end();
        if (!is_counted || row->second.is_assigned) continue;
        const double radius = solvation.radius[i];
        if (std::abs(radius - row->second.radius) <= alike || !seen.insert(row->first).second)
            continue;
        others.push_back(
            fmt::format("{} ({} Å, not {} Å)", row->first, radius, row->second.radius));
    }
    return others;
}

std::vector<std::string> find_assigned_types(const Connectivity& connectivity,
                                             const SolvationTable& table) {
    std::set<std::string_view> seen;
    std::vector<std::string> assigned;
    for (const std::string& type : connectivity.type) {
        const auto row = table.types.find(type);
        if (row == table.types.end() || !row->second.is_assigned || !seen.insert(type).second)
            continue;
        const std::string& source = row->second.source;
        const std::size_t colon = source.find(": ");
        assigned.push_back(fmt::format(
            "{}: {}", type, colon == std::string::npos ? source : source.substr(colon + 2)));
    }
    return assigned;
}

}  // namespace palpa
