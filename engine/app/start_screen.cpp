#include "app/start_screen.h"

#include "app/fetch_structure.h"
#include "app/scene_cards.h"
#include "core/load_error.h"
#include "core/translate.h"
#include "render/picture_sheet.h"
#include "ui/colours.h"
#include "ui/file_browser.h"
#include "ui/language_list.h"
#include "ui/layout.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

namespace fs = std::filesystem;

constexpr float card_width = 200, picture_height = 125, card_text_height = 92;
constexpr double frames_per_s = 60;
constexpr ImU32 chosen_edge = IM_COL32(60, 120, 210, 255), card_edge = IM_COL32(150, 160, 175, 255);

// What a scene's level may be.
[[maybe_unused]] constexpr std::array levels{
    for_translation("beginner"), for_translation("student"), for_translation("researcher")};

// As describe_effort() says it.
std::string translated_effort(const SceneEntry& scene) {
    std::vector<std::string> parts;
    if (scene.has_lesson) parts.emplace_back(translated("lesson"));
    if (!scene.level.empty()) parts.emplace_back(translated(scene.level.c_str()));
    if (scene.minutes > 0) parts.push_back(format_translated("{:.0f} minutes", scene.minutes));
    return fmt::format("{}", fmt::join(parts, ", "));
}

// Where a picture of a card goes, and what of it is seen, in pixels of the window.
struct CardPicture {
    std::size_t number;  // in the sheet
    PixelBox to, within;
};

class StartScreen {
public:
    StartScreen(WindowShell& shell, const StartOptions& options);
    StartScreen(const StartScreen&) = delete;
    StartScreen& operator=(const StartScreen&) = delete;
    ~StartScreen() { drop_pictures(); }
    std::optional<NextScreen> run();

private:
    bool frame();
    void take_input();
    void press(const KeyPress& press);
    void move(int by);
    void open_chosen();
    void open(const fs::path& file);
    void fetch(const std::optional<std::string>& code);
    void browse();
    void describe();
    void draw_header();
    void draw_cards();
    void draw_card(std::size_t number, float width);
    void draw_side();
    void draw_recovered();
    void draw_recent();
    void draw_devices();
    void choose_device(const std::string& name);
    void load_pictures();
    void drop_pictures();

    WindowShell& shell_;
    const StartOptions& options_;
    const SceneCards scenes_;
    const std::vector<SceneEntry>& cards_ = scenes_.cards;
    const Graphics* sheet_of_ = nullptr;
    std::unique_ptr<PictureSheet> sheet_;
    std::vector<CardPicture> shown_;
    std::size_t chosen_ = 0;  // cards, then recent files
    bool moved_ = false;      // the choice, by keys
    bool mouse_moved_ = false;
    bool closes_list_ = false;
    std::size_t columns_ = 1;
    std::string device_, problem_, notice_;
    FileBrowser browser_;
    CodeField code_field_;
    std::vector<Language> languages_ = list_languages();
    bool is_over_ = false;
    std::optional<NextScreen> next_;
};

StartScreen::StartScreen(WindowShell& shell, const StartOptions& options)
    : shell_(shell),
      options_(options),
      scenes_(list_cards(options.scenes)),
      device_(options.device),
      problem_(options.problem) {
    shell.window().set_title("Palpa");
}

std::optional<NextScreen> StartScreen::run() {
    shell_.run(frames_per_s, [this] { return frame(); }, [this] { sheet_.reset(); });
    shell_.check_validation();
    return next_;
}

bool StartScreen::frame() {
    take_input();
    load_pictures();
    if (std::string news = shell_.take_notice(); !news.empty()) notice_ = std::move(news);
    shell_.draw_panels([this] { describe(); },
                       [this](VkCommandBuffer commands, VkImage image) {
                           for (const CardPicture& one : shown_)
                               sheet_->record(commands, one.number, image, one.to, one.within);
                       });
    return !is_over_ && !next_;
}

