#include "statics/second_derivatives.h"

#include "core/assertion.h"
#include "forces/pair_hessian.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace palpa {
namespace {

// Where a body is attached to its parent; of a base, its pivot.
Vec3 point_of(const TorsionModel& model, const TorsionState& state, std::uint32_t body) noexcept {
    if (model.tree.bodies.is_base(body)) return state.pivots[model.tree.molecule_of[body]];
    return state.positions[model.tree.bodies.bodies[body].axis[1]];
}

// A screw about `to` from one about `from`; its transpose takes a wrench back.
Mat6 from_point(const Vec3& from, const Vec3& to) noexcept {
    Mat6 X = Mat6::Identity();
    X.bottomLeftCorner<3, 3>() = -cross_matrix(to - from);
    return X;
}

// The pairs that the topology leaves out, either way round.
std::vector<std::vector<std::uint32_t>> find_excluded(const Topology& topology) {
    std::vector<std::vector<std::uint32_t>> excluded(topology.size());
    for (std::uint32_t i = 0; i < topology.size(); ++i) {
        for (const std::uint32_t j : topology.exclusions.of(i)) {
            excluded[i].push_back(j);
            excluded[j].push_back(i);
        }
    }
    return excluded;
}

class PairBlocks {
public:
    PairBlocks(const TorsionModel& model, const NonbondedSettings& settings,
               const TorsionState& state)
        : model_(model),
          state_(state),
          law_(model.topology, settings),
          excluded_(find_excluded(model.topology)),
          is_left_out_(model.topology.size(), 0) {}

    // Of one body with each other, about a point.
    void update_row(std::uint32_t body, const Vec3& point, std::vector<Mat6>& row) {
        row.assign(model_.tree.bodies.bodies.size(), Mat6::Zero());
        const AssemblyTree& tree = model_.tree;
        for (std::uint32_t a = tree.first_atom[body]; a < tree.first_atom[body + 1]; ++a) {
            add_atom(tree.atoms[a], body, point, row);
        }
    }

private:
    void add_atom(std::uint32_t i, std::uint32_t body, const Vec3& point, std::vector<Mat6>& row) {
        const Topology& topology = model_.topology;
        const std::vector<std::uint32_t>& body_of = model_.tree.bodies.body_of;
        for (const std::uint32_t j : excluded_[i]) is_left_out_[j] = 1;
        for (std::uint32_t j = 0; j < topology.size(); ++j) {
            if (body_of[j] == body || is_left_out_[j] != 0) continue;
            const Vec3 x_i = state_.positions[i] - point, x_j = state_.positions[j] - point;
            const double r2 = (x_i - x_j).squaredNorm();
            if (r2 >= law_.reach2()) continue;
            row[body_of[j]] += pair_block(x_i, x_j, law_.plain(i, j, r2));
        }
        for (const std::uint32_t j : excluded_[i]) is_left_out_[j] = 0;
    }

    const TorsionModel& model_;
    const TorsionState& state_;
    TopologyPairHessian law_;
    std::vector<std::vector<std::uint32_t>> excluded_;
    std::vector<std::uint8_t> is_left_out_;  // of the atom at hand
};

// Blocks times screws: what one body gets from each coordinate, about a point of the body.
using Wrenches = Eigen::Matrix<double, 6, Eigen::Dynamic>;

void add_wrenches(const TorsionModel& model, const LocalCoordinates& coordinates,
                  std::span<const CoordinateMotion> motions, const Vec3& point,
                  std::vector<Mat6>& row, Wrenches& wrenches) {
    const std::vector<Body>& bodies = model.tree.bodies.bodies;
    std::vector<std::uint8_t> is_there(row.size());
    for (std::size_t b = bodies.size(); b-- > 0;) {
        is_there[b] |= static_cast<std::uint8_t>(!row[b].isZero(0));
        const std::uint32_t parent = bodies[b].parent;
        if (is_there[b] == 0) continue;
        if (parent != no_body) {
            row[parent] += row[b];
            is_there[parent] = 1;
        }
        for (const CarriedCoordinate& carried : coordinates.of(b)) {
            wrenches.col(carried.column) +=
                row[b] * motions[static_cast<std::size_t>(carried.column)].screw_at(point);
        }
    }
}

// From where both bodies are: -S_a^T (sum of blocks of what a moves with what b moves) S_b. Writes
// into `outward` the sum of each body's blocks, with all behind it, about the body's own point.
void add_pair_products(const TorsionModel& model, const LocalCoordinates& coordinates,
                       PairBlocks& blocks, const TorsionState& state,
                       std::span<const CoordinateMotion> motions, std::vector<Mat6>& outward,
                       Eigen::MatrixXd& all) {
    const std::vector<Body>& bodies = model.tree.bodies.bodies;
    outward.assign(bodies.size(), Mat6::Zero());
    std::vector<Mat6> row;
    // Of bodies on whose children work is done; empty where there is nothing.
    std::vector<Wrenches> wrenches(bodies.size());
    for (std::uint32_t a = static_cast<std::uint32_t>(bodies.size()); a-- > 0;) {
        Wrenches& of_a = wrenches[a];
        const Vec3 point = point_of(model, state, a);
        if (of_a.size() == 0) of_a.setZero(6, coordinates.size());
        blocks.update_row(a, point, row);
        for (const Mat6& block : row) outward[a] += block;
        add_wrenches(model, coordinates, motions, point, row, of_a);
        for (const CarriedCoordinate& carried : coordinates.of(a)) {
            all.row(carried.column) -=
                motions[static_cast<std::size_t>(carried.column)].screw_at(point).transpose() *
                of_a;
        }
        const std::uint32_t parent = bodies[a].parent;
        if (parent != no_body) {
            const Mat6 X = from_point(point_of(model, state, parent), point);
            outward[parent] += X.transpose() * outward[a] * X;
            Wrenches& of_parent = wrenches[parent];
            if (of_parent.size() == 0) of_parent.setZero(6, coordinates.size());
            of_parent += X.transpose() * of_a;
        }
        of_a.resize(6, 0);
    }
}

// The part from each body's blocks with all others, taken where the outer coordinate acts.
void add_outward(const TorsionModel& model, const LocalCoordinates& coordinates,
                 const TorsionState& state, std::span<const CoordinateMotion> motions,
                 std::span<const Mat6> outward, Eigen::MatrixXd& half) {
    std::vector<Vec3> points;
    std::vector<Vec6> inward(motions.size(), Vec6::Zero());
    for (std::uint32_t b = 0; b < outward.size(); ++b) {
        points.push_back(point_of(model, state, b));
        for (const CarriedCoordinate& carried : coordinates.of(b)) {
            const auto column = static_cast<std::size_t>(carried.column);
            inward[column] = outward[b].transpose() * motions[column].screw_at(points[b]);
        }
    }
    add_outward_products(model, coordinates, motions, points, inward, half);
}

}  // namespace

