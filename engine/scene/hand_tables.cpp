#include "scene/hand_tables.h"

#include "core/hands.h"
#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace palpa {
namespace {

// Takes a table out of another; nothing if there is none.
std::optional<toml::table> take_table(std::string_view key, toml::table& from) {
    toml::table* const inner = from[key].as_table();
    if (!inner) return std::nullopt;
    toml::table taken = std::move(*inner);
    from.erase(key);
    return taken;
}

// Moves a part of a hand from the scene's tables into the hand's, unless the hand has that part.
void move_into(std::string_view key, toml::table& from, toml::table& hand) {
    if (hand.contains(key)) return;
    if (std::optional<toml::table> part = take_table(key, from)) hand.insert(key, std::move(*part));
}

// The list of hands, made of [hand] and [grab] if need be. Null if `hand` is no table.
toml::array* list_of_hands(toml::table& root) {
    if (toml::array* const list = root["hand"].as_array()) return list;
    if (root.contains("hand") && !root["hand"].is_table()) return nullptr;
    toml::table first = take_table("hand", root).value_or(toml::table());
    move_into("grab", root, first);
    toml::array list;
    list.push_back(std::move(first));
    return root.insert_or_assign("hand", std::move(list)).first->second.as_array();
}

// A second hand as files until format 2.1 have it: its keys are in [second.hand].
toml::table take_second(toml::table& root) {
    toml::table second = *take_table("second", root);
    std::optional<toml::table> hand = take_table("hand", second);
    if (!hand) return second;
    merge(std::move(second), *hand);
    return std::move(*hand);
}

// Throws LoadError if the first hand's grip is given twice.
void check_grab(const toml::table& hand, const toml::table& root) {
    const toml::node* const grab = hand.get("grab");
    if (!grab || !root.contains("grab")) return;
    const toml::source_region& source = grab->source();
    throw LoadError({source.path ? *source.path : "", source.begin.line, source.begin.column},
                    "the first hand has a table [grab] and a table [hand.grab]; expected one");
}

// Moves the grip, device and coupling of the only hand into the tables of the scene.
void move_parts_out(toml::table& hand, toml::table& root) {
    for (const std::string_view part : {"grab", "device", "coupling"}) {
        std::optional<toml::table> own = take_table(part, hand);
        if (!own) continue;
        toml::table outer;
        outer.insert(part, std::move(*own));
        merge(std::move(outer), root);
    }
}

// Writes a list of one hand as the tables that one hand has.
void flatten(toml::table& root) {
    toml::array* const list = root["hand"].as_array();
    if (!list || list->size() != 1 || !list->front().is_table()) return;
    toml::table hand = std::move(*list->front().as_table());
    move_parts_out(hand, root);
    root.insert_or_assign("hand", std::move(hand));
}

// The number in "hand[2]", from 1.
std::optional<std::int64_t> find_hand_number(std::string_view word) {
    constexpr std::string_view begin = "hand[";
    if (!word.starts_with(begin) || !word.ends_with(']')) return std::nullopt;
    word = word.substr(begin.size(), word.size() - begin.size() - 1);
    const std::optional<std::int64_t> number = find_integer(word);
    return number && std::to_string(*number) == word ? number : std::nullopt;
}

}  // namespace

void merge(toml::table from, toml::table& onto) {
    for (auto&& [key, node] : from) {
        toml::table* const inner = node.as_table();
        toml::node* const old = onto.get(key.str());
        if (inner && old && old->is_table()) {
            merge(std::move(*inner), *old->as_table());
        } else {
            node.visit([&, &k = key](auto& value) { onto.insert_or_assign(k, std::move(value)); });
        }
    }
}

void gather_hands(toml::table& root) {
    if (root["second"].is_table()) {
        toml::array* const list = list_of_hands(root);
        if (list && list->size() == 1) list->push_back(take_second(root));
    }
    if (toml::table* const only = root["hand"].as_table()) {
        check_grab(*only, root);
        return move_parts_out(*only, root);
    }
    toml::array* const list = root["hand"].as_array();
    if (!list || list->empty() || !list->front().is_table()) return;
    check_grab(*list->front().as_table(), root);
    move_into("grab", root, *list->front().as_table());
    flatten(root);
}

bool names_further_hand(std::string_view key) {
    const std::string_view word = trimmed(key.substr(0, key.find('.')));
    return word == "second" || find_hand_number(word).value_or(1) > 1;
}

std::pair<toml::table*, std::string> find_table_of(const std::string& key, const TextPlace& place,
                                                   toml::table& root) {
    const std::size_t dot = key.find('.');
    std::string word(trimmed(std::string_view(key).substr(0, dot)));
    if (word == "\"hand\"" || word == "'hand'") word = "hand";
    std::string rest = dot == key.npos ? "" : key.substr(dot + 1);
    const bool has_list = root["hand"].is_array();
    std::optional<std::int64_t> number = find_hand_number(word);
    if (word == "second") {
        number = 2;
        if (rest.starts_with("hand.")) rest.erase(0, 5);
    } else if (word == "hand") {
        number = 1;
    } else if (has_list && word == "grab") {
        number = 1;
        rest = key;
    }
    if (!number || rest.empty()) return {&root, key};
    if (*number == 1 && !has_list) {
        const std::string part = rest.substr(0, rest.find('.'));
        const bool is_outside = part == "grab" || part == "device" || part == "coupling";
        return {&root, is_outside ? rest : "hand." + rest};
    }
    toml::array* const list = list_of_hands(root);
    if (!list) return {&root, key};
    const auto count = static_cast<std::int64_t>(list->size());
    const auto most = static_cast<std::int64_t>(most_hands);
    if (*number == count + 1 && *number <= most) list->push_back(toml::table());
    if (*number < 1 || *number > static_cast<std::int64_t>(list->size())) {
        throw LoadError(place, fmt::format("the scene has no {}; expected hand[1] to hand[{}]",
                                           word, std::min(count + 1, most)));
    }
    toml::table* const hand = list->get(static_cast<std::size_t>(*number - 1))->as_table();
    if (!hand) return {&root, key};
    return {hand, rest};
}

}  // namespace palpa
