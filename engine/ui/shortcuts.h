// The list of keyboard shortcuts: used by the window and shown in the help.
#pragma once
#include "window/window.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

enum class Action {
    PauseOrGo,
    StartScreen,
    StepOnce,
    Reset,
    Mode1,
    Mode2,
    Mode3,
    Mode4,
    Mode5,
    Guarded,
    Undo,
    Redo,
    Release,
    PutBack,
    OtherHand,
    Add,
    Remove,
    Record,
    NextRepresentation,
    NextColouring,
    Focus,
    FrameAll,
    FirstView,
    Select,
    FocusSelected,
    NextView,
    AddView,
    Tour,
    ToggleOverlay,
    ToggleLesson,
    ToggleHelp,
    NextLessonStep,
    NextDevice,
    ToggleSound,
    Screenshot,
    Film,
    Export,
    PlayTrajectory,
    TrajectoryStart,
    Save,
    LargerText,
    SmallerText,
    UsualText,
    RestartGraphics,
    Quit
};

struct Shortcut {
    Key key;
    bool control;  // with the Ctrl key
    Action action;
    std::string_view name;  // name of the key in the help
    std::string_view does;
    bool shift = false;  // true: with Shift; false: with or without
};

// All shortcuts.
std::span<const Shortcut> shortcuts() noexcept;

// Other uses of mouse and keys, for the help.
struct Gesture {
    std::string_view name, does;
};

std::optional<Action> find_action(Key key, bool control, bool shift = false) noexcept;

// All lines of the help in its language; the keys of one action stand together.
struct HelpLine {
    std::string keys, does;
};
std::vector<HelpLine> list_help();

}  // namespace palpa