// The last frame may still use them.
void StartScreen::drop_pictures() {
    try {
        if (sheet_ && shell_.graphics()) shell_.graphics()->swapchain.wait();
    } catch (const GpuError&) {  // a device that was lost uses nothing
    }
    sheet_.reset();
}

// Again where the graphics device was set up again.
void StartScreen::load_pictures() {
    Graphics* const graphics = shell_.graphics();
    if (sheet_ && sheet_of_ == graphics) return;
    sheet_ = std::make_unique<PictureSheet>(graphics->device, scenes_.pictures);
    sheet_of_ = graphics;
}

void StartScreen::take_input() {
    if (shell_.window().should_close()) is_over_ = true;
    const Input& input = shell_.poll();
    if (input.rescaled) {
        drop_pictures();
        shell_.restart_graphics();
    }
    mouse_moved_ = input.mouse_dx != 0 || input.mouse_dy != 0;
    if (!input.dropped.empty()) next_ = name_screen(input.dropped);
    for (const KeyPress& each : input.pressed) press(each);
}

void StartScreen::press(const KeyPress& press) {
    if (browser_.is_open()) {
        if (press.key == Key::Escape) return browser_.close();
        return browser_.press(press.key);
    }
    if (ImGui::GetIO().WantTextInput && !(press.control && press.key == Key::Q)) {
        if (press.key == Key::Enter) code_field_.enter();
        if (press.key == Key::Escape) ImGui::SetWindowFocus(nullptr);  // leaves the field
        return;
    }
    const auto scale_text = [&](double scale) {
        drop_pictures();
        notice_ = shell_.change_text_scale(scale);
    };
    if (press.control && press.key == Key::Plus) return scale_text(shell_.text_scale() * text_step);
    if (press.control && press.key == Key::Minus)
        return scale_text(shell_.text_scale() / text_step);
    if (press.control && press.key == Key::Digit0) return scale_text(1);
    const auto row = static_cast<int>(chosen_ < cards_.size() ? columns_ : 1);
    if (press.key == Key::Right) move(1);
    if (press.key == Key::Left) move(-1);
    if (press.key == Key::Down) move(row);
    if (press.key == Key::Up) move(-row);
    if (press.key == Key::Enter || press.key == Key::Space) open_chosen();
    if (press.key == Key::O) browse();
    if (press.key == Key::P) code_field_.focus();
    if (press.key == Key::V && press.control) fetch(code_field_.paste());
    if (press.key == Key::Escape && ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) {
        closes_list_ = true;
    } else if (press.key == Key::Escape) {
        notice_ = translated("nothing is open; Ctrl+Q quits");
    } else if (press.key == Key::Q && press.control) {
        is_over_ = true;
    }
}

void StartScreen::move(int by) {
    const auto last = static_cast<int>(cards_.size() + options_.recent.size()) - 1;
    chosen_ =
        static_cast<std::size_t>(std::clamp(static_cast<int>(chosen_) + by, 0, std::max(last, 0)));
    moved_ = true;
}

void StartScreen::open_chosen() {
    if (chosen_ < cards_.size()) return open(cards_[chosen_].file);
    const std::size_t recent = chosen_ - cards_.size();
    if (recent < options_.recent.size()) open(options_.recent[recent]);
}

void StartScreen::open(const fs::path& file) { next_ = {{file}}; }

void StartScreen::fetch(const std::optional<std::string>& code) {
    if (code) next_ = NextScreen{.code = *code};
}

void StartScreen::browse() {
    std::error_code error;
    browser_.open(translated("Open a structure or a scene"), list_endings(),
                  fs::current_path(error));
}

void StartScreen::describe() {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    shown_.clear();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(screen);
    ImGui::Begin("##start", nullptr,
                 fixed_panel | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoBackground |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollbar);
    draw_header();
    const float side = std::min(scaled(280), 0.38F * screen.x);
    ImGui::BeginChild("##cards", {-side - panel_edge(), 0}, false, ImGuiWindowFlags_NoBackground);
    draw_cards();
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("##side", {0, 0}, false);
    draw_side();
    ImGui::EndChild();
    ImGui::End();
    if (const std::optional<fs::path> file = browser_.draw()) open(*file);
    moved_ = closes_list_ = false;
}

