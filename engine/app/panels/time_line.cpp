// The panel "Time line": a recorded session, or a trajectory, while it is played.
#include "app/panels.h"
#include "app/window_world.h"
#include "core/translate.h"
#include "ui/icons.h"

#include <fmt/format.h>
#include <imgui.h>
#include <string>

namespace palpa {
namespace {

// A slider over the panel's width; true if it was moved.
bool slide(const char* id, float& value, float low, float high, const char* format,
           bool is_logarithmic, const char* explanation) {
    ImGui::SetNextItemWidth(-1);
    const bool is_moved = ImGui::SliderFloat(
        id, &value, low, high, format,
        ImGuiSliderFlags_AlwaysClamp | (is_logarithmic ? ImGuiSliderFlags_Logarithmic : 0));
    tip(explanation);
    return is_moved;
}

void draw_trajectory(World& app, const PlaybackState& state) {
    if (ImGui::Button(
            labelled(state.is_paused ? for_translation("Play (T)") : for_translation("Stop (T)"))
                .c_str()))
        request(app, action_called("play-trajectory"));
    tip(
        translated("T. Stops at this frame: the hand feels the forces in it, and moves the "
                   "molecule in hand from there."));
    ImGui::SameLine();
    if (ImGui::Button(labelled("From the beginning (Shift+T)").c_str()))
        request(app, action_called("trajectory-start"));
    std::string text = format_translated("%d of {}", state.frames);
    if (state.time_ps) text += fmt::format(" ({:.6g} ps)", *state.time_ps);
    int frame = static_cast<int>(state.frame) + 1;
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderInt("##frame", &frame, 1, static_cast<int>(state.frames), text.c_str(),
                         ImGuiSliderFlags_AlwaysClamp))
        send(app,
             PlaybackOrder{
                 .paused = true, .frames_per_s = {}, .frame = static_cast<std::size_t>(frame - 1)});
    tip(translated("The frame that is shown. Moving the slider stops the trajectory there."));
    auto speed = static_cast<float>(state.frames_per_s);
    if (slide("##speed", speed, 0.5F, 500, translated("%.1f frames a second"), true,
              translated("Speed of the trajectory.")))
        send(app, PlaybackOrder{.paused = {}, .frames_per_s = speed, .frame = {}});
    if (!state.problem.empty()) ImGui::TextWrapped("%s", state.problem.c_str());
}

void draw_replay(World& app, const ReplayState& state) {
    if (ImGui::Button(labelled(state.is_paused ? for_translation("Play (P)")
                                               : for_translation("Stop here (P)"))
                          .c_str()))
        request(app, action_called("pause"));
    ImGui::SameLine();
    if (ImGui::Button(labelled("From the beginning (R)").c_str()))
        request(app, action_called("reset"));
    auto at_s = static_cast<float>(state.at_s);
    const std::string place = format_translated("%.2f of {:.2f} s", state.length_s);
    if (slide("##time", at_s, 0, static_cast<float>(state.length_s), place.c_str(), false,
              translated("Time of the session. Going back computes it again from the beginning.")))
        send(app, ReplayOrder{.paused = {}, .speed = {}, .at_s = at_s});
    auto speed = static_cast<float>(state.speed);
    if (slide("##speed", speed, 0.02F, 10, translated("%.2f times real time"), true,
              translated("How fast it is played, as far as it can be computed so fast.")))
        send(app, ReplayOrder{.paused = {}, .speed = speed, .at_s = {}});
    if (!state.verdict.empty()) ImGui::TextWrapped("%s", state.verdict.c_str());
}

void draw_time_line(World& app) {
    const Readout& readout = frame_of(app).readout;
    readout.replay ? draw_replay(app, *readout.replay) : draw_trajectory(app, *readout.playback);
}

bool is_played(const World& app) {
    const Readout& readout = frame_of(app).readout;
    return readout.replay || readout.playback;
}

}  // namespace

extern const Panel time_line_panel{
    .id = "time line",
    .title = for_translation("Time line"),
    .explains = for_translation("A recorded session or a trajectory, and where it is."),
    .icon = icon_clock,
    .side = Side::Bottom,
    .draw = draw_time_line,
    .is_there = is_played};

}  // namespace palpa
