#include "app/start_screen.h"

#include "app/fetch_structure.h"
#include "core/load_error.h"
#include "core/translate.h"
#include "render/picture_sheet.h"
#include "ui/colours.h"
#include "ui/file_browser.h"
#include "ui/language_list.h"
#include "ui/layout.h"
#include "ui/text_field.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
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
constexpr float mark_radius = 11;
constexpr double frames_per_s = 60;
constexpr ImU32 chosen_edge = IM_COL32(60, 120, 210, 255), card_edge = IM_COL32(150, 160, 175, 255),
                mark_colour = IM_COL32(255, 255, 255, 255);

// Names in the order of CardGroup.
constexpr std::array<const char*, card_groups> group_names{
    for_translation("Lessons"), for_translation("Explore"), for_translation("Research"),
    for_translation("Yours")};

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
    void move(int right, int down);
    void open_chosen();
    void open(const fs::path& file);
    void go_back();
    void fetch(const std::optional<std::string>& code);
    void browse();
    void describe();
    void draw_header();
    void find_seen();
    void draw_cards();
    void draw_card(std::size_t number, float width);
    void draw_done_mark(const ImVec2& place);
    void draw_side();
    void draw_sound_question();
    void draw_recovered();
    void draw_recent();
    void draw_devices();
    void draw_messages();
    float height_of_messages() const;
    void choose_device(const std::string& name);
    void choose_sound(bool is_on);
    void load_pictures();
    void drop_pictures();

    WindowShell& shell_;
    const StartOptions& options_;
    const SceneCards scenes_;
    const std::vector<SceneCard>& cards_ = scenes_.cards;
    const Graphics* sheet_of_ = nullptr;
    std::unique_ptr<PictureSheet> sheet_;
    std::vector<CardPicture> shown_;
    std::string searched_;
    std::vector<std::size_t> seen_;  // cards that the search finds
    std::vector<ImVec2> places_;     // of these at the last drawing, on the scrolled page
    std::size_t chosen_ = 0;         // of these
    bool moved_ = false;             // the choice, by keys
    bool closes_list_ = false, wants_search_ = false;
    bool searches_ = false;  // the search field has the keys
    bool asks_for_sound_;
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
      scenes_(list_cards(options.cards)),
      asks_for_sound_(options.asks_for_sound),
      device_(options.device),
      problem_(options.problem),
      notice_(options.said) {
    shell.window().set_title("Palpa");
    const auto next = std::ranges::find(cards_, false, &SceneCard::is_done);
    if (next != cards_.end()) chosen_ = static_cast<std::size_t>(next - cards_.begin());
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
    const Input& input = shell_.poll();
    if (shell_.window().should_close()) is_over_ = true;
    if (input.rescaled) {
        drop_pictures();
        shell_.restart_graphics();
    }
    if (!input.dropped.empty()) next_ = name_screen(input.dropped);
    for (const KeyPress& each : input.pressed) press(each);
}

void StartScreen::press(const KeyPress& press) {
    if (browser_.is_open()) {
        if (press.key == Key::Escape) return browser_.close();
        return browser_.press(press.key);
    }
    if (ImGui::GetIO().WantTextInput && !searches_) {
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
    if (press.key == Key::F && press.control) wants_search_ = true;
    if (press.key == Key::Escape) return go_back();
    if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) return;
    const bool moves_in_text = searches_ && !searched_.empty();
    if (press.key == Key::Right && !moves_in_text) move(1, 0);
    if (press.key == Key::Left && !moves_in_text) move(-1, 0);
    if (press.key == Key::Down) move(0, 1);
    if (press.key == Key::Up) move(0, -1);
    if (press.key == Key::Enter) open_chosen();
    if (ImGui::GetIO().WantTextInput || wants_search_) return;
    if (press.key == Key::Space) open_chosen();
    if (press.key == Key::O) browse();
    if (press.key == Key::P) code_field_.focus();
    if (press.key == Key::V && press.control) fetch(code_field_.paste());
}

// Closes a list, then the search, then goes back to the scene that was left.
void StartScreen::go_back() {
    if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) {
        closes_list_ = true;
    } else if (searches_ || !searched_.empty()) {
        searched_.clear();
        ImGui::ClearActiveID();
    } else if (options_.before) {
        open(options_.before->file);
    } else {
        notice_ = translated("nothing is open; Ctrl+Q quits");
    }
}

// Chooses the next card in its row, or the nearest one in the next row.
void StartScreen::move(int right, int down) {
    if (seen_.empty() || places_.size() != seen_.size()) return;
    moved_ = true;
    const auto last = static_cast<int>(seen_.size()) - 1;
    const ImVec2 from = places_[chosen_];
    if (right != 0) {
        chosen_ = static_cast<std::size_t>(std::clamp(static_cast<int>(chosen_) + right, 0, last));
        return;
    }
    std::optional<std::size_t> nearest;
    const auto way = [&](std::size_t i) {
        return std::pair(std::abs(places_[i].y - from.y), std::abs(places_[i].x - from.x));
    };
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const bool is_there = down > 0 ? places_[i].y > from.y + 1 : places_[i].y < from.y - 1;
        if (is_there && (!nearest || way(i) < way(*nearest))) nearest = i;
    }
    chosen_ = nearest.value_or(chosen_);
}

