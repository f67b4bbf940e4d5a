#include "statics/fast_second_derivatives.h"

#include "forces/fast_nonbonded.h"
#include "forces/pair_hessian.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace palpa {
namespace {

// One entry per atom; empty without solvation.
class AllSolvation {
public:
    explicit AllSolvation(const Topology& topology) {
        if (!topology.solvation) return;
        for (std::size_t i = 0; i < topology.size(); ++i) {
            const SolvationAtom atom = solvation_atom(*topology.solvation, i);
            volume_.push_back(atom.volume);
            strength_.push_back(atom.strength);
            inverse_lambda_.push_back(atom.inverse_lambda);
            radius_.push_back(atom.radius);
        }
    }

    SolvationParameters parameters() const noexcept {
        return {volume_, strength_, inverse_lambda_, radius_};
    }

private:
    std::vector<double> volume_, strength_, inverse_lambda_, radius_;
};

Vec3 middle_of(std::span<const Vec3> positions) noexcept {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& place : positions) sum += place;
    return positions.empty() ? sum : Vec3(sum / static_cast<double>(positions.size()));
}

// Pairs whose numbers are not combined.
std::vector<RadialSlopes> find_replaced(const TorsionModel& model,
                                        const NonbondedSettings& settings,
                                        std::span<const Vec3> positions) {
    const TopologyPairHessian law(model.topology, settings);
    std::vector<RadialSlopes> slopes;
    for (const auto& [i, j] : model.fast.atoms.replaced()) {
        const PairHessian pair = law.plain(i, j, (positions[i] - positions[j]).squaredNorm());
        slopes.push_back({pair.first, pair.second});
    }
    return slopes;
}

// As the plan numbers them, the transpose of the rows that the kernel writes.
Eigen::Map<Eigen::MatrixXd, Eigen::Aligned64, Eigen::OuterStride<>> half_of(
    const LocalCoordinates& ordered, HessianSums& sums) {
    const auto stride = static_cast<Eigen::Index>(sums.blocks * hessian_block);
    return {sums.products.front().at.data(), ordered.size(), ordered.size(),
            Eigen::OuterStride<>(stride)};
}

// The half and its transpose, as the coordinates number them.
void write_whole(const FastSecondDerivatives& fast, HessianSums& sums, Eigen::MatrixXd& all) {
    const auto half = half_of(fast.ordered, sums);
    constexpr Eigen::Index tile = 8;
    const Eigen::Index size = half.cols();
    const auto write_tile = [&](Eigen::Index first_a, Eigen::Index first_b) {
        for (Eigen::Index a = first_a; a < std::min(size, first_a + tile); ++a) {
            for (Eigen::Index b = first_b; b < std::min(a + 1, first_b + tile); ++b) {
                const double value = half(b, a) + half(a, b);
                const Eigen::Index i = fast.column_of[static_cast<std::size_t>(a)];
                const Eigen::Index j = fast.column_of[static_cast<std::size_t>(b)];
                all(j, i) = value;
                all(i, j) = value;
            }
        }
    };
    for (Eigen::Index a = 0; a < size; a += tile) {
        for (Eigen::Index b = 0; b <= a; b += tile) write_tile(a, b);
    }
}

void add_outward(const TorsionModel& model, const FastSecondDerivatives& fast, const Vec3& origin,
                 SecondDerivativesMemory& memory) {
    const std::vector<Body>& bodies = model.tree.bodies.bodies;
    std::vector<Mat6>& outward = memory.sums.rows;
    std::vector<Vec6> inward(memory.motions.size(), Vec6::Zero());
    for (std::size_t b = bodies.size(); b-- > 0;) {
        for (const CarriedCoordinate& carried : fast.ordered.of(b)) {
            const auto a = static_cast<std::size_t>(carried.column);
            inward[a] = outward[b].transpose() * memory.motions[a].screw_at(origin);
            const WrenchBlock& block = memory.sums.wrenches[a / hessian_block];
            for (std::size_t i = 0; i < 6; ++i)
                inward[a][static_cast<int>(i)] += block.at[i][a % hessian_block];
        }
        if (bodies[b].parent != no_body) outward[bodies[b].parent] += outward[b];
    }
    add_outward_products(model, fast.ordered, memory.motions,
                         std::vector<Vec3>(bodies.size(), origin), inward,
                         half_of(fast.ordered, memory.sums));
}

