#include "ui/overlay.h"

#include "core/translate.h"
#include "haptics/gains.h"
#include "haptics/hand.h"
#include "session/run_headless.h"
#include "simulation/coupling.h"
#include "simulation/grip_queries.h"
#include "ui/layout.h"
#include "ui/legend_panel.h"
#include "ui/playback_panel.h"
#include "ui/selection_panel.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr ImU32 task_colour = IM_COL32(20, 90, 190, 255);
constexpr ImU32 done_colour = IM_COL32(20, 130, 70, 255);
constexpr const char* lesson_panel = for_translation("Lesson");

// Keys and what they do, twice beside each other.
struct HelpTable {
    static constexpr std::size_t columns = 4;
    std::vector<std::array<std::string, columns>> rows;
    std::array<float, columns> widths{};  // pixels, unbroken

    static float gaps() { return 2 * columns * ImGui::GetStyle().CellPadding.x; }
    float width() const { return std::accumulate(widths.begin(), widths.end(), gaps()); }
    // Narrow columns stay; wide ones share what is left, and their words are broken.
    void shrink(float widest) {
        std::array<float*, columns> ascending{&widths[0], &widths[1], &widths[2], &widths[3]};
        std::ranges::sort(ascending, {}, [](const float* width) { return *width; });
        float left = widest - gaps();
        for (std::size_t i = 0; i < columns; ++i) {
            float& width = *ascending[i];
            width = std::min(width, left / static_cast<float>(columns - i));
            left -= width;
        }
    }
};

HelpTable lay_out_help() {
    HelpTable table;
    std::vector<HelpLine> lines = list_help();
    const std::size_t half = (lines.size() + 1) / 2;
    lines.resize(2 * half);
    for (std::size_t i = 0; i < half; ++i) {
        const HelpLine &left = lines[i], &right = lines[half + i];
        table.rows.push_back({left.keys, left.does, right.keys, right.does});
        for (std::size_t k = 0; k < HelpTable::columns; ++k) {
            const float width = ImGui::CalcTextSize(table.rows.back()[k].c_str()).x;
            table.widths[k] = std::max(table.widths[k], width);
        }
    }
    for (float& width : table.widths) width += scaled(6);
    return table;
}

}  // namespace

double cm_per_angstrom(double displacement_gain) { return displacement_gain * 1e-8; }

double felt_stiffness(const CouplingLaws& laws, const ContactModel& contact) {
    return largest_felt(laws.force, contact.force_newton, contact.stiffness_matrix_N_per_m) /
           displacement_gain(laws.displacement, contact.force_newton.norm());
}

Overlay::Overlay(const SceneDescription& scene)
    : scene_(scene),
      settings_{coupling_of(scene, 0), scene.period_ms},
      additions_(additions_of(scene.view)),
      has_flexible_(std::any_of(
          scene.molecules.begin(), scene.molecules.end(),
          [](const MoleculeDescription& molecule) { return molecule.shape == Shape::Flexible; })),
      lesson_(scene.lesson) {
    update_limit();
}

void Overlay::update_limit() {
    stiffness_limit_ = is_guarded()
                           ? device_cap_N_per_m_
                           : calm_stiffness(scene_, 0, hand_model(scene_.hands.front().grip),
                                            settings_.period_ms * 1e-3);
}

void Overlay::add_tick(const ServoTick& tick) {
    const Reading reading = read_tick(tick);
    if (has_tick_ && reading.time_s == last_.time_s) return;  // paused: no time passed
    has_tick_ = true;
    last_ = reading;
    if (tick.contact.active_freedom == 1) {
        const double side = tick.contact.molecule.place_angstrom.x();
        if (side_ == 0) side_ = side;
        went_through_ = side * side_ < 0;
    } else {
        side_ = 0;
        went_through_ = false;
    }
    clamped_ = tick.clamped;
    stopped_ = tick.stopped;
    stage_ = tick.stage;
    reason_ = tick.reason;
    felt_N_per_m_ = tick.felt_N_per_m;
    cap_ratio_ = tick.cap_ratio;
    hand_energy_J_ = tick.hand_energy_J;
    overtravel_m_ = tick.overtravel_m.norm();
    is_at_stop_ = tick.is_at_stop && !tick.clutched;
    if (std::exchange(device_cap_N_per_m_, tick.cap_N_per_m) != tick.cap_N_per_m) update_limit();
    force_gain_ = tick.force_gain;
    history_.add(last_);
    // Nothing that an empty hand could do, or that was before the beginning.
    if (tick.contact.is_still || awaited_reset_) return;
    lesson_.update(last_, settings_.coupling.mode, measured_);
    if (!lesson_.steps().empty()) lesson_curve_.add(last_);
}

