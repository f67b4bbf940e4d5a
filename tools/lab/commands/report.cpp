// palpa-lab report: what the page is made of.
#include "tools/lab/report/report.h"

#include "tools/lab/commands/commands.h"

namespace palpa {

void add_report(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& report = *program.add_subcommand(
        "report", "Compute the paper's figures and the acceptance limits again, on one page");
    ReportOptions& options = own_options<ReportOptions>(report, chosen, report_command);
    describe(report, {"palpa-lab report -o report.html"});
    report.add_option("-o,--output", options.output, "page to write (default report.html)");
    add_overwrite_flag(report, options.overwrites);
    report.add_option("--scene", options.scene, "scene of one axis (default scenes/water)");
    report
        .add_option(
            "--hiv", options.flexible,
            "flexible scene (default scenes/hiv/flexible.toml, left out if it does not exist)")
        ->check(CLI::ExistingPath);
    report.add_flag("--quick", options.quick, "fewer and shorter runs, about half a minute");
    add_seed_option(report, options.seed);
    add_set_option(report, options.settings);
}

}  // namespace palpa
