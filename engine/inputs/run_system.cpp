#include "inputs/run_system.h"

#include "core/load_error.h"
#include "inputs/molecules.h"
#include "molecule/coincident_atoms.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace palpa {
namespace {

constexpr double closest_atoms = 0.5;    // Å; closer than that engines fly apart
constexpr double neutral_within = 1e-3;  // e

void check(const RunSystem& system) {
    const TextPlace place{system.connectivity.file};
    if (system.positions.empty()) throw LoadError(place, "there are no atoms to run");
    if (system.topology.solvation) {
        throw LoadError(place,
                        "has implicit water (EEF1-SB), which other engines do not support; "
                        "expected a system in vacuum or with explicit water");
    }
    if (!std::ranges::all_of(system.positions, [](const Vec3& p) { return p.allFinite(); }))
        throw LoadError(place, "an atom has no coordinates; expected finite numbers");
    if (system.box && !(system.box->allFinite() && system.box->minCoeff() > 0))
        throw LoadError(place, "an edge of the box is not positive; expected edges above 0 Å");
}

Connectivity reordered(const Connectivity& from, const std::vector<std::uint32_t>& order,
                       const std::vector<std::uint32_t>& place) {
    Connectivity to = from;
    for (std::size_t i = 0; i < order.size(); ++i) {
        to.names[i] = from.names[order[i]];
        to.type[i] = from.type[order[i]];
        to.charge[i] = from.charge[order[i]];
        to.mass[i] = from.mass[order[i]];
        to.lines[i] = from.lines[order[i]];
    }
    const auto renumber = [&](auto& terms) {
        for (auto& atoms : terms)
            for (std::uint32_t& atom : atoms) atom = place[atom];
    };
    renumber(to.bonds);
    renumber(to.angles);
    renumber(to.dihedrals);
    renumber(to.impropers);
    renumber(to.cmaps);
    return to;
}

Topology reordered(const Topology& from, const std::vector<std::uint32_t>& order,
                   const std::vector<std::uint32_t>& place) {
    Topology to = from;
    for (std::size_t i = 0; i < order.size(); ++i) {
        to.charge[i] = from.charge[order[i]];
        to.type[i] = from.type[order[i]];
    }
    const auto renumber = [&](auto&... atoms) { ((atoms = place[atoms]), ...); };
    for (Bond& t : to.bonds) renumber(t.a, t.b);
    for (Angle& t : to.angles) renumber(t.a, t.b, t.c);
    for (UreyBradley& t : to.urey_bradleys) renumber(t.a, t.c);
    for (Dihedral& t : to.dihedrals) renumber(t.a, t.b, t.c, t.d);
    for (Improper& t : to.impropers) renumber(t.a, t.b, t.c, t.d);
    for (CmapTerm& t : to.cmap_terms) {
        for (std::uint32_t& atom : t.phi) atom = place[atom];
        for (std::uint32_t& atom : t.psi) atom = place[atom];
    }
    to.exclusions = build_exclusions(to.bonds, to.size());
    return to;
}

}  // namespace

double timestep_of(const EngineRunOptions& options) noexcept {
    return options.timestep.value_or(options.flexible ? 1.0 : 2.0);
}

RunSystem in_run_order(const RunSystem& system) {
    check(system);
    const std::vector<std::uint32_t> molecule = find_molecules(system.topology);
    std::vector<std::uint32_t> order(molecule.size()), place(molecule.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return molecule[a] < molecule[b]; });
    for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
    RunSystem result{system.title,
                     reordered(system.connectivity, order, place),
                     reordered(system.topology, order, place),
                     {},
                     system.box,
                     system.coulomb_constant};
    for (const std::uint32_t atom : order) result.positions.push_back(system.positions[atom]);
    return result;
}

Extent find_extent(const std::vector<Vec3>& positions) {
    Extent extent{positions.at(0), positions.at(0)};
    for (const Vec3& position : positions) {
        extent.low = extent.low.cwiseMin(position);
        extent.high = extent.high.cwiseMax(position);
    }
    return extent;
}

double find_reach(const std::vector<Vec3>& positions) {
    constexpr double spare = 10;  // Å, by which it may grow
    return std::ceil(find_extent(positions).size().norm() + spare);
}

std::vector<std::string> list_warnings(const RunSystem& system) {
    std::vector<std::string> warnings;
    const double charge =
        std::accumulate(system.topology.charge.begin(), system.topology.charge.end(), 0.0);
    if (system.box && std::abs(charge) > neutral_within) {
        warnings.push_back(
            fmt::format("the box has a charge of {:.3f} e, which PME spreads evenly over it; add "
                        "ions to make it neutral",
                        charge));
    }
    if (system.box) {
        const Vec3 size = find_extent(system.positions).size();
        for (int axis = 0; axis < 3; ++axis) {
            // Molecules may stick out of the box by half of themselves.
            if (size[axis] < 0.9 * (*system.box)[axis] || size[axis] > 1.5 * (*system.box)[axis]) {
                warnings.push_back(fmt::format(
                    "along {} the box is {:.2f} Å long, but its atoms extend over {:.2f} Å",
                    "xyz"[axis], (*system.box)[axis], size[axis]));
            }
        }
    }
    if (const auto closest =
            describe_coincident_atoms(system.connectivity.names, system.positions, closest_atoms)) {
        warnings.push_back("atoms overlap: " + *closest);
    }
    return warnings;
}

}  // namespace palpa
