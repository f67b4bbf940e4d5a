// What a person may do with a key, in one list: the window obeys it, the help shows it.
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
    LetGo,
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
    bool control;  // with Ctrl
    Action action;
    std::string_view name;  // as the help shows the key
    std::string_view does;
    bool shift = false;  // with Shift; else it does not matter
};

// Keys that act when pressed.
std::span<const Shortcut> shortcuts() noexcept;

// Everything else that mouse and keys do, for the help.
struct Gesture {
    std::string_view name, does;
};
std::span<const Gesture> gestures() noexcept;

std::optional<Action> find_action(Key key, bool control, bool shift = false) noexcept;

// All of it, for the help, in its language: the keys of one action together.
struct HelpLine {
    std::string keys, does;
};
std::vector<HelpLine> list_help();

}  // namespace palpa