void Overlay::change_settings(const LiveSettings& settings, std::vector<Command>& commands) {
    settings_ = settings;
    update_limit();
    commands.emplace_back(settings_);
}

void Overlay::set_mode(CouplingMode mode, std::vector<Command>& commands) {
    if (settings_.coupling.mode == mode || is_replay_) return;
    LiveSettings settings = settings_;
    settings.coupling.mode = mode;
    change_settings(settings, commands);
}

bool Overlay::perform(Action action, std::vector<Command>& commands) {
    switch (action) {
        case Action::PauseOrGo:
            wants_pause_ = !wants_pause_;
            commands.emplace_back(Pause{wants_pause_});
            return true;
        case Action::StepOnce:
            wants_pause_ = true;
            commands.emplace_back(StepOnce{});
            return true;
        case Action::Reset:
            commands.emplace_back(Reset{});
            return true;
        case Action::Mode1:
        case Action::Mode2:
        case Action::Mode3:
        case Action::Mode4:
        case Action::Mode5:
        case Action::Guarded: {
            const int mode = static_cast<int>(action) - static_cast<int>(Action::Mode1);
            set_mode(static_cast<CouplingMode>(mode), commands);
            return true;
        }
        case Action::ToggleOverlay:
            shows_overlays_ = !shows_overlays_;
            return true;
        case Action::ToggleLesson:
            shows_lesson_ = !shows_lesson_;
            return true;
        case Action::ToggleHelp:
            shows_help_ = !shows_help_;
            return true;
        case Action::NextLessonStep:
            if (shows_lesson_) lesson_.go_on();
            return true;
        default:
            return false;
    }
}

bool Overlay::set_additions(ViewAdditions additions) {
    if (additions_ == additions) return false;
    additions_ = std::move(additions);
    return true;
}

void Overlay::follow_undo(const UndoReadout& undo, std::vector<Command>& commands) {
    if (is_replay_ || std::exchange(restored_, undo.restored) == undo.restored) return;
    additions_ = undo.additions;
    const bool is_other_period = settings_.period_ms != undo.settings.period_ms;
    settings_ = undo.settings;
    update_limit();
    if (is_other_period) commands.emplace_back(settings_);  // devices hear of it as well
}

bool Overlay::is_shaking(const Readout& readout) const {
    if (is_guarded()) return false;
    const CouplingLaws laws = build_coupling_laws(settings_.coupling);
    return felt_stiffness(laws, readout.contact) > stiffness_limit_;
}

ScreenArea Overlay::free_area(float width, float height) const {
    ScreenArea area{0, 0, width, height};
    if (shows_overlays_) {
        area.left = left_covered_;
        area.right = width - right_covered_;
    }
    // The notes above and the lesson below change their size; the picture does not follow that, but
    // leaves room for what is usual.
    area.top = scaled(area.width() < scaled(620) ? 68 : 48);
    if (selects_ || (shows_lesson_ && !lesson_.steps().empty())) {
        area.bottom = height - scaled(area.width() < scaled(480) ? 215 : 185);
    }
    // In a window so small that nothing is left, the picture has all of it.
    if (area.width() < 0.2F * width) area.left = 0, area.right = width;
    if (area.height() < 0.3F * height) area.top = 0, area.bottom = height;
    return area;
}

