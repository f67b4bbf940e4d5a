#include "session/undo_history.h"

#include "core/load_error.h"
#include "core/text.h"
#include "core/translate.h"
#include "loading/edit.h"
#include "scene/write_scene.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace palpa {
namespace {

// "mode = 3": the key, then the value.
std::pair<std::string_view, std::string_view> split_setting(std::string_view setting) {
    const std::size_t equals = setting.find('=');
    return {trimmed(setting.substr(0, equals)), trimmed(setting.substr(equals + 1))};
}

struct SettingChange {
    std::vector<std::string> keys;
    bool is_of_numbers = true;
};

SettingChange find_change(const LiveSettings& before, const LiveSettings& after) {
    SettingChange change;
    if (before.period_ms != after.period_ms) change.keys.emplace_back("period_ms");
    const std::vector<std::string> old = list_settings(before.coupling),
                                   now = list_settings(after.coupling);
    // Adds the settings that only one of the two has: of another value, or unset in the other.
    const auto add_those_missing = [&](const auto& settings, const auto& in) {
        for (const std::string& setting : settings) {
            if (std::ranges::find(in, setting) != in.end()) continue;
            const auto [key, value] = split_setting(setting);
            if (std::ranges::find(change.keys, key) == change.keys.end())
                change.keys.emplace_back(key);
            change.is_of_numbers =
                change.is_of_numbers && (value.starts_with('[') || find_real(value));
        }
    };
    add_those_missing(now, old);
    add_those_missing(old, now);
    return change;
}

}  // namespace

UndoHistory::Part UndoHistory::apply(World& world, const EditDescription& edit,
                                     PersonChoices& choices) {
    const bool undoes = std::holds_alternative<UndoEdit>(edit.action);
    if (undoes || std::holds_alternative<RedoEdit>(edit.action)) {
        std::deque<Entry>&from = undoes ? undo_ : redo_, &to = undoes ? redo_ : undo_;
        if (from.empty())
            throw LoadError(edit.place,
                            undoes ? "there is nothing to undo" : "there is nothing to redo");
        return go(world, choices, from, to);
    }
    World changed = make_edit(world, edit);
    std::swap(world, changed);
    note_edit(std::move(changed), edit);
    return Part::World;
}

void UndoHistory::apply(World& world, const EditDescription& edit) {
    PersonChoices none;
    apply(world, edit, none);
}

void UndoHistory::adopt(World& world, World changed, const EditDescription& edit) {
    World next = continue_with(world, std::move(changed));
    std::swap(world, next);
    note_edit(std::move(next), edit);
}

void UndoHistory::note_edit(World before, const EditDescription& edit) {
    Entry entry{palpa::undo_name(edit.action), std::move(before)};
    entry.is_of_coupling = kind_of(edit.action).sets_coupling;
    has_changed_coupling_ = entry.is_of_coupling;
    const bool takes = std::holds_alternative<GrabEdit>(edit.action);
    const bool lets_go = std::holds_alternative<ReleaseEdit>(edit.action);
    if (takes || lets_go) {
        const auto ended = std::ranges::find(undo_, edit.hand, &Entry::grip);
        const bool is_last = ended != undo_.end() && std::next(ended) == undo_.end();
        if (ended != undo_.end()) ended->grip.reset();
        // Letting go belongs to the grip if nothing happened between.
        if (lets_go && is_last) {
            redo_.clear();
            ended->edits.push_back(edit);
            return;
        }
    }
    if (takes) entry.grip = edit.hand;
    entry.edits.push_back(edit);
    note(std::move(entry));
}

void UndoHistory::note_pull(World before, const std::string& what) {
    note({format_translated("pull of {}", what), std::move(before)});
}

void UndoHistory::note_settings(const LiveSettings& before, const LiveSettings& after,
                                double time_s) {
    constexpr double together_s = 0.5;
    SettingChange change = find_change(before, after);
    if (change.keys.empty()) return;
    std::string name = format_translated("change of {}", change.keys.front());
    if (change.keys.size() > 1) name = translated("change of settings");
    const auto* const last =
        undo_.empty() ? nullptr : std::get_if<LiveSettings>(&undo_.back().before);
    const bool goes_on = change.is_of_numbers && last && last->hand == before.hand &&
                         undo_.back().slid == change.keys &&
                         time_s - undo_.back().slid_s < together_s;
    if (goes_on) {
        undo_.back().slid_s = time_s;
        redo_.clear();
        return;
    }
    Entry entry{std::move(name), before};
    entry.slid_s = time_s;
    if (change.is_of_numbers) entry.slid = std::move(change.keys);
    note(std::move(entry));
}

void UndoHistory::note_additions(ViewAdditions before) {
    note({translated("change of the picture"), std::move(before)});
}

void UndoHistory::note(Entry entry) {
    redo_.clear();
    undo_.push_back(std::move(entry));
    limit();
}

void UndoHistory::forget_worlds() {
    const auto is_of_world = [](const Entry& entry) {
        return std::holds_alternative<World>(entry.before);
    };
    std::erase_if(undo_, is_of_world);
    std::erase_if(redo_, is_of_world);
    dropped_edits_.clear();
}

std::vector<EditDescription> UndoHistory::list_edits() const {
    std::vector<EditDescription> edits = dropped_edits_;
    for (const Entry& entry : undo_)
        edits.insert(edits.end(), entry.edits.begin(), entry.edits.end());
    return edits;
}

UndoHistory::Part UndoHistory::go(World& world, PersonChoices& choices, std::deque<Entry>& from,
                                  std::deque<Entry>& to) {
    Part part = Part::World;
    Entry entry = std::move(from.back());
    from.pop_back();
    entry.slid.clear();
    has_changed_coupling_ = entry.is_of_coupling;
    if (auto* const before = std::get_if<World>(&entry.before)) {
        *before = continue_with(world, std::move(*before));
        std::swap(world, *before);
    } else if (auto* const settings = std::get_if<LiveSettings>(&entry.before)) {
        part = Part::Settings;
        std::swap(*settings, choices.settings.at(settings->hand));
    } else {
        part = Part::Additions;
        std::swap(std::get<ViewAdditions>(entry.before), choices.additions);
    }
    to.push_back(std::move(entry));
    limit();
    return part;
}

void UndoHistory::limit() {
    while (undo_.size() > 1 && (undo_.size() > most_entries || count_bytes() > most_bytes)) {
        std::ranges::move(undo_.front().edits, std::back_inserter(dropped_edits_));
        dropped_name_ = std::move(undo_.front().name);
        undo_.pop_front();
        ++dropped_;
    }
}

std::size_t UndoHistory::count_bytes() const {
    std::vector<const World*> worlds;
    for (const std::deque<Entry>* const entries : {&undo_, &redo_}) {
        for (const Entry& entry : *entries) {
            if (const auto* const world = std::get_if<World>(&entry.before))
                worlds.push_back(world);
        }
    }
    return World::count_bytes(worlds);
}

}  // namespace palpa
