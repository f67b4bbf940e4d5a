// Edits that a person makes in the window: by clicks on atoms, by keys, by files that are dropped.
#pragma once
#include "ecs/world.h"
#include "scene/edits.h"
#include "window/window.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

// The atom at a pixel of the window; none on the background or a sign.
std::optional<std::uint32_t> find_atom(World& app, double x, double y);
// Names the atom and what clicks on it do.
std::string describe_atom(const World& app, std::uint32_t atom);

// Tells so and returns true in a recorded session, which is played as it was.
bool refuse_in_replay(World& app);
// Sends an edit by a hand, the one that the mouse leads if none is named; hands pull at nothing
// from then on. Refuses it in a recorded session.
void edit_scene(World& app, EditAction action, std::optional<std::size_t> hand = {});
// Does so once the frame is drawn.
void request_edit(World& app, EditAction action);

// A click takes what is there, unless another one follows and makes both a double click.
void click_atom(World& app, const MouseClick& click);
void take_clicked(World& app);  // call once a frame
void release_held(World& app);
void put_back_held(World& app);
void remove_held(World& app);
void undo(World& app);
void redo(World& app);

// Opens the dialog "Add a molecule", and adds what it asks for near the middle of the picture.
void open_add_panel(World& app);
void add_molecule(World& app, AddEdit wanted);
// Asks what to do with files that were dropped on the window.
void take_dropped(World& app, const std::vector<std::filesystem::path>& files);

// Tells what became of an announced edit; call once a new frame.
void tell_of_edit(World& app);

// The molecule in hand; empty if there is none.
std::string molecule_in_hand(const World& app);

}  // namespace palpa
