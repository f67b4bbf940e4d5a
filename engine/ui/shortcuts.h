// What a person may do with a key, in one list: the window obeys it, the help shows it.
#pragma once
#include "platform/window.h"

#include <optional>
#include <span>
#include <string_view>

namespace palpa {

enum class Action {
    PauseOrGo,
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
    NextRepresentation,
    NextColouring,
    Focus,
    FrameAll,
    FirstView,
    ToggleOverlay,
    ToggleLesson,
    ToggleHelp,
    NextDevice,
    ToggleSound,
    Screenshot,
    RestartGraphics,
    Quit
};

struct Shortcut {
    Key key;
    bool control;  // with Ctrl
    Action action;
    std::string_view name;  // as the help shows the key
    std::string_view does;
};

// Keys that act when pressed.
std::span<const Shortcut> shortcuts() noexcept;

// Everything else that mouse and keys do, for the help.
struct Gesture {
    std::string_view name, does;
};
std::span<const Gesture> gestures() noexcept;

std::optional<Action> find_action(Key key, bool control) noexcept;

}  // namespace palpa