void Overlay::draw(const Readout& readout, const OverlayStatus& status,
                   std::vector<Command>& commands, std::vector<Action>& actions) {
    follow_restart(readout);
    measured_ = readout.lesson.values;
    selects_ = status.selects;
    is_replay_ = readout.replay.has_value();
    if (is_replay_ && settings_ != readout.replay->settings) {
        settings_ = readout.replay->settings;
        update_limit();
    }
    follow_undo(readout.undo, commands);
    if (shows_overlays_) {
        draw_scene(readout, status, commands, actions);
        draw_right_panel(commands);
        if (!status.hover.empty()) ImGui::SetTooltip("%s", status.hover.c_str());
    }
    if (status.selects) {
        // The window has its panel there.
    } else if (readout.replay) {  // in the lesson's place, as the next
        const ImVec2 screen = ImGui::GetIO().DisplaySize;
        draw_replay_panel(*readout.replay, free_area(screen.x, screen.y), commands, actions);
    } else if (readout.playback) {
        const ImVec2 screen = ImGui::GetIO().DisplaySize;
        draw_playback_panel(*readout.playback, free_area(screen.x, screen.y), commands);
    } else if (shows_lesson_ && !lesson_.steps().empty()) {
        draw_lesson(readout, commands, actions);
    }
    if (shows_overlays_) draw_legend_panel(status.legend, area_above_panels());
    draw_warnings(readout, status);
    if (status.recorded_s) draw_recording(*status.recorded_s);
    if (shows_help_) draw_help();
}

// Above what stands below the picture, however high that is.
ScreenArea Overlay::area_above_panels() const {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ScreenArea area = free_area(screen.x, screen.y);
    for (const char* const name : {lesson_panel, playback_panel, replay_panel, selection_panel}) {
        const ImGuiWindow* const panel = ImGui::FindWindowByName(labelled(name).c_str());
        if (panel && panel->Active) area.bottom = std::min(area.bottom, panel->Pos.y);
    }
    return area;
}

bool Overlay::close_something() {
    if (ImGui::GetCurrentContext()->OpenPopupStack.Size > 0) {
        ImGui::ClosePopupToLevel(0, true);
        return true;
    }
    return std::exchange(shows_help_, false);
}

void Overlay::draw_lesson(const Readout& readout, std::vector<Command>& commands,
                          std::vector<Action>& actions) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const ScreenArea area = free_area(screen.x, screen.y);
    const float width =
        std::min(std::max(area.width() - 2 * panel_edge(), scaled(260)), scaled(560));
    ImGui::SetNextWindowPos({0.5F * (area.left + area.right), screen.y - panel_edge()},
                            ImGuiCond_Always, {0.5F, 1});
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, 0.6F * screen.y});
    ImGui::SetNextWindowSize({width, 0});
    ImGui::Begin(labelled(lesson_panel).c_str(), nullptr, fixed_panel);
    const std::size_t count = lesson_.steps().size();
    if (lesson_.is_done()) {
        ImGui::TextWrapped(translated("All %d steps are done. L hides this."),
                           static_cast<int>(count));
    } else {
        draw_lesson_step(readout, count);
    }
    if (ImGui::SmallButton(labelled("from the start").c_str()))
        restart_lesson(readout, commands, actions);
    ImGui::End();
}

// Steps, what they measured, the world and the coupling's mode.
void Overlay::restart_lesson(const Readout& readout, std::vector<Command>& commands,
                             std::vector<Action>& actions) {
    lesson_.restart();
    lesson_curve_.clear();
    const CouplingMode mode = coupling_of(scene_, 0).mode;
    if (settings_.coupling.mode != mode) set_mode(mode, commands);
    actions.push_back(Action::Reset);
    awaited_reset_ = readout.resets + 1;
    saw_reset_ = false;
}

// Ticks from before the reset come until the frame after the one that shows it.
void Overlay::follow_restart(const Readout& readout) {
    if (!awaited_reset_) return;
    if (saw_reset_) return awaited_reset_.reset();
    saw_reset_ = readout.resets >= *awaited_reset_;
}

