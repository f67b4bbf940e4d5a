#include "inputs/water_box.h"

#include "charmm/build_topology.h"
#include "charmm/generate.h"
#include "core/draws.h"
#include "core/load_error.h"
#include "inputs/molecules.h"
#include "inputs/run_system.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

namespace palpa {
namespace {

constexpr double neighbours_within = 6.5;  // Å, between oxygens or to an atom of the molecule
constexpr int sweeps = 8, tries = 40;
constexpr double small_turn = 0.1;  // of a quaternion's parts: some ten degrees
constexpr std::size_t residues_per_segment = 9999;

using Water = std::array<Vec3, 3>;  // oxygen first

Structure name_waters(std::size_t count) {
    Structure structure;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t part = i / residues_per_segment;
        const std::string segment = part == 0 ? "WAT" : fmt::format("WAT{}", part);
        for (const char* const atom : {"OH2", "H1", "H2"}) {
            structure.names.push_back(
                {segment, "TIP3", fmt::format("{}", i % residues_per_segment + 1), atom});
            structure.positions.push_back(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
            structure.lines.push_back(0);
        }
    }
    structure.file = "waters of the box";
    return structure;
}

// One water at the origin as the force field has it.
Water water_at_rest(const Topology& topology) {
    const double oh = topology.bonds.at(0).r0, half = 0.5 * topology.angles.at(0).theta0;
    return {Vec3::Zero(), Vec3(oh * std::sin(half), oh * std::cos(half), 0),
            Vec3(-oh * std::sin(half), oh * std::cos(half), 0)};
}

Mat3 draw_turn(Draws& draws) {
    Eigen::Quaterniond turn;
    for (double& part : turn.coeffs()) part = draws.normal();
    return turn.normalized().toRotationMatrix();
}

Mat3 draw_small_turn(Draws& draws) {
    Eigen::Quaterniond turn;
    for (double& part : turn.coeffs()) part = small_turn * draws.normal();
    turn.w() = 1;
    return turn.normalized().toRotationMatrix();
}

Vec3 to_nearest_image(Vec3 way, double edge) {
    for (double& each : way) each -= edge * std::round(each / edge);
    return way;
}

// Oxygens of a lattice that leave the molecule its room.
std::vector<Vec3> place_oxygens(const WaterBoxSettings& settings, const Connectivity& molecule,
                                const std::vector<Vec3>& places, double edge) {
    const auto has_room = [&](const Vec3& oxygen) {
        for (std::size_t i = 0; i < places.size(); ++i) {
            const double least =
                is_hydrogen(molecule.mass[i]) ? settings.closest_hydrogen : settings.closest_heavy;
            if (to_nearest_image(oxygen - places[i], edge).norm() < least) return false;
        }
        return true;
    };
    std::vector<Vec3> oxygens;
    // Eight in a cube, as carbons in diamond; quarters of its edge.
    constexpr std::array<std::array<int, 3>, 8> sites{
        {{0, 0, 0}, {0, 2, 2}, {2, 0, 2}, {2, 2, 0}, {1, 1, 1}, {1, 3, 3}, {3, 1, 3}, {3, 3, 1}}};
    const std::size_t n = settings.cells;
    const double quarter = edge / (4 * static_cast<double>(n));
    for (std::size_t cell = 0; cell < n * n * n; ++cell) {
        const Vec3 corner(static_cast<double>(cell / (n * n)), static_cast<double>(cell / n % n),
                          static_cast<double>(cell % n));
        for (const auto& [x, y, z] : sites) {
            const Vec3 oxygen = quarter * (4 * corner + Vec3(x + 0.5, y + 0.5, z + 0.5));
            if (has_room(oxygen)) oxygens.push_back(oxygen);
        }
    }
    return oxygens;
}

// Turns waters in the field of what is around them.
class Turner {
public:
    Turner(const Topology& topology, const std::vector<Vec3>& molecule, double edge)
        : topology_(topology), positions_(molecule), molecule_(molecule.size()), edge_(edge) {}

    void add(const Vec3& oxygen, const Water& water) {
        for (const Vec3& atom : water) positions_.push_back(oxygen + atom);
    }

    // The energy never rises.
    void turn_all(const Water& water, Draws& draws) {
        for (std::size_t first = molecule_; first < positions_.size(); first += 3) {
            const std::vector<std::size_t> around = find_around(first);
            const Vec3 oxygen = positions_[first];
            Water best{oxygen, positions_[first + 1], positions_[first + 2]};
            double lowest = energy(best, first, around);
            for (int i = 0; i < tries; ++i) {
                // Anywhere, or a little off the best so far.
                const bool anywhere = i % 2 == 0;
                const Mat3 turn = anywhere ? draw_turn(draws) : draw_small_turn(draws);
                const Vec3 h1 = anywhere ? water[1] : Vec3(best[1] - oxygen),
                           h2 = anywhere ? water[2] : Vec3(best[2] - oxygen);
                const Water turned{oxygen, oxygen + turn * h1, oxygen + turn * h2};
                const double now = energy(turned, first, around);
                if (now >= lowest) continue;
                lowest = now;
                best = turned;
            }
            std::copy(best.begin(), best.end(),
                      positions_.begin() + static_cast<std::ptrdiff_t>(first));
        }
    }

