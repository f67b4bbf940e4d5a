// The sections of a report; each computes what it shows.
#pragma once
#include "tools/lab/report/page.h"
#include "tools/lab/report/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string>
#include <vector>

namespace palpa {

// On standard error: how far the report is.
void report_progress(const std::string& what);

// The settings that a command line repeats, those of the options last.
inline std::vector<std::string> settings_of(const ReportOptions& options,
                                            std::vector<std::string> settings) {
    settings.insert(settings.end(), options.settings.begin(), options.settings.end());
    return settings;
}

inline std::string run_command_of(const ReportOptions& options,
                                  const std::vector<std::string>& settings) {
    return fmt::format("palpa run {} --headless --set \"{}\"", options.scene.string(),
                       fmt::join(settings_of(options, settings), "\" --set \""));
}

// report_figures.cpp
ReportSection report_figure_1(const ReportOptions& options);
ReportSection report_figure_4(const ReportOptions& options);
ReportSection report_figure_5(const ReportOptions& options);
ReportSection report_figure_6(const ReportOptions& options);
// report_acceptance.cpp
ReportSection report_acceptance(const ReportOptions& options);
// report_stability.cpp
ReportSection report_stability(const ReportOptions& options);
// report_energy.cpp
ReportSection report_energy(const ReportOptions& options);
// report_hard.cpp
ReportSection report_hard(const ReportOptions& options);
// report_study.cpp
ReportSection report_figures_7_and_8(const ReportOptions& options);
// report_flexible.cpp
ReportSection report_figure_9(const ReportOptions& options);
ReportSection report_speed(const ReportOptions& options);
// report_answer.cpp
ReportSection report_answers(const ReportOptions& options);
// report_kernel.cpp
ReportSection report_kernels(const ReportOptions& options);

}  // namespace palpa
