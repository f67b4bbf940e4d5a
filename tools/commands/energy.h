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
    std::string method = "all-pairs";                          // or "cutoff"
    NonbondedSettings nonbonded;                               // but for what the cutoff is like:
    std::optional<double> cutoff, switch_from;                 // Å; 12 and 10 unless given
    std::optional<std::string> electrostatics, van_der_waals;  // "fshift" and "switch" unless given
    std::optional<std::filesystem::path> forces;               // CSV to write
    bool overwrites = false;                                   // an earlier file of this command
    bool json = false;
};

// Throws LoadError on bad input. Returns the exit code.
int energy_command(const EnergyOptions& options);

}  // namespace palpa
