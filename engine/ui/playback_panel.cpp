#include "ui/playback_panel.h"

#include "core/translate.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <string>

namespace palpa {
namespace {

constexpr float slowest = 0.5F, fastest = 500;  // frames a second

std::string describe_frame(const PlaybackState& state) {
    std::string text = format_translated("%d of {}", state.frames);
    if (state.time_ps) text += fmt::format(" ({:.6g} ps)", *state.time_ps);
    return text;
}

}  // namespace

PlaybackOrder play_or_pause(const PlaybackState& state) {
    return {.paused = !state.is_paused, .frames_per_s = {}, .frame = {}};
}

PlaybackOrder play_from_start() { return {.paused = {}, .frames_per_s = {}, .frame = 0}; }

void draw_playback_panel(const PlaybackState& state, const ScreenArea& area,
                         std::vector<Command>& commands) {
    const float bottom = ImGui::GetIO().DisplaySize.y - panel_edge();
    const float width =
        std::min(std::max(area.width() - 2 * panel_edge(), scaled(260)), scaled(620));
    ImGui::SetNextWindowPos({0.5F * (area.left + area.right), bottom}, ImGuiCond_Always, {0.5F, 1});
    ImGui::SetNextWindowSize({width, 0});
    ImGui::Begin(labelled(playback_panel).c_str(), nullptr, fixed_panel);
    if (ImGui::Button(
            labelled(state.is_paused ? for_translation("Play (T)") : for_translation("Stop (T)"))
                .c_str()))
        commands.emplace_back(play_or_pause(state));
    tip(
        translated("T. Stops at this frame: the hand feels the forces in it, and moves the "
                   "molecule in hand from there."));
    ImGui::SameLine();
    if (ImGui::Button(labelled("From the beginning (Shift+T)").c_str()))
        commands.emplace_back(play_from_start());

    int frame = static_cast<int>(state.frame) + 1;
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderInt("##frame", &frame, 1, static_cast<int>(state.frames),
                         describe_frame(state).c_str(), ImGuiSliderFlags_AlwaysClamp)) {
        commands.emplace_back(PlaybackOrder{
            .paused = true, .frames_per_s = {}, .frame = static_cast<std::size_t>(frame - 1)});
    }
    tip(translated("The frame that is shown. Moving the slider stops the trajectory there."));
    auto speed = static_cast<float>(state.frames_per_s);
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##speed", &speed, slowest, fastest, translated("%.1f frames a second"),
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp)) {
        commands.emplace_back(PlaybackOrder{.paused = {}, .frames_per_s = speed, .frame = {}});
    }
    tip(translated("Speed of the trajectory."));
    if (!state.problem.empty()) ImGui::TextWrapped("%s", state.problem.c_str());
    ImGui::End();
}

}  // namespace palpa
