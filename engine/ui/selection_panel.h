// The panel "Select": which atoms, and what is done with them.
#pragma once
#include "core/translate.h"
#include "scene/choices.h"
#include "ui/layout.h"
#include "ui/view_additions.h"
#include "window/window.h"

#include <optional>
#include <string>

namespace palpa {

inline constexpr const char* selection_panel = for_translation("Select");

// What is selected at the moment.
struct SelectionStatus {
    std::string expression;  // empty: nothing is
    std::string count;       // "12 residues, 180 atoms"
    std::string problem;     // of the expression that was asked for last, with its column
};

// What the person asked for.
struct SelectionOrder {
    std::optional<std::string> select;       // this expression; empty: nothing
    std::optional<ViewAdditions> additions;  // from now on
    bool focus = false;                      // look at what is selected
};

class SelectionPanel {
public:
    // The field takes the keys.
    void open();
    void close();
    bool is_open() const noexcept { return is_open_; }
    // It was opened, and its field is not there yet.
    bool awaits_keys() const noexcept { return awaits_keys_; }

    // A key while a field has the keys: where it is this one, Enter asks for its expression, Esc
    // ends typing. When it is drawn the next time, so that what was typed before counts.
    void press(Key key);

    // Of a selection that was made elsewhere: the field shows it.
    void show(const std::string& expression);

    // Describes it to the overlay library, at the lower edge of the area.
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
    std::optional<Colouring> colouring_;  // as everything
};

}  // namespace palpa
