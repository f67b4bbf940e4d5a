#include "app/actions.h"

#include "app/camera.h"
#include "app/device_choice.h"
#include "app/editing.h"
#include "app/hands.h"
#include "app/lesson_course.h"
#include "app/marks.h"
#include "app/notices.h"
#include "app/panels.h"
#include "app/recorder.h"
#include "app/saved_views.h"
#include "app/saving.h"
#include "app/selecting.h"
#include "app/settings.h"
#include "app/window_world.h"
#include "core/assertion.h"
#include "core/translate.h"
#include "ui/colours.h"
#include "ui/icons.h"

#include <algorithm>
#include <array>
#include <string>

namespace palpa {
namespace {

bool holds_something(const World& app) { return frame_of(app).readout.holds_something; }
bool has_lesson(const World& app) { return !app.resource<LessonState>().lesson.steps().empty(); }
bool has_playback(const World& app) { return frame_of(app).readout.playback.has_value(); }
bool is_paused(const World& app) { return frame_of(app).readout.paused; }
bool can_save(const World& app) { return static_cast<bool>(options_of(app).save); }
// An edit that is under way is not in the history yet.
bool can_undo(const World& app) {
    const Readout& readout = frame_of(app).readout;
    return !readout.undo.undo.empty() || !readout.edit_under_way.empty();
}
bool can_redo(const World& app) { return !frame_of(app).readout.undo.redo.empty(); }
bool has_selection(const World& app) { return !app.resource<SelectionState>().atoms.empty(); }
bool has_views(const World& app) { return !app.resource<SavedViewState>().all.empty(); }
bool is_recording(const World& app) { return session_of(app).recording().has_value(); }
bool is_filming(const World& app) { return app.resource<Recorder>().film != nullptr; }
bool sounds(const World& app) { return app.resource<ForceTone>().is_on; }
bool looks_at_held(const World& app) { return app.resource<CameraState>().looks_at_held; }

bool can_relax(const World& app) { return frame_of(app).objects.can_relax; }

bool shows_docks(const World& app) { return app.resource<Docks>().is_shown; }
bool is_in_lesson(const World& app) { return !app.resource<LessonState>().lesson.is_done(); }
bool shows_lesson(const World& app) { return is_panel_open(app, "lesson"); }
bool shows_keys(const World& app) { return is_panel_open(app, "keys"); }

void save_scene_as_new(World& app) { (void)save_scene_in_window(app); }
void toggle_docks(World& app) {
    bool& is_shown = app.write<Docks>().is_shown;
    is_shown = !is_shown;
    if (!is_shown) tell(app, translated("Tab or Esc shows the panels again"), long_notice_s);
}
void toggle_lesson(World& app) { toggle_panel(app, "lesson"); }
void toggle_keys(World& app) { toggle_panel(app, "keys"); }
void open_search(World& app) { open_panel(app, "search", true); }
void open_picture_panel(World& app) {
    if (has_frame(app)) open_panel(app, "picture");
}
void open_select_panel(World& app) {
    if (has_frame(app)) open_panel(app, "select", true);
}
void relax(World& app) { edit_scene(app, RelaxEdit{}); }
void select_nothing(World& app) { (void)end_selection(app); }

void change_text(World& app, double scale) { tell(app, shell_of(app).change_text_scale(scale)); }
void enlarge_text(World& app) { change_text(app, shell_of(app).text_scale() * text_step); }
void reduce_text(World& app) { change_text(app, shell_of(app).text_scale() / text_step); }
void reset_text(World& app) { change_text(app, 1); }
void restart_graphics(World& app) { shell_of(app).restart_graphics(); }
void toggle_theme(World& app) {
    const std::string news = shell_of(app).change_theme(!is_dark_theme());
    if (!news.empty()) tell(app, news);
}
bool is_dark(const World&) { return is_dark_theme(); }

void pause_or_go_on(World& app) {
    bool& wants_pause = app.write<SettingsState>().wants_pause;
    wants_pause = !wants_pause;
    send(app, Pause{wants_pause});
}
void step_once(World& app) {
    app.write<SettingsState>().wants_pause = true;
    send(app, StepOnce{});
}
void reset_scene(World& app) {
    show_first_view(app);
    rest_hands(app);
    app.write<PendingEdits>().click.reset();
    app.write<PendingEdits>().announced.reset();
    app.write<SavedViewState>().lesson_step.reset();  // its step has a view of its own
    send(app, Reset{});
}
void play_or_stop_trajectory(World& app) {
    const PlaybackState& state = *frame_of(app).readout.playback;
    send(app, PlaybackOrder{.paused = !state.is_paused, .frames_per_s = {}, .frame = {}});
}
void play_trajectory_from_start(World& app) {
    send(app, PlaybackOrder{.paused = {}, .frames_per_s = {}, .frame = 0});
}

// Goes back one level; quits nothing but a study.
void go_back(World& app) {
    if (is_study(app)) return ask_to_quit(app);
    if (measures(app)) return measure_or_end(app);
    if (close_something(app) || end_tour(app) || end_selection(app)) return;
    if (!shows_docks(app)) return toggle_docks(app);
    tell(app, translated("nothing is open; Ctrl+O goes to the start screen, Ctrl+Q quits"));
}

template <CouplingMode mode>
void choose_mode(World& app) {
    set_mode(app, mode);
}
template <CouplingMode mode>
bool is_mode(const World& app) {
    return app.resource<SettingsState>().now.coupling.mode == mode;
}

// clang-format off: a line for each action
constexpr auto actions = std::to_array<Action>({
    // ---- File
    {"open", for_translation("Open..."), for_translation("Opens another scene, or a file of your own."), Menu::File, {{{Key::O, true}}}, icon_open, open_start_screen},
    {"save", for_translation("Save as a new scene"), for_translation("Saves the scene with its present atoms and settings to a new file."), Menu::File, {{{Key::S, true}}}, icon_save, save_scene_as_new, can_save},
    {"export", for_translation("Export coordinates..."), for_translation("Saves coordinates or readings for other programs."), Menu::File, {{{Key::E}}}, "", ask_for_export},
    {"screenshot", for_translation("Screenshot"), for_translation("Saves a picture of the window."), Menu::File, {{{Key::F12}}}, icon_camera, take_screenshot, nullptr, nullptr, true, true},
    {"picture", for_translation("Save a picture..."), for_translation("Saves a picture of what is on screen, without panels, at any size."), Menu::File, {{{Key::F12, false, true}}}, "", open_picture_panel},
    {"film", for_translation("Film"), for_translation("Starts or ends a film of the window."), Menu::File, {{{Key::M}}}, "", film_or_end, nullptr, is_filming},
    {"record", for_translation("Record the session"), for_translation("Starts or ends a recording that can be played again to the last digit."), Menu::File, {{{Key::F9}}}, icon_record, record_or_end, nullptr, is_recording, false, false, describe_recording},
    {"quit", for_translation("Quit"), for_translation("Closes the window; asks if something is not saved."), Menu::File, {{{Key::Q, true}}}, "", ask_to_quit, nullptr, nullptr, true},
    // ---- Edit
    {"undo", for_translation("Undo"), for_translation("Undoes a change, a grip or a pull."), Menu::Edit, {{{Key::Z, true}}}, icon_undo, undo, can_undo},
    {"redo", for_translation("Redo"), for_translation("Does again what was undone."), Menu::Edit, {{{Key::Z, true, true}, {Key::Y, true}}}, icon_redo, redo, can_redo},
    {"add", for_translation("Add a molecule..."), for_translation("Adds a residue, a copy of a molecule, or a molecule from files."), Menu::Edit, {{{Key::Insert}}}, icon_add, open_add_panel},
    {"remove", for_translation("Remove the molecule in hand"), for_translation("Removes the molecule in hand; Ctrl+Z brings it back."), Menu::Edit, {{{Key::Delete}}}, icon_remove, remove_held},
    {"release", for_translation("Release"), for_translation("Lets go of the molecule in hand."), Menu::Edit, {{{Key::G}}}, "", release_held, holds_something},
    {"put-back", for_translation("Put back"), for_translation("Puts the molecule in hand back to where it was at the start."), Menu::Edit, {{{Key::R, false, true}}}, "", put_back_held},
    {"other-hand", for_translation("Mouse to the other hand"), for_translation("Gives the mouse to the other hand; the arrow keys move the first."), Menu::Edit, {{{Key::X}}}, "", exchange_hands},
    // ---- View
    {"first-view", for_translation("First view"), for_translation("Shows the scene as it was when the window opened."), Menu::View, {{{Key::Home}}}, icon_home, show_first_view, nullptr, nullptr, true},
    {"show-all", for_translation("Show everything"), for_translation("Fits all molecules into the picture."), Menu::View, {{{Key::A}}}, icon_all, look_at_all, nullptr, nullptr, true},
    {"only-in-hand", for_translation("Only the molecule in hand"), for_translation("Shows only the molecule in hand and what is behind it; or all again."), Menu::View, {{{Key::F}}}, icon_centre, look_at_held_or_all, nullptr, looks_at_held, true},
    {"representation", for_translation("Next representation"), for_translation( "Draws molecules in another way: balls and sticks, cartoon, surface and others."), Menu::View, {{{Key::V}}}, icon_molecule, choose_next_representation},
    {"colours", for_translation("Next colours"), for_translation("Colours atoms by another property."), Menu::View, {{{Key::C}}}, icon_colour, choose_next_colouring},
    {"contacts", for_translation("Contacts"), for_translation("Draws contacts, clashes and salt bridges of what is in hand."), Menu::View, {}, "", toggle_contacts, nullptr, shows_contacts},
    {"residue-forces", for_translation("Forces by residue"), for_translation("Draws the strongest forces of single residues on what is in hand."), Menu::View, {}, "", toggle_forces_by_residue, nullptr, shows_forces_by_residue},
    {"ghost", for_translation("Ghost"), for_translation("Draws the molecule in hand where it was at the start, too."), Menu::View, {}, "", toggle_ghost, nullptr, shows_ghost},
    {"trail", for_translation("Trail"), for_translation("Draws the path of the molecule in hand in the last seconds."), Menu::View, {}, "", toggle_trail, nullptr, shows_trail},
    {"shadows", for_translation("Shadows"), for_translation("Lets molecules cast shadows on each other; drawing takes longer."), Menu::View, {}, "", toggle_shadows, nullptr, shows_shadows},
    {"next-view", for_translation("Next saved view"), for_translation("Flies to the next saved view."), Menu::View, {{{Key::W}}}, "", go_to_next_view},
    {"add-view", for_translation("Save this view"), for_translation("Saves the present view; Ctrl+S writes it to a scene file."), Menu::View, {{{Key::W, false, true}}}, "", add_view},
    {"tour", for_translation("Tour of the saved views"), for_translation("Starts or ends a tour of the saved views."), Menu::View, {{{Key::U}}}, "", begin_or_end_tour, has_views},
    {"panels", for_translation("Panels"), for_translation("Shows or hides all panels and bars."), Menu::View, {{{Key::Tab}}}, "", toggle_docks, nullptr, shows_docks},
    {"dark-theme", for_translation("Dark theme"), for_translation("Light text on dark panels and a dark background."), Menu::View, {}, "", toggle_theme, nullptr, is_dark},
    {"larger-text", for_translation("Larger text"), for_translation("Makes text and panels larger."), Menu::View, {{{Key::Plus, true}}}, "", enlarge_text, nullptr, nullptr, true, true},
    {"smaller-text", for_translation("Smaller text"), for_translation("Makes text and panels smaller."), Menu::View, {{{Key::Minus, true}}}, "", reduce_text, nullptr, nullptr, true, true},
    {"usual-text", for_translation("Usual text size"), for_translation("Makes text and panels as large as the display asks for."), Menu::View, {{{Key::Digit0, true}}}, "", reset_text, nullptr, nullptr, true, true},
    {"restart-graphics", for_translation("Restart the graphics"), for_translation("Sets the graphics device up again."), Menu::View, {{{Key::F5}}}, "", restart_graphics, nullptr, nullptr, true, true},
    // ---- Select
    {"select", for_translation("Select atoms..."), for_translation("Selects atoms by an expression; Ctrl+drag selects those in a box."), Menu::Select, {{{Key::F, true}}}, "", open_select_panel},
    {"centre", for_translation("Centre the selection"), for_translation("Flies to the selected atoms, or to the ligand."), Menu::Select, {{{Key::F, false, true}}}, "", look_at_selected_or_ligand},
    {"select-nothing", for_translation("Select nothing"), for_translation("Clears the selection."), Menu::Select, {}, "", select_nothing, has_selection},
    {"measure", for_translation("Measure"), for_translation("Measures by clicks: two atoms give a distance, three an angle, four a dihedral."), Menu::Select, {{{Key::I}}}, "", measure_or_end, has_frame, measures},
    {"remove-measures", for_translation("Remove all measures"), for_translation("Removes all measures from the picture."), Menu::Select, {}, "", remove_measures, has_measures},
    // ---- Simulate
    {"pause", for_translation("Pause"), for_translation("While paused, nothing moves and the hand feels no force."), Menu::Simulate, {{{Key::P}}}, icon_pause, pause_or_go_on, nullptr, is_paused},
    {"step", for_translation("One step"), for_translation("Makes one step of the simulation, then pauses."), Menu::Simulate, {{{Key::Period}}}, icon_step, step_once},
    {"reset", for_translation("Reset"), for_translation("Puts molecules and view back to their start; the settings stay."), Menu::Simulate, {{{Key::R}}}, icon_reset, reset_scene},
    {"relax", for_translation("Relax"), for_translation("Brings everything that no hand holds to where no force is left."), Menu::Simulate, {}, "", relax, can_relax},
    {"mode-1", for_translation("Mode 1: variable force and displacement gain"), for_translation("The paper's eq. 2 and eq. 3."), Menu::Simulate, {{{Key::Digit1}}}, "", choose_mode<CouplingMode::VariableForceVariableDisplacement>, nullptr, is_mode<CouplingMode::VariableForceVariableDisplacement>},
    {"mode-2", for_translation("Mode 2: variable force gain"), for_translation("The paper's eq. 2 with a constant displacement gain."), Menu::Simulate, {{{Key::Digit2}}}, "", choose_mode<CouplingMode::VariableForceConstantDisplacement>, nullptr, is_mode<CouplingMode::VariableForceConstantDisplacement>},
    {"mode-3", for_translation("Mode 3: variable displacement gain"), for_translation("The paper's eq. 3 with a constant force gain."), Menu::Simulate, {{{Key::Digit3}}}, "", choose_mode<CouplingMode::ConstantForceVariableDisplacement>, nullptr, is_mode<CouplingMode::ConstantForceVariableDisplacement>},
    {"mode-4", for_translation("Mode 4: constant gains"), for_translation("Both gains are constant."), Menu::Simulate, {{{Key::Digit4}}}, "", choose_mode<CouplingMode::ConstantForceConstantDisplacement>, nullptr, is_mode<CouplingMode::ConstantForceConstantDisplacement>},
    {"mode-5", for_translation("Mode 5: no force"), for_translation("The hand leads the molecule and feels nothing."), Menu::Simulate, {{{Key::Digit5}}}, "", choose_mode<CouplingMode::NoForce>, nullptr, is_mode<CouplingMode::NoForce>},
    {"guarded", for_translation("Mode 6: guarded coupling"), for_translation("The 1 kHz servo itself moves the molecule in the force field around it."), Menu::Simulate, {{{Key::Digit6}}}, "", choose_mode<CouplingMode::Guarded>, nullptr, is_mode<CouplingMode::Guarded>},
    {"next-device", for_translation("Another device"), for_translation("Takes the next connected device into the hand."), Menu::Simulate, {{{Key::D}}}, "", choose_next_device, can_choose_device},
    {"sound", for_translation("Hear the force"), for_translation("Plays the force on the hand as a tone, higher and louder for a stronger force, clicks at snaps, and shakes a game pad."), Menu::Simulate, {{{Key::S}}}, icon_sound, choose_sound, nullptr, sounds},
    {"play-trajectory", for_translation("Play the trajectory"), for_translation("Plays or stops the trajectory."), Menu::Simulate, {{{Key::T}}}, "", play_or_stop_trajectory, has_playback},
    {"trajectory-start", for_translation("Trajectory from the start"), for_translation("Goes back to the first frame of the trajectory."), Menu::Simulate, {{{Key::T, false, true}}}, "", play_trajectory_from_start, has_playback},
    // ---- Lesson
    {"lesson", for_translation("Lesson"), for_translation("Shows or hides the lesson of the scene."), Menu::Lesson, {{{Key::L}}}, "", toggle_lesson, has_lesson, shows_lesson},
    {"next-step", for_translation("Next step"), for_translation("Goes to the next step of the lesson, if this one is done; from the end, to the next lesson."), Menu::Lesson, {{{Key::Enter}, {Key::N}}}, "", go_on_in_lesson, has_lesson},
    {"skip-step", for_translation("Skip this step"), for_translation("Goes to the next step of the lesson, done or not."), Menu::Lesson, {}, "", skip_step, is_in_lesson},
    {"restart-lesson", for_translation("From the start"), for_translation("Begins the lesson again, with the scene as at the start."), Menu::Lesson, {}, "", restart_lesson, has_lesson},
    // ---- Help
    {"search", for_translation("Search actions and keys..."), for_translation("Finds every action and every key of scene files."), Menu::Help, {{{Key::K, true}}}, icon_search, open_search},
    {"keys", for_translation("Keys and mouse"), for_translation("Lists all keys and uses of the mouse."), Menu::Help, {{{Key::H}, {Key::F1}}}, "", toggle_keys, nullptr, shows_keys},
    {"back", for_translation("Back"), for_translation("Closes what was opened last, ends a tour, clears the selection."), Menu::Help, {{{Key::Escape}}}, "", go_back, nullptr, nullptr, true},
});
// clang-format on

constexpr auto gestures = std::to_array<Gesture>({
    {for_translation("click on an atom"), for_translation("take its molecule in hand")},
    {for_translation("Shift+click"), for_translation("hold its residue by a spring")},
    {for_translation("Ctrl+click"), for_translation("hold this atom by a spring")},
    {for_translation("hold Space, move the mouse"),
     for_translation("take the molecule in hand and pull it")},
    {for_translation("hold Space, turn the wheel"), for_translation("push it away, pull it near")},
    {for_translation("arrows, Page up, Page down"),
     for_translation("pull it, or what the second hand holds; slowly with Shift")},
    {for_translation("drag"), for_translation("turn the view")},
    {for_translation("right drag, Shift+drag"), for_translation("shift the view")},
    {for_translation("wheel"), for_translation("zoom in on the place under the cursor, zoom out")},
    {for_translation("Ctrl+drag"),
     for_translation("select the atoms in the box; Shift adds to the selection")},
    {for_translation("point at an atom"), for_translation("show its name")},
    {for_translation("Alt+click, right click"),
     for_translation("label an atom; once more removes the label")},
    {for_translation("double click on an atom"), for_translation("centre it")},
    {for_translation("Ctrl+click on a slider"), for_translation("type a number")},
    {for_translation("drop a file on the window"), for_translation("add its molecule, or open it")},
});

constexpr std::array<const char*, menus> menu_names{
    for_translation("File"),   for_translation("Edit"),     for_translation("View"),
    for_translation("Select"), for_translation("Simulate"), for_translation("Lesson"),
    for_translation("Help")};

// Names of keys that are not letters.
struct KeyName {
    Key key;
    const char* name;
};
constexpr auto key_names = std::to_array<KeyName>({{Key::Enter, for_translation("Enter")},
                                                   {Key::Escape, for_translation("Esc")},
                                                   {Key::Tab, "Tab"},
                                                   {Key::Home, for_translation("Home")},
                                                   {Key::Insert, for_translation("Insert")},
                                                   {Key::Delete, for_translation("Delete")},
                                                   {Key::F1, "F1"},
                                                   {Key::F5, "F5"},
                                                   {Key::F9, "F9"},
                                                   {Key::F12, "F12"},
                                                   {Key::Period, "."},
                                                   {Key::Plus, "+"},
                                                   {Key::Minus, "-"}});

std::string name_of_key(Key key) {
    for (const KeyName& each : key_names)
        if (each.key == key) return translated(each.name);
    const auto behind = [&](Key first) { return static_cast<int>(key) - static_cast<int>(first); };
    if (key >= Key::Digit0 && key <= Key::Digit6)
        return std::string(1, static_cast<char>('0' + behind(Key::Digit0)));
    return std::string(1, static_cast<char>('A' + behind(Key::A)));
}

}  // namespace

std::span<const Action> list_actions() noexcept { return actions; }
std::span<const Gesture> list_gestures() noexcept { return gestures; }

const Action& action_called(std::string_view id) noexcept {
    const auto* const found = std::ranges::find(actions, id, &Action::id);
    PALPA_ASSERT(found != actions.end());
    return *found;
}

const Action* find_action(const KeyPress& press) noexcept {
    const Action* found = nullptr;
    for (const Action& action : actions)
        for (const KeyChord& chord : action.keys) {
            if (chord.key != press.key || chord.control != press.control) continue;
            if (chord.shift && press.shift) return &action;
            if (!chord.shift) found = &action;
        }
    return found;
}

bool is_possible(const World& app, const Action& action) {
    return !action.is_possible || action.is_possible(app);
}

void perform(World& app, const Action& action, By by) {
    if ((is_study(app) && !action.in_study) || !is_possible(app, action)) return;
    if (options_of(app).note_action) options_of(app).note_action(action, by);
    action.act(app);
}

void perform(World& app, std::string_view id, By by) { perform(app, action_called(id), by); }

const char* name_of(Menu menu) noexcept { return menu_names[static_cast<std::size_t>(menu)]; }

std::string name_of(const KeyChord& chord) {
    if (!chord) return {};
    return std::string(chord.control ? translated("Ctrl+") : "") +
           (chord.shift ? translated("Shift+") : "") + name_of_key(chord.key);
}

std::string keys_of(const Action& action) {
    std::string keys;
    for (const KeyChord& chord : action.keys)
        if (chord) keys += (keys.empty() ? "" : ", ") + name_of(chord);
    return keys;
}

}  // namespace palpa
