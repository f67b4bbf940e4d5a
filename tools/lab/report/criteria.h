// Limits of a report that need no stroke of their own, and how a limit is printed.
#pragma once
#include "ecs/world.h"
#include "tools/lab/experiments/closed_paths.h"
#include "tools/lab/report/report.h"

#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct CriterionRow {
    std::string test, limit, measured;  // HTML
    bool is_met = false;
};

// What two waters do to each other; `rest` in Å.
void add_dimer_limits(const World& world, double rest, std::vector<CriterionRow>& rows);

// Equations 2 and 3.
void add_law_limits(std::vector<CriterionRow>& rows);

// The closed paths in space of a report; nothing where no space.toml lies beside its scene.
std::optional<ClosedPathOptions> find_closed_paths(const ReportOptions& options);

// Random hands and devices on the scene's line, and, where it lies beside it, in space.toml.
void add_random_limits(const ReportOptions& options, std::vector<CriterionRow>& rows);

}  // namespace palpa
