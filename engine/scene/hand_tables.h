// The hands of a scene file as one list of tables, whichever way they are written or set.
#pragma once
#include "core/load_error.h"

#include <toml++/toml.h>
#include <string>
#include <utility>

namespace palpa {

// Lays `from` over `onto`, table by table. Moves, since copies of a node forget where they stood.
void merge(toml::table from, toml::table& onto);

// Makes [hand] and [grab] the first entry of [[hand]] where there is [second.hand] or
// [second.grab], which were a second hand until format 2.1 and becomes the second entry. Makes a
// list of one hand [hand] and [grab].
void gather_hands(toml::table& root);

// The table and the key in it that a setting's full key means: that of "hand[2].grab.atom" or
// "second.grab.atom" is in the second entry of [[hand]], which is added where there is one hand.
// Throws LoadError for a hand that is none.
std::pair<toml::table*, std::string> find_table_of(const std::string& key, const TextPlace& place,
                                                   toml::table& root);

}  // namespace palpa
