// What a report is made of: sections with text, tables and figures, and the page that they become.
#pragma once
#include "platform/program.h"

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {

struct ReportSection {
    std::string id, title;
    std::string shows = {};    // a sentence in front
    std::string body = {};     // HTML: figures and tables
    std::string differs = {};  // from the paper
    std::string command = {};  // that repeats the numbers
    bool meets_limits = true;
    double seconds = 0;  // it took
};

// Its title, by which a report is known again.
inline constexpr std::string_view page_mark = "<title>Palpa: report</title>";

// For text that is no HTML.
std::string escaped(std::string_view text);

// A table, the first row of which is its head; cells are HTML.
std::string format_table(const std::vector<std::vector<std::string>>& rows);

// Another program, to its end, and what it wrote.
struct ProgramRun {
    ProgramEnd end;
    std::string output, errors;
};
ProgramRun read_program(const std::vector<std::string>& words);

// Throws LoadError where gnuplot cannot be started.
void check_gnuplot();

// Rows of numbers that a script knows as $NAME. What is no number is a gap.
std::string format_data(const std::string& name, const std::vector<std::vector<double>>& rows);

struct PlotSize {
    int width = 900, height = 380;
};

// What gnuplot makes of a script, as an <svg> element. Throws LoadError where there is no gnuplot,
// and std::runtime_error with its words where it does not like the script.
std::string draw_svg(const std::string& script, PlotSize size = {});

// The same with this text below.
std::string draw_figure(const std::string& script, const std::string& caption, PlotSize size = {});

// `facts`: of the run, name and value.
std::string format_page(std::span<const std::pair<std::string, std::string>> facts,
                        std::span<const ReportSection> sections);

}  // namespace palpa
