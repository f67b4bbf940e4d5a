// Contributions of bonded terms, 1-4 pairs and springs to the second derivatives of the energy
// along coordinates: each term over the coordinates that change it.
#pragma once
#include "statics/local_coordinates.h"

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// A body that moves some of a term's atoms relative to others: bit a is set for atom a of the term.
struct TermStep {
    std::uint32_t body;
    std::uint32_t atoms;
};

// For terms of one kind: the bodies that change term t are in [first[t], first[t + 1]), parents
// before children.
struct TermPaths {
    std::vector<std::size_t> first;
    std::vector<TermStep> steps;

    std::span<const TermStep> of(std::size_t term) const noexcept {
        return std::span(steps).subspan(first[term], first[term + 1] - first[term]);
    }
};

// Constant data of a model's topology.
struct ModelPaths {
    TermPaths bonds, angles, urey_bradleys, dihedrals, impropers, cmap_terms, pairs14;
};

ModelPaths build_model_paths(const TorsionModel& model);

// Adds the contributions of the terms and of the state's springs to half of the second derivatives:
// the sum with its transpose gives all of them. `motions` are those of the state.
void add_term_derivatives(const TorsionModel& model, const LocalCoordinates& coordinates,
                          const ModelPaths& paths, const NonbondedSettings& settings,
                          const TorsionState& state, std::span<const CoordinateMotion> motions,
                          Eigen::Ref<Eigen::MatrixXd> half);

}  // namespace palpa
