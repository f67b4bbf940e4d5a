// The hands of a scene file as one list of tables, whichever way they are written or set.
#pragma once
#include "core/load_error.h"

#include <toml++/toml.h>
#include <string>
#include <string_view>
#include <utility>

namespace palpa {

// Lays `from` over `onto`, table by table. Moves the nodes, since copies lose their source place.
void merge(toml::table from, toml::table& onto);

// Reads [second.hand] and [second.grab], the second hand until format 2.1, as the second entry of
// [[hand]], and [hand] and [grab] as the first. One hand, in a list or with [hand.grab], becomes
// [hand] and [grab]. Throws LoadError if the first hand has both [grab] and [hand.grab].
void gather_hands(toml::table& root);

// True for a key of a second or further hand: "hand[2].stroke", "second.grab.atom".
bool names_further_hand(std::string_view key);

// The table, and the key in it, of a setting's full key: those of "hand[2].grab.atom" and
// "second.grab.atom" are in the second entry of [[hand]], which is added to a scene of one hand.
// Throws LoadError for the number of a hand that the scene cannot have.
std::pair<toml::table*, std::string> find_table_of(const std::string& key, const TextPlace& place,
                                                   toml::table& root);

}  // namespace palpa
