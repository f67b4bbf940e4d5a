// The one history of a session: edits, pulls, changes of settings and of the picture, each with a
// name and with what it changed as it was before.
#pragma once
#include "ecs/world.h"
#include "scene/edits.h"
#include "session/commands.h"
#include "session/view_additions.h"

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace palpa {

// A person's choices that are not part of the world.
struct PersonChoices {
    std::vector<LiveSettings> settings;  // of each hand
    ViewAdditions additions;
};

class UndoHistory {
public:
    static constexpr std::size_t most_entries = 200;
    static constexpr std::size_t most_bytes = std::size_t{256} << 20;  // total memory

    // The part that an edit has changed, or that undo or redo has restored.
    enum class Part { World, Settings, Additions };
    // Carries out an edit of any kind, including undo and redo. Throws LoadError at the edit's
    // place. Undo and redo restore the choices that they find in the history.
    Part apply(World& world, const EditDescription& edit, PersonChoices& choices);
    // For a history of edits alone.
    void apply(World& world, const EditDescription& edit);
    // Replaces the world by the result of make_edit on an earlier state; the clock continues, and
    // hands grip at the present poses of their devices.
    void adopt(World& world, World changed, const EditDescription& edit);

    // Adds a pull at what a hand holds; `before`: the world when it began.
    void note_pull(World before, const std::string& what);
    // Adds a change of settings. Changes of the same numbers that follow each other within half a
    // second, as by a slider, are one entry.
    void note_settings(const LiveSettings& before, const LiveSettings& after, double time_s);
    // Adds a change of the picture.
    void note_additions(ViewAdditions before);

    // Removes the entries of worlds: the world is loaded again.
    void forget_worlds();

    // The edits since the world's start that are not undone, in order; a release follows its grip.
    std::vector<EditDescription> list_edits() const;

    // The names of what undo and redo would change next; empty: nothing.
    std::string undo_name() const { return undo_.empty() ? "" : undo_.back().name; }
    std::string redo_name() const { return redo_.empty() ? "" : redo_.back().name; }
    // True if the last edit, undo or redo changed the coupling of the world.
    bool has_changed_coupling() const noexcept { return has_changed_coupling_; }
    // The number of oldest entries that were dropped to limit the size, and the last one's name.
    std::size_t dropped() const noexcept { return dropped_; }
    const std::string& dropped_name() const noexcept { return dropped_name_; }

private:
    struct Entry {
        std::string name;
        std::variant<World, LiveSettings, ViewAdditions> before;
        // The hand that grips, until it releases.
        std::optional<std::size_t> grip{};
        bool is_of_coupling = false;
        std::vector<EditDescription> edits{};  // one edit, or a grip with its release
        // Keys of numbers that a slider may change further, and the time of the last change.
        std::vector<std::string> slid{};
        double slid_s = 0;
    };

    void note_edit(World before, const EditDescription& edit);
    void note(Entry entry);
    Part go(World& world, PersonChoices& choices, std::deque<Entry>& from, std::deque<Entry>& to);
    void limit();
    std::size_t count_bytes() const;

    std::deque<Entry> undo_, redo_;
    std::vector<EditDescription> dropped_edits_;
    std::size_t dropped_ = 0;
    std::string dropped_name_;
    bool has_changed_coupling_ = false;
};

}  // namespace palpa
