#include "ui/shortcuts.h"

#include <array>

namespace palpa {
namespace {

constexpr std::array list = std::to_array<Shortcut>({
    {Key::P, false, Action::PauseOrGo, "P", "pause, go on"},
    {Key::Period, false, Action::StepOnce, ".", "one single step"},
    {Key::R, false, Action::Reset, "R", "molecules and view back to the start"},
    {Key::Z, true, Action::Undo, "Ctrl+Z", "undo a change, or what was taken"},
    {Key::Z, true, Action::Redo, "Ctrl+Shift+Z", "do it again", true},
    {Key::Y, true, Action::Redo, "Ctrl+Y", "do it again"},
    {Key::G, false, Action::LetGo, "G", "let go of what is in hand"},
    {Key::X, false, Action::OtherHand, "X", "mouse and clicks: the other of two hands"},
    {Key::Insert, false, Action::Add, "Insert", "add a molecule"},
    {Key::Delete, false, Action::Remove, "Delete", "remove the molecule in hand"},
    {Key::F9, false, Action::Record, "F9", "record the session; end the recording"},
    {Key::T, false, Action::PlayTrajectory, "T", "trajectory: play, stop here"},
    {Key::T, false, Action::TrajectoryStart, "Shift+T", "trajectory: from the beginning", true},
    {Key::Digit1, false, Action::Mode1, "1", "variable force and displacement gain"},
    {Key::Digit2, false, Action::Mode2, "2", "variable force gain"},
    {Key::Digit3, false, Action::Mode3, "3", "variable displacement gain"},
    {Key::Digit4, false, Action::Mode4, "4", "constant gains"},
    {Key::Digit5, false, Action::Mode5, "5", "no force"},
    {Key::Digit6, false, Action::Guarded, "6", "guarded coupling"},
    {Key::O, true, Action::StartScreen, "Ctrl+O", "open another scene, or a file of your own"},
    {Key::S, true, Action::Save, "Ctrl+S", "save the scene as set, to a new file"},
    {Key::V, false, Action::NextRepresentation, "V", "another representation"},
    {Key::C, false, Action::NextColouring, "C", "other colours"},
    {Key::F, false, Action::Focus, "F", "the molecule in hand alone; all again"},
    {Key::F, true, Action::Select, "Ctrl+F", "select atoms, by an expression"},
    {Key::F, false, Action::FocusSelected, "Shift+F", "look at what is selected, or the ligand",
     true},
    {Key::Home, false, Action::FirstView, "Home", "the first view"},
    {Key::W, false, Action::NextView, "W", "the next saved view"},
    {Key::W, false, Action::AddView, "Shift+W", "save this view; Ctrl+S writes it", true},
    {Key::U, false, Action::Tour, "U", "start or end a tour of the saved views"},
    {Key::A, false, Action::FrameAll, "A", "look at everything"},
    {Key::O, false, Action::ToggleOverlay, "O", "overlays on, off"},
    {Key::Tab, false, Action::ToggleOverlay, "Tab", "overlays on, off"},
    {Key::Enter, false, Action::NextLessonStep, "Enter", "next step of the lesson"},
    {Key::N, false, Action::NextLessonStep, "N", "next step of the lesson"},
    {Key::L, false, Action::ToggleLesson, "L", "lesson on, off"},
    {Key::H, false, Action::ToggleHelp, "H", "this list"},
    {Key::F1, false, Action::ToggleHelp, "F1", "this list"},
    {Key::D, false, Action::NextDevice, "D", "another device"},
    {Key::S, false, Action::ToggleSound, "S", "force as a tone on, off"},
    {Key::Plus, true, Action::LargerText, "Ctrl++", "larger text"},
    {Key::Minus, true, Action::SmallerText, "Ctrl+-", "smaller text"},
    {Key::Digit0, true, Action::UsualText, "Ctrl+0", "text as large as usual"},
    {Key::F12, false, Action::Screenshot, "F12", "screenshot"},
    {Key::M, false, Action::Film, "M", "film the window; end the film"},
    {Key::E, false, Action::Export, "E", "save coordinates for other programs"},
    {Key::F5, false, Action::RestartGraphics, "F5", "set the graphics up again"},
    {Key::Escape, false, Action::Quit, "Esc", "close a list, end a selection; quit"},
});

constexpr std::array gesture_list = std::to_array<Gesture>({
    {"click on an atom", "take its molecule in hand"},
    {"Shift+click", "hold its residue by a spring"},
    {"Ctrl+click", "hold this atom by a spring"},
    {"hold Space, move the mouse", "take the molecule in hand and pull it"},
    {"hold Space, turn the wheel", "push it away from you, draw it near"},
    {"arrows, Page up, Page down", "pull it, or what the second hand holds; with Shift slowly"},
    {"drag", "turn the view"},
    {"right drag, Shift+drag", "shift the view"},
    {"wheel", "nearer to what is under the cursor, farther"},
    {"Ctrl+drag", "select what is in the box; Shift adds"},
    {"rest on an atom", "its name"},
    {"Alt+click, right click", "label an atom; again removes it"},
    {"double click on an atom", "look at it"},
    {"Ctrl+click on a slider", "type a number"},
    {"drop a file on the window", "add the molecule in it, or open it"},
});

}  // namespace

std::span<const Shortcut> shortcuts() noexcept { return list; }

std::span<const Gesture> gestures() noexcept { return gesture_list; }

std::optional<Action> find_action(Key key, bool control, bool shift) noexcept {
    std::optional<Action> found;
    for (const Shortcut& shortcut : list) {
        if (shortcut.key != key || shortcut.control != control) continue;
        if (shortcut.shift && shift) return shortcut.action;
        if (!shortcut.shift) found = shortcut.action;
    }
    return found;
}

std::vector<HelpLine> list_help() {
    std::vector<HelpLine> lines;
    for (const Gesture& gesture : gesture_list) {
        lines.push_back({std::string(gesture.name), std::string(gesture.does)});
    }
    const Shortcut* before = nullptr;
    for (const Shortcut& shortcut : list) {
        if (before && before->action == shortcut.action) {
            lines.back().keys += ", " + std::string(shortcut.name);
        } else {
            lines.push_back({std::string(shortcut.name), std::string(shortcut.does)});
        }
        before = &shortcut;
    }
    return lines;
}

}  // namespace palpa
