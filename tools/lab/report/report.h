// palpa-lab report: one page of figures and numbers, all of them computed while it is made.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace palpa {

struct ReportOptions {
    std::filesystem::path scene = "scenes/water";                 // of one axis
    std::filesystem::path flexible = "scenes/hiv/flexible.toml";  // left out where it is not there
    std::vector<std::string> settings;                            // "key=value", over the scene
    std::filesystem::path output = "report.html";
    bool overwrites = false;  // an earlier file of this command
    bool quick = false;       // fewer and shorter runs
    std::uint64_t seed = 1;
};

// Throws LoadError on bad input, or where gnuplot is missing. Returns the exit code: 1 where a bar
// is missed.
int report_command(const ReportOptions& options);

}  // namespace palpa
