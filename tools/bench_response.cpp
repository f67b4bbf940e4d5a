#include "tools/bench_response.h"

#include "tools/bench_stroke.h"

#include <algorithm>
#include <cmath>

namespace palpa {
namespace {

constexpr double step = 2e-4;  // rad and Å

// Forces on the coordinates, then on the hand.
using Pull = Eigen::VectorXd;

Pull find_pull(Flexible& flexible) {
    update_forces(flexible.model, flexible.settings.step.forces, flexible.statics.memory,
                  flexible.state);
    update_coordinate_forces(flexible.model, flexible.state);
    Pull pull(flexible.model.coordinates + 3);
    pull << flexible.state.coordinate_forces, find_force(flexible);
    return pull;
}

// By what `move` changes, central differences.
template <class Move>
Pull find_slope(Flexible& flexible, const Move& move) {
    const TorsionState start = flexible.state;
    move(step);
    const Pull up = find_pull(flexible);
    flexible.state = start;
    move(-step);
    const Pull down = find_pull(flexible);
    flexible.state = start;
    return (up - down) / (2 * step);
}

// Forces on the coordinates and the hand per coordinate, and in the last column per Å of the hand.
Eigen::MatrixXd find_slopes(Flexible& flexible, const Vec3& direction) {
    const Eigen::Index n = flexible.model.coordinates;
    Eigen::MatrixXd slopes(n + 3, n + 1);
    for (Eigen::Index c = 0; c < n; ++c) {
        slopes.col(c) = find_slope(flexible, [&](double by) {
            add_move(flexible.model, by * Coordinates::Unit(n, c), flexible.state);
        });
    }
    slopes.col(n) =
        find_slope(flexible, [&](double by) { move_held(flexible, by * direction.normalized()); });
    return slopes;
}

// The coordinate that lowers the energy most by coming to rest; -1 where none can.
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

}  // namespace

HandResponse find_hand_response(Flexible& at_rest, const Vec3& direction,
                                std::span<const std::size_t> counts) {
    Eigen::MatrixXd slopes = find_slopes(at_rest, direction);
    const Eigen::Index n = slopes.cols() - 1;
    const auto force = [&] { return Vec3(slopes.col(n).tail<3>()); };
    HandResponse response;
    response.rigid = force();
    std::vector<Vec3> left{force()};  // by the number of coordinates that came to rest
    for (Eigen::Index best = find_best(slopes); best >= 0; best = find_best(slopes)) {
        const Eigen::VectorXd column = slopes.col(best);
        const Eigen::RowVectorXd row = slopes.row(best) / slopes(best, best);
        slopes.noalias() -= column * row;
        slopes.row(best).setZero();
        slopes.col(best).setZero();
        left.push_back(force());
    }
    response.relaxed = left.back();
    for (const std::size_t count : counts) {
        const Vec3 error = left[std::min(count, left.size() - 1)] - response.relaxed;
        response.errors.push_back(error.norm() / response.relaxed.norm());
    }
    return response;
}

}  // namespace palpa
