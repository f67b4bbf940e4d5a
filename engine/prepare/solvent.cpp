#include "prepare/solvent.h"

#include "charmm/assign_solvation.h"
#include "charmm/build_topology.h"
#include "charmm/charge_groups.h"
#include "charmm/find_parameters.h"
#include "charmm/ionic_groups.h"
#include "charmm/used_parameters.h"
#include "core/load_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr std::string_view solvent_heading = "Solvent";

// Nothing, or why EEF1-SB cannot be, and what can be done.
struct SolventObstacle {
    std::string reason, advice;
};

std::vector<std::uint8_t> find_structural(const Connectivity& connectivity,
                                          const PrepareSettings& settings) {
    if (settings.structural_waters.empty()) return {};
    return find_water_atoms(connectivity.names, connectivity.mass);
}

// What has no numbers.
std::optional<SolventObstacle> find_uncovered(const Connectivity& connectivity,
                                              const PrepareSettings& settings) {
    const std::vector<std::uint8_t> is_water =
        find_water_atoms(connectivity.names, connectivity.mass);
    if (settings.keeps_waters && std::ranges::find(is_water, 1) != is_water.end()) {
        return SolventObstacle{"the system has explicit waters, which EEF1-SB would count twice",
                               "leave the waters out (no --keep-waters), or name the few that are "
                               "part of the structure (--structural-water A:301)"};
    }
    const std::vector<std::string> uncovered =
        find_uncovered_types(connectivity, eef1sb_table(), find_structural(connectivity, settings));
    if (!uncovered.empty()) {
        return SolventObstacle{
            fmt::format("EEF1-SB has no parameters for {}: {}",
                        uncovered.size() == 1 ? "a type of atoms" : "types of atoms",
                        join_some(uncovered)),
            "leave those residues out (--without, --no-ions)"};
    }
    return std::nullopt;
}

// What has numbers, but not those that EEF1-SB is made for.
std::optional<SolventObstacle> find_obstacle(
    const Connectivity& connectivity, const Solvation& solvation,
    const std::vector<std::vector<std::uint32_t>>& groups) {
    const std::vector<std::string> others =
        find_other_radii(connectivity, solvation, eef1sb_table());
    if (!others.empty()) {
        return SolventObstacle{
            fmt::format(
                "EEF1-SB requires the radii of CHARMM36, but these parameter files have others: {}",
                join_some(others)),
            "give CHARMM36's or CHARMM36m's files (--toppar)"};
    }
    const std::vector<std::string> charged = find_charged_groups(connectivity, groups);
    if (!charged.empty()) {
        return SolventObstacle{
            fmt::format("EEF1-SB requires neutral charge groups and has no charges for {}",
                        join_some(charged)),
            "take residues and patches that it knows (ARG LYS ASP GLU HSP, NTER GLYP PROP CTER), "
            "or give ionic groups of a ligand neutral charges in its topology file"};
    }
    return std::nullopt;
}

void report_groups(const Connectivity& connectivity, std::size_t charge_groups, Report& report) {
    const std::vector<std::string_view> types(connectivity.type.begin(), connectivity.type.end());
    std::vector<std::pair<std::string_view, std::vector<std::string>>> of_kind;
    std::map<std::string_view, double> full_charge;
    for (const IonicGroup& group :
         find_ionic_groups(connectivity.names, types, connectivity.charge)) {
        auto kind =
            std::ranges::find(of_kind, group.kind, [](const auto& entry) { return entry.first; });
        if (kind == of_kind.end()) kind = of_kind.insert(kind, {group.kind, {}});
        const AtomName& name = connectivity.names[group.atoms.front()];
        kind->second.push_back(fmt::format("{} {}", name.segment, name.number));
        full_charge[group.kind] = group.full_charge;
    }
    for (const auto& [kind, residues] : of_kind) {
        report.add(solvent_heading,
                   fmt::format("{} neutral, not {:+.0f} e ({}): {}", kind, full_charge[kind],
                               residues.size(), fmt::join(residues, ", ")));
    }
    report.add(solvent_heading,
               fmt::format("{} charge groups, all neutral; total charge 0 e", charge_groups));
}

