#include "statics/pair_derivatives.h"

#include "forces/pair_hessian.h"

#include <cstddef>
#include <unordered_map>
#include <vector>

namespace palpa {
namespace {

using PairSpan = std::span<const std::array<std::uint32_t, 2>>;

struct ListedPair {
    std::uint32_t i, j;
    PairHessian hessian;
};

// Those of atoms that move against each other and are in reach.
std::vector<ListedPair> evaluate_pairs(const TorsionModel& model, PairSpan pairs, PairSpan solvated,
                                       const NonbondedSettings& settings,
                                       const TorsionState& state) {
    const std::vector<std::uint32_t>& body_of = model.tree.bodies.body_of;
    const TopologyPairHessian vacuum(model.topology, without_solvation(settings));
    const TopologyPairHessian water(model.topology, settings);
    std::vector<ListedPair> listed;
    listed.reserve(pairs.size() + solvated.size());
    const auto add = [&](PairSpan of, double reach2, auto&& hessian) {
        for (const auto& [i, j] : of) {
            const double r2 = (state.positions[i] - state.positions[j]).squaredNorm();
            if (body_of[i] != body_of[j] && r2 < reach2)
                listed.push_back({i, j, hessian(i, j, r2)});
        }
    };
    add(pairs, vacuum.reach2(), [&](auto i, auto j, double r2) { return vacuum.plain(i, j, r2); });
    add(solvated, water.reach2(),
        [&](auto i, auto j, double r2) { return water.solvation(i, j, r2); });
    return listed;
}

// The coordinates that move an atom of a listed pair, numbered one after the other.
struct MovingCoordinates {
    std::vector<std::uint32_t> bodies;    // that carry them, rising: a parent before its children
    LocalCoordinates numbered;            // other bodies carry none
    std::vector<Eigen::Index> column_of;  // of each among all
};

MovingCoordinates find_moving(const TorsionModel& model, const LocalCoordinates& coordinates,
                              std::span<const ListedPair> listed) {
    const std::vector<Body>& bodies = model.tree.bodies.bodies;
    std::vector<std::uint8_t> is_moving(bodies.size(), 0);
    for (const ListedPair& pair : listed) {
        is_moving[model.tree.bodies.body_of[pair.i]] = 1;
        is_moving[model.tree.bodies.body_of[pair.j]] = 1;
    }
    for (std::size_t b = bodies.size(); b-- > 0;) {
        if (is_moving[b] != 0 && bodies[b].parent != no_body) is_moving[bodies[b].parent] = 1;
    }
    MovingCoordinates moving;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        moving.numbered.first.push_back(moving.numbered.carried.size());
        if (is_moving[b] == 0) continue;
        moving.bodies.push_back(b);
        for (CarriedCoordinate carried : coordinates.of(b)) {
            moving.column_of.push_back(carried.column);
            carried.column = moving.numbered.mobile++;
            moving.numbered.carried.push_back(carried);
        }
    }
    moving.numbered.first.push_back(moving.numbered.carried.size());
    return moving;
}

// Blocks times screws: what a body, with all that hang on it, gets from each coordinate.
using WrenchColumns = Eigen::Matrix<double, 6, Eigen::Dynamic>;

class PairProducts {
public:
    PairProducts(const TorsionModel& model, std::span<const ListedPair> listed,
                 const MovingCoordinates& moving, const TorsionState& state, const Vec3& origin)
        : model_(model),
          moving_(moving),
          state_(state),
          origin_(origin),
          outward_(model.tree.bodies.bodies.size(), Mat6::Zero()),
          wrenches_(outward_.size()),
          row_(outward_.size(), Mat6::Zero()),
          of_body_(outward_.size()) {
        sum_blocks(listed);
        update_motions(model, moving.numbered, state, motions_);
        for (const CoordinateMotion& motion : motions_) screws_.push_back(motion.screw_at(origin));
    }

