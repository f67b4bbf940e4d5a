// Times joint accelerations of a tree with Simbody and with the assembly tree, by turns, and says
// how far apart they are. Compiled and fed by tools/lab/scripts/compare_simbody.
#include "tools/lab/bench/compare_simbody.h"
#include "assembly/passes.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <vector>

namespace {

using namespace palpa;

std::array<double, 3> read_vector(std::istream& file) {
    std::array<double, 3> v{};
    for (double& component : v) file >> component;
    return v;
}

// Atoms as mass, position, force; bodies as parent or -1, axis, number of atoms, atoms.
PeerTree read_tree(const char* path) {
    std::ifstream file(path);
    file.exceptions(std::ios::failbit | std::ios::badbit);
    std::size_t atoms = 0, bodies = 0;
    file >> atoms >> bodies;
    PeerTree tree;
    for (std::size_t i = 0; i < atoms; ++i) {
        double mass = 0;
        file >> mass;
        tree.masses.push_back(mass);
        tree.positions.push_back(read_vector(file));
        tree.forces.push_back(read_vector(file));
    }
    for (std::size_t b = 0; b < bodies; ++b) {
        PeerBody body;
        std::size_t count = 0;
        file >> body.parent >> body.axis[0] >> body.axis[1] >> count;
        body.atoms.resize(count);
        for (std::size_t& atom : body.atoms) file >> atom;
        tree.bodies.push_back(body);
    }
    return tree;
}

TorsionBodies bodies_of(const PeerTree& tree) {
    TorsionBodies result;
    result.body_of.resize(tree.masses.size());
    for (const PeerBody& peer : tree.bodies) {
        const auto number = static_cast<std::uint32_t>(result.bodies.size());
        for (const std::size_t atom : peer.atoms) result.body_of[atom] = number;
        Body body;
        if (peer.parent >= 0) body.parent = static_cast<std::uint32_t>(peer.parent);
        for (const std::size_t end : {0, 1}) {
            body.axis[end] = static_cast<std::uint32_t>(peer.axis[end]);
        }
        result.bodies.push_back(body);
    }
    return result;
}

std::vector<Vec3> vectors_of(const std::vector<std::array<double, 3>>& arrays) {
    std::vector<Vec3> result;
    for (const auto& [x, y, z] : arrays) result.emplace_back(x, y, z);
    return result;
}

template <class Work>
double microseconds_of(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin)
        .count();
}

void print_times(const char* name, std::vector<double> times) {
    std::ranges::sort(times);
    fmt::print("{:<10}{:>9.1f} us at least, median {:.1f}\n", name, times.front(),
               times[times.size() / 2]);
}

}  // namespace

int main(int, char** arguments) {
    const PeerTree input = read_tree(arguments[1]);
    const std::vector<Vec3> positions = vectors_of(input.positions);
    const std::vector<Vec3> forces = vectors_of(input.forces);
    const AssemblyTree tree = build_assembly_tree(bodies_of(input), input.masses, positions);
    AssemblyState state = build_assembly_state(tree);
    const std::unique_ptr<Peer> simbody = build_simbody(input);
    std::vector<double> ours, theirs;
    for (int run = 0; run < 201; ++run) {
        theirs.push_back(microseconds_of([&] { simbody->update_accelerations(); }));
        ours.push_back(
            microseconds_of([&] { update_accelerations(tree, positions, forces, state); }));
    }
    double squares = 0, worst = 0;
    for (std::size_t b = 0; b < input.bodies.size(); ++b) {
        if (tree.bodies.is_base(b)) continue;
        const double expected = simbody->joint_acceleration(b);
        squares += expected * expected;
        worst = std::max(worst, std::abs(state.joint_acceleration[b] - expected));
    }
    const auto joints = static_cast<double>(tree.bodies.joints());
    fmt::print("{} joints, {} molecules\n", joints, tree.bodies.molecules());
    print_times("Simbody", theirs);
    print_times("Palpa", ours);
    fmt::print("Simbody takes {:.2f} times as long, by the least\n",
               std::ranges::min(theirs) / std::ranges::min(ours));
    fmt::print("accelerations are {:.1e} of their rms apart at most\n",
               worst / std::sqrt(squares / joints));
}
