#include "tools/lab/report/criteria.h"

#include "core/units.h"
#include "haptics/gains.h"
#include "simulation/probe.h"
#include "tools/lab/experiments/scenarios.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>

namespace palpa {

void add_dimer_limits(const World& world, double rest, std::vector<CriterionRow>& rows) {
    constexpr double nN = units::newton_per_kcal_per_mol_angstrom * 1e9;
    double deepest = 0, most = 0;
    for (int i = 0; i <= 4000; ++i) {
        const LineForce at = force_along_line_at(world, rest - 0.2 + 2.5e-4 * i);
        deepest = std::min(deepest, at.energy);
        most = std::min(most, at.force * nN);
    }
    const double k = force_along_line_at(world, rest).stiffness *
                     units::newton_per_metre_per_kcal_per_mol_angstrom2;
    const auto near = [&](const char* name, const char* unit, double value, double limit,
                          double give) {
        rows.push_back({name, fmt::format("{} ± {} {}", limit, give, unit),
                        fmt::format("{:.4g} {}", value, unit), std::abs(value - limit) <= give});
    };
    near("Two waters: deepest energy", "kcal/mol", deepest, -6.594, 0.005);
    near("Two waters: distance of rest", "Å", rest, 2.767, 0.002);
    near("Two waters: stiffness there", "N/m", k, 29.3, 0.2);
    near("Two waters: strongest attraction", "nN", -most, 0.322, 0.002);
}

void add_law_limits(std::vector<CriterionRow>& rows) {
    const PrintedForceLaw law({});
    const PrintedDisplacementLaw gain({});
    const auto digits = [&](const char* name, double value, double limit) {
        rows.push_back({name, fmt::format("{:.7g}", limit), fmt::format("{:.7g}", value),
                        std::abs(value / limit - 1) < 1e-6});
    };
    digits("Eq. 2: slope at 0", law.slope(0), 5.508036e9);
    digits("Eq. 2: slope at F_0", law.slope(1.5e-9), 4.528171e8);
    digits("Eq. 3: A_d without force, exactly A_dmin", gain.value(0), 5e6);
    double most = 0;
    for (int i = 1; i <= 100; ++i) {
        const double F = 1e-10 * i, h = 1e-5 * F;
        most = std::max(
            most, std::abs((law.value(F + h) - law.value(F - h)) / (2 * h) / law.slope(F) - 1));
    }
    rows.push_back(
        {"Eq. 2: slope against differences", "1e-6", fmt::format("{:.1g}", most), most < 1e-6});
}

std::optional<ClosedPathOptions> find_closed_paths(const ReportOptions& options) {
    const std::filesystem::path space =
        (std::filesystem::is_directory(options.scene) ? options.scene
                                                      : options.scene.parent_path()) /
        "space.toml";
    if (!std::filesystem::exists(space)) return std::nullopt;
    return ClosedPathOptions{.scene = space,
                             .settings = options.settings,
                             .count = static_cast<std::size_t>(options.quick ? 20 : 300),
                             .seed = options.seed};
}

void add_random_limits(const ReportOptions& options, std::vector<CriterionRow>& rows) {
    ScenarioOptions scenarios{.scene = options.scene,
                              .settings = options.settings,
                              .count = static_cast<std::size_t>(options.quick ? 20 : 500),
                              .seed = options.seed};
    double generated = -1e9, ripple = 0;
    const auto played = play_scenarios(scenarios, {});
    for (const ScenarioResult& r : played) {
        generated = std::max(generated, r.generated_J);
        ripple = std::max(ripple, r.ripple_N);
    }
    rows.push_back({fmt::format("{} random hands, devices, periods, speeds", played.size()),
                    "≤ 1 mJ generated, ripple &lt; 0.02 N, none through",
                    fmt::format("{:+.2f} mJ, {:.4f} N", generated * 1e3, ripple),
                    std::ranges::all_of(played, &ScenarioResult::is_calm)});
    const std::optional<ClosedPathOptions> paths = find_closed_paths(options);
    if (!paths) return;
    double extra = -1e9, drift = 0;
    const auto closed = play_closed_paths(*paths, {});
    for (const ClosedPathResult& r : closed) {
        extra = std::max(extra, r.was_limited ? r.extra_joule() : std::abs(r.extra_joule()));
        if (!r.was_limited && r.farthest_angstrom <= near_angstrom)
            drift = std::max(drift, r.drift_angstrom);
    }
    const auto missed = std::ranges::count_if(
        closed, [](const ClosedPathResult& r) { return !meets_limits(r, false); });
    rows.push_back(
        {fmt::format("{} closed paths in space", closed.size()),
         "1 mJ and, near, 0.1 Å from the continuous law",
         fmt::format("{:.2f} mJ, {:.3f} Å at most; {} missed", extra * 1e3, drift, missed),
         missed == 0});
}

}  // namespace palpa
