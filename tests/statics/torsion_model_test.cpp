#include "statics/torsion_model.h"

#include "forces/force_field.h"
#include "tests/support/torsion_case.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

// Whether the distances between some atoms stay as they are, found by moving.
class Distances {
public:
    explicit Distances(const TorsionModel& model) : reference_(model.reference) {
        std::mt19937 random(11);
        TorsionState state = build_torsion_state(model);
        for (int i = 0; i < 5; ++i) {
            add_move(model, test::random_move(model, 1, random), state);
            moved_.push_back(state.positions);
        }
    }

    template <class Atoms>
    bool stay(const Atoms& atoms) const {
        for (const std::uint32_t a : atoms) {
            for (const std::uint32_t b : atoms) {
                const double before = (reference_[a] - reference_[b]).norm();
                for (const std::vector<Vec3>& positions : moved_) {
                    if (std::abs((positions[a] - positions[b]).norm() - before) > 1e-9)
                        return false;
                }
            }
        }
        return true;
    }

private:
    std::vector<Vec3> reference_;
    std::vector<std::vector<Vec3>> moved_;
};

// How many terms have distances that change; `atoms_of` gives a term's atoms.
template <class Terms, class AtomsOf>
std::size_t count_changing(const Distances& distances, const Terms& terms,
                           const AtomsOf& atoms_of) {
    return static_cast<std::size_t>(std::ranges::count_if(
        terms, [&](const auto& term) { return !distances.stay(atoms_of(term)); }));
}

}  // namespace

TEST_CASE("joints come first among the coordinates, then the bases that move", "[statics][model]") {
    using enum BaseFreedom;
    const test::FlexibleCase pair = test::with_copy(test::alanine_dipeptide(), {8, 0, 0});

    const TorsionModel model = test::model_of(pair, {Turning, Free});

    // phi and psi of each
    CHECK(model.coordinates == 4 + 3 + 6);
    CHECK(model.coordinate_of_base == std::vector<Eigen::Index>{4, 7});
    CHECK(model.coordinate_of_body == std::vector<Eigen::Index>{-1, 0, 1, -1, 2, 3});
    CHECK(test::model_of(pair, {Held, Free}).coordinate_of_base ==
          std::vector<Eigen::Index>{-1, 4});
    CHECK(test::model_of(pair, {Held, Held}).coordinates == 4);
    double mass = 0;
    for (std::size_t i = 0; i < 22; ++i) mass += pair.connectivity.mass[i];
    CHECK(model.molecule_masses == std::vector<double>{mass, mass});
}

TEST_CASE("terms are kept where a distance within them changes, and dropped else",
          "[statics][model]") {
    const bool is_small = GENERATE(true, false);
    const test::FlexibleCase c = is_small ? test::alanine_dipeptide() : test::tetrapeptide();
    const TorsionModel model = test::model_of(c, {BaseFreedom::Free});
    const Distances distances(model);
    const auto changing = [&](const auto& terms, const auto& atoms_of) {
        return count_changing(distances, terms, atoms_of);
    };
    const auto four = [](const auto& t) { return std::array{t.a, t.b, t.c, t.d}; };

    // No bond or angle ever changes.
    CHECK(model.topology.bonds.empty());
    CHECK(model.topology.angles.empty());
    CHECK(model.topology.urey_bradleys.empty());
    CHECK(changing(c.topology.angles, [](const Angle& t) { return std::array{t.a, t.b, t.c}; }) ==
          0);
    CHECK(model.topology.dihedrals.size() == changing(c.topology.dihedrals, four));
    CHECK(model.topology.impropers.size() == changing(c.topology.impropers, four));
    CHECK(changing(model.topology.dihedrals, four) == model.topology.dihedrals.size());
    CHECK(model.topology.dihedrals.size() < c.topology.dihedrals.size());
    CHECK(model.topology.cmap_terms.size() == c.topology.cmap_terms.size());
    const auto& pairs = model.topology.exclusions.pairs14;
    const auto both = [](const std::array<std::uint32_t, 2>& pair) { return pair; };
    CHECK(pairs.size() == changing(c.topology.exclusions.pairs14, both));
    CHECK(changing(pairs, both) == pairs.size());
    CHECK(model.topology.exclusions.atoms == c.topology.exclusions.atoms);
}

TEST_CASE("what is dropped costs the same everywhere and pulls at no coordinate",
          "[statics][model]") {
    using enum BaseFreedom;
    const test::FlexibleCase pair = test::with_copy(test::tetrapeptide(), {14, 3, -2});
    const TorsionModel model = test::model_of(pair, {Free, Turning});
    TorsionModel full = model;
    full.topology = pair.topology;
    ForceMemory memory;
    std::mt19937 random(5);
    TorsionState state = build_torsion_state(model);
    std::vector<double> dropped;

    for (int i = 0; i < 20; ++i) {
        TorsionState whole = state;
        update_forces(model, {}, memory, state);
        update_forces(full, {}, memory, whole);
        update_coordinate_forces(model, state);
        update_coordinate_forces(full, whole);
        dropped.push_back(whole.energy() - state.energy());

        // Rounding of the largest terms: atoms come close to each other on the way.
        const double scale = std::abs(whole.energy()) + std::abs(dropped[0]);
        CHECK(std::abs(dropped.back() - dropped[0]) < 1e-10 * scale);
        CHECK((whole.coordinate_forces - state.coordinate_forces).norm() <
              1e-10 * (1 + whole.coordinate_forces.norm() + test::stacked(whole.forces).norm()));
        add_move(model, test::random_move(model, 0.1, random), state);
    }
    CHECK(std::abs(dropped[0]) > 10);
}
