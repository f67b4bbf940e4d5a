// Edits change a world between two steps. An edit either succeeds completely, or throws LoadError
// with the problem and a remedy and changes nothing. If the mobile parts change, the mechanics are
// rebuilt at the present positions (rebuild_mechanics).
#pragma once
#include "ecs/world.h"
#include "scene/edits.h"

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace palpa {

// The edits of scene/edits.h, with a hand where they need one. The hand first releases what it
// held. A molecule held as a whole follows the hand; at a spring it moves by itself, even if it is
// otherwise fixed. On release it gets back its former mobility.
void take(World& world, Entity hand, const TakeEdit& edit);
void let_go(World& world, Entity hand);
// Refused where something else is there now, and where another hand holds it too.
void put_back(World& world, Entity hand);
void add_molecule(World& world, const AddEdit& edit);
void remove_molecule(World& world, const RemoveEdit& edit);
void pin(World& world, const PinEdit& edit);
void add_restraint(World& world, const RestraintEdit& edit);
void set_mobility(World& world, const MobilityEdit& edit);
void set_appearance(World& world, const AppearanceEdit& edit);
void set_coupling(World& world, const CouplingEdit& edit);
// Loads the scene again; the clock continues, and hands grip at the present poses of their devices.
void reset(World& world);

// Returns the world after an edit of any kind except undo and redo. Throws LoadError at the edit's
// place. Works on a copy, so it may run in another thread.
World make_edit(const World& world, const EditDescription& edit);

// Earlier worlds for undo: one for each edit, and one for each grip from taking to release.
class EditHistory {
public:
    static constexpr std::size_t most_entries = 200;
    static constexpr std::size_t most_bytes = std::size_t{256} << 20;  // approximate total size

    // Carries out an edit of any kind, including undo and redo. Throws LoadError at the edit's
    // place.
    void apply(World& world, const EditDescription& edit);
    // Replaces the world by the result of make_edit on an earlier state; the clock continues, and
    // hands grip at the present poses of their devices.
    void adopt(World& world, World changed, const EditDescription& edit);

    // The edits since the world's start that are not undone, in order; a release follows its grip.
    std::vector<EditDescription> list_edits() const;

    bool can_undo() const noexcept { return !undo_.empty(); }
    bool can_redo() const noexcept { return !redo_.empty(); }
    // True if the last edit, undo or redo changed the coupling.
    bool has_changed_coupling() const noexcept { return has_changed_coupling_; }
    // Number of oldest entries that were dropped to limit the size.
    std::size_t dropped() const noexcept { return dropped_; }

private:
    // The difference between a world and the next one.
    struct Change {
        // The hand that grips, until it releases.
        std::optional<std::size_t> grip;
        bool is_of_coupling = false;
        std::vector<EditDescription> edits{};  // one edit, or a grip with its release
    };
    struct Entry {
        World world;
        Change change;
    };

    void replace(World& world, World changed, const EditDescription& edit);
    void go(World& world, std::deque<Entry>& from, std::deque<Entry>& to);
    void push(World world, const Change& change, std::deque<Entry>& to);
    std::size_t count_bytes() const;
    Entry* end_grip(std::size_t hand) noexcept;

    std::deque<Entry> undo_, redo_;
    std::vector<EditDescription> dropped_edits_;
    std::size_t dropped_ = 0;
    bool has_changed_coupling_ = false;
};

}  // namespace palpa
