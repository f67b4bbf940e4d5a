// palpa report: what the page is made of.
#include "tools/report/report.h"

#include "tools/commands/command.h"

namespace palpa {

void add_report(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& report = *program.add_subcommand(
        "report", "The paper's figures, the acceptance limits and more, computed anew: one page");
    ReportOptions& options = own_options<ReportOptions>(report, chosen, report_command);
    describe(report, "Experiments", {"palpa report -o report.html"});
    report.add_option("-o,--output", options.output, "page to write, report.html unless given");
    add_overwrite_flag(report, options.overwrites);
    report.add_option("--scene", options.scene, "of one axis, scenes/water unless given");
    report
        .add_option(
            "--hiv", options.flexible,
            "flexible scene, scenes/hiv/flexible.toml unless given; left out where that is not "
            "there")
        ->check(CLI::ExistingPath);
    report.add_flag("--quick", options.quick, "fewer and shorter runs: half a minute");
    add_seed_option(report, options.seed);
    add_set_option(report, options.settings);
}

}  // namespace palpa