void StartScreen::open_chosen() {
    if (chosen_ < seen_.size()) open(cards_[seen_[chosen_]].scene.file);
}

void StartScreen::open(const fs::path& file) { next_ = {{file}}; }

void StartScreen::fetch(const std::optional<std::string>& code) {
    if (code) next_ = NextScreen{.code = *code};
}

void StartScreen::browse() {
    std::error_code error;
    browser_.open(translated("Open a structure or a scene"), list_endings(),
                  options_.folder.empty() ? fs::current_path(error) : options_.folder);
}

void StartScreen::describe() {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    shown_.clear();
    find_seen();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(screen);
    ImGui::Begin("##start", nullptr,
                 fixed_panel | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoBackground |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollbar);
    draw_header();
    const float side = std::min(scaled(280), 0.38F * screen.x);
    const float below = height_of_messages();
    ImGui::BeginChild("##cards", {-side - panel_edge(), -below}, false,
                      ImGuiWindowFlags_NoBackground);
    draw_cards();
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("##side", {0, -below}, false);
    draw_side();
    ImGui::EndChild();
    draw_messages();
    ImGui::End();
    if (const std::optional<fs::path> file = browser_.draw()) {
        (void)keep_choice(options_.remember_folder, browser_.folder().string());
        open(*file);
    }
    moved_ = closes_list_ = false;
}

// Two lines, or more where the messages need them.
float StartScreen::height_of_messages() const {
    constexpr float usual_lines = 2.2F, most_lines = 8.2F;
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const float width = ImGui::GetContentRegionAvail().x;
    float height = 0.4F * line;
    for (const std::string* const text : {&problem_, &notice_})
        if (!text->empty())
            height += ImGui::CalcTextSize(text->c_str(), nullptr, false, width).y +
                      ImGui::GetStyle().ItemSpacing.y;
    return std::clamp(height, usual_lines * line, most_lines * line);
}

void StartScreen::find_seen() {
    seen_.clear();
    for (std::size_t i = 0; i < cards_.size(); ++i)
        if (has_words(cards_[i].scene, searched_)) seen_.push_back(i);
    chosen_ = std::min(chosen_, seen_.empty() ? 0 : seen_.size() - 1);
}

void StartScreen::draw_header() {
    ImGui::SetWindowFontScale(1.6F);
    ImGui::TextUnformatted(translated("Palpa: feel molecules"));
    ImGui::SetWindowFontScale(1);
    const float field = std::min(scaled(280), 0.38F * ImGui::GetIO().DisplaySize.x);
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - field);
    ImGui::SetNextItemWidth(field);
    if (std::exchange(wants_search_, false)) ImGui::SetKeyboardFocusHere();
    if (type_text("##search", translated("search (Ctrl+F)"), searched_)) chosen_ = 0;
    searches_ = ImGui::IsItemActive();
    ImGui::TextDisabled(
        "%s", translated("Choose a scene, or open a structure of your own. In a scene: hold Space "
                         "and move the mouse to pull; H lists all keys."));
    if (chosen_ < seen_.size()) {
        const std::string& title = cards_[seen_[chosen_]].scene.title;
        ImGui::TextUnformatted(format_translated("Enter opens: {}", title).c_str());
    } else {
        ImGui::TextUnformatted(translated("Nothing has these words; Esc ends the search."));
    }
    if (options_.before) {
        ImGui::SameLine();
        ImGui::TextDisabled(
            "%s", format_translated("Esc goes back to: {}", options_.before->title).c_str());
    }
    ImGui::Separator();
}

// Draws them in a place of their own, so that nothing moves under the mouse.
void StartScreen::draw_messages() {
    ImGui::Separator();
    if (!problem_.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, colours().wrong);
        ImGui::TextWrapped("%s", problem_.c_str());
        ImGui::PopStyleColor();
    }
    if (!notice_.empty()) ImGui::TextWrapped("%s", notice_.c_str());
}

void StartScreen::draw_cards() {
    const float gap = scaled(10);
    const float room = ImGui::GetContentRegionAvail().x;
    const auto columns = static_cast<std::size_t>(
        std::max(1.0F, std::floor((room + gap) / (scaled(card_width) + gap))));
    const auto gaps = static_cast<float>(columns - 1) * gap;
    const float width = std::floor((room - gaps) / static_cast<float>(columns));
    places_.clear();
    std::size_t in_group = 0;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
        const CardGroup group = cards_[seen_[i]].group;
        if (i == 0 || cards_[seen_[i - 1]].group != group) {
            ImGui::TextUnformatted(translated(group_names[static_cast<std::size_t>(group)]));
            in_group = 0;
        }
        if (in_group++ % columns != 0) ImGui::SameLine(0, gap);
        draw_card(i, width);
    }
    if (cards_.empty())
        ImGui::TextWrapped(
            "%s", translated("No scenes came with this program; open a structure of your own."));
}

