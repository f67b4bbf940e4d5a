// What the benches of scenes in which something moves by itself share: a stroke of the hand, timed.
#pragma once
#include "simulation/mechanics.h"
#include "tools/lab/bench/row.h"

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

inline constexpr std::size_t everything = std::numeric_limits<std::size_t>::max();
inline constexpr std::array<std::size_t, 8> active_counts{0, 10, 20, 40, 80, 160, 320, everything};

// On standard error: how far a bench is.
void say(const std::string& what);

// A scene that has been loaded.
struct BenchStart {
    const SceneDescription& scene;
    const Connectivity& connectivity;
    World world;
};

// Throws LoadError where nothing moves by itself.
BenchStart load_start(const SceneDescription& scene, const Connectivity& connectivity);

// What of a scene's statics a bench sets.
struct Variant {
    std::size_t active;
    std::optional<double> cutoff;
    JointWeights weights;
    PairPrecision pairs;
};

SceneDescription scene_with(SceneDescription scene, const Variant& variant);

World build_variant(const BenchStart& start, const Variant& variant);

// The rms force along the coordinates that is left, kcal/mol/rad or Å.
double relax(const BenchStart& start, RelaxMethod method, std::size_t steps, World& world);

// Starts from another state, with nothing remembered.
void put(const TorsionState& state, World& world);

// kcal/mol/Å, on the hand.
Vec3 find_force(const World& world);

// Å along x, from where the scene's path begins to where it is farthest.
double find_reach(const SceneDescription& scene);

struct StrokeResult {
    std::vector<double> ordinary_us, choice_us;
    std::vector<double> neglected;  // shares of the metric, at choices
    std::vector<double> active, backbone;
    std::size_t renewals = 0;
    std::vector<Vec3> forces;  // after each move, kcal/mol/Å

    double mean_us() const;
};

// Out and back.
StrokeResult play_stroke(const BenchStart& start, int moves, World& world);

// Twice the same; each move took what it took the faster time.
StrokeResult time_stroke(const BenchStart& start, const TorsionState& from, int moves,
                         World& world);

// NAME and NAME/choice. `all_us` is the mean time of all joints, 0 where that is not known.
void add_time_rows(const std::string& name, const StrokeResult& stroke, double all_us,
                   std::vector<BenchRow>& rows);

double mean_of(std::span<const double> values);

// Of logarithms, of values above 0.
struct Relation {
    double slope = 0, correlation = 0;
    std::size_t points = 0;
};

Relation relate(std::span<const std::array<double, 2>> points);

}  // namespace palpa
