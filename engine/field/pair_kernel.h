// The single-precision kernel for Lennard-Jones and Coulomb over a cluster list, with the widest
// vectors of the processor. Its reference implementation in double is forces/nonbonded.h.
#pragma once
#include "field/cluster_list.h"
#include "field/cutoff.h"
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace palpa {

// Settings for all pairs.
struct PairScheme {
    double coulomb = 0;  // C/eps, kcal Å/mol/e^2
    // A dielectric of eps r: E = C q q'/(eps r^2).
    bool distance_dielectric = false;
    ElectrostaticCutoff electrostatics = ElectrostaticCutoff::None;
    VanDerWaalsCutoff van_der_waals = VanDerWaalsCutoff::None;
    double switch_from = 10;  // m, Å
    double cutoff = 12;       // c, Å
    // Of solvation, Å: it is switched off smoothly from one to the other. 0: there is none.
    // add_cluster_pair_forces leaves it to field/solvation_kernel.h.
    double solvation_begin = 0, solvation_end = 0;
};

// Whether there is a kernel in single precision: of no cutoff, of ForceSwitch for both without that
// dielectric (too little would be left of the energy between m and c), and of the smooth ends,
// CubicShift with SmoothSwitch.
bool has_kernel(const PairScheme& scheme) noexcept;

// One entry per atom. Every pair follows CHARMM's combination rules; what does not is left out of
// the list.
struct PairParameters {
    std::span<const double> charge;        // e
    std::span<const double> sqrt_epsilon;  // (kcal/mol)^(1/2)
    std::span<const double> half_rmin;     // Å
};

// The atoms of a cluster as the kernel wants them. A coordinate is high + low: high a multiple of
// 2^-10 Å, so that differences of two are exact, and low the rest; so a pair's distance keeps
// the precision of the distance, not that of the extent.
struct alignas(64) ClusterAtoms {
    using Column = std::array<float, cluster_size>;

    std::array<Column, 3> high, low;  // Å, from the origin
    Column charge;                    // e
    Column sqrt_epsilon;              // (kcal/mol)^(1/2)
    Column half_rmin;                 // Å
};

struct alignas(64) ClusterForces {
    std::array<std::array<double, cluster_size>, 3> on;  // kcal/mol/Å
};

// Memory that calls reuse; made by `build_pair_workspace` for one list.
struct PairWorkspace {
    Vec3 origin = Vec3::Zero();
    std::vector<ClusterAtoms> atoms;                 // clusters of the list, the empty one last
    std::vector<std::vector<ClusterForces>> forces;  // one for each thread
};

PairWorkspace build_pair_workspace(const ClusterList& list, const PairParameters& parameters,
                                   PairWorkspace storage = {});

struct PairKernelSum {
    // Without it nothing was added: two atoms are nearer than `nearest_single_precision`, or one is
    // further than `farthest_single_precision` from the origin, or nowhere. Such pairs are the
    // reference's.
    bool is_sound = false;
    double van_der_waals = 0;  // kcal/mol; 0 where no energies are asked for
    double electrostatic = 0;  // kcal/mol
};

inline constexpr double nearest_single_precision = 0.5;    // Å
inline constexpr double farthest_single_precision = 8000;  // Å

enum class PairResult { Forces, ForcesAndEnergies };

// How many threads share a sum. Those beyond the first are started at each call; std::system_error
// where there are none.
struct PairThreads {
    std::size_t count = 1;
    // What the calling thread does first, while the others have begun with the pairs, and how many
    // tiles take as long. Called once, whether the sum is sound or not.
    std::function<void()> beside = nullptr;
    std::size_t beside_tiles = 0;
};

// Adds the forces (kcal/mol/Å, one entry per atom) of all pairs of a list that is not outdated and
// whose cutoff is at least the scheme's, which has a kernel. Pairs are in single precision, sums
// over more than a thousand of them in double. Repeats to the bit with the same list, processor and
// threads.
//
// Against the reference: forces within 2e-5 of the larger of the atom's own and the rms force, the
// energy within 1e-6 of the sum of all pairs' repulsion, attraction and electrostatic energy, each
// without its sign. (Of a single pair the van der Waals part alone can be off by 2e-6 of its own.)
PairKernelSum add_cluster_pair_forces(const ClusterList& list, const PairScheme& scheme,
                                      std::span<const Vec3> positions, PairWorkspace& workspace,
                                      std::span<Vec3> forces, PairResult result,
                                      const PairThreads& threads = {});

}  // namespace palpa
