#include "charmm/cmap_map.h"

#include "core/assertion.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace palpa {
namespace {

// The slopes of a periodic cubic spline through y solve m[i-1] + 4 m[i] + m[i+1] =
// 3 (y[i+1] - y[i-1]). The inverse of that matrix is known: its entries fall off by
// sqrt(3) - 2 per step from the diagonal, in both directions around the period.
std::vector<double> build_inverse(std::size_t size) {
    const double decay = std::sqrt(3.0) - 2.0;
    std::vector<double> power(size + 1, 1.0);
    for (std::size_t k = 1; k <= size; ++k) power[k] = decay * power[k - 1];
    std::vector<double> inverse(size);
    for (std::size_t k = 0; k < size; ++k)
        inverse[k] = (power[k] + power[size - k]) / (2.0 * std::sqrt(3.0) * (1.0 - power[size]));
    return inverse;
}

// Slopes, per step, of splines through `from` along one direction of the map, written to `to`.
void add_slopes(std::span<const double> inverse, bool along_phi, double CmapPoint::* from,
                double CmapPoint::* to, CmapMap& map) {
    const std::size_t n = map.size;
    const auto at = [&](std::size_t line, std::size_t i) -> CmapPoint& {
        return map.points[along_phi ? i * n + line : line * n + i];
    };
    for (std::size_t line = 0; line < n; ++line) {
        for (std::size_t i = 0; i < n; ++i) {
            double slope = 0;
            for (std::size_t j = 0; j < n; ++j) {
                const double right = at(line, (j + 1) % n).*from - at(line, (j + n - 1) % n).*from;
                slope += inverse[(i + n - j) % n] * 3.0 * right;
            }
            at(line, i).*to = slope;
        }
    }
}

}  // namespace

CmapMap build_cmap_map(std::span<const double> energies) {
    const auto size =
        static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(energies.size()))));
    PALPA_ASSERT(size > 0 && size * size == energies.size());

    CmapMap map{size, std::vector<CmapPoint>(energies.size())};
    for (std::size_t i = 0; i < energies.size(); ++i) map.points[i].energy = energies[i];
    const std::vector<double> inverse = build_inverse(size);
    add_slopes(inverse, true, &CmapPoint::energy, &CmapPoint::slope_phi, map);
    add_slopes(inverse, false, &CmapPoint::energy, &CmapPoint::slope_psi, map);
    add_slopes(inverse, false, &CmapPoint::slope_phi, &CmapPoint::twist, map);
    return map;
}

}  // namespace palpa
