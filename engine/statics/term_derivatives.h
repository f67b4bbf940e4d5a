// What bonded terms, pairs three bonds apart and springs add to the second derivatives of the
// energy along coordinates: each term by itself, over the coordinates that change it.
#pragma once
#include "statics/local_coordinates.h"

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// A body that moves some of a term's atoms against others: bit a is set for atom a of the term.
struct TermStep {
    std::uint32_t body;
    std::uint32_t atoms;
};

// Of terms of one kind: the bodies that change term t stand in [first[t], first[t + 1]), a parent
// before what is attached to it.
struct TermPaths {
    std::vector<std::size_t> first;
    std::vector<TermStep> steps;

    std::span<const TermStep> of(std::size_t term) const noexcept {
        return std::span(steps).subspan(first[term], first[term + 1] - first[term]);
    }
};

// Of a model's topology; constant.
struct ModelPaths {
    TermPaths bonds, angles, urey_bradleys, dihedrals, impropers, cmap_terms, pairs14;
};

ModelPaths build_model_paths(const TorsionModel& model);

// Adds what the terms and the state's springs contribute to half of the second derivatives: a
// matrix that with its transpose makes all of them. `motions` are those of the state.
void add_term_derivatives(const TorsionModel& model, const LocalCoordinates& coordinates,
                          const ModelPaths& paths, const NonbondedSettings& settings,
                          const TorsionState& state, std::span<const CoordinateMotion> motions,
                          Eigen::Ref<Eigen::MatrixXd> half);

}  // namespace palpa
