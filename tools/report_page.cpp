#include "tools/report_page.h"

#include "core/files.h"
#include "core/load_error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <system_error>

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

// A folder that goes when it is no longer needed.
class WorkFolder {
public:
    WorkFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "palpa-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) {
            throw LoadError({name}, std::string("cannot be made: ") + std::strerror(errno));
        }
        path_ = name;
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    ~WorkFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    std::filesystem::path operator/(const char* name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

// What gnuplot prints for a script.
std::string run_gnuplot(const std::string& script) {
    const WorkFolder folder;
    const std::string input = folder / "script";
    write_text_file(input, script);
    const ProgramRun run = run_program({"gnuplot", input});
    if (run.problem != 0) {
        throw LoadError({"gnuplot"}, fmt::format("cannot be started ({}), and draws all figures; "
                                                 "expected it to be installed: package gnuplot-nox",
                                                 std::strerror(run.problem)));
    }
    if (run.status != 0) throw std::runtime_error("gnuplot: " + run.errors);
    return run.output;
}

}  // namespace

ProgramRun run_program(std::vector<std::string> words) {
    const WorkFolder folder;
    const std::string output = folder / "output", errors = folder / "errors";
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    constexpr int write_new = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), write_new, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors.c_str(), write_new, 0600);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t child = 0;
    ProgramRun run;
    run.problem = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (run.problem != 0) return run;
    while (waitpid(child, &run.status, 0) < 0 && errno == EINTR) continue;
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

std::string draw_figure(const std::string& script, const std::string& caption, PlotSize size) {
    const std::string svg = run_gnuplot(
        fmt::format("set terminal svg size {},{} font 'sans-serif,12'\nset grid lc rgb '#dddddd'\n",
                    size.width, size.height) +
        script);
    const std::size_t begin = svg.find("<svg");
    if (begin == std::string::npos) throw std::runtime_error("gnuplot drew nothing");
    return "<figure>\n" + svg.substr(begin) + "<figcaption>" + escaped(caption) +
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
