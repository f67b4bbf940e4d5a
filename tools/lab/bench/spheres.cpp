#include "core/load_error.h"
#include "core/text.h"
#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/solver.h"
#include "tools/lab/bench/adaptive.h"
#include "tools/lab/bench/cut_sphere.h"
#include "tools/lab/bench/held_model.h"
#include "tools/lab/bench/stroke.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

constexpr std::array<std::size_t, 5> sphere_sizes{1'000, 3'000, 10'000, 30'000, 100'000};
constexpr std::size_t sphere_of_counts = 30'000, sphere_active = 40;

bool is_residue(const AtomName& name, const AtomName& other) {
    return name.segment == other.segment && name.number == other.number;
}

// The first atom of what the hand's spring holds.
std::uint32_t find_centre(const SceneDescription& scene, const Connectivity& connectivity) {
    const std::vector<std::string_view> words = split_words(scene.hands.front().grab.atom);
    const auto held = std::ranges::find(scene.molecules, scene.hands.front().grab.molecule,
                                        &MoleculeDescription::name);
    if (!words.empty() && held != scene.molecules.end()) {
        for (std::uint32_t i = 0; i < connectivity.names.size(); ++i) {
            const AtomName& name = connectivity.names[i];
            if (name.segment == held->segment && name.number == words.front()) return i;
        }
    }
    throw LoadError(
        scene.place_of("grab.atom"),
        "names no residue; expected a residue in the hand, around which spheres are cut");
}

// A sphere with its middle residue on the hand's spring.
World build_sphere(const SceneDescription& scene, const CutSystem& sphere, const AtomName& middle) {
    ModelSpring spring;
    spring.k = scene.hands.front().grab.spring_kcal_per_mol_angstrom2;
    for (std::uint32_t i = 0; i < sphere.connectivity.names.size(); ++i) {
        if (is_residue(sphere.connectivity.names[i], middle)) spring.atoms.push_back(i);
    }
    TorsionModel model = build_held_model(sphere.connectivity, sphere.topology, sphere.positions);
    const std::uint32_t body = model.tree.bodies.body_of[spring.atoms.front()];
    const std::uint32_t grabbed = model.tree.molecule_of[body];
    const Variant variant{0, 12.0, JointWeights::HandProximity, PairPrecision::Fast};
    return build_mechanics_world(scene_with(scene, variant), std::move(model),
                                 {grabbed, std::move(spring)});
}

StrokeResult time_sphere(const BenchStart& start, std::size_t active, int moves) {
    World world = start.world;
    if (PaperStep* const paper = write_solver<PaperStep>(world))
        paper->settings.limits.degrees_of_freedom = active;
    return time_stroke(start, start.world.resource<TorsionState>(), moves, world);
}

constexpr std::string_view sphere_table_head =
    "| atoms | joints | active | backbone | step, µs | 10 to 90 % | choice | mean |\n"
    "| --- | --- | --- | --- | --- | --- | --- | --- |\n";

std::string sphere_line(std::size_t atoms, std::size_t joints, std::size_t active,
                        const StrokeResult& s) {
    return fmt::format("| {} | {} | {} | {:.1f} | {:.0f} | {:.0f} to {:.0f} | {:.0f} | {:.0f} |\n",
                       atoms, joints, active, mean_of(s.backbone), quantile(s.ordinary_us, 0.5),
                       quantile(s.ordinary_us, 0.1), quantile(s.ordinary_us, 0.9),
                       quantile(s.choice_us, 0.5), s.mean_us());
}

// Growth of steps, choices and all together.
class Growth {
public:
    void add(double size, const StrokeResult& stroke) {
        steps_.push_back({size, quantile(stroke.ordinary_us, 0.5)});
        choices_.push_back({size, quantile(stroke.choice_us, 0.5)});
        means_.push_back({size, stroke.mean_us()});
    }

    std::string add_rows(const std::string& name, std::vector<BenchRow>& rows) const {
        rows.push_back({name + "/step", {relate(steps_).slope}, "exponent"});
        rows.push_back({name + "/choice", {relate(choices_).slope}, "exponent"});
        rows.push_back({name + "/mean", {relate(means_).slope}, "exponent"});
        return fmt::format("step {:.2f}, choice {:.2f}, mean {:.2f}", relate(steps_).slope,
                           relate(choices_).slope, relate(means_).slope);
    }

private:
    std::vector<std::array<double, 2>> steps_, choices_, means_;
};

}  // namespace

std::string bench_spheres(const std::string& scene_name, const SceneDescription& scene,
                          const AdaptiveBenchSettings& settings, std::vector<BenchRow>& rows) {
    const SceneSystem system = load_system(scene);
    const std::uint32_t centre = find_centre(scene, system.connectivity);
    const std::string prefix = "adaptive/" + scene_name;
    std::string table{sphere_table_head};
    Growth with_atoms, with_active;
    for (const std::size_t most : sphere_sizes) {
        if (most > system.positions.size()) break;
        const CutSystem sphere =
            cut_sphere(system.connectivity, system.topology, system.positions, centre, most);
        const BenchStart start{scene, sphere.connectivity,
                               build_sphere(scene, sphere, system.connectivity.names[centre])};
        for (const std::size_t active : active_counts) {
            const bool is_counted = most == sphere_of_counts && active > 0 && active != everything;
            if (active != sphere_active && !is_counted) continue;
            say(fmt::format("sphere of {} atoms, {} active", sphere.positions.size(), active));
            const StrokeResult stroke = time_sphere(start, active, settings.stroke_moves);
            add_time_rows(
                fmt::format("{}/atoms={}/active={}", prefix, sphere.positions.size(), active),
                stroke, 0, rows);
            table += sphere_line(sphere.positions.size(),
                                 start.world.resource<StartReport>().joints, active, stroke);
            if (active == sphere_active)
                with_atoms.add(static_cast<double>(sphere.positions.size()), stroke);
            if (is_counted) with_active.add(static_cast<double>(active), stroke);
        }
    }
    table += fmt::format("\nExponents of growth with atoms: {}; with active joints: {}.\n",
                         with_atoms.add_rows(prefix + "/exponent-of-atoms", rows),
                         with_active.add_rows(prefix + "/exponent-of-active", rows));
    return table;
}

}  // namespace palpa