Mat6 pair_block(const Vec3& x_i, const Vec3& x_j, const PairHessian& pair) noexcept {
    const Vec3 d = x_i - x_j;
    Vec6 line;
    line << x_i.cross(d), d;
    const Mat3 X_i = cross_matrix(x_i), X_j = cross_matrix(x_j);
    Mat6 block = pair.second * line * line.transpose();
    block.topLeftCorner<3, 3>() -= pair.first * X_i * X_j;
    block.topRightCorner<3, 3>() += pair.first * X_i;
    block.bottomLeftCorner<3, 3>() -= pair.first * X_j;
    block.bottomRightCorner<3, 3>().diagonal().array() += pair.first;
    return block;
}

void add_outward_products(const TorsionModel& model, const LocalCoordinates& coordinates,
                          std::span<const CoordinateMotion> motions, std::span<const Vec3> points,
                          std::span<const Vec6> inward, Eigen::Ref<Eigen::MatrixXd> half) {
    const std::vector<Body>& bodies = model.tree.bodies.bodies;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        const auto product = [&](const CarriedCoordinate& inner, const CarriedCoordinate& outer) {
            return inward[static_cast<std::size_t>(inner.column)].dot(
                motions[static_cast<std::size_t>(outer.column)].screw_at(points[b]));
        };
        const std::span<const CarriedCoordinate> own = coordinates.of(b);
        for (std::size_t i = 0; i < own.size(); ++i) {
            half(own[i].column, own[i].column) += 0.5 * product(own[i], own[i]);
            for (std::size_t j = i + 1; j < own.size(); ++j) {
                double value = product(own[i], own[j]);
                // Turns come before displacements; of two turns both orders count alike.
                if (own[i].kind == own[j].kind) value = 0.5 * (value + product(own[j], own[i]));
                half(own[j].column, own[i].column) += value;
            }
            for (std::uint32_t a = bodies[b].parent; a != no_body; a = bodies[a].parent) {
                for (const CarriedCoordinate& outer : coordinates.of(a))
                    half(outer.column, own[i].column) += product(own[i], outer);
            }
        }
    }
}

void update_second_derivatives(const TorsionModel& model, const LocalCoordinates& coordinates,
                               const ModelPaths& paths, const NonbondedSettings& settings,
                               const TorsionState& state, SecondDerivatives& derivatives) {
    PALPA_ASSERT(!find_problem(settings));
    derivatives.mobile = coordinates.mobile;
    derivatives.all.setZero(coordinates.size(), coordinates.size());
    std::vector<CoordinateMotion> motions;
    update_motions(model, coordinates, state, motions);
    std::vector<Mat6> outward;
    PairBlocks blocks(model, settings, state);
    add_pair_products(model, coordinates, blocks, state, motions, outward, derivatives.all);
    Eigen::MatrixXd half = Eigen::MatrixXd::Zero(coordinates.size(), coordinates.size());
    add_outward(model, coordinates, state, motions, outward, half);
    add_term_derivatives(model, coordinates, paths, settings, state, motions, half);
    derivatives.all += half + half.transpose();
}

}  // namespace palpa
