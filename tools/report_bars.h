// Bars of a report that need no stroke of their own, and how a bar is told.
#pragma once
#include "simulation/simulation.h"
#include "tools/loops.h"
#include "tools/report.h"

#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct BarRow {
    std::string test, bar, measured;  // HTML
    bool is_met = false;
};

// What two waters do to each other; `rest` in Å.
void add_dimer_bars(const Simulation& simulation, double rest, std::vector<BarRow>& rows);

// Equations 2 and 3.
void add_law_bars(std::vector<BarRow>& rows);

// The closed ways in space of a report; nothing where no space.toml lies beside its scene.
std::optional<LoopOptions> find_loops(const ReportOptions& options);

// Random hands and devices on the scene's line, and, where it lies beside it, in space.toml.
void add_random_bars(const ReportOptions& options, std::vector<BarRow>& rows);

}  // namespace palpa
