// Molecules of the reference cases as torsion models, one or two of them.
#pragma once
#include "assembly/bodies.h"
#include "molecule/connectivity.h"
#include "statics/torsion_state.h"
#include "tests/support/torsion_molecules.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace palpa::test {

struct FlexibleCase {
    Topology topology;
    Connectivity connectivity;
    std::vector<Vec3> positions;  // Å
};

// CASE.ff.json and the first frame of CASE.frames.json.
FlexibleCase read_flexible_case(const std::filesystem::path& folder, const std::string& name,
                                const std::string& frames = "frames");

FlexibleCase alanine_dipeptide();

FlexibleCase tetrapeptide();

// With EEF1-SB's numbers of its types; charges stay as they are.
FlexibleCase solvated(FlexibleCase c);

// The molecule and a copy, turned and `away` from it.
FlexibleCase with_copy(FlexibleCase c, const Vec3& away);

inline const JointRules all_joints{
    .methyl = true, .amide = true, .amide_nh2 = true, .guanidinium_nh2 = true, .overrides = {}};

TorsionBodies bodies_of(const FlexibleCase& c, const JointRules& rules = {});

// Bases in the order of the molecules; each turns about its molecule's first atom if not free.
TorsionModel model_of(const FlexibleCase& c, const std::vector<BaseFreedom>& freedoms,
                      const JointRules& rules = {});

// Made-up bodies on which no force field acts.
TorsionModel forceless_model(const TorsionCase& c, BaseFreedom freedom, std::uint32_t pivot = 0);

Coordinates random_move(const TorsionModel& model, double size, std::mt19937& random);

// Where it is after a random move from the reference.
TorsionState state_after(const TorsionModel& model, double size, std::uint32_t seed);

// Two tetrapeptides near each other, after a random move.
struct PeptidePair {
    TorsionModel model;
    TorsionState state;
};

PeptidePair peptide_pair(const std::array<BaseFreedom, 2>& bases);

// How atoms go with each coordinate, as the positions themselves tell: a column of x, y and z of
// each atom per coordinate. Differences of fourth order, an error of 1e-11 of the arm or so.
Eigen::MatrixXd find_jacobian(const TorsionModel& model, const TorsionState& state);

// Forces on atoms, one below the other as the rows of the jacobian.
Eigen::VectorXd stacked(const std::vector<Vec3>& vectors);

// J^T m J qdd = J^T f
Coordinates find_accelerations(const TorsionModel& model, const TorsionState& state);

}  // namespace palpa::test
