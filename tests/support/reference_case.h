// The reference cases, energies and forces of other programs (tests/data/README.md), in engine
// units.
#pragma once
#include "charmm/topology.h"
#include "core/units.h"
#include "math/vec.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace palpa::test {

inline constexpr double kcal_per_kilojoule = 1000 / units::joule_per_kcal;
inline constexpr double angstrom_per_nm = 10;

// kcal Å/mol/e^2; CHARMM's own is 2.4e-5 larger.
inline constexpr double reference_coulomb_constant =
    138.935457644382 * kcal_per_kilojoule * angstrom_per_nm;

// As the file's program calls it.
struct ReferenceAtom {
    std::string name, residue, type;
    int number;  // of the residue
    double mass, charge;
    std::string segment;  // empty where the file has none
};

struct ReferenceCase {
    Topology topology;
    std::vector<ReferenceAtom> atoms;
};

struct ReferenceFrame {
    std::string name;
    std::map<std::string, double> energy;  // kcal/mol, by the file's names of the terms
    std::vector<Vec3> positions;           // Å
    std::vector<Vec3> forces;              // kcal/mol/Å
    std::map<std::string, std::vector<Vec3>> forces_by_term;  // of small cases only
};

// CASE.ff.json: nm, kJ/mol, degree, and a factor one half in every harmonic term.
ReferenceCase read_reference_case(const std::filesystem::path& path);

// CASE.frames.json or CASE.FRAME.json: nm, kJ/mol.
std::vector<ReferenceFrame> read_reference_frames(const std::filesystem::path& path);

}  // namespace palpa::test
