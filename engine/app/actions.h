// Everything that a person can do in a window, as one list: menus, toolbar, search, the list of
// keys and tests are made from it. A new action is one line of actions.cpp.
#pragma once
#include "ecs/world.h"
#include "window/window.h"

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace palpa {

enum class Menu { File, Edit, View, Select, Simulate, Lesson, Help };
inline constexpr std::size_t menus = 7;

// A key with its modifiers; `shift`: true with Shift, false with or without it.
struct KeyChord {
    Key key = Key::Count;  // Count: none
    bool control = false, shift = false;

    explicit operator bool() const noexcept { return key != Key::Count; }
};

struct Action {
    std::string_view id;   // "pause", for code and tests
    const char* text;      // of the menu, in English
    const char* explains;  // a sentence for tooltip and search, in English
    Menu menu;
    std::array<KeyChord, 2> keys{};
    const char* icon = "";  // in the toolbar, a character of ui/icons.h; empty: not there
    void (*act)(World& app);
    bool (*is_possible)(const World& app) = nullptr;  // null: always
    bool (*is_on)(const World& app) = nullptr;        // of a switch; null: it is none
    bool in_study = false;                            // also for a participant of a study
    bool over_dialogs = false;                        // also while a dialog has the keys
    std::string (*state)(const World&) = nullptr;     // beside its icon; null or empty: nothing
};

// All of them, in the order of their menus.
std::span<const Action> list_actions() noexcept;

// The action of this name, which must exist.
const Action& action_called(std::string_view id) noexcept;

// The action of a key; null if none has it.
const Action* find_action(const KeyPress& press) noexcept;

// How a person asks for an action.
enum class By { Key, Menu, Toolbar, Search, Panel };

// False if the action does nothing now.
bool is_possible(const World& app, const Action& action);
// Does it, if it is possible and the participant of a study may.
void perform(World& app, const Action& action, By by = By::Panel);
void perform(World& app, std::string_view id, By by = By::Panel);

// The title of a menu, in English.
const char* name_of(Menu menu) noexcept;

// The name of a chord in the window's language: "Ctrl+Shift+Z"; empty without a key.
std::string name_of(const KeyChord& chord);
// Names of all keys of an action: "O, Tab".
std::string keys_of(const Action& action);

// Other uses of mouse and keys, for the list of keys; both texts in English.
struct Gesture {
    const char* name;
    const char* does;
};
std::span<const Gesture> list_gestures() noexcept;

}  // namespace palpa
