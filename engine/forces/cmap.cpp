#include "forces/cmap.h"

#include "core/assertion.h"
#include "forces/torsion.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace palpa {
namespace {

// Where an angle lies on the grid: between two points, and how far from the first to the second.
struct Cell {
    std::size_t low, high;
    double fraction;
};

Cell find_cell(double angle, std::size_t size) noexcept {
    const double place = (angle / (2.0 * std::numbers::pi) + 0.5) * static_cast<double>(size);
    // Exactly pi is the end of the last cell; an angle that is no number must not become an index.
    const std::size_t low = place > 0 ? std::min(static_cast<std::size_t>(place), size - 1) : 0;
    return {low, (low + 1) % size, place - static_cast<double>(low)};
}

// Cubic Hermite weights at t in [0, 1] of the energies and slopes at 0 and 1, and their
// derivatives.
struct Weights {
    std::array<double, 2> energy, slope;
    std::array<double, 2> d_energy, d_slope;
};

Weights evaluate_weights(double t) noexcept {
    const double s = 1.0 - t;
    return {{s * s * (1.0 + 2.0 * t), t * t * (3.0 - 2.0 * t)},
            {s * s * t, -t * t * s},
            {-6.0 * s * t, 6.0 * s * t},
            {s * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)}};
}

Torsion evaluate_torsion(const std::array<std::uint32_t, 4>& atoms,
                         std::span<const Vec3> positions) noexcept {
    return palpa::evaluate_torsion(positions[atoms[0]], positions[atoms[1]], positions[atoms[2]],
                                   positions[atoms[3]]);
}

}  // namespace

CmapValue evaluate_cmap(const CmapMap& map, double phi, double psi) noexcept {
    const Cell row = find_cell(phi, map.size), column = find_cell(psi, map.size);
    const Weights along_phi = evaluate_weights(row.fraction);
    const Weights along_psi = evaluate_weights(column.fraction);

    CmapValue value{0, 0, 0};
    for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t j = 0; j < 2; ++j) {
            const CmapPoint& point =
                map.points[(i ? row.high : row.low) * map.size + (j ? column.high : column.low)];
            const double across =
                along_psi.energy[j] * point.energy + along_psi.slope[j] * point.slope_psi;
            const double across_slope =
                along_psi.energy[j] * point.slope_phi + along_psi.slope[j] * point.twist;
            const double d_across =
                along_psi.d_energy[j] * point.energy + along_psi.d_slope[j] * point.slope_psi;
            const double d_across_slope =
                along_psi.d_energy[j] * point.slope_phi + along_psi.d_slope[j] * point.twist;
            value.energy += along_phi.energy[i] * across + along_phi.slope[i] * across_slope;
            value.slope_phi += along_phi.d_energy[i] * across + along_phi.d_slope[i] * across_slope;
            value.slope_psi += along_phi.energy[i] * d_across + along_phi.slope[i] * d_across_slope;
        }
    }
    const double steps_per_rad = static_cast<double>(map.size) / (2.0 * std::numbers::pi);
    value.slope_phi *= steps_per_rad;
    value.slope_psi *= steps_per_rad;
    return value;
}

double add_cmap_forces(std::span<const CmapTerm> terms, std::span<const CmapMap> maps,
                       std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    double energy = 0;
    for (const CmapTerm& term : terms) {
        PALPA_ASSERT(term.map < maps.size());
        const Torsion phi = evaluate_torsion(term.phi, positions);
        const Torsion psi = evaluate_torsion(term.psi, positions);
        const CmapValue value = evaluate_cmap(maps[term.map], phi.angle, psi.angle);
        energy += value.energy;
        for (std::size_t i = 0; i < 4; ++i) {
            forces[term.phi[i]] -= value.slope_phi * phi.gradient[i];
            forces[term.psi[i]] -= value.slope_psi * psi.gradient[i];
        }
    }
    return energy;
}

}  // namespace palpa
