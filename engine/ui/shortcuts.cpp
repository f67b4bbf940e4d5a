#include "ui/shortcuts.h"

#include "core/translate.h"

#include <array>

namespace palpa {
namespace {

constexpr std::array list = std::to_array<Shortcut>({
    {Key::P, false, Action::PauseOrGo, "P", for_translation("pause, continue")},
    {Key::Period, false, Action::StepOnce, ".", for_translation("one simulation step")},
    {Key::R, false, Action::Reset, "R", for_translation("molecules and view back to the start")},
    {Key::Z, true, Action::Undo, for_translation("Ctrl+Z"),
     for_translation("undo a change, a grip or a pull")},
    {Key::Z, true, Action::Redo, for_translation("Ctrl+Shift+Z"), for_translation("redo"), true},
    {Key::Y, true, Action::Redo, for_translation("Ctrl+Y"), for_translation("redo")},
    {Key::G, false, Action::Release, "G", for_translation("let go of the molecule in hand")},
    {Key::R, false, Action::PutBack, for_translation("Shift+R"),
     for_translation("put the molecule in hand back to where it was"), true},
    {Key::X, false, Action::OtherHand, "X", for_translation("switch the mouse to the other hand")},
    {Key::Insert, false, Action::Add, for_translation("Insert"), for_translation("add a molecule")},
    {Key::Delete, false, Action::Remove, for_translation("Delete"),
     for_translation("remove the molecule in hand")},
    {Key::F9, false, Action::Record, "F9", for_translation("start or end recording the session")},
    {Key::T, false, Action::PlayTrajectory, "T", for_translation("trajectory: play, stop")},
    {Key::T, false, Action::TrajectoryStart, for_translation("Shift+T"),
     for_translation("trajectory: from the start"), true},
    {Key::Digit1, false, Action::Mode1, "1",
     for_translation("variable force and displacement gain")},
    {Key::Digit2, false, Action::Mode2, "2", for_translation("variable force gain")},
    {Key::Digit3, false, Action::Mode3, "3", for_translation("variable displacement gain")},
    {Key::Digit4, false, Action::Mode4, "4", for_translation("constant gains")},
    {Key::Digit5, false, Action::Mode5, "5", for_translation("no force")},
    {Key::Digit6, false, Action::Guarded, "6", for_translation("guarded coupling")},
    {Key::O, true, Action::StartScreen, for_translation("Ctrl+O"),
     for_translation("open another scene, or a file of your own")},
    {Key::S, true, Action::Save, for_translation("Ctrl+S"),
     for_translation("save the scene with its present settings to a new file")},
    {Key::V, false, Action::NextRepresentation, "V", for_translation("next representation")},
    {Key::C, false, Action::NextColouring, "C", for_translation("next colouring")},
    {Key::F, false, Action::Focus, "F",
     for_translation("show only the molecule in hand; show all again")},
    {Key::F, true, Action::Select, for_translation("Ctrl+F"),
     for_translation("select atoms by an expression")},
    {Key::F, false, Action::FocusSelected, for_translation("Shift+F"),
     for_translation("centre the selection, or the ligand"), true},
    {Key::Home, false, Action::FirstView, for_translation("Home"),
     for_translation("back to the first view")},
    {Key::W, false, Action::NextView, "W", for_translation("next saved view")},
    {Key::W, false, Action::AddView, for_translation("Shift+W"),
     for_translation("save this view (Ctrl+S writes it to a file)"), true},
    {Key::U, false, Action::Tour, "U", for_translation("start or end a tour of the saved views")},
    {Key::A, false, Action::FrameAll, "A", for_translation("show everything")},
    {Key::O, false, Action::ToggleOverlay, "O", for_translation("panels on, off")},
    {Key::Tab, false, Action::ToggleOverlay, "Tab", for_translation("panels on, off")},
    {Key::Enter, false, Action::NextLessonStep, "Enter",
     for_translation("next step of the lesson")},
    {Key::N, false, Action::NextLessonStep, "N", for_translation("next step of the lesson")},
    {Key::L, false, Action::ToggleLesson, "L", for_translation("lesson on, off")},
    {Key::H, false, Action::ToggleHelp, "H", for_translation("this list")},
    {Key::F1, false, Action::ToggleHelp, "F1", for_translation("this list")},
    {Key::D, false, Action::NextDevice, "D", for_translation("next device")},
    {Key::S, false, Action::ToggleSound, "S", for_translation("force as a tone on, off")},
    {Key::Plus, true, Action::LargerText, for_translation("Ctrl++"),
     for_translation("larger text")},
    {Key::Minus, true, Action::SmallerText, for_translation("Ctrl+-"),
     for_translation("smaller text")},
    {Key::Digit0, true, Action::UsualText, for_translation("Ctrl+0"),
     for_translation("usual text size")},
    {Key::F12, false, Action::Screenshot, "F12", for_translation("screenshot")},
    {Key::M, false, Action::Film, "M", for_translation("start or end a film of the window")},
    {Key::E, false, Action::Export, "E", for_translation("save coordinates for other programs")},
    {Key::F5, false, Action::RestartGraphics, "F5", for_translation("set the graphics up again")},
    {Key::Escape, false, Action::Quit, "Esc",
     for_translation("close a list; clear a selection; quit")},
});

constexpr std::array gesture_list = std::to_array<Gesture>({
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

std::string in_language(std::string_view literal) { return translated(literal.data()); }

}  // namespace

std::span<const Shortcut> shortcuts() noexcept { return list; }

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
        lines.push_back({in_language(gesture.name), in_language(gesture.does)});
    }
    const Shortcut* before = nullptr;
    for (const Shortcut& shortcut : list) {
        if (before && before->action == shortcut.action) {
            lines.back().keys += ", " + in_language(shortcut.name);
        } else {
            lines.push_back({in_language(shortcut.name), in_language(shortcut.does)});
        }
        before = &shortcut;
    }
    return lines;
}

}  // namespace palpa
