// Undo and redo through 1,000 random sequences of edits and moves, to the byte.
#include "core/load_error.h"
#include "loading/edit.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/undo_history.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/step.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"
#include "tests/support/world_bytes.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;
using test::world_bytes;

namespace {

using Settings = std::vector<std::string>;

World load(const std::string& file, const Settings& settings) {
    return load_world(read_scene(file, settings));
}

// A world, its history, and what both must be: the bytes of every state that one can go back or
// forth to.
class Sequence {
public:
    Sequence(World world, unsigned seed) : world_(std::move(world)), random_(seed) {
        poses_.resize(find_hands(world_).size());
        first_ = bytes();
        first_later_ = bytes_later();
        make(AppearanceEdit{draw_molecule(), {}, {}, true});
    }

    void do_anything() {
        const unsigned what = draw(20);
        if (what < 6) return move();
        if (what < 8) {  // but for the first, so that there is a way back to the start
            if (undone_.size() > 1) go(UndoEdit{}, undone_, redone_);
            return;
        }
        if (what < 10) return go(RedoEdit{}, redone_, undone_);
        make(draw_edit());
    }

    // To the world that it was built with.
    void undo_all() {
        INFO(log_);
        while (!undone_.empty()) go(UndoEdit{}, undone_, redone_);
        CHECK(history_.undo_name().empty());
        REQUIRE((bytes() == first_));
        REQUIRE((bytes_later() == first_later_));
    }
    void redo_all() {
        while (!redone_.empty()) go(RedoEdit{}, redone_, undone_);
        CHECK(history_.redo_name().empty());
    }

    std::string bytes() const { return world_bytes(world_); }
    // After a step in which every handle stays where it is.
    std::string bytes_later() const {
        World later = world_;
        step(later);
        return world_bytes(later);
    }
    const std::multiset<std::size_t>& made() const { return made_; }

private:
    unsigned draw(unsigned n) { return static_cast<unsigned>(random_() % n); }
    double draw_angstrom() { return 0.02 * draw(11) - 0.1; }

    void step(World& world) const {
        std::vector<ContactModel> felt;
        for (const Entity hand : find_hands(world))
            felt.push_back(contact_of(world, hand).sent.model);
        (void)step_world(world, {poses_, felt});
    }

    void move() {
        for (HandPose& pose : poses_)
            pose.travel_m += 0.025 * Vec3(draw_angstrom(), draw_angstrom(), draw_angstrom());
        step(world_);
        log_ += " move";
    }

    std::string draw_molecule() {
        std::vector<std::string> names;
        world_.each<Molecule>([&](Entity, const Molecule& m) { names.push_back(m.name); });
        return names[draw(static_cast<unsigned>(names.size()))];
    }

    // A residue or an atom of a molecule.
    std::string draw_part(bool is_atom) {
        const std::string name = draw_molecule();
        const AtomRange range = find_range(name);
        const AtomName& atom = world_.resource<AtomTable>().names[range.first + draw(range.count)];
        return name + ":" + atom.number + (is_atom ? " " + atom.atom : "");
    }

    AtomRange find_range(const std::string& name) const {
        AtomRange range;
        world_.each<Molecule>([&](Entity, const Molecule& m) {
            if (m.name == name) range = m.atoms;
        });
        return range;
    }

    EditAction draw_edit() {
        switch (draw(16)) {
            case 0:
            case 1:
                return GrabEdit{draw_molecule()};
            case 2:
                return GrabEdit{draw_part(false)};
            case 3:
                return GrabEdit{draw_part(true)};
            case 4:
                return ReleaseEdit{};
            case 5:
                return PutBackEdit{};
            case 6:
                return AddEdit{"", draw_molecule(), draw_name(), draw_place()};
            case 7:
                return RemoveEdit{draw_molecule()};
            case 8: {
                PinEdit pin;
                for (unsigned n = 1 + draw(4); n > 0; --n) pin.atoms.push_back(draw_part(true));
                return pin;
            }
            case 9:
                if (draw(2) == 0) return RestraintEdit{{draw_part(true)}, draw_place(), 2, 1};
                return RestraintEdit{{draw_part(true), draw_part(false)}, {}, 5, 2};
            case 10:
                return MobilityEdit{
                    draw_molecule(), draw(2) == 0 ? Motion::Free : Motion::Fixed, {}};
            case 11:
                return AppearanceEdit{draw_molecule(), {}, {}, draw(2) == 0};
            case 12:
                return CouplingEdit{{draw(2) == 0 ? "mode=3" : "mode=guarded"}};
            case 13:
                return RelaxEdit{};
            case 14:
                return RenameEdit{draw_molecule(), draw_name()};
            default:
                return ResetEdit{};
        }
    }

