// palpa-lab bench --adaptive: speed against error of steps in which few joints are active.
#pragma once
#include "scene/description.h"
#include "tools/lab/bench/row.h"

#include <string>
#include <vector>

namespace palpa {

struct AdaptiveBenchSettings {
    int poses = 3;           // along the stroke
    int stroke_moves = 200;  // of the hand, half of them back
    // Where not empty: only variants whose NAME has one of these in it, and all joints.
    std::vector<std::string> only;
};

// Every number of active degrees of freedom with every weight, with all pairs and with a cutoff of
// 12 Å, as the scene else says. NAME is adaptive/SCENE/active=N/CUTOFF/WEIGHT, and
//
//   NAME                 one step of the simulation in which nothing was chosen, along the stroke
//   NAME/choice          one in which joints were, or everything was summed anew
//   NAME/local-force     change of the force on the hand when it moves by 0.1 Å from rest and 300
//                        steps follow, of each pose; relative to the rms of that with all joints
//                        active and all pairs in double
//   NAME/local-position  rms over all atoms where they are then, of each pose
//   NAME/local-rest      as local-force, but against where all joints come to rest
//   NAME/path            force on the hand along the stroke, of each move, relative to the rms;
//                        `adaptive/SCENE/floor` is that of two runs with all joints active that
//                        began 0.001 Å apart
//   adaptive/SCENE/relation/CUTOFF/WEIGHT/force, position
//                        correlation of the logarithms of what was neglected and of the local error
//   adaptive/SCENE/exponent-of-active/CUTOFF/WEIGHT
//
// of scenes in which something moves by itself. Returns all that as a table in Markdown. Says on
// standard error how far it is.
std::string bench_adaptive(const std::string& scene_name, const SceneDescription& scene,
                           const AdaptiveBenchSettings& settings, std::vector<BenchRow>& rows);

// Spheres of 1,000 to 100,000 atoms cut from the scene's system around what the hand's spring
// holds, all bases fixed, 12 Å, weights hand-proximity: adaptive/SCENE/atoms=N/active=40, its
// choice, exponents of growth with the atoms, and with the active joints in 30,000 of them. Returns
// a table likewise.
std::string bench_spheres(const std::string& scene_name, const SceneDescription& scene,
                          const AdaptiveBenchSettings& settings, std::vector<BenchRow>& rows);

// What no choice of joints can mend: adaptive/SCENE/best/active=N is the change of the force on the
// hand per Å along x, from rest, when N coordinates come to rest again, and how far that is from
// all. They are chosen one by one, each the one that lowers the energy most beside those before it,
// from all second derivatives of the energy: nearly as good as any choice, and far too slow for a
// step. Throws LoadError where there are too many. Returns a table likewise.
std::string bench_best_joints(const std::string& scene_name, const SceneDescription& scene,
                              const AdaptiveBenchSettings& settings, std::vector<BenchRow>& rows);

}  // namespace palpa
