// The panels of the window as one list. Each panel is one file of app/panels/ with its state, texts
// and actions; a new one is that file and one line of panels.cpp. Menu bar, toolbar, status bar and
// the docks at the left, right and bottom are laid out here; the picture has what they leave.
#pragma once
#include "app/actions.h"
#include "ecs/world.h"
#include "ui/layout.h"
#include "window/window.h"

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

enum class Side { Left, Right, Bottom, Over };

struct Panel {
    std::string_view id;   // "tree"
    const char* title;     // in English
    const char* explains;  // what it has, for tooltip and search, in English
    const char* icon;      // a character of ui/icons.h
    Side side;
    void (*draw)(World& app);                      // describes its content to the overlay library
    bool (*is_there)(const World& app) = nullptr;  // null: always
    bool is_open = true;                           // at the start
    void (*take_keys)(World& app) = nullptr;       // gives the keys to its field
    bool (*press)(World& app, const KeyPress& press) = nullptr;  // true if it takes the key
};

std::span<const Panel* const> list_panels() noexcept;

// A wish of a panel, done once the frame is drawn: an action may set the graphics up again.
using PanelRequest = std::function<void(World& app)>;

// State of the docks.
struct Docks {
    std::map<std::string_view, bool> is_open;      // by panel
    std::map<Side, std::string_view> front;        // the panel in front
    std::map<Side, std::string_view> wants_front;  // from the next frame on
    int last_frame = 0;          // of the overlay library, which begins anew with the graphics
    std::map<Side, float> size;  // pixels at the usual size of text, as a person set it; 0: usual
    std::map<Side, bool> is_folded;
    bool is_shown = true;  // docks, menu, toolbar and status bar
    ScreenArea picture;    // what they left at the last drawing, pixels
    std::vector<PanelRequest> requests;

    // The area that they leave of a window of this size.
    ScreenArea picture_area(float width, float height) const;
};

// The docks with panels as list_docks had them; lines that no panel understands are ignored.
Docks build_docks(std::span<const std::string> kept = {});
// Lists what a person has changed: "left 240" (pixels at the usual size of text), "right folded",
// "left unfolded", "plots open", "lesson closed".
std::vector<std::string> list_docks(const Docks& docks);

// Describes all panels to the overlay library; returns what they ask for.
std::vector<PanelRequest> draw_panels(World& app);

// Asks for something, or for an action, once the frame is drawn.
void request(World& app, PanelRequest what);
void request(World& app, const Action& action, By by = By::Panel);

// Opens a panel and brings it to the front of its dock, which may be hidden or folded.
void bring_forward(World& app, std::string_view id);
// Shows it in any case, because a person asks for it; `takes_keys`: its field, if it has one, gets
// the keys.
void open_panel(World& app, std::string_view id, bool takes_keys = false);
void close_panel(World& app, std::string_view id);
bool is_panel_open(const World& app, std::string_view id);
// Whether it is in front of its dock, and docks are shown.
bool is_panel_seen(const World& app, std::string_view id);
void toggle_panel(World& app, std::string_view id);

// Closes what was opened last: a list, a panel over the picture. False if nothing is open.
bool close_something(World& app);

// True while a text field has the keys.
bool types_text();
// Gives a key to the panels; true if one takes it.
bool press_in_panels(World& app, const KeyPress& press);

// The state of a panel, made when it is first asked for.
template <class State>
State& panel_state(World& app) {
    if (!app.find_resource<State>()) app.set_resource(State{});
    return app.write<State>();
}

}  // namespace palpa
