// A system for a run by another engine: all atoms, all terms, and the box.
#pragma once
#include "charmm/topology.h"
#include "core/units.h"
#include "math/vec.h"
#include "molecule/connectivity.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct RunSystem {
    std::string title;            // one line
    Connectivity connectivity;    // of all atoms
    Topology topology;            // of all atoms, in the same order
    std::vector<Vec3> positions;  // Å
    std::optional<Vec3> box;      // edges along x, y, z, Å; unset: vacuum
    double coulomb_constant = units::charmm_coulomb_constant;  // kcal Å/mol/e^2
};

struct EngineRunOptions {
    std::uint16_t port = 8888;  // port where the engine waits for a client
    // Atoms that the engine sends and the client may pull, by index in the order of the files,
    // rising; empty: all.
    std::vector<std::uint32_t> sent;
    double temperature = 300;  // K
    // fs; without it 2, where bonds to hydrogen and waters are rigid, and 1 where all is flexible.
    std::optional<double> timestep;
    bool flexible = false;
    std::int64_t steps = -1;  // -1: until the client ends the run
};

double timestep_of(const EngineRunOptions& options) noexcept;  // fs

// The same system with the atoms of each molecule behind each other, molecules in the order of
// their first atoms. Engines number atoms so. Throws LoadError where a system cannot be run: no
// atoms, implicit water, positions that are not finite, a box with an edge that is not positive.
RunSystem in_run_order(const RunSystem& system);

// The range of the positions, Å.
struct Extent {
    Vec3 low, high;

    Vec3 size() const { return high - low; }
    Vec3 centre() const { return 0.5 * (low + high); }
};
Extent find_extent(const std::vector<Vec3>& positions);

// From this distance on, Å, nothing of the system has another atom: no pair is left out by a cutoff
// there, nor after some expansion. In vacuum engines sum all pairs so.
double find_reach(const std::vector<Vec3>& positions);

// Warnings about a system that can be run all the same, as sentences.
std::vector<std::string> list_warnings(const RunSystem& system);

}  // namespace palpa
