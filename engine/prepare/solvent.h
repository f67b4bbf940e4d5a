// Applies EEF1-SB's implicit water to a prepared system, if possible.
#pragma once
#include "charmm/force_field.h"
#include "charmm/generate.h"
#include "charmm/topology.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"
#include "prepare/report.h"
#include "prepare/settings.h"

#include <optional>

namespace palpa {

// A system with neutral ionic groups, and its force field.
struct SolvatedSystem {
    ForceField force_field;
    Connectivity connectivity;
    Topology topology;  // including solvation
};

// The same atoms with EEF1-SB's charges; nothing in vacuum, as the settings say, or, where they
// leave it open, as EEF1-SB does not cover a type, a charge group or waters of the system.
// `structure` has every atom. What is decided is added to the report: groups, types that we
// assigned, the backbone's term. Throws LoadError where EEF1-SB was asked for and cannot be: with
// the types that have no numbers, with charge groups that are not neutral, and where waters are
// not all structural.
std::optional<SolvatedSystem> solvate(const ForceField& force_field, const Structure& structure,
                                      const GenerateSettings& generate,
                                      const PrepareSettings& settings, Report& report);

}  // namespace palpa
