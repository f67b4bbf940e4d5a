#include "tests/hard/ways_of_stepping.h"

#include "core/units.h"
#include "field/pair_field.h"
#include "statics/adaptive_step.h"
#include "statics/relax_joints.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

namespace palpa::test {
namespace {

Stepper full_steps(const TorsionModel& model, const QuasiStaticSettings& settings) {
    return [&model, settings, statics = std::make_shared<QuasiStatics>(build_quasi_statics(model))](
               TorsionState& state) { return step_quasi_static(model, settings, state, *statics); };
}

Stepper adaptive_steps(const TorsionModel& model, const QuasiStaticSettings& settings) {
    AdaptiveSettings adaptive;
    adaptive.step = settings;
    adaptive.limits.degrees_of_freedom = 8;
    adaptive.limits.shape = SelectionShape::Single;
    return [&model, adaptive,
            statics = std::make_shared<AdaptiveStatics>(build_adaptive_statics(model))](
               TorsionState& state) {
        const QuasiStaticReport report = step_adaptive(model, adaptive, state, *statics).step;
        complete_forces(model, *statics, state);
        return report;
    };
}

double pair_terms(const LennardJonesPair& pair, double charges, double distance) {
    const double r = std::max(distance, pair_core_radius);
    const double s6 = std::pow(pair.rmin / r, 6);
    return pair.epsilon * (s6 * s6 + 2 * s6) +
           std::abs(units::charmm_coulomb_constant * charges / r);
}

bool is_excluded(const Exclusions& exclusions, std::uint32_t low, std::uint32_t high) {
    return std::ranges::binary_search(exclusions.of(low), high);
}

// Both atoms of a joint's bond lie on its axis, and belong to both bodies.
std::vector<std::vector<std::uint32_t>> rigid_sets(const TorsionBodies& bodies) {
    std::vector<std::vector<std::uint32_t>> sets(bodies.bodies.size());
    for (std::uint32_t atom = 0; atom < bodies.body_of.size(); ++atom)
        sets[bodies.body_of[atom]].push_back(atom);
    for (std::size_t b = 0; b < bodies.bodies.size(); ++b) {
        if (bodies.is_base(b)) continue;
        const auto& [parent, axis] = bodies.bodies[b];
        sets[b].push_back(axis[0]);
        sets[parent].push_back(axis[1]);
    }
    return sets;
}

// Of what is no number too.
bool is_same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void check_relaxing(const TorsionModel& model, const ForceSettings& forces, RelaxMethod method,
                    TorsionState state, std::size_t steps) {
    RelaxSettings settings;
    settings.method = method;
    settings.steps = steps;
    settings.step.forces = forces;
    QuasiStatics statics = build_quasi_statics(model);
    TorsionState before = state;

    const JointRelaxReport report =
        relax_joints(model, settings, state, statics, [&](const RelaxProgress& progress) {
            CHECK(std::isfinite(progress.energy));
            CHECK(std::isfinite(progress.rms_force));
            CHECK(find_largest_move(before.positions, state.positions) <=
                  settings.largest_move * (1 + 1e-9));
            check_no_rise(model, before, state, rounding_of(forces));
            before = state;
            return true;
        });

    check_shape(model, state.positions);
    CHECK(is_same(report.energy_after, state.energy()));
    if (report.end == RelaxEnd::NotFinite) {
        CHECK_FALSE((is_finite(state) && std::isfinite(report.rms_force)));
        CHECK(report.steps == 0);
        return;
    }
    CHECK(is_finite(state));
    CHECK((report.rms_force <= settings.force_tolerance) == (report.end == RelaxEnd::Converged));
    CHECK((report.steps == steps || report.end != RelaxEnd::Steps));
}

}  // namespace

ForceSettings fast_forces() {
    ForceSettings forces;
    forces.fast = true;
    return forces;
}

const std::vector<WayOfStepping>& all_ways_of_stepping() {
    static const std::vector<WayOfStepping> ways{
        {"all joints, pairs in double",
         {},
         {"statics.method=quasi-static", "statics.pairs=double"},
         false,
         full_steps},
        {"all joints, fast pairs",
         fast_forces(),
         {"statics.method=quasi-static", "statics.pairs=fast"},
         false,
         full_steps},
        {"few joints, pairs in double",
         {},
         {"statics.pairs=double", "statics.active=8"},
         true,
         adaptive_steps},
        {"few joints, fast pairs",
         fast_forces(),
         {"statics.pairs=fast", "statics.active=8"},
         true,
         adaptive_steps},
    };
    return ways;
}

double rounding_of(const ForceSettings& forces) { return forces.fast ? 1e-6 : 1e-9; }

double exact_energy(const TorsionModel& model, const TorsionState& state) {
    ForceMemory memory;
    TorsionState exact = state;
    update_forces(model, {}, memory, exact);
    return exact.energy();
}

double sum_of_terms(const TorsionModel& model, const TorsionState& state) {
    ForceMemory memory;
    TorsionState exact = state;
    update_forces(model, {}, memory, exact);
    const EnergyTerms& terms = exact.terms;
    const Topology& topology = model.topology;
    double sum = terms.bond + terms.angle + terms.urey_bradley + terms.improper +
                 std::abs(terms.cmap) + exact.spring_energy;
    for (const Dihedral& dihedral : topology.dihedrals) sum += 2 * std::abs(dihedral.k);
    double largest = 0;
    const auto add = [&](const LennardJonesTable& table, std::uint32_t a, std::uint32_t b) {
        const double pair = pair_terms(table.row(topology.type[a])[topology.type[b]],
                                       topology.charge[a] * topology.charge[b],
                                       (state.positions[a] - state.positions[b]).norm());
        sum += pair;
        largest = std::max(largest, pair);
    };
    for (std::uint32_t a = 0; a < topology.size(); ++a) {
        for (std::uint32_t b = a + 1; b < topology.size(); ++b) {
            if (!is_excluded(topology.exclusions, a, b)) add(topology.lennard_jones, a, b);
        }
    }
    for (const auto& [a, b] : topology.exclusions.pairs14) add(topology.lennard_jones14, a, b);
    // A single pair, which in a clash is most of the sum, may be twice as far off.
    return sum + largest;
}

bool is_finite(const TorsionState& state) {
    const auto all_finite = [](const std::vector<Vec3>& vectors) {
        return std::ranges::all_of(vectors, [](const Vec3& v) { return v.allFinite(); });
    };
    return std::isfinite(state.energy()) && all_finite(state.positions) &&
           all_finite(state.forces) &&
           std::ranges::all_of(state.angles, [](double angle) { return std::isfinite(angle); });
}

void check_shape(const TorsionModel& model, const std::vector<Vec3>& positions) {
    double worst = 0;
    for (const std::vector<std::uint32_t>& atoms : rigid_sets(model.tree.bodies)) {
        for (const std::uint32_t a : atoms) {
            for (const std::uint32_t b : atoms) {
                const double distance = (positions[a] - positions[b]).norm(),
                             first = (model.reference[a] - model.reference[b]).norm();
                worst = std::max(worst, std::abs(distance - first));
            }
        }
    }
    CHECK(worst < 1e-8);
}

void check_no_rise(const TorsionModel& model, const TorsionState& from, const TorsionState& to,
                   double rounding) {
    const double before = exact_energy(model, from), after = exact_energy(model, to);
    if (after <= before) return;
    CHECK(after - before <= rounding * sum_of_terms(model, from));
}

Outcome check_steps(const TorsionModel& model, const WayOfStepping& way, TorsionState& state,
                    int steps) {
    QuasiStaticSettings settings;
    settings.forces = way.forces;
    const Stepper step = way.start(model, settings);
    ForceMemory memory;
    update_forces(model, way.forces, memory, state);
    const TorsionState start = state;
    Outcome outcome;
    for (int i = 0; i < steps && outcome.is_finite; ++i) {
        const TorsionState before = state;
        const QuasiStaticReport report = step(state);
        outcome.is_finite = report.is_finite;
        const double far = find_largest_move(before.positions, state.positions);
        if (!report.is_taken) {
            ++outcome.refused;
            CHECK(far <= (way.is_renewed ? 1e-9 : 0));
            if (!way.is_renewed || !std::isfinite(before.energy())) {
                CHECK(is_same(state.energy(), before.energy()));
            } else {
                CHECK(std::abs(state.energy() - before.energy()) <=
                      rounding_of(way.forces) * sum_of_terms(model, before));
            }
            continue;
        }
        ++outcome.taken;
        outcome.bounded += report.is_bounded ? 1 : 0;
        CHECK(is_finite(state));
        CHECK(report.is_finite);
        const double change = state.energy() - before.energy();
        if (report.energy_change != change) {
            CHECK(way.is_renewed);
            // Both energies are rounded.
            const double most = sum_of_terms(model, before) + sum_of_terms(model, state);
            CHECK(std::abs(report.energy_change - change) <= rounding_of(way.forces) * most);
        }
        CHECK(far <= settings.largest_move * (1 + 1e-9));
        CHECK(report.largest_move == Approx(far).margin(1e-12));
        check_no_rise(model, before, state, rounding_of(way.forces));
    }
    if (outcome.taken > 0) check_no_rise(model, start, state, rounding_of(way.forces));
    check_shape(model, state.positions);
    return outcome;
}

void check_all_ways(const TorsionModel& model, const TorsionState& start, int steps,
                    const std::function<void(const Outcome&, const TorsionState&)>& look) {
    for (const WayOfStepping& way : all_ways_of_stepping()) {
        INFO(way.name);
        TorsionState state = start;
        const Outcome outcome = check_steps(model, way, state, steps);
        if (look) look(outcome, state);
    }
    for (const ForceSettings& forces : {ForceSettings{}, fast_forces()}) {
        INFO((forces.fast ? "fast pairs" : "pairs in double"));
        for (const RelaxMethod method : {RelaxMethod::QuasiStatic, RelaxMethod::SecondOrder}) {
            INFO("method " << static_cast<int>(method));
            check_relaxing(model, forces, method, start, static_cast<std::size_t>(steps));
        }
    }
}

}  // namespace palpa::test
