// Saved views of the window, the way from one to the next, and the tour of them.
#pragma once
#include "ecs/world.h"

#include <cstddef>
#include <string>
#include <vector>

namespace palpa {

void go_to_view(World& app, std::size_t number);
void go_to_next_view(World& app);
// Saves the present view, around what the view before looked at.
void add_view(World& app);
void begin_or_end_tour(World& app);
bool end_tour(World& app);  // false if there is none
void follow_tour(World& app);

// The atoms that a selection names; none if it is wrong: then SavedViewState::problem says why.
const std::vector<bool>& find_framed(World& app, const std::string& selection);

}  // namespace palpa
