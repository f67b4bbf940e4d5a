#include "prepare/region_choice.h"

#include "math/vec.h"
#include "prepare/residues.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace palpa {
namespace {

constexpr std::array distances{32.0, 28.0, 24.0, 20.0, 16.0, 14.0, 12.0, 10.0, 8.0};  // Å

// The box that holds these atoms.
struct Box {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;

    void add(const Vec3& place) {
        low = low.cwiseMin(place);
        high = high.cwiseMax(place);
    }
    double distance_to(const Vec3& place) const {
        return (low - place).cwiseMax(place - high).cwiseMax(0).norm();
    }
};

// A residue's atoms, and how near to what is held the nearest of them is.
struct NearResidue {
    double distance2 = 0;  // Å^2
    std::size_t atoms = 0;
};

std::vector<NearResidue> find_near_residues(const Structure& structure,
                                            std::span<const SystemSegment> segments,
                                            std::span<const std::uint32_t> held) {
    Box box;
    for (const std::uint32_t atom : held) box.add(structure.positions[atom]);
    std::vector<NearResidue> residues;
    for (const SystemSegment& segment : segments) {
        if (segment.kind != SegmentKind::Molecule) continue;
        for (std::size_t i = 0; i < segment.atoms.size(); ++i) {
            const std::uint32_t atom = segment.atoms[i];
            if (i == 0 ||
                !is_same_residue(structure.names[segment.atoms[i - 1]], structure.names[atom])) {
                residues.push_back({std::numeric_limits<double>::infinity(), 0});
            }
            ++residues.back().atoms;
            const Vec3& place = structure.positions[atom];
            if (box.distance_to(place) > distances.front()) continue;
            for (const std::uint32_t other : held) {
                residues.back().distance2 = std::min(
                    residues.back().distance2, (structure.positions[other] - place).squaredNorm());
            }
        }
    }
    return residues;
}

}  // namespace

RegionChoice choose_region(const Structure& structure, std::span<const SystemSegment> segments,
                           std::span<const std::uint32_t> held) {
    const std::vector<NearResidue> residues = find_near_residues(structure, segments, held);
    RegionChoice choice;
    for (const double distance : distances) {
        choice = {distance, 0};
        for (const NearResidue& residue : residues) {
            if (residue.distance2 <= distance * distance) choice.atoms += residue.atoms;
        }
        if (choice.atoms <= most_atoms_of_region) break;
    }
    return choice;
}

std::size_t count_mobile_atoms(std::span<const SystemSegment> segments) noexcept {
    std::size_t count = 0;
    for (const SystemSegment& segment : segments) {
        if (segment.kind == SegmentKind::Molecule) count += segment.atoms.size();
    }
    return count;
}

}  // namespace palpa
