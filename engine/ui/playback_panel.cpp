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

// In the middle of the area, at the bottom.
void begin_panel(const char* title, const ScreenArea& area) {
    const float bottom = ImGui::GetIO().DisplaySize.y - panel_edge();
    const float width =
        std::min(std::max(area.width() - 2 * panel_edge(), scaled(260)), scaled(620));
    ImGui::SetNextWindowPos({0.5F * (area.left + area.right), bottom}, ImGuiCond_Always, {0.5F, 1});
    ImGui::SetNextWindowSize({width, 0});
    ImGui::Begin(labelled(title).c_str(), nullptr, fixed_panel);
}

}  // namespace

PlaybackOrder play_or_pause(const PlaybackState& state) {
    return {.paused = !state.is_paused, .frames_per_s = {}, .frame = {}};
}

PlaybackOrder play_from_start() { return {.paused = {}, .frames_per_s = {}, .frame = 0}; }

void draw_playback_panel(const PlaybackState& state, const ScreenArea& area,
                         std::vector<Command>& commands) {
    begin_panel(playback_panel, area);
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

void draw_replay_panel(const ReplayState& state, const ScreenArea& area,
                       std::vector<Command>& commands, std::vector<Action>& actions) {
    begin_panel(replay_panel, area);
    if (ImGui::Button(labelled(state.is_paused ? for_translation("Play (P)")
                                               : for_translation("Stop here (P)"))
                          .c_str()))
        actions.push_back(Action::PauseOrGo);
    ImGui::SameLine();
    if (ImGui::Button(labelled("From the beginning (R)").c_str())) actions.push_back(Action::Reset);
    auto at_s = static_cast<float>(state.at_s);
    ImGui::SetNextItemWidth(-1);
    const std::string place = format_translated("%.2f of {:.2f} s", state.length_s);
    if (ImGui::SliderFloat("##time", &at_s, 0, static_cast<float>(state.length_s), place.c_str(),
                           ImGuiSliderFlags_AlwaysClamp))
        commands.emplace_back(ReplayOrder{.paused = {}, .speed = {}, .at_s = at_s});
    tip(translated("Time of the session. Going back computes it again from the beginning."));
    auto speed = static_cast<float>(state.speed);
    ImGui::SetNextItemWidth(-1);
    constexpr float slow = 0.02F, fast = 10;
    if (ImGui::SliderFloat("##speed", &speed, slow, fast, translated("%.2f times real time"),
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
        commands.emplace_back(ReplayOrder{.paused = {}, .speed = speed, .at_s = {}});
    tip(translated("How fast it is played, as far as it can be computed so fast."));
    if (!state.verdict.empty()) ImGui::TextWrapped("%s", state.verdict.c_str());
    ImGui::End();
}

}  // namespace palpa
