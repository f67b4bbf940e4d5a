#include "molecule/surface/potential.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace palpa {
namespace {

// kcal/mol/K, from the molar gas constant 8.31446261815324 J/mol/K of the 2019 SI.
constexpr double gas_constant = 8.31446261815324 / units::joule_per_kcal;

constexpr Eigen::Index lanes = 16;  // vertices side by side
using Lanes = Eigen::Array<float, lanes, 1>;

struct Charge {
    float x, y, z, q;
};

// Relative to a place near by, so that single precision has digits left. Those of 0 are omitted.
std::vector<Charge> charges_from(const Vec3& origin, std::span<const Vec3> positions,
                                 std::span<const double> charges) {
    std::vector<Charge> list;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (charges[i] == 0 || !positions[i].allFinite()) continue;
        const Eigen::Vector3f place = (positions[i] - origin).cast<float>();
        list.push_back({place.x(), place.y(), place.z(), static_cast<float>(charges[i])});
    }
    return list;
}

// sum q/r^2, or q/r.
template <bool Grows>
Lanes sum_charges(const std::array<Lanes, 3>& place, std::span<const Charge> charges) {
    constexpr float closest = 0.5F;
    Lanes sum = Lanes::Zero();
    for (const Charge& c : charges) {
        const Lanes squared =
            ((place[0] - c.x).square() + (place[1] - c.y).square() + (place[2] - c.z).square())
                .max(closest * closest);
        if constexpr (Grows) {
            sum += c.q / squared;
        } else {
            sum += c.q / squared.sqrt();
        }
    }
    return sum;
}

}  // namespace

std::vector<float> find_potentials(const SurfaceMesh& mesh, std::span<const Vec3> positions,
                                   std::span<const double> charges,
                                   const PotentialSettings& settings) {
    std::vector<float> potentials(mesh.places.size());
    if (potentials.empty()) return potentials;
    const Vec3 origin = mesh.places[0].cast<double>();
    const std::vector<Charge> list = charges_from(origin, positions, charges);
    const double factor = settings.coulomb_constant /
                          (gas_constant * settings.temperature * settings.dielectric.constant);
    for (std::size_t first = 0; first < potentials.size(); first += lanes) {
        const std::size_t count = std::min<std::size_t>(lanes, potentials.size() - first);
        std::array<Lanes, 3> place;
        for (std::size_t i = 0; i < lanes; ++i) {
            const std::size_t vertex = first + std::min(i, count - 1);
            const Vec3 at = mesh.places[vertex].cast<double>() - origin +
                            settings.outward * mesh.normals[vertex].cast<double>();
            for (std::size_t k = 0; k < 3; ++k)
                place[k][static_cast<Eigen::Index>(i)] =
                    static_cast<float>(at[static_cast<Eigen::Index>(k)]);
        }
        const Lanes sums = settings.dielectric.grows_with_distance
                               ? sum_charges<true>(place, list)
                               : sum_charges<false>(place, list);
        for (std::size_t i = 0; i < count; ++i)
            potentials[first + i] = static_cast<float>(factor) * sums[static_cast<Eigen::Index>(i)];
    }
    return potentials;
}

}  // namespace palpa