    // Of the numbered coordinates.
    Eigen::MatrixXd sum() {
        const auto size = static_cast<Eigen::Index>(motions_.size());
        Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size, size);
        for (std::size_t k = moving_.bodies.size(); k-- > 0;) add_body(moving_.bodies[k], all);
        Eigen::MatrixXd half = Eigen::MatrixXd::Zero(size, size);
        std::vector<Vec6> inward(motions_.size(), Vec6::Zero());
        for (const std::uint32_t b : moving_.bodies) {
            for (const CarriedCoordinate& carried : moving_.numbered.of(b)) {
                const auto column = static_cast<std::size_t>(carried.column);
                inward[column] = outward_[b].transpose() * screws_[column];
            }
        }
        add_outward_products(model_, moving_.numbered, motions_,
                             std::vector<Vec3>(outward_.size(), origin_), inward, half);
        all += half + half.transpose();
        return all;
    }

private:
    // Of each two bodies once: that of the other way round is its transpose.
    void sum_blocks(std::span<const ListedPair> listed) {
        const std::vector<std::uint32_t>& body_of = model_.tree.bodies.body_of;
        std::unordered_map<std::uint64_t, std::uint32_t> number_of;
        for (const ListedPair& pair : listed) {
            const bool is_swapped = body_of[pair.j] < body_of[pair.i];
            const std::uint32_t i = is_swapped ? pair.j : pair.i, j = is_swapped ? pair.i : pair.j;
            const std::uint32_t a = body_of[i], b = body_of[j];
            const auto [found, is_new] = number_of.try_emplace(
                std::uint64_t{a} << 32U | b, static_cast<std::uint32_t>(blocks_.size()));
            if (is_new) {
                blocks_.emplace_back(Mat6::Zero());
                of_body_[a].push_back({b, found->second, false});
                of_body_[b].push_back({a, found->second, true});
            }
            blocks_[found->second] += pair_block(state_.positions[i] - origin_,
                                                 state_.positions[j] - origin_, pair.hessian);
        }
    }

    // The blocks of a body, along all that moves the other one.
    void add_own(std::uint32_t body, WrenchColumns& wrenches) {
        for (const Block& of : of_body_[body]) {
            Mat6& row = row_[of.other];
            const Mat6& block = blocks_[of.number];
            if (of.is_transposed) {
                row = block.transpose();
            } else {
                row = block;
            }
            outward_[body] += row;
        }
        for (std::size_t k = moving_.bodies.size(); k-- > 0;) {
            const std::uint32_t b = moving_.bodies[k], parent = model_.tree.bodies.bodies[b].parent;
            if (row_[b].isZero(0)) continue;
            for (const CarriedCoordinate& carried : moving_.numbered.of(b)) {
                wrenches.col(carried.column) +=
                    row_[b] * screws_[static_cast<std::size_t>(carried.column)];
            }
            if (parent != no_body) row_[parent] += row_[b];
            row_[b].setZero();
        }
    }

    void add_body(std::uint32_t body, Eigen::MatrixXd& all) {
        WrenchColumns& wrenches = wrenches_[body];
        if (wrenches.size() == 0) wrenches.setZero(6, all.cols());
        if (!of_body_[body].empty()) add_own(body, wrenches);
        for (const CarriedCoordinate& carried : moving_.numbered.of(body)) {
            all.col(carried.column).noalias() -=
                wrenches.transpose() * screws_[static_cast<std::size_t>(carried.column)];
        }
        const std::uint32_t parent = model_.tree.bodies.bodies[body].parent;
        if (parent != no_body) {
            outward_[parent] += outward_[body];
            if (wrenches_[parent].size() == 0) {
                wrenches_[parent] = std::move(wrenches);
            } else {
                wrenches_[parent] += wrenches;
            }
        }
        wrenches.resize(6, 0);
    }

    const TorsionModel& model_;
    const MovingCoordinates& moving_;
    const TorsionState& state_;
    const Vec3 origin_;
    std::vector<CoordinateMotion> motions_;
    std::vector<Vec6> screws_;  // of each motion, about the origin
    std::vector<Mat6> outward_;
    std::vector<WrenchColumns> wrenches_;  // of bodies on whose children work is done
    std::vector<Mat6> row_;                // zero between calls
    std::vector<Mat6> blocks_;
    struct Block {
        std::uint32_t other;  // body
        std::uint32_t number;
        bool is_transposed;
    };
    std::vector<std::vector<Block>> of_body_;
};

}  // namespace

void update_pair_derivatives(const TorsionModel& model, const LocalCoordinates& coordinates,
                             PairSpan pairs, PairSpan solvated, const NonbondedSettings& settings,
                             const TorsionState& state, SecondDerivatives& derivatives) {
    derivatives.mobile = coordinates.mobile;
    derivatives.all.setZero(coordinates.size(), coordinates.size());
    const std::vector<ListedPair> listed = evaluate_pairs(model, pairs, solvated, settings, state);
    if (listed.empty()) return;
    // Among the atoms, so that turns about it are no larger than they need be.
    Vec3 origin = Vec3::Zero();
    for (const ListedPair& pair : listed) origin += state.positions[pair.i];
    origin /= static_cast<double>(listed.size());
    const MovingCoordinates moving = find_moving(model, coordinates, listed);
    const Eigen::MatrixXd sum = PairProducts(model, listed, moving, state, origin).sum();
    for (Eigen::Index b = 0; b < sum.cols(); ++b) {
        for (Eigen::Index a = 0; a < sum.rows(); ++a)
            derivatives.all(moving.column_of[static_cast<std::size_t>(a)],
                            moving.column_of[static_cast<std::size_t>(b)]) = sum(a, b);
    }
}

}  // namespace palpa
