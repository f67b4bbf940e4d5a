// How wrong the force at the hand is after a given time, of each way to move a flexible scene.
#include "tools/lab/report/answer.h"

#include "scene/read_scene.h"
#include "tools/lab/report/sections.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {
namespace {

// Colours that stay apart for those who see red and green alike (Okabe and Ito, 2008); what is
// related has one colour and other points. Names that begin like another stand before it.
struct AnswerStyle {
    std::string_view method;  // how its name begins
    std::string_view title;
    std::string_view look;
};
constexpr std::array<AnswerStyle, 8> answer_styles{{
    {"default", "as the scene has it", "pt 2 ps 1.3 lw 1.5 lc rgb '#000000'"},
    {"near=6/cutoff", "exact within 6 Å", "pt 6 ps 0.9 lw 2 lc rgb '#0072b2'"},
    {"near=6", "exact within 6 Å", "pt 7 ps 0.7 lw 2 lc rgb '#0072b2'"},
    {"full-second-order", "full second order", "pt 5 ps 0.7 lw 2 lc rgb '#000000'"},
    {"paper-40", "paper’s step, 40 active", "pt 9 ps 0.7 lw 2 lc rgb '#e69f00'"},
    {"paper-all/cutoff", "paper’s step, all", "pt 6 ps 0.9 lw 2 lc rgb '#d55e00'"},
    {"paper-all", "paper’s step, all", "pt 7 ps 0.7 lw 2 lc rgb '#d55e00'"},
    {"", "", "pt 1 lw 1 lc rgb '#555555'"},
}};

const AnswerStyle& style_of(const AnswerCurve& curve) {
    return *std::ranges::find_if(answer_styles, [&](const AnswerStyle& style) {
        return curve.method.starts_with(style.method);
    });
}

// As "exact within 6 Å, cutoff 12 Å, against rest with it".
std::string title_of(const AnswerCurve& curve) {
    std::string title(style_of(curve).title);
    const std::size_t at = curve.method.find("cutoff=");
    if (at != std::string::npos) {
        const std::size_t begin = at + std::string_view("cutoff=").size();
        title += fmt::format(", cutoff {} Å",
                             curve.method.substr(begin, curve.method.find('/', begin) - begin));
    }
    return title + (curve.is_own() ? ", against rest with it" : "");
}

std::string look_of(const AnswerCurve& curve) {
    // Its line is one of the others in most scenes.
    const bool is_default = curve.method == "default";
    return fmt::format("with {} {}{}", is_default ? "points" : "linespoints", style_of(curve).look,
                       curve.is_own() ? " dt 2" : "");
}

// Column 2 of the data has the median, 3 nine of ten.
std::string plot_panel(const Answers& answers, int column) {
    std::vector<std::string> plots;
    for (std::size_t i = 0; i < answers.curves.size(); ++i) {
        if (answers.curves[i].in_time.empty()) continue;
        plots.push_back(
            fmt::format("$curve{} using 1:{} {} notitle", i, column, look_of(answers.curves[i])));
    }
    return fmt::format("plot {}\n", fmt::join(plots, ", "));
}

// Three columns below the panels: gnuplot's own legend has one where titles are long.
std::string plot_legend(const Answers& answers) {
    constexpr std::size_t lines = 5;
    constexpr std::array columns{0.02, 0.23, 0.62};
    std::string script;
    for (std::size_t c = 0; c < columns.size(); ++c) {
        std::vector<std::string> plots;
        const std::size_t end = c + 1 == columns.size() ? answers.curves.size() : (c + 1) * lines;
        for (std::size_t i = c * lines; i < std::min(end, answers.curves.size()); ++i) {
            const AnswerCurve& curve = answers.curves[i];
            if (!curve.in_time.empty())
                plots.push_back(fmt::format("NaN {} title '{}'", look_of(curve), title_of(curve)));
        }
        if (plots.empty()) continue;
        script += fmt::format(
            "set key at screen {}, 0.205 left top Left reverse samplen 3 spacing 1.2\n"
            "plot {}\n",
            columns[c], fmt::join(plots, ", "));
    }
    return script;
}

// Of both panels: from shortly before the first answer on.
std::string format_ranges(const Answers& answers) {
    double first_ms = 100, least = 1, most = 1;
    for (const AnswerCurve& curve : answers.curves) {
        for (const AnswerCurve::Point& point : curve.in_time) {
            first_ms = std::min(first_ms, point.ms);
            if (point.errors.median > 0) least = std::min(least, point.errors.median);
            most = std::max(most, point.errors.ninety);
        }
    }
    return fmt::format("set xrange [{}:120]\nset yrange [{}:{}]\n", first_ms / 1.2,
                       70 * std::max(least, 1e-5), 150 * most);
}

// Beside a scene SCENE.toml: SCENE-poses.txt.
std::optional<std::filesystem::path> find_poses_file(const std::filesystem::path& scene) {
    std::filesystem::path file =
        std::filesystem::is_directory(scene) ? scene / "scene.toml" : scene;
    file.replace_filename(file.stem().string() + "-poses.txt");
    if (!std::filesystem::exists(file)) return std::nullopt;
    return file;
}

// "1.4, 4.9" of median and nine of ten.
std::string both(double median, double ninety) {
    const auto digits = [](double value) {
        return value < 100 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
    };
    return fmt::format("{}, {}", digits(median), digits(ninety));
}

// Of one step and after 10 and 100 ms.
std::vector<std::vector<std::string>> list_answers(const Answers& answers) {
    std::vector<std::vector<std::string>> table{
        {"method", "time", "error, %: median, nine of ten", "pN", "mN at the handle"}};
    const auto add = [&](const AnswerCurve& curve, const std::string& time,
                         const AnswerErrors& errors) {
        const double millinewton = 1e3 * answers.newton_per_pN;
        table.push_back({escaped(title_of(curve)), time,
                         both(100 * errors.median, 100 * errors.ninety),
                         both(errors.median_pN, errors.ninety_pN),
                         both(millinewton * errors.median_pN, millinewton * errors.ninety_pN)});
    };
    for (const AnswerCurve& curve : answers.curves) {
        if (curve.moves == 0) continue;
        add(curve, fmt::format("{:.1f} ms, a step", 1e-3 * quantile(curve.step_us, 0.5)),
            curve.of_step);
        for (const AnswerCurve::Point& point : curve.in_time) {
            if (point.ms == 10 || point.ms == 100)
                add(curve, fmt::format("{} ms", point.ms), point.errors);
        }
    }
    return table;
}

}  // namespace