void StartScreen::draw_header() {
    ImGui::SetWindowFontScale(1.6F);
    ImGui::TextUnformatted(translated("Palpa: feel molecules"));
    ImGui::SetWindowFontScale(1);
    ImGui::TextDisabled(
        "%s", translated("Choose a scene, or open a structure of your own. In a scene: hold Space "
                         "and move the mouse to pull; H lists all keys."));
    if (options_.recent.empty())
        ImGui::TextWrapped("%s",
                           translated("New here? Press Enter: the first card is a tour of two "
                                      "minutes."));
    if (!problem_.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, colours().wrong);
        ImGui::TextWrapped("%s", problem_.c_str());
        ImGui::PopStyleColor();
    }
    if (!notice_.empty()) ImGui::TextWrapped("%s", notice_.c_str());
    ImGui::Separator();
}

void StartScreen::draw_cards() {
    const float gap = scaled(10);
    const float room = ImGui::GetContentRegionAvail().x;
    columns_ = static_cast<std::size_t>(
        std::max(1.0F, std::floor((room + gap) / (scaled(card_width) + gap))));
    const auto columns = static_cast<float>(columns_);
    const float width = std::floor((room - (columns - 1) * gap) / columns);
    for (std::size_t i = 0; i < cards_.size(); ++i) {
        if (i % columns_ != 0) ImGui::SameLine(0, gap);
        draw_card(i, width);
    }
    if (cards_.empty())
        ImGui::TextWrapped(
            "%s", translated("No scenes came with this program; open a structure of your own."));
}

void StartScreen::draw_card(std::size_t number, float width) {
    const SceneEntry& scene = cards_[number];
    const float high = width * picture_height / card_width;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 end{at.x + width, at.y + high + scaled(card_text_height)};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 clip_from = list.GetClipRectMin(), clip_to = list.GetClipRectMax();
    const VkExtent2D window = shell_.graphics()->swapchain.size();
    if (scenes_.picture_numbers[number]) {
        const auto pixel = [](float place) { return static_cast<int>(std::lround(place)); };
        const PixelBox all{0, 0, static_cast<int>(window.width), static_cast<int>(window.height)};
        const PixelBox clip{pixel(clip_from.x), pixel(clip_from.y), pixel(clip_to.x),
                            pixel(clip_to.y)};
        shown_.push_back({*scenes_.picture_numbers[number],
                          {pixel(at.x), pixel(at.y), pixel(end.x), pixel(at.y + high)},
                          common(all, clip)});
    }
    ImGui::PushID(static_cast<int>(number));
    ImGui::BeginGroup();
    if (ImGui::InvisibleButton("##card", {width, end.y - at.y})) open(scene.file);
    const bool is_chosen = number == chosen_;
    if (ImGui::IsItemHovered() && mouse_moved_) chosen_ = number;
    if (is_chosen && moved_) ImGui::SetScrollHereY();
    list.AddRectFilled({at.x, at.y + high}, end, colours().ground);
    list.AddRect(at, end, is_chosen ? chosen_edge : card_edge, 0, 0, scaled(is_chosen ? 3 : 1));
    const float pad = scaled(6);
    const ImVec4 inside{at.x + pad, at.y + high, end.x - pad, end.y - pad / 2};
    ImFont* const font = ImGui::GetFont();
    const float size = ImGui::GetFontSize(), small = 0.87F * size;
    float y = at.y + high + pad / 2;
    const auto write = [&](const std::string& text, float height, ImU32 colour) {
        list.AddText(font, height, {at.x + pad, y}, colour, text.c_str(), nullptr, width - 2 * pad,
                     &inside);
        y += font->CalcTextSizeA(height, width, width - 2 * pad, text.c_str()).y;
    };
    write(scene.title, size, colours().ink);
    write(translated_effort(scene), small, colours().task);
    write(scene.about, small, ImGui::GetColorU32(ImGuiCol_Text, 0.75F));
    ImGui::EndGroup();
    if (ImGui::IsItemHovered())
        tip(fmt::format("{}\n{}", scene.about, scene.file.string()).c_str());
    ImGui::PopID();
}

