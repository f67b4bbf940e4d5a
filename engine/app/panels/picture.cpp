// The panel "Save a picture": a picture of the state on screen without panels, at any size.
#include "app/clean_picture.h"
#include "app/notices.h"
#include "app/panels.h"
#include "app/screenshots.h"
#include "app/window_shell.h"
#include "app/window_world.h"
#include "core/load_error.h"
#include "core/translate.h"
#include "gpu/resources.h"
#include "ui/icons.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cstdint>

namespace palpa {
namespace {

struct PictureChoice {
    CleanPicture picture;
    bool is_saving = false;  // Enter was pressed
};

struct Size {
    const char* name;
    std::uint32_t width, height;
};
constexpr std::array sizes{Size{"1920 x 1080", 1920, 1080}, Size{"3840 x 2160", 3840, 2160},
                           Size{"2400 x 1600", 2400, 1600}};

void save_picture(World& app) {
    close_panel(app, "picture");
    const CleanPicture wanted = panel_state<PictureChoice>(app).picture;
    const std::uint64_t samples = std::uint64_t{wanted.width} * wanted.height * wanted.samples;
    if (samples > most_picture_samples)
        return tell(
            app,
            format_translated("a picture of {} x {} pixels is too large; expected {} million "
                              "at most, a fourth of it with smooth edges",
                              wanted.width, wanted.height, most_picture_samples / 1'000'000),
            long_notice_s);
    try {
        const std::filesystem::path file =
            find_free_name(options_of(app).files_folder, "palpa-picture", {".png"});
        std::string problem;
        write_png(file, draw_clean_picture(app, wanted, &problem));
        const std::string saved = format_translated("saved {}: {} x {} pixels", file.string(),
                                                    wanted.width, wanted.height);
        tell(app, problem.empty() ? saved : saved + "\n" + problem, long_notice_s);
    } catch (const LoadError& error) {
        tell(app, error.what(), long_notice_s);
    } catch (const GpuError& error) {
        tell(app, error.what(), long_notice_s);
    }
}

void draw_sizes(CleanPicture& picture) {
    constexpr int most = 16'384;
    std::array<int, 2> size{static_cast<int>(picture.width), static_cast<int>(picture.height)};
    if (ImGui::InputInt2(labelled("Width and height").c_str(), size.data())) {
        picture.width = static_cast<std::uint32_t>(std::clamp(size[0], 16, most));
        picture.height = static_cast<std::uint32_t>(std::clamp(size[1], 16, most));
    }
    for (const Size& each : sizes) {
        if (ImGui::SmallButton(each.name)) {
            picture.width = each.width;
            picture.height = each.height;
        }
        ImGui::SameLine();
    }
    ImGui::NewLine();
}

void draw_picture_panel(World& app) {
    PictureChoice& choice = panel_state<PictureChoice>(app);
    CleanPicture& picture = choice.picture;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowFocus();
    bool stays = true;
    ImGui::Begin(labelled("Save a picture").c_str(), &stays,
                 fixed_panel | ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushItemWidth(scaled(200));
    ImGui::TextUnformatted(translated("What you see, without panels."));
    draw_sizes(picture);
    bool is_smooth = picture.samples > 1;
    if (ImGui::Checkbox(labelled("smooth edges").c_str(), &is_smooth))
        picture.samples = is_smooth ? 4 : 1;
    ImGui::Checkbox(labelled("labels and legend").c_str(), &picture.has_words);
    ImGui::Checkbox(labelled("arrow of the force").c_str(), &picture.has_arrow);
    ImGui::Checkbox(labelled("transparent background").c_str(), &picture.is_clear);
    ImGui::PopItemWidth();
    if (ImGui::Button(labelled("Save (Enter)").c_str()) || choice.is_saving)
        request(app, save_picture);
    choice.is_saving = false;
    ImGui::End();
    if (!stays) close_panel(app, "picture");
}

bool press_in_picture(World& app, const KeyPress& press) {
    if (press.key == Key::Escape) close_panel(app, "picture");
    if (press.key == Key::Enter) panel_state<PictureChoice>(app).is_saving = true;
    return !(press.control && press.key == Key::Q);
}

}  // namespace

extern const Panel picture_panel{
    .id = "picture",
    .title = for_translation("Save a picture"),
    .explains = for_translation("A picture of the state on screen, without panels, at any size."),
    .icon = icon_camera,
    .side = Side::Over,
    .draw = draw_picture_panel,
    .is_open = false,
    .press = press_in_picture};

}  // namespace palpa
