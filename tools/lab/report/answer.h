// The picture of palpa-lab bench --answer.
#pragma once
#include "tools/lab/bench/answer.h"
#include "tools/lab/report/page.h"

#include <string>
#include <string_view>

namespace palpa {

// By which a picture in a file of its own is known again.
inline constexpr std::string_view answer_picture_mark = "<!-- Palpa: error against time -->\n";

inline constexpr PlotSize answer_picture_size{960, 520};

// For draw_svg and draw_figure, with answer_picture_size: error in per cent over time, left the
// median, right nine of ten moves.
std::string plot_answers(const Answers& answers);

}  // namespace palpa