void StartScreen::draw_side() {
    if (ImGui::Button(labelled("Open a file... (O)").c_str(), {-1, 0})) browse();
    fetch(code_field_.draw());
    ImGui::TextWrapped(
        "%s",
        translated("PDB or mmCIF (also .gz), CHARMM coordinates, or a scene; or drop one here. "
                   "A structure is completed first, which takes a few seconds."));
    draw_recovered();
    draw_recent();
    draw_devices();
    ImGui::Separator();
    if (const std::optional<std::string> language = draw_language_list(languages_))
        notice_ = shell_.change_language(*language);
    ImGui::Separator();
    if (ImGui::Button(labelled("Quit (Ctrl+Q)").c_str())) is_over_ = true;
}

void StartScreen::draw_recovered() {
    if (options_.recovered.empty()) return;
    ImGui::Separator();
    ImGui::TextUnformatted(translated("Not saved when Palpa ended"));
    for (const fs::path& file : options_.recovered) {
        if (ImGui::Selectable(file.stem().string().c_str())) open(file);
        tip(format_translated(
                "{}\nOpen it and press Ctrl+S to save it as a scene; delete the file to discard it",
                file.string())
                .c_str());
    }
}

void StartScreen::draw_recent() {
    ImGui::Separator();
    ImGui::TextUnformatted(translated("Opened before"));
    if (options_.recent.empty()) ImGui::TextDisabled("%s", translated("nothing yet"));
    for (std::size_t i = 0; i < options_.recent.size(); ++i) {
        const fs::path& file = options_.recent[i];
        // Scenes mostly have the same name; their folders tell them apart.
        const std::string name = (file.parent_path().filename() / file.filename()).generic_string();
        ImGui::PushID(static_cast<int>(i));
        const bool is_chosen = cards_.size() + i == chosen_;
        if (ImGui::Selectable(name.c_str(), is_chosen)) open(file);
        if (is_chosen && moved_) ImGui::SetScrollHereY();
        tip(file.string().c_str());
        ImGui::PopID();
    }
}

void StartScreen::draw_devices() {
    ImGui::Separator();
    ImGui::TextUnformatted(translated("In your hand"));
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("##device", device_.c_str(), ImGuiComboFlags_HeightLarge)) {
        if (closes_list_) ImGui::CloseCurrentPopup();
        for (const DeviceOffer& offer : options_.devices) {
            if (offer.is_stand_in) continue;
            const std::string text = fmt::format("{}{}\n  {}", offer.name,
                                                 offer.is_there ? "" : translated(" (not found)"),
                                                 translated(offer.summary.c_str()));
            if (ImGui::Selectable(text.c_str(), offer.name == device_)) choose_device(offer.name);
        }
        ImGui::EndCombo();
    }
    std::string found;
    for (const DeviceOffer& offer : options_.devices) {
        if (offer.is_stand_in || !offer.is_there || offer.name == "mouse") continue;
        found += (found.empty() ? "" : ", ") + offer.name;
    }
    ImGui::TextWrapped(
        "%s",
        found.empty()
            ? translated("No haptic device was found; choose yours above to see what is missing. "
                         "The mouse works without one, and sound makes the force audible.")
            : format_translated("Found: {}.", found).c_str());
}

void StartScreen::choose_device(const std::string& name) {
    try {
        notice_ = options_.choose_device(name);
        device_ = name;
    } catch (const LoadError& error) {
        problem_ = error.what();
    }
}

}  // namespace

std::optional<NextScreen> show_start_screen(WindowShell& shell, const StartOptions& options) {
    return StartScreen(shell, options).run();
}

}  // namespace palpa
