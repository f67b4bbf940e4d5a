#include "ui/shortcuts.h"

#include <catch2/catch.hpp>
#include <set>
#include <tuple>

using namespace palpa;

TEST_CASE("every key means one thing, and the help tells it", "[ui]") {
    std::set<std::tuple<Key, bool, bool>> seen;
    for (const Shortcut& shortcut : shortcuts()) {
        CHECK(seen.emplace(shortcut.key, shortcut.control, shortcut.shift).second);
        CHECK(find_action(shortcut.key, shortcut.control, shortcut.shift) == shortcut.action);
        CHECK_FALSE(shortcut.name.empty());
        CHECK_FALSE(shortcut.does.empty());
    }
    // The hand's own keys start nothing else.
    for (const Key key :
         {Key::Space, Key::Left, Key::Right, Key::Up, Key::Down, Key::PageUp, Key::PageDown}) {
        CHECK_FALSE(find_action(key, false));
    }
    CHECK_FALSE(find_action(Key::P, true));
    // Shift matters only where a key says so: a plus needs it on many keyboards.
    CHECK(find_action(Key::Plus, true, true) == Action::LargerText);
    CHECK(find_action(Key::Z, true, true) == Action::Redo);
    CHECK(find_action(Key::Z, true, false) == Action::Undo);
    // Letters that do something else with Ctrl or Shift.
    CHECK(find_action(Key::F, false) == Action::Focus);
    CHECK(find_action(Key::F, false, true) == Action::FocusSelected);
    CHECK(find_action(Key::F, true) == Action::Select);
    CHECK(find_action(Key::W, false) == Action::NextView);
    CHECK(find_action(Key::W, false, true) == Action::AddView);
    CHECK_FALSE(find_action(Key::W, true));  // closes windows elsewhere
    CHECK(find_action(Key::U, false) == Action::Tour);
}
