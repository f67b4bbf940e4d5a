// Marks of the past: the start pose of molecules, and the path of what hands hold.
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

// Follows one world from step to step by its clock. After a reset, or if the clock goes back
// (another world), everything restarts.
class Past {
public:
    // The first call defines the start, and finds the pose at rest if marks need it. The start of
    // an added molecule is when it is first seen; the path of a removed and restored one has a gap.
    void follow(const World& world, const ViewMarks& marks);

    // Draws pale sticks, without hydrogens on carbon, at the start pose: of what hands hold if it
    // has moved by 0.1 Å, and of residues of `pocket` (one entry per atom) with a heavy atom that
    // has moved by 0.5 Å. Also draws a ring about the pose at rest of what hands held at the start.
    void add_ghost(const World& world, std::span<const ResidueSpan> residues,
                   const std::vector<bool>& pocket, FrameScene& frame,
                   std::vector<ViewLabel>& labels) const;

    // Draws the path of the centre of what each hand holds over the last `trail_s`; it fades into
    // the background.
    void add_trail(double trail_s, FrameScene& frame) const;

private:
    struct Point {
        double time_s;
        Vec3 place;
        bool is_joined;  // connected to the previous point
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
    std::vector<Vec3> rests_;                     // reference atoms at rest, Å
    std::map<Entity, Trail> trails_;              // by hand
};

// The pose at rest of what a hand holds (Å, its reference atom or the hand's end of its spring) in
// a newly loaded world. In space it is known from loading; on a line it is computed here, unless
// that would take more than a tenth of a second. Nothing if there is none.
std::optional<Vec3> find_resting_place(const World& world, Entity hand);

}  // namespace palpa
