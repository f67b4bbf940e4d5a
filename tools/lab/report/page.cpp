#include "tools/lab/report/page.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/work_folder.h"

#include <fmt/format.h>
#include <cmath>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <string_view>

namespace palpa {
namespace {

// Readable on a screen and on paper, without anything from elsewhere.
constexpr std::string_view style = R"(
body { font: 16px/1.45 sans-serif; color: #222; max-width: 60em; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; } h2 { font-size: 1.2em; margin: 2.2em 0 .3em; border-top: 1px solid #ccc; padding-top: .8em; }
table { border-collapse: collapse; margin: .8em 0; font-size: .88em; }
th, td { border-bottom: 1px solid #ddd; padding: .2em .7em .2em 0; text-align: left; vertical-align: top; }
figure { margin: .8em 0; } figure svg { width: 100%; height: auto; } figcaption, .took { color: #555; font-size: .88em; }
code { font-size: .88em; background: #f3f3f3; overflow-wrap: anywhere; } .missed { color: #b00; font-weight: bold; }
@media print { body { max-width: none; font-size: 11px; } h2 { break-after: avoid; } figure, tr { break-inside: avoid; } }
)";

// What gnuplot prints for a script.
std::string run_gnuplot(const std::string& script) {
    const WorkFolder folder;
    const std::filesystem::path input = folder.path() / "script";
    write_text_file(input, script);
    const ProgramRun run = read_program({"gnuplot", input.string()});
    if (run.end.problem != 0) {
        throw LoadError(
            {"gnuplot"},
            fmt::format(
                "cannot be started ({}), but draws all figures; install it (Debian: gnuplot-nox)",
                std::strerror(run.end.problem)));
    }
    if (run.end.status != 0) throw std::runtime_error("gnuplot: " + run.errors);
    return run.output;
}

}  // namespace

ProgramRun read_program(const std::vector<std::string>& words) {
    const WorkFolder folder;
    const std::filesystem::path output = folder.path() / "output",
                                errors = folder.path() / "errors";
    ProgramRun run;
    run.end = run_program(words, output, errors);
    if (run.end.problem != 0) return run;
    run.output = read_text_file(output);
    run.errors = read_text_file(errors);
    return run;
}

std::string escaped(std::string_view text) {
    std::string result;
    for (const char letter : text) {
        if (letter == '&') {
            result += "&amp;";
        } else if (letter == '<') {
            result += "&lt;";
        } else if (letter == '>') {
            result += "&gt;";
        } else {
            result += letter;
        }
    }
    return result;
}

std::string format_table(const std::vector<std::vector<std::string>>& rows) {
    std::string text = "<table>\n";
    for (std::size_t i = 0; i < rows.size(); ++i) {
        text += "<tr>";
        for (const std::string& cell : rows[i])
            text += i == 0 ? "<th>" + cell + "</th>" : "<td>" + cell + "</td>";
        text += "</tr>\n";
    }
    return text + "</table>\n";
}

void check_gnuplot() { (void)run_gnuplot("\n"); }

std::string format_data(const std::string& name, const std::vector<std::vector<double>>& rows) {
    std::string text = "$" + name + " << EOD\n";
    for (const std::vector<double>& row : rows) {
        for (const double value : row)
            text += std::isfinite(value) ? fmt::format("{:.6g} ", value) : "NaN ";
        text += '\n';
    }
    return text + "EOD\n";
}

std::string draw_svg(const std::string& script, PlotSize size) {
    const std::string svg =
        run_gnuplot(fmt::format("set terminal svg size {},{} background '#ffffff' font "
                                "'sans-serif,12'\nset grid lc rgb '#dddddd'\n",
                                size.width, size.height) +
                    script);
    const std::size_t begin = svg.find("<svg");
    if (begin == std::string::npos) throw std::runtime_error("gnuplot produced no figure");
    return svg.substr(begin);
}

std::string draw_figure(const std::string& script, const std::string& caption, PlotSize size) {
    return "<figure>\n" + draw_svg(script, size) + "<figcaption>" + escaped(caption) +
           "</figcaption>\n</figure>\n";
}

std::string format_page(std::span<const std::pair<std::string, std::string>> facts,
                        std::span<const ReportSection> sections) {
    std::string text = "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\">";
    text += page_mark;
    text += "\n<style>";
    text += style;
    text += "</style></head>\n<body>\n<h1>Palpa: variable gain coupling, measured</h1>\n";
    std::vector<std::vector<std::string>> rows{{"this run", ""}};
    for (const auto& [name, value] : facts) rows.push_back({name, escaped(value)});
    text += format_table(rows);
    text +=
        "<p>Figures have the numbers of “Variable Gain Haptic Coupling for Molecular Simulation” "
        "(2011), with its axes and units. Everything was computed in this run; hands and device "
        "are emulated.</p>\n<ul>\n";
    for (const ReportSection& section : sections)
        text += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", section.id, section.title);
    text += "</ul>\n";
    for (const ReportSection& section : sections) {
        fmt::format_to(std::back_inserter(text), "<section id=\"{}\">\n<h2>{}</h2>\n<p>{}</p>\n{}",
                       section.id, section.title, section.shows, section.body);
        if (!section.differs.empty()) text += "<p>" + section.differs + "</p>\n";
        if (!section.command.empty())
            text += "<p>Again: <code>" + escaped(section.command) + "</code></p>\n";
        text += fmt::format("<p class=\"took\">{:.1f} s.</p>\n</section>\n", section.seconds);
    }
    return text + "</body>\n</html>\n";
}

}  // namespace palpa