    std::vector<Vec3> positions() && { return std::move(positions_); }

private:
    // Atoms of the molecule and of waters near by, whole waters.
    std::vector<std::size_t> find_around(std::size_t water) const {
        std::vector<std::size_t> around;
        const auto is_near = [&](std::size_t atom) {
            return to_nearest_image(positions_[atom] - positions_[water], edge_).norm() <
                   neighbours_within;
        };
        for (std::size_t atom = 0; atom < molecule_; ++atom)
            if (is_near(atom)) around.push_back(atom);
        for (std::size_t first = molecule_; first < positions_.size(); first += 3) {
            if (first == water || !is_near(first)) continue;
            for (std::size_t i = 0; i < 3; ++i) around.push_back(first + i);
        }
        return around;
    }

    double energy(const Water& water, std::size_t first,
                  const std::vector<std::size_t>& around) const {
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const LennardJonesPair* const row =
                topology_.lennard_jones.row(topology_.type[first + i]);
            for (const std::size_t atom : around) {
                const double r2 =
                    to_nearest_image(positions_[atom] - water[i], edge_).squaredNorm();
                const LennardJonesPair& pair = row[topology_.type[atom]];
                const double s2 = pair.rmin * pair.rmin / r2, s6 = s2 * s2 * s2;
                sum += units::charmm_coulomb_constant * topology_.charge[first + i] *
                           topology_.charge[atom] / std::sqrt(r2) +
                       pair.epsilon * s6 * (s6 - 2);
            }
        }
        return sum;
    }

    const Topology& topology_;
    std::vector<Vec3> positions_;
    std::size_t molecule_;  // its atoms
    double edge_;
};

// Whatever patches the ends of a protein's chains have by default.
Connectivity connect_waters(const ForceField& force_field, std::size_t count) {
    const Structure waters = name_waters(count);
    GenerateSettings settings;
    for (const AtomName& name : waters.names) {
        if (settings.segments.empty() || settings.segments.back().segment != name.segment)
            settings.segments.push_back({name.segment, "NONE", "NONE"});
    }
    return build_connectivity(force_field, waters, settings);
}

void append_all(const Connectivity& from, Connectivity& to) {
    std::vector<std::uint32_t> atoms(from.names.size());
    for (std::uint32_t i = 0; i < atoms.size(); ++i) atoms[i] = i;
    append_atoms(from, atoms, to);
}

void check_segments(const Connectivity& molecule) {
    for (std::size_t i = 0; i < molecule.names.size(); ++i) {
        if (!molecule.names[i].segment.starts_with("WAT")) continue;
        throw LoadError({molecule.file, molecule.lines[i]},
                        fmt::format("segment '{}' has a name of the box's waters; expected a name "
                                    "that does not begin with WAT",
                                    molecule.names[i].segment));
    }
}

}  // namespace

WaterBox build_water_box(const ForceField& force_field, const Connectivity& molecule,
                         const std::vector<Vec3>& places, const WaterBoxSettings& settings) {
    check_segments(molecule);
    WaterBox box;
    box.edge = 2 * static_cast<double>(settings.cells) / std::cbrt(settings.density);
    box.positions = places;
    if (!places.empty()) {
        const Extent extent = find_extent(places);
        if (extent.size().maxCoeff() > box.edge) {
            throw LoadError(
                {molecule.file},
                fmt::format(
                    "the molecule is {:.1f} Å long and the box only {:.1f} Å; expected more waters",
                    extent.size().maxCoeff(), box.edge));
        }
        for (Vec3& place : box.positions) place += Vec3::Constant(0.5 * box.edge) - extent.centre();
    }
    const std::vector<Vec3> oxygens = place_oxygens(settings, molecule, box.positions, box.edge);
    box.waters = oxygens.size();
    box.connectivity.file = molecule.file;
    append_all(molecule, box.connectivity);
    append_all(connect_waters(force_field, box.waters), box.connectivity);
    const Topology topology = build_topology(box.connectivity, force_field);
    Connectivity single;
    append_all(connect_waters(force_field, 1), single);
    const Water water = water_at_rest(build_topology(single, force_field));
    Draws draws(settings.seed, 0);
    Turner turner(topology, box.positions, box.edge);
    for (const Vec3& oxygen : oxygens) {
        const Mat3 turn = draw_turn(draws);
        turner.add(oxygen, {Vec3::Zero(), turn * water[1], turn * water[2]});
    }
    for (int i = 0; i < sweeps; ++i) turner.turn_all(water, draws);
    box.positions = std::move(turner).positions();
    return box;
}

}  // namespace palpa