void Overlay::draw_lesson_step(const Readout& readout, std::size_t count) {
    const LessonStepDescription& step = lesson_.steps()[lesson_.current()];
    std::string head = format_translated("step {} of {}", lesson_.current() + 1, count);
    if (const auto value = lesson_.value()) head += ": " + describe_value(step, *value);
    ImGui::TextDisabled("%s", head.c_str());
    ImGui::TextWrapped("%s", step.text.c_str());
    ImGui::PushStyleColor(ImGuiCol_Text, lesson_.is_step_done() ? done_colour : task_colour);
    ImGui::TextWrapped("%s%s", lesson_.is_step_done() ? translated("Done: ") : "",
                       step.task.c_str());
    ImGui::PopStyleColor();
    if (step.question) {
        const auto pressed = draw_lesson_question(*step.question, lesson_.chosen());
        if (pressed) lesson_.answer(*pressed);
    }
    if (step.plot == LessonPlot::Map) draw_lesson_map(readout.lesson);
    if (step.plot == LessonPlot::Force) lesson_curve_.draw();
    if (step.for_s > 0) {
        ImGui::ProgressBar(static_cast<float>(lesson_.share()), {-1, scaled(6)}, "");
    }
    if (lesson_.can_go_on()) {
        const bool is_last = lesson_.current() + 1 == count;
        if (ImGui::Button(labelled(is_last ? for_translation("Finish (Enter)")
                                           : for_translation("Next (Enter)"))
                              .c_str()))
            lesson_.go_on();
    } else if (ImGui::SmallButton(labelled("skip").c_str())) {
        lesson_.skip();
    }
    ImGui::SameLine();
}

