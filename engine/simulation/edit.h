// What changes a world between two steps. Every edit succeeds whole, or throws LoadError, which
// says what is wrong and what would be right, and leaves all as it was. Where it changes what
// moves, mechanics are then built anew from where everything is (rebuild_mechanics).
#pragma once
#include "ecs/world.h"
#include "scene/edits.h"

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace palpa {

// The edits of scene/edits.h, of a hand where they need one. Whatever a hand held before it lets
// go. Held as a whole a molecule goes where the hand goes; at a spring it moves by itself, also one
// that is fixed otherwise. A hand that lets go gives back what the molecule may do.
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
// Loads the scene anew; the clock goes on, and hands take hold where their devices are.
void reset(World& world);

// The world as the edit makes it, whatever edit but undo and redo. Throws LoadError at the edit's
// place. Touches nothing but its own copy, so a thread of its own may make it.
World make_edit(const World& world, const EditDescription& edit);

// Worlds to go back to: one for each edit, and one for each grip, from taking hold to letting go.
class EditHistory {
public:
    static constexpr std::size_t most_entries = 200;
    static constexpr std::size_t most_bytes = std::size_t{256} << 20;  // of all of them, about

    // An edit of any kind, undo and redo too. Throws LoadError at the edit's place.
    void apply(World& world, const EditDescription& edit);
    // Puts what make_edit made of an earlier state in the world's place; the clock goes on, and
    // hands take hold where their devices are.
    void adopt(World& world, World changed, const EditDescription& edit);

    // What was made of the world it began with and is not undone, in order; letting go stands
    // behind its taking hold.
    std::vector<EditDescription> list_edits() const;

    bool can_undo() const noexcept { return !undo_.empty(); }
    bool can_redo() const noexcept { return !redo_.empty(); }
    // Whether the edit made last, undone or done again changed the coupling.
    bool has_changed_coupling() const noexcept { return has_changed_coupling_; }
    // Entries that were dropped, the oldest first, for there were too many.
    std::size_t dropped() const noexcept { return dropped_; }

private:
    // What lies between a world and the one that follows it.
    struct Change {
        // The hand that took hold, as long as it has not let go.
        std::optional<std::size_t> grip;
        bool is_of_coupling = false;
        std::vector<EditDescription> edits{};  // one, or taking hold and letting go
    };
    struct Entry {
        World world;
        Change change;
        std::size_t bytes = 0;
    };

    void replace(World& world, World changed, const EditDescription& edit);
    void go(World& world, std::deque<Entry>& from, std::deque<Entry>& to);
    void push(World world, const Change& change, std::deque<Entry>& to);
    Entry* end_grip(std::size_t hand) noexcept;

    std::deque<Entry> undo_, redo_;
    std::vector<EditDescription> dropped_edits_;
    std::size_t dropped_ = 0;
    bool has_changed_coupling_ = false;
};

// What a copy of the world takes, about; what copies share counts as nothing.
std::size_t count_bytes(const World& world) noexcept;

}  // namespace palpa
