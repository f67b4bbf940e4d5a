// Small molecules made by hand, and structures typed from CHARMM's files, to build and turn.
#pragma once
#include "charmm/build_topology.h"
#include "charmm/complete.h"
#include "charmm/generate.h"
#include "forces/torsion.h"
#include "prepare/build_positions.h"
#include "tests/support/native_case.h"

#include <fmt/format.h>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <vector>

namespace palpa::test {

inline constexpr double degree = std::numbers::pi / 180;
inline const Vec3 nowhere = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());

// A molecule made by hand: bonds and angles of the numbers given.
struct Molecule {
    Connectivity connectivity;
    Topology topology;
    std::vector<Vec3> positions;

    std::uint32_t add(double mass, const Vec3& position = nowhere) {
        const auto atom = static_cast<std::uint32_t>(positions.size());
        connectivity.names.push_back({"A", "RES", "1", fmt::format("X{}", atom)});
        connectivity.mass.push_back(mass);
        topology.charge.push_back(0);
        positions.push_back(position);
        return atom;
    }
    void bond(std::uint32_t a, std::uint32_t b, double r0) {
        topology.bonds.push_back({a, b, 300, r0});
    }
    void angle(std::uint32_t a, std::uint32_t b, std::uint32_t c, double theta0_deg) {
        topology.angles.push_back({a, b, c, 50, theta0_deg * degree});
    }
    BuiltPositions build(const std::vector<AtomCoordinate>& coordinates = {}) {
        topology.exclusions = build_exclusions(topology.bonds, positions.size());
        return build_positions(connectivity, topology, coordinates, positions);
    }
    double length(std::uint32_t a, std::uint32_t b) const {
        return (positions[a] - positions[b]).norm();
    }
    double angle_deg(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        const Vec3 u = positions[a] - positions[b], v = positions[c] - positions[b];
        return std::acos(u.dot(v) / (u.norm() * v.norm())) / degree;
    }
    double dihedral_deg(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) const {
        return evaluate_torsion(positions[a], positions[b], positions[c], positions[d]).angle /
               degree;
    }
};

inline constexpr double hydrogen = 1.008, carbon = 12.011, nitrogen = 14.007, oxygen = 15.999;

inline AtomCoordinate dihedral_line(std::array<std::uint32_t, 4> atoms, double dihedral_deg,
                                    bool is_improper = false) {
    return {.atoms = atoms, .is_improper = is_improper, .dihedral = dihedral_deg * degree};
}

struct Typed {
    Connectivity connectivity;
    Topology topology;
    std::vector<AtomCoordinate> coordinates;
};

inline Typed type(const std::filesystem::path& charmm, const Structure& structure,
                  const GenerateSettings& settings = {}) {
    const ForceField force_field =
        read_charmm(charmm, {"top_all36_prot.rtf", "par_all36m_prot.prm"});
    Typed typed{build_connectivity(force_field, structure, settings), {}, {}};
    typed.topology = build_topology(typed.connectivity, force_field);
    typed.coordinates = find_internal_coordinates(force_field, structure, settings);
    return typed;
}

inline bool is_hydrogen(const Connectivity& connectivity, std::uint32_t atom) {
    return connectivity.mass[atom] < 2;
}

inline std::vector<std::vector<std::uint32_t>> neighbours_of(const Connectivity& connectivity) {
    std::vector<std::vector<std::uint32_t>> neighbours(connectivity.names.size());
    for (const auto& [a, b] : connectivity.bonds) {
        neighbours[a].push_back(b);
        neighbours[b].push_back(a);
    }
    return neighbours;
}

// `file`: the one that the structure was read from, beside CHARMM's files. Asp 29 of both chains
// has a hydrogen on OD2.
inline Typed type_1tw7(const std::filesystem::path& file, const Structure& structure) {
    return type(
        file.parent_path().parent_path() / "charmm", structure,
        {.segments = {}, .patches = {{"ASPP", {{"PROA", "29"}}}, {"ASPP", {{"PROB", "29"}}}}});
}

}  // namespace palpa::test