void report_force_field(const ForceField& given, Report& report) {
    const bool is_m = given.nbfix.contains(in_order("NC2", "OC"));
    if (is_m) {
        report.add(solvent_heading, "NBFIX of NC2 and OC: switched off, as EEF1-SB requires");
    }
    const double k = find_backbone_term(given);
    if (k != 0) {
        report.add(solvent_heading,
                   fmt::format("backbone: EEF1-SB's term of Cβ-Cα-C-N, {} kcal/mol, is in the "
                               "parameter files",
                               k));
    } else {
        report.add(
            solvent_heading,
            fmt::format("backbone: EEF1-SB's term of Cβ-Cα-C-N (0.5196 kcal/mol) is left "
                        "out: the parameter files do not have it{}",
                        is_m ? "; EEF1-SB with CHARMM36m's backbone is an untested mixture" : ""));
    }
}

void report_types(const Connectivity& connectivity, Report& report) {
    for (const std::string& assigned : find_assigned_types(connectivity, eef1sb_table())) {
        report.add(solvent_heading, fmt::format("assigned by Palpa, not published: {}", assigned));
    }
}

void report_structural(const Connectivity& connectivity, const PrepareSettings& settings,
                       Report& report) {
    if (settings.structural_waters.empty()) return;
    const std::vector<std::uint8_t> is_water =
        find_water_atoms(connectivity.names, connectivity.mass);
    const auto atoms = std::ranges::count(is_water, std::uint8_t{1});
    report.add(
        solvent_heading,
        fmt::format("structural waters, as requested: {}, without volume or solvation energy",
                    atoms / 3));
}

}  // namespace

std::optional<SolvatedSystem> solvate(const ForceField& force_field, const Structure& structure,
                                      const GenerateSettings& generate,
                                      const PrepareSettings& settings, Report& report) {
    if (settings.solvent == Solvent::None) return std::nullopt;
    SolvatedSystem system;
    system.force_field = neutralise_ionic_groups(keep_named_residues(force_field, structure.names));
    system.connectivity = build_connectivity(system.force_field, structure, generate);
    const std::vector<std::vector<std::uint32_t>> groups =
        find_charge_groups(system.force_field, structure, generate);
    std::optional<SolventObstacle> obstacle = find_uncovered(system.connectivity, settings);
    Solvation solvation;
    if (!obstacle) {
        solvation = assign_solvation(system.connectivity, system.force_field, eef1sb_table(),
                                     find_structural(system.connectivity, settings));
        obstacle = find_obstacle(system.connectivity, solvation, groups);
    }
    if (obstacle) {
        if (settings.solvent) {
            throw LoadError(
                {structure.file},
                fmt::format(
                    "--solvent eef1-sb cannot be used: {}; expected to {}, or --solvent none",
                    obstacle->reason, obstacle->advice));
        }
        report.add(solvent_heading, fmt::format("none (vacuum), because {}", obstacle->reason));
        return std::nullopt;
    }
    report.add(
        solvent_heading,
        fmt::format("implicit water, EEF1-SB{}: neutral ionic groups, a dielectric of 1.5 r, no "
                    "explicit water",
                    settings.solvent ? ", as requested" : ", because it covers every atom type"));
    report.add(
        solvent_heading,
        "hydrogens were oriented and clashes relaxed with full charges, as without a solvent");
    report_groups(system.connectivity, groups.size(), report);
    report_types(system.connectivity, report);
    report_structural(system.connectivity, settings, report);
    report_force_field(force_field, report);
    system.topology = build_topology(system.connectivity, system.force_field);
    system.topology.solvation = std::move(solvation);
    return system;
}

}  // namespace palpa
