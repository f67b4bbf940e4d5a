// What was before: how molecules stood at the start, and the way of what hands hold since.
#pragma once
#include "ecs/world.h"
#include "math/vec.h"
#include "render/frame_scene.h"
#include "scene/description.h"
#include "view/pocket.h"
#include "view/signs.h"

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// Of one world, followed from step to step by its clock. After a reset, or where the clock goes
// back (in another world), everything begins anew.
class Past {
public:
    // The first look is the start, where marks that want a place of rest have it found. Edits may
    // add molecules, whose start is when they are first seen; where they take a molecule back, its
    // way has a gap.
    void follow(const World& world, const ViewMarks& marks);

    // What hands hold as it stood at the start, where it has moved by 0.1 Å, and residues of
    // `pocket`, one an atom, of which a heavy atom has moved by 0.5 Å: pale sticks without
    // hydrogens on carbon. And a ring about the place of rest of what hands held at the start.
    void add_ghost(const World& world, std::span<const ResidueSpan> residues,
                   const std::vector<bool>& pocket, FrameScene& frame,
                   std::vector<ViewLabel>& labels) const;

    // The way of the centre of what each hand holds over the last `trail_s`, which fades into the
    // background.
    void add_trail(double trail_s, FrameScene& frame) const;

private:
    struct Point {
        double time_s;
        Vec3 place;
        bool is_joined;  // to the one before
    };
    struct Trail {
        Entity molecule;
        std::deque<Point> points;  // the oldest first
    };

    void begin(const World& world, bool seeks_rest);
    void see_new_molecules(const World& world);
    void follow_hand(const World& world, Entity hand, double trail_s);
    std::vector<Vec3> start_of_all(const World& world) const;

    std::uint64_t steps_ = 0, resets_ = 0;
    bool has_begun_ = false;
    double now_s_ = 0;
    std::map<Entity, std::vector<Vec3>> starts_;  // by molecule, Å
    std::vector<Vec3> rests_;                     // of reference atoms, Å
    std::map<Entity, Trail> trails_;              // by hand
};

// Where what a hand of the scene holds is at rest (Å, its reference atom or its end of the spring),
// in a world just loaded. In space loading has found it; on a line it is sought here, unless that
// would take more than a tenth of a second. Nothing where there is none.
std::optional<Vec3> find_resting_place(const World& world, Entity hand);

}  // namespace palpa
