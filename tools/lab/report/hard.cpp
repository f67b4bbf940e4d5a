// Starts, blows and hands that no coupling likes: what guarded coupling makes of them.
#include "tools/lab/experiments/axis_run.h"
#include "tools/lab/report/sections.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace palpa {
namespace {

struct HardCase {
    const char* what;
    std::vector<std::string> settings;
};

std::vector<HardCase> list_cases() {
    const std::string in_contact = "hand.start_angstrom=2.767";
    return {
        {"begins at 1 Å, atoms on each other", {"stroke=hold", "hand.start_angstrom=1"}},
        {"begins at 2.2 Å, in 28 nN of repulsion", {"stroke=hold", "hand.start_angstrom=2.2"}},
        {"knocked by 0.1 N s in contact", {"stroke=hold", in_contact, "kick_N_s=0.1"}},
        {"30 Å at the largest gain, 14 cm in 0.15 s, and back",
         {"stroke=path", "hand.start_angstrom=30",
          "path=[[0.3, 70], [0.45, -70], [0.6, -70], [0.75, 70]]"}},
        {"hand lets go in the middle of a push", {"stroke=in-out", "release_s=3"}},
        {"nobody holds the handle, impulse of 5 mN s",
         {"stroke=hold", in_contact, "grip=none", "kick_N_s=0.005"}},
        {"force gains a hundredfold", {"stroke=in-out", "A_f_max=510e9", "A_f_min=64e9"}},
        {"T_s = 500 ms", {"stroke=in-out", "period_ms=500"}},
        {"a device of 10 g without viscosity",
         {"stroke=in-out", "inertia_kg=0.01", "device.viscosity_N_s_per_m=0"}},
        {"7 ms between force and hand", {"stroke=in-out", "servo_delay_ticks=7"}},
    };
}

double largest_sent(const AxisRun& played) {
    double most = 0;
    for (const Reading& reading : played.readings) most = std::max(most, std::abs(reading.hand_N));
    return most;
}

}  // namespace

ReportSection report_hard(const ReportOptions& options) {
    ReportSection section{"hard", "Hard cases"};
    section.shows =
        "Difficult cases for any coupling: two waters, guarded coupling, medium hand, 14 ms and no "
        "friction unless stated. Required: every number is finite, no force exceeds the limit of 3 "
        "N, and the hand is at rest in the end (ripple below 0.02 N).";
    std::vector<std::vector<std::string>> table{{"case", "largest force (N)", "closest (Å)",
                                                 "in the end (Å)", "energy (mJ)",
                                                 "ripple at the end (N)", ""}};
    for (const auto& [what, settings] : list_cases()) {
        std::vector<std::string> all{"mode=guarded", "period_ms=14", "friction_N=0", "seconds=20"};
        all.insert(all.end(), settings.begin(), settings.end());
        const AxisRun p = play_axis({options.scene, settings_of(options, all)});
        const double force = largest_sent(p);
        const bool is_met = std::isfinite(p.energy_J) && std::isfinite(p.last_angstrom) &&
                            force <= 3 + 1e-9 && p.ripple_N < 0.02 &&
                            p.stage < SafetyStage::NotFinite;
        section.meets_limits = section.meets_limits && is_met;
        table.push_back(
            {what, fmt::format("{:.2f}", force), fmt::format("{:.2f}", p.closest_angstrom),
             fmt::format("{:.2f}", p.last_angstrom), fmt::format("{:+.2f}", p.energy_J * 1e3),
             fmt::format("{:.4f}", p.ripple_N),
             is_met ? "met" : "<span class=\"missed\">missed</span>"});
        if (section.command.empty()) section.command = run_command_of(options, all);
    }
    section.body = format_table(table);
    section.differs =
        "The paper has no such cases. Potential energy of the start can be given to the hand. The "
        "tests labelled [hard] have many more cases for every module.";
    return section;
}

}  // namespace palpa
