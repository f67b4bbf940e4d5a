// palpa energy: energies term by term, and forces.
#pragma once
#include "forces/nonbonded.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct EnergyOptions {
    std::filesystem::path system;                      // a PSF, or a structure with all its atoms
    std::optional<std::filesystem::path> coordinates;  // of a PSF
    std::vector<std::filesystem::path> toppar;
    std::string method = "all-pairs";  // or "cutoff"
    std::string solvent = "none";      // or "eef1-sb"
    // "smooth" and "exact" unless given
    std::optional<std::string> solvent_end, solvent_exp;
    std::optional<std::filesystem::path> solvent_table;        // instead of the program's
    bool structural_water = false;                             // all waters are
    double coulomb_constant = units::charmm_coulomb_constant;  // kcal Å/mol/e^2
    std::optional<double> dielectric;                          // 1, with a solvent 1.5
    bool distance_dielectric = false;                          // with a solvent always
    std::optional<double> cutoff, switch_from;                 // Å; 12 and 10 unless given
    std::optional<std::string> electrostatics, van_der_waals;  // "fshift" and "switch" unless given
    std::optional<std::filesystem::path> forces, per_atom;     // CSV to write
    bool overwrites = false;                                   // earlier files of this command
    bool json = false;
};

// Throws LoadError on bad input. Returns the exit code.
int energy_command(const EnergyOptions& options);

}  // namespace palpa