void StartScreen::draw_card(std::size_t number, float width) {
    const SceneCard& card = cards_[seen_[number]];
    const SceneEntry& scene = card.scene;
    const float high = width * picture_height / card_width;
    places_.push_back(ImGui::GetCursorPos());
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 end{at.x + width, at.y + high + scaled(card_text_height)};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 clip_from = list.GetClipRectMin(), clip_to = list.GetClipRectMax();
    const VkExtent2D window = shell_.graphics()->swapchain.size();
    if (card.picture) {
        const auto pixel = [](float place) { return static_cast<int>(std::lround(place)); };
        const PixelBox all{0, 0, static_cast<int>(window.width), static_cast<int>(window.height)};
        const PixelBox clip{pixel(clip_from.x), pixel(clip_from.y), pixel(clip_to.x),
                            pixel(clip_to.y)};
        shown_.push_back({*card.picture,
                          {pixel(at.x), pixel(at.y), pixel(end.x), pixel(at.y + high)},
                          common(all, clip)});
    }
    ImGui::PushID(static_cast<int>(number));
    ImGui::BeginGroup();
    if (ImGui::InvisibleButton("##card", {width, end.y - at.y})) open(scene.file);
    const bool is_chosen = number == chosen_, is_pointed_at = ImGui::IsItemHovered();
    if (is_chosen && moved_) ImGui::SetScrollHereY();
    list.AddRectFilled({at.x, at.y + high}, end, colours().ground);
    list.AddRect(at, end, is_chosen || is_pointed_at ? chosen_edge : card_edge, 0, 0,
                 scaled(is_chosen ? 3 : 1));
    if (card.is_done)
        draw_done_mark({end.x - scaled(mark_radius + 4), at.y + scaled(mark_radius + 4)});
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
    const std::string effort = translated_effort(scene);
    write(scene.title, size, colours().ink);
    write(card.is_done ? fmt::format("{}, {}", translated("done"), effort) : effort, small,
          card.is_done ? colours().done : colours().task);
    write(scene.about, small, ImGui::GetColorU32(ImGuiCol_Text, 0.75F));
    ImGui::EndGroup();
    if (is_pointed_at) tip(fmt::format("{}\n{}", scene.about, scene.file.string()).c_str());
    ImGui::PopID();
}

void StartScreen::draw_done_mark(const ImVec2& place) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float r = scaled(mark_radius);
    list.AddCircleFilled(place, r, colours().done);
    const std::array tick{ImVec2{place.x - 0.5F * r, place.y + 0.05F * r},
                          ImVec2{place.x - 0.1F * r, place.y + 0.45F * r},
                          ImVec2{place.x + 0.5F * r, place.y - 0.4F * r}};
    list.AddPolyline(tick.data(), static_cast<int>(tick.size()), mark_colour, ImDrawFlags_None,
                     scaled(2));
}

void StartScreen::draw_side() {
    if (ImGui::Button(labelled("Open a file... (O)").c_str(), {-1, 0})) browse();
    fetch(code_field_.draw());
    ImGui::TextWrapped(
        "%s",
        translated("PDB or mmCIF (also .gz), CHARMM coordinates, or a scene; or drop one here. "
                   "A structure is completed first, which takes seconds to minutes."));
    draw_sound_question();
    draw_recovered();
    draw_recent();
    draw_devices();
    ImGui::Separator();
    if (const std::optional<std::string> language = draw_language_list(languages_))
        notice_ = shell_.change_language(*language);
    ImGui::Separator();
    if (ImGui::Button(labelled("Quit (Ctrl+Q)").c_str())) is_over_ = true;
}

// Asked until it is answered, here or in a scene.
void StartScreen::draw_sound_question() {
    if (!asks_for_sound_) return;
    ImGui::Separator();
    ImGui::TextWrapped("%s", translated("Feel without a device: play the force on your hand as a "
                                        "tone? A game pad shakes with it."));
    if (ImGui::Button(labelled("Yes").c_str())) choose_sound(true);
    ImGui::SameLine();
    if (ImGui::Button(labelled("No").c_str())) choose_sound(false);
}

void StartScreen::choose_sound(bool is_on) {
    asks_for_sound_ = false;
    notice_ = keep_choice(options_.sound.remember, is_on);
    if (notice_.empty())
        notice_ = is_on ? translated("The force will be heard; S in a scene turns it off.")
                        : translated("The force will not be heard; S in a scene turns it on.");
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
        const SceneEntry& entry = options_.recent[i];
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::Selectable(entry.title.c_str())) open(entry.file);
        tip(entry.file.string().c_str());
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
                         "The mouse works without one.")
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