// Numbers coordinates as the plan does, ends of springs last.
void number_in_order(const LocalCoordinates& coordinates, FastSecondDerivatives& fast) {
    fast.ordered = coordinates;
    for (const std::uint32_t motion : fast.plan.motions) {
        CarriedCoordinate& carried = fast.ordered.carried[motion];
        fast.column_of.push_back(carried.column);
        carried.column = static_cast<Eigen::Index>(fast.column_of.size()) - 1;
    }
    for (LocalCoordinates::SpringEnd& end : fast.ordered.ends) {
        const auto first = static_cast<Eigen::Index>(fast.column_of.size());
        for (Eigen::Index axis = 0; axis < 3; ++axis) fast.column_of.push_back(end.column + axis);
        end.column = first;
    }
}

}  // namespace

FastSecondDerivatives build_fast_second_derivatives(const TorsionModel& model,
                                                    const LocalCoordinates& coordinates) {
    const AssemblyTree& tree = model.tree;
    std::vector<std::uint32_t> parents, motions;
    for (std::size_t b = 0; b < tree.bodies.bodies.size(); ++b) {
        parents.push_back(tree.bodies.bodies[b].parent);
        motions.push_back(static_cast<std::uint32_t>(coordinates.of(b).size()));
    }
    const FastAtoms& atoms = model.fast.atoms;
    const AllSolvation solvation(model.topology);
    FastSecondDerivatives fast;
    fast.paths = build_model_paths(model);
    fast.plan = build_hessian_plan({parents, tree.first_atom, tree.atoms, motions},
                                   {model.topology.charge, atoms.sqrt_epsilon, atoms.half_rmin},
                                   solvation.parameters(), atoms.left_out, atoms.first_replaced);
    number_in_order(coordinates, fast);
    return fast;
}

bool update_fast_second_derivatives(const TorsionModel& model, const LocalCoordinates& coordinates,
                                    const FastSecondDerivatives& fast,
                                    const NonbondedSettings& settings, const TorsionState& state,
                                    SecondDerivativesMemory& memory,
                                    SecondDerivatives& derivatives) {
    const auto use_reference = [&] {
        update_second_derivatives(model, coordinates, fast.paths, settings, state, derivatives);
        return false;
    };
    const PairScheme scheme = pair_scheme(settings);
    if (!has_hessian_kernel(scheme) || settings.solvation == SolvationEnd::Sharp)
        return use_reference();
    const Vec3 origin = middle_of(state.positions);
    update_motions(model, fast.ordered, state, memory.motions);
    std::vector<Vec6> screws;
    for (const CarriedCoordinate& carried : fast.ordered.carried) {
        screws.push_back(memory.motions[static_cast<std::size_t>(carried.column)].screw_at(origin));
    }
    const bool is_sound =
        update_hessian_sums(fast.plan, scheme, state.positions, origin, screws,
                            find_replaced(model, settings, state.positions),
                            static_cast<std::size_t>(coordinates.size()), memory.sums);
    if (!is_sound) return use_reference();
    add_outward(model, fast, origin, memory);
    add_term_derivatives(model, fast.ordered, fast.paths, settings, state, memory.motions,
                         half_of(fast.ordered, memory.sums));
    derivatives.mobile = coordinates.mobile;
    derivatives.all.resize(coordinates.size(), coordinates.size());
    write_whole(fast, memory.sums, derivatives.all);
    return true;
}

}  // namespace palpa
