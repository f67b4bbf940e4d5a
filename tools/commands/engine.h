// palpa engine: the input of a run of GROMACS or LAMMPS, or a box of water.
#pragma once
#include "inputs/run_system.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct EngineOptions {
    std::string what;             // "gromacs", "lammps", "box"
    std::filesystem::path scene;  // or the three below
    std::vector<std::string> settings;
    std::optional<std::filesystem::path> psf, coordinates;
    std::vector<std::filesystem::path> toppar;
    std::string box;                // "A,B,C", Å; empty: vacuum
    std::vector<std::string> send;  // segments; none: all atoms
    EngineRunOptions run;
    std::size_t waters = 216;  // of a box, before some are left out
    std::filesystem::path folder;
    bool overwrites = false;  // earlier files of this command
};

// Throws LoadError on bad input. Returns the exit code.
int engine_command(const EngineOptions& options);

}  // namespace palpa