    std::string draw_name() { return "new" + std::to_string(++names_); }

    // Apart from everything, and from each other.
    std::array<double, 3> draw_place() {
        return {40.0 + draw(9), 30.0 * static_cast<double>(++places_), 7.0 * draw(3)};
    }

    // One that is refused changes nothing.
    void make(EditAction action) {
        const EditDescription edit{
            0, draw(static_cast<unsigned>(poses_.size())), std::move(action), {"sequence", 1, 0}};
        std::string before = bytes();
        log_ += " " + std::string(edit_names[edit.action.index()]);
        INFO(log_);
        try {
            history_.apply(world_, edit);
        } catch (const LoadError& error) {
            INFO(error.what());
            REQUIRE((bytes() == before));
            return;
        }
        made_.insert(edit.action.index());
        redone_.clear();
        const bool takes = std::holds_alternative<GrabEdit>(edit.action);
        const bool lets_go = std::holds_alternative<ReleaseEdit>(edit.action);
        // Letting go belongs to the entry of the hand's grip if that is the last one.
        if ((takes || lets_go) && end_grip(edit.hand) && lets_go) return;
        undone_.push_back({std::move(before), takes ? std::optional(edit.hand) : std::nullopt});
    }

    // Returns true if the grip's entry is the last.
    bool end_grip(std::size_t hand) {
        for (std::size_t i = undone_.size(); i-- > 0;) {
            if (undone_[i].grip != hand) continue;
            undone_[i].grip.reset();
            return i + 1 == undone_.size();
        }
        return false;
    }

    struct Entry {
        std::string bytes;
        std::optional<std::size_t> grip;  // of this hand, which has not let go
    };

    void go(EditAction action, std::vector<Entry>& from, std::vector<Entry>& to) {
        if (from.empty()) return;
        log_ += " " + std::string(edit_names[action.index()]);
        INFO(log_);
        std::string now = bytes();
        history_.apply(world_, {0, 0, std::move(action), {"sequence", 1, 0}});
        REQUIRE((bytes() == from.back().bytes));
        to.push_back({std::move(now), from.back().grip});
        from.pop_back();
    }

    World world_;
    std::mt19937 random_;
    UndoHistory history_;
    std::string first_, first_later_;
    std::vector<HandPose> poses_;
    std::vector<Entry> undone_, redone_;  // what undo and redo lead to, the next last
    std::string log_;                     // what was done
    std::multiset<std::size_t> made_;     // edits that were not refused, by kind
    unsigned names_ = 0, places_ = 0;
};

struct Scene {
    std::string file;
    Settings settings;
    unsigned sequences;
};

}  // namespace

TEST_CASE("a thousand random sequences of edits and moves are undone and redone, to the byte",
          "[simulation][edit][slow]") {
    const Settings rigid{"molecules.held.shape=rigid", "molecules.resting.shape=rigid"};
    const std::string waters = test::in_project("scenes/water/"),
                      peptides = test::test_data("two_peptides");
    const std::vector<Scene> scenes{
        {waters + "scene.toml", {"mode=guarded"}, 100},
        {waters + "space.toml", {}, 100},
        {waters + "two-hands.toml", {}, 250},
        {waters + "two-hands.toml",
         {"molecules.left.motion=translate-and-turn", "molecules.right.motion=translate-and-turn"},
         250},
        {peptides, rigid, 150},
        {peptides, {}, 150}};
    std::multiset<std::size_t> made;
    unsigned seed = 0;
    for (const Scene& scene : scenes) {
        Settings settings = scene.settings;
        settings.emplace_back("statics.method=quasi-static");
        const World start = load(scene.file, settings);
        for (unsigned i = 0; i < scene.sequences; ++i) {
            INFO(scene.file << ", sequence " << ++seed);
            Sequence sequence(start, seed);
            for (int n = 0; n < 12; ++n) sequence.do_anything();
            sequence.redo_all();
            const std::string last = sequence.bytes(), last_later = sequence.bytes_later();

            sequence.undo_all();
            sequence.redo_all();

            REQUIRE((sequence.bytes() == last));
            REQUIRE((sequence.bytes_later() == last_later));
            made.insert(sequence.made().begin(), sequence.made().end());
        }
    }
    CHECK(seed == 1000);
    // Of every kind that a sequence draws, dozens.
    for (std::size_t kind = 0; kind + 2 < std::variant_size_v<EditAction>; ++kind) {
        INFO(edit_names[kind]);
        CHECK(made.count(kind) > 30);
    }
}
