// The panel "Select": selects atoms and acts on them.
#pragma once
#include "core/translate.h"
#include "scene/choices.h"
#include "session/view_additions.h"
#include "ui/layout.h"
#include "window/window.h"

#include <optional>
#include <string>

namespace palpa {

inline constexpr const char* selection_panel = for_translation("Select");

// The present selection.
struct SelectionStatus {
    std::string expression;  // empty: nothing is selected
    std::string count;       // "12 residues, 180 atoms"
    std::string problem;     // problem with the last requested expression, with its column
};

// The person's requests.
struct SelectionOrder {
    std::optional<std::string> select;       // select this expression; empty: nothing
    std::optional<ViewAdditions> additions;  // new additions to the picture
    bool focus = false;                      // move the camera to the selection
};

class SelectionPanel {
public:
    // Gives the keyboard to the field.
    void open();
    void close();
    bool is_open() const noexcept { return is_open_; }
    // True if it was opened and its field is not drawn yet.
    bool awaits_keys() const noexcept { return awaits_keys_; }

    // Handles a key while a field has the keyboard: in this panel's field Enter requests its
    // expression and Esc ends typing. Takes effect at the next drawing, so that text typed before
    // counts.
    void press(Key key);

    // Shows a selection made elsewhere in the field.
    void show(const std::string& expression);

    // Describes the panel to the overlay library, at the lower edge of the area.
    SelectionOrder draw(const SelectionStatus& status, const ViewAdditions& additions,
                        const ScreenArea& area);

private:
    void type_expression(const SelectionStatus& status, SelectionOrder& order);
    void choose_look();
    void draw_buttons(const SelectionStatus& status, const ViewAdditions& additions,
                      SelectionOrder& order);
    void list_additions(const ViewAdditions& additions, SelectionOrder& order);

    bool is_open_ = false, wants_focus_ = false, awaits_keys_ = false;
    std::optional<Key> pressed_;
    std::string text_;
    Representation representation_ = Representation::Licorice;
    std::optional<Colouring> colouring_;  // nothing: the colouring of everything
};

}  // namespace palpa
