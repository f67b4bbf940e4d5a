#include "prepare/align.h"

#include "core/load_error.h"
#include "math/eigenvectors.h"
#include "prepare/residues.h"

#include <fmt/format.h>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <vector>

namespace palpa {
namespace {

bool is_heavy(const Structure& structure, std::size_t atom) {
    return element_of(structure, atom) != "H";
}

Vec3 middle_of(const Structure& structure, std::span<const Vec3> positions,
               const std::string& segment) {
    Vec3 sum = Vec3::Zero();
    double count = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (structure.names[i].segment != segment || !is_heavy(structure, i)) continue;
        sum += positions[i];
        ++count;
    }
    if (count == 0) {
        std::set<std::string> segments;
        for (const AtomName& name : structure.names) segments.insert(name.segment);
        throw LoadError({structure.file}, fmt::format("--x-along {}: no such segment (only {})",
                                                      segment, fmt::join(segments, ", ")));
    }
    return sum / count;
}

// The segment's axes as columns, the longest last.
Mat3 axes_of(const Structure& structure, std::span<const Vec3> positions,
             const std::string& segment, const Vec3& middle) {
    Mat3 spread = Mat3::Zero();
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (structure.names[i].segment != segment || !is_heavy(structure, i)) continue;
        spread += (positions[i] - middle) * (positions[i] - middle).transpose();
    }
    return find_eigenvectors(spread).vectors;
}

// From the first of the other segments to the last; nothing where there is only one.
Vec3 direction_of_others(const Structure& structure, std::span<const Vec3> positions,
                         const std::string& segment) {
    std::vector<std::string> others;
    for (const AtomName& name : structure.names) {
        if (name.segment == segment) continue;
        if (others.empty() || others.back() != name.segment) others.push_back(name.segment);
    }
    if (others.empty()) return Vec3::Zero();
    return middle_of(structure, positions, others.back()) -
           middle_of(structure, positions, others.front());
}

// Of the residue of this number, or the mean of those in all chains where none is named.
Vec3 place_of(const Structure& structure, std::span<const Vec3> positions,
              const ResidueChoice& choice) {
    Vec3 sum = Vec3::Zero();
    double count = 0;
    for (const ResidueRange& residue : find_residues(structure)) {
        const AtomName& name = structure.names[residue.first];
        const bool is_chain = choice.chain.empty() || name.segment == choice.chain ||
                              chain_of(structure, residue.first) == choice.chain;
        if (name.number != choice.number || !is_chain) continue;
        sum += positions[find_atom(structure, residue, "CA").value_or(residue.first)];
        ++count;
    }
    if (count > 0) return sum / count;
    throw LoadError({structure.file},
                    fmt::format("--y-towards: no residue {}:{} here", choice.chain, choice.number));
}

}  // namespace

void align(const Structure& structure, const AlignSettings& settings, std::span<Vec3> positions) {
    const Vec3 middle = middle_of(structure, positions, settings.segment);
    const Mat3 axes = axes_of(structure, positions, settings.segment, middle);
    Vec3 x = axes.col(2);
    if (x.dot(direction_of_others(structure, positions, settings.segment)) < 0) x = -x;
    Vec3 up = axes.col(1);
    if (settings.up) {
        up = place_of(structure, positions, settings.up->second) -
             place_of(structure, positions, settings.up->first);
    }
    const Vec3 across = up - up.dot(x) * x;
    if (!(across.norm() > 1e-3)) {
        throw LoadError({structure.file},
                        "--y-towards: the direction between the two residues is parallel to x; "
                        "expected residues that lie across the x axis");
    }
    const Vec3 y = across.normalized();
    Mat3 turn;
    turn << x.transpose(), y.transpose(), x.cross(y).transpose();
    for (Vec3& position : positions) {
        position = 1e-6 * (1e6 * (turn * (position - middle))).array().round();
    }
}

}  // namespace palpa
