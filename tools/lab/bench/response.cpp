#include "core/load_error.h"
#include "core/units.h"
#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/solver.h"
#include "tools/lab/bench/adaptive.h"
#include "tools/lab/bench/stroke.h"

#include <fmt/format.h>
#include <algorithm>

namespace palpa {
namespace {

constexpr double step = 2e-4;  // rad and Å

// Forces on the coordinates, then on the hand.
using Pull = Eigen::VectorXd;

Pull find_pull(World& world) {
    ForceMemory memory;
    update_forces(model_of(world), build_step_settings(world).forces, memory,
                  world.write<TorsionState>());
    update_coordinate_forces(model_of(world), world.write<TorsionState>());
    const TorsionState state = world.resource<TorsionState>();
    put(state, world);
    Pull pull(model_of(world).coordinates + 3);
    pull << state.coordinate_forces, find_force(world);
    return pull;
}

// How it changes with a move, by central differences.
template <class Move>
Pull find_slope(World& world, const Move& move) {
    const TorsionState start = world.resource<TorsionState>();
    move(step);
    const Pull up = find_pull(world);
    put(start, world);
    move(-step);
    const Pull down = find_pull(world);
    put(start, world);
    return (up - down) / (2 * step);
}

// A column for each coordinate, and a last one for the hand along x.
Eigen::MatrixXd find_slopes(World& world) {
    const Eigen::Index n = model_of(world).coordinates;
    Eigen::MatrixXd slopes(n + 3, n + 1);
    for (Eigen::Index c = 0; c < n; ++c) {
        if (c % 100 == 0) say(fmt::format("second derivatives: {} of {} coordinates", c, n));
        slopes.col(c) = find_slope(world, [&](double by) {
            add_move(model_of(world), by * Coordinates::Unit(n, c), world.write<TorsionState>());
        });
    }
    slopes.col(n) = find_slope(world, [&](double by) { move_held(world, {by, 0, 0}); });
    return slopes;
}

// The coordinate that lowers the energy most by coming to rest; -1 where none does.
Eigen::Index find_best(const Eigen::MatrixXd& slopes) {
    const Eigen::Index n = slopes.cols() - 1;
    Eigen::Index best = -1;
    double most = 0;
    for (Eigen::Index c = 0; c < n; ++c) {
        if (!(slopes(c, c) < 0)) continue;
        const double fall = -slopes(c, n) * slopes(c, n) / slopes(c, c);
        if (fall <= most) continue;
        most = fall;
        best = c;
    }
    return best;
}

// The change of the force on the hand per Å that it went, kcal/mol/Å^2, when none, one, two, ...
// coordinates came to rest: each the best beside those before it.
std::vector<Vec3> find_responses(Eigen::MatrixXd slopes) {
    const auto force = [&] { return Vec3(slopes.rightCols<1>().tail<3>()); };
    std::vector<Vec3> responses{force()};
    for (Eigen::Index best = find_best(slopes); best >= 0; best = find_best(slopes)) {
        const Eigen::VectorXd column = slopes.col(best);
        const Eigen::RowVectorXd row = slopes.row(best) / slopes(best, best);
        slopes.noalias() -= column * row;
        slopes.row(best).setZero();
        slopes.col(best).setZero();
        responses.push_back(force());
    }
    return responses;
}

}  // namespace

std::string bench_best_joints(const std::string& scene_name, const SceneDescription& scene,
                              const AdaptiveBenchSettings&, std::vector<BenchRow>& rows) {
    const Connectivity connectivity = load_system(scene).connectivity;
    const BenchStart start = load_start(scene, connectivity);
    World world =
        build_variant(start, {everything, {}, JointWeights::Acceleration, PairPrecision::Double});
    constexpr Eigen::Index most = 2000;
    if (model_of(world).coordinates > most) {
        throw LoadError({scene.file.string()},
                        fmt::format("{} degrees of freedom; expected at most {}, because second "
                                    "derivatives of more take too long",
                                    model_of(world).coordinates, most));
    }
    const double left = relax(start, RelaxMethod::SecondOrder, 300, world);
    say(fmt::format("at rest to {:.2g} kcal/mol per rad and Å", left));
    const std::vector<Vec3> responses = find_responses(find_slopes(world));

    const Vec3& relaxed = responses.back();
    const std::string reference = fmt::format(
        "all at rest: {:.1f} pN/A", units::piconewton_per_kcal_per_mol_angstrom * relaxed.norm());
    std::string table = "| come to rest | the hand finds, pN/Å | wrong, % |\n| --- | --- | --- |\n";
    for (const std::size_t active : active_counts) {
        const std::size_t count = std::min(active, responses.size() - 1);
        if (count < active && active != everything) continue;
        const std::string name = active == everything ? "all" : fmt::format("{}", active);
        const double error = (responses[count] - relaxed).norm();
        rows.push_back({fmt::format("adaptive/{}/best/active={}", scene_name, name),
                        {units::piconewton_per_kcal_per_mol_angstrom * responses[count].norm()},
                        "pN/A",
                        error / relaxed.norm(),
                        "relative",
                        reference});
        table += fmt::format("| {} | {:.1f} | {:.3g} |\n", name,
                             units::piconewton_per_kcal_per_mol_angstrom * responses[count].norm(),
                             100 * error / relaxed.norm());
    }
    return table;
}

}  // namespace palpa