void Overlay::draw_warnings(const Readout& readout, const OverlayStatus& status) {
    std::vector<std::string> warnings;
    // Each stays for a while after its reason, or nobody could read it.
    const auto warn = [&](double& left_s, bool is_so, auto&& text) {
        if (is_so) left_s = 2;
        left_s -= ImGui::GetIO().DeltaTime;
        if (left_s > 0) warnings.push_back(text());
    };
    if (stopped_)
        warnings.emplace_back(translated(
            "a force was not finite, so the force is off until you reset the scene (R)"));
    const bool feels = readout.holds_something && !stopped_;
    if (reason_ != SafetyStage::None && feels)
        warnings.emplace_back(translated(describe(reason_).data()));
    if (stage_ >= SafetyStage::ThermalLimit && stage_ != reason_ && feels)
        warnings.emplace_back(translated(describe(stage_).data()));
    warn(shaking_for_s_, is_shaking(readout), [&] {
        return format_translated(
            "this setting vibrates: K > B/(1.5 T_s). This hand is stable up to {:.3g} N/m at T_s = "
            "{} ms. Shorten the period, raise A_d, or lower the force gain.",
            stiffness_limit_, settings_.period_ms);
    });
    warn(clamped_for_s_, clamped_, [&] {
        return format_translated(
            "clipping: the force is limited to {} N; push less or lower the force gain",
            settings_.coupling.clamp_N);
    });
    // A single late step, of any length, is no reason to raise the period.
    const double step_ms = std::min(readout.step_ms, 10 * settings_.period_ms);
    mean_step_ms_ +=
        std::min(1.0, static_cast<double>(ImGui::GetIO().DeltaTime)) * (step_ms - mean_step_ms_);
    warn(late_for_s_, mean_step_ms_ > settings_.period_ms, [&] {
        return format_translated(
            "steps take longer than the period of {} ms, so the force is delayed; raise the period",
            settings_.period_ms);
    });
    warn(at_wall_for_s_, is_guarded() && overtravel_m_ > least_overtravel_m, [&] {
        return format_translated(
            "overtravel: the contact force has reached {:.3g} nN, so the molecule has stopped; "
            "move the hand back by {:.0f} mm before it follows again",
            settings_.coupling.stop_nN, std::ceil(1e3 * overtravel_m_));
    });
    warn(at_stop_for_s_, is_at_stop_, [&] {
        return std::string(
            status.has_mouse_hand
                ? translated("the handle is at its end: release Space, press it again")
                : translated("the handle is at its end: press the clutch, move back, let go"));
    });
    if (went_through_) {
        warnings.emplace_back(
            translated("the molecule was pushed through another one; R resets the scene"));
    }
    if (!readout.problem.empty()) warnings.push_back(readout.problem);
    if (!readout.engine.empty()) warnings.push_back(readout.engine);
    if (!readout.edit_under_way.empty())
        warnings.push_back(format_translated("{}: in preparation", readout.edit_under_way));
    if (readout.paused) warnings.emplace_back(translated("paused; P continues"));
    if (!status.notice.empty()) warnings.push_back(status.notice);
    warnings.emplace_back(
        readout.replay
            ? translated("a recorded session is played again; drag turns the view, H: all keys")
        : !readout.holds_something
            ? translated("nothing is in hand: click on an atom to take its molecule; H: all "
                         "keys")
        : !status.has_mouse_hand ? format_translated("device: {}; H: all keys", status.device_name)
        : status.holding         ? translated("in hand: move the mouse; the wheel goes in and out")
                                 : translated("hold Space and move the mouse to pull the molecule, "
                                                      "or use the arrow keys; H: all keys"));
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const ScreenArea area = free_area(screen.x, screen.y);
    const float width = std::max(scaled(240), area.width() - 2 * panel_edge());
    ImGui::SetNextWindowPos({0.5F * (area.left + area.right), panel_edge()}, ImGuiCond_Always,
                            {0.5F, 0});
    // The library would know the size of new words only in the next frame.
    const ImGuiStyle& style = ImGui::GetStyle();
    const float wrap = width - 2 * style.WindowPadding.x;
    ImVec2 size{scaled(200), 2 * style.WindowPadding.y - style.ItemSpacing.y};
    for (const std::string& warning : warnings) {
        const ImVec2 words = ImGui::CalcTextSize(warning.c_str(), nullptr, false, wrap);
        size.x = std::max(size.x, std::min(words.x + 1, wrap) + 2 * style.WindowPadding.x);
        size.y += words.y + style.ItemSpacing.y;
    }
    ImGui::SetNextWindowSize({size.x, std::min(size.y, 0.6F * screen.y)});
    ImGui::Begin("##warnings", nullptr,
                 fixed_panel | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoInputs);
    ImGui::PushTextWrapPos(style.WindowPadding.x + wrap);
    for (const std::string& warning : warnings) ImGui::TextUnformatted(warning.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

// A red mark and the time, in the lower right corner of what no panel covers.
void Overlay::draw_recording(double seconds) const {
    const ScreenArea area = area_above_panels();
    const auto whole = static_cast<int>(seconds);
    const std::string text = format_translated("recording {}:{:02}", whole / 60, whole % 60);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float radius = 0.4F * size.y;
    const ImVec2 corner{area.right - panel_edge() - size.x, area.bottom - panel_edge() - size.y};
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    constexpr ImU32 red = IM_COL32(200, 20, 20, 255);
    list.AddCircleFilled({corner.x - 2 * radius, corner.y + 0.5F * size.y}, radius, red);
    list.AddText(corner, red, text.c_str());
}

void Overlay::draw_help() {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float edge = panel_edge();
    HelpTable table = lay_out_help();
    const float widest = screen.x - 2 * edge - ImGui::GetStyle().ScrollbarSize -
                         2 * ImGui::GetStyle().WindowPadding.x;
    ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {screen.x - 2 * edge, screen.y - 2 * edge});
    ImGui::SetNextWindowFocus();
    ImGui::SetNextWindowBgAlpha(1);
    ImGui::Begin(labelled("Keys and mouse").c_str(), &shows_help_,
                 fixed_panel | ImGuiWindowFlags_AlwaysAutoResize);
    const bool fits = table.width() <= widest;
    if (!fits) table.shrink(widest);
    constexpr ImGuiTableFlags tight = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoPadOuterX;
    if (ImGui::BeginTable("keys", HelpTable::columns, tight, {table.width(), 0})) {
        for (const float width : table.widths)
            ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, width);
        for (const auto& row : table.rows) {
            for (const std::string& cell : row) {
                ImGui::TableNextColumn();
                ImGui::PushTextWrapPos(fits ? -1.0F : 0.0F);
                ImGui::TextUnformatted(cell.c_str());
                ImGui::PopTextWrapPos();
            }
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

}  // namespace palpa