std::string plot_answers(const Answers& answers) {
    std::string script;
    for (std::size_t i = 0; i < answers.curves.size(); ++i) {
        std::vector<std::vector<double>> rows;
        for (const AnswerCurve::Point& point : answers.curves[i].in_time)
            rows.push_back({point.ms, 100 * point.errors.median, 100 * point.errors.ninety});
        script += format_data(fmt::format("curve{}", i), rows);
    }
    if (answers.curves.empty()) return script + "plot [0:1] [0:1] NaN notitle\n";
    return script + "set logscale xy\n" + format_ranges(answers) +
           R"(set xtics (0.2, 0.5, 1, 2, 5, 10, 20, 50, 100)
set ytics format '%g'
set multiplot
set xlabel 'time spent (ms)'
set ylabel 'error of the force on the hand (%)'
set tmargin at screen 0.93
set bmargin at screen 0.34
set lmargin at screen 0.09
set rmargin at screen 0.485
set title 'median'
)" + plot_panel(answers, 2) +
           R"(set lmargin at screen 0.595
set rmargin at screen 0.99
set title 'nine of ten moves'
)" + plot_panel(answers, 3) +
           R"(set tmargin at screen 0.23
set bmargin at screen 0.01
set lmargin at screen 0.01
set rmargin at screen 0.99
unset title
unset xlabel
unset ylabel
unset border
unset tics
unset grid
unset logscale
set yrange [0:1]
)" + plot_legend(answers) +
           "unset multiplot\n";
}

ReportSection report_answers(const ReportOptions& options) {
    const SceneDescription scene = read_scene(options.flexible);
    AnswerPoseSettings settings;
    settings.file = find_poses_file(options.flexible);
    if (options.quick) {
        settings.count = 1;
    } else if (!settings.file) {
        settings.count = 3;
    }
    const Answers answers = measure_answers(scene, settings);
    std::size_t snaps = 0;
    if (!answers.curves.empty()) snaps = answers.curves.front().snaps;

    ReportSection section{"answer", "Error of the force at the hand against the time spent on it"};
    section.shows = fmt::format(
        "At {} completely relaxed pose{} the hand moves by 0.1 Å along x, y and z. The error is "
        "that of the change of the force on it, against complete relaxation on all pairs and "
        "relative to the change, or to 20 pN if it is less. {} moves were snaps and are left out. "
        "Methods with a cutoff are also compared with complete relaxation with the same cutoff; "
        "the difference is the error of the cutoff. mN are forces at the handle, with the gain for "
        "weak forces, {:.3g} N/N.",
        answers.poses, answers.poses == 1 ? "" : "s", snaps, 1e12 * answers.newton_per_pN);
    section.body = draw_figure(plot_answers(answers),
                               "Left: median over poses and axes; right: 90 % of the moves. A line "
                               "begins where half of the moves have a result.",
                               answer_picture_size) +
                   format_table(list_answers(answers));
    section.differs =
        "In the paper a step takes 83 ms, and it gives no error of the force at the hand.";
    section.command =
        fmt::format("palpa-lab bench {} --answer --no-ways --table{}", options.flexible.string(),
                    settings.file ? " --poses-file " + settings.file->string() : "");
    return section;
}

}  // namespace palpa
