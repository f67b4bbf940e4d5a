#include "session/compare_poses.h"

#include "math/superpose.h"
#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace palpa {
namespace {

constexpr double heaviest_hydrogen = 2.5;  // amu

bool is_backbone(const AtomName& name) {
    constexpr std::array<std::string_view, 4> names{"N", "CA", "C", "O"};
    return std::ranges::find(names, name.atom) != names.end();
}

// Of one residue each, in the order of the table, without those atoms.
std::vector<std::vector<std::uint32_t>> list_residues(const AtomTable& atoms,
                                                      std::span<const std::uint32_t> without) {
    std::vector<bool> left_out(atoms.size(), false);
    for (const std::uint32_t i : without) left_out[i] = true;
    std::vector<std::vector<std::uint32_t>> residues;
    for (std::uint32_t i = 0; i < atoms.size(); ++i) {
        if (left_out[i]) continue;
        if (residues.empty() ||
            !is_same_residue(atoms.names[residues.back().back()], atoms.names[i]))
            residues.emplace_back();
        residues.back().push_back(i);
    }
    return residues;
}

bool is_amino_acid(const AtomTable& atoms, const std::vector<std::uint32_t>& residue) {
    return std::ranges::count_if(residue,
                                 [&](std::uint32_t i) { return is_backbone(atoms.names[i]); }) >= 3;
}

bool is_near(const AtomTable& atoms, std::span<const std::uint32_t> residue,
             std::span<const std::uint32_t> held) {
    constexpr double pocket = 5;  // Å
    return std::ranges::any_of(residue, [&](std::uint32_t i) {
        return atoms.mass[i] > heaviest_hydrogen && std::ranges::any_of(held, [&](std::uint32_t j) {
                   return (atoms.positions[i] - atoms.positions[j]).squaredNorm() < pocket * pocket;
               });
    });
}

double rms_of(double square, std::size_t count) {
    return count > 0 ? std::sqrt(square / static_cast<double>(count)) : 0;
}

}  // namespace

PoseComparison::PoseComparison(const World& world) {
    const AtomTable& atoms = world.resource<AtomTable>();
    const Entity hand = hand_at(world, 0);
    const std::vector<std::uint32_t> held = held_atoms(world, hand);
    held_ = find_symmetries(atoms, held);
    const Entity other = molecule_called(world, world.find<GripSettings>(hand)->measured_from);
    const AtomRange frame = other == Entity{} ? AtomRange{} : world.find<Molecule>(other)->atoms;
    for (const std::vector<std::uint32_t>& residue : list_residues(atoms, held)) {
        if (!is_amino_acid(atoms, residue)) continue;
        std::vector<std::uint32_t> side_chain;
        for (const std::uint32_t i : residue) {
            if (!is_backbone(atoms.names[i])) {
                side_chain.push_back(i);
                continue;
            }
            backbone_.push_back(i);
            if (has_atom(frame, i)) frame_.push_back(i);
        }
        if (!is_near(atoms, residue, held_.atoms)) continue;
        SymmetricAtoms symmetric = find_symmetries(atoms, side_chain);
        if (!symmetric.atoms.empty()) pocket_.push_back(std::move(symmetric));
    }
    if (!holds_whole(world, hand)) {
        frame_.clear();
        return;
    }
    if (!frame_.empty()) return;
    for (std::uint32_t i = frame.first; i < frame.first + frame.count; ++i) {
        if (atoms.mass[i] > heaviest_hydrogen) frame_.push_back(i);
    }
}

PoseDistance PoseComparison::between(std::span<const Vec3> from, std::span<const Vec3> to) const {
    std::vector<Vec3> frame_from, frame_to;
    for (const std::uint32_t i : frame_) {
        frame_from.push_back(from[i]);
        frame_to.push_back(to[i]);
    }
    constexpr std::size_t fewest = 3;  // that say how to turn
    const RigidMotion motion =
        frame_.size() >= fewest ? superpose(frame_from, frame_to) : RigidMotion{};
    PoseDistance distance;
    distance.held = rms_of(find_square_distance(held_, motion, from, to), held_.atoms.size());
    double square = 0;
    for (const std::uint32_t i : backbone_) square += (motion * from[i] - to[i]).squaredNorm();
    distance.backbone = rms_of(square, backbone_.size());
    square = 0;
    std::size_t count = 0;
    for (const SymmetricAtoms& side_chain : pocket_) {
        square += find_square_distance(side_chain, motion, from, to);
        count += side_chain.atoms.size();
    }
    distance.pocket = rms_of(square, count);
    return distance;
}

}  // namespace palpa
