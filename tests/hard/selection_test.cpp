// Which joints wake where forces are those of clashes, and limits leave none or all of them.
#include "assembly/selection.h"

#include "assembly/metric.h"
#include "statics/step_quasi_static.h"
#include "tests/support/torsion_case.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <limits>

using namespace palpa;

namespace {

// Two peptides in one place, with the accelerations that this causes.
struct Clash {
    TorsionModel model = test::model_of(test::with_copy(test::tetrapeptide(), {0.5, 0.3, 0}),
                                        {BaseFreedom::Turning, BaseFreedom::Free});
    QuasiStatics statics = build_quasi_statics(model);
    AccelerationMetric metric = build_acceleration_metric(model.tree);
    JointSelection selection = build_joint_selection(model.tree);

    Clash() {
        TorsionState state = build_torsion_state(model);
        Coordinates accelerations;
        update_forces(model, {}, statics.memory, state);
        update_coordinate_accelerations(model, state, statics.assembly, accelerations);
        update_metric(model.tree, statics.assembly, {}, metric);
    }

    void select(std::size_t degrees_of_freedom) {
        SelectionLimits limits;
        limits.degrees_of_freedom = degrees_of_freedom;
        select_joints(model.tree, metric, {}, limits, statics.assembly, selection);
    }

    // Counted from what is active; a base that turns about a point has three.
    std::size_t count_active() const {
        std::size_t count = 0;
        for (std::size_t b = 0; b < selection.is_active.size(); ++b) {
            if (selection.is_active[b] == 0) continue;
            const bool is_first = b == model.tree.bases[0], is_second = b == model.tree.bases[1];
            count += is_first ? 3 : is_second ? 6 : 1;
        }
        return count;
    }
};

}  // namespace

TEST_CASE("a budget of a microsecond wakes nothing and neglects all of it", "[hard]") {
    Clash clash;
    const std::size_t affordable = degrees_of_freedom_within(1, {.fixed_us = 40, .each_us = 0.5});
    REQUIRE(affordable == 0);

    clash.select(affordable);

    CHECK(clash.selection.degrees_of_freedom == 0);
    CHECK(clash.count_active() == 0);
    CHECK(std::isfinite(clash.selection.total));
    CHECK(clash.selection.total > 0);
    CHECK(clash.selection.neglected == clash.selection.total);
}

TEST_CASE("times and costs that make no sense allow no joint, or all that there can be", "[hard]") {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double smallest = std::numeric_limits<double>::denorm_min();

    CHECK(degrees_of_freedom_within(0, {0, 1}) == 0);
    CHECK(degrees_of_freedom_within(-1, {0, 1}) == 0);
    CHECK(degrees_of_freedom_within(-infinity, {0, 1}) == 0);
    CHECK(degrees_of_freedom_within(std::nan(""), {0, 1}) == 0);
    CHECK(degrees_of_freedom_within(1, {infinity, 1}) == 0);
    CHECK(degrees_of_freedom_within(1, {0, infinity}) == 0);
    CHECK(degrees_of_freedom_within(1e300, {0, 1}) == 1'000'000'000);
    CHECK(degrees_of_freedom_within(infinity, {0, 1}) == 1'000'000'000);
    CHECK(degrees_of_freedom_within(1, {0, smallest}) == 1'000'000'000);
}

TEST_CASE("more active degrees of freedom than there are wake all of them", "[hard]") {
    Clash clash;
    const auto all = static_cast<std::size_t>(clash.model.coordinates);
    constexpr std::size_t most = std::numeric_limits<std::size_t>::max();
    for (const std::size_t wanted : {all, all + 1, std::size_t{1'000'000'000}, most}) {
        INFO(wanted);
        clash.select(0);
        clash.select(wanted);

        CHECK(clash.selection.degrees_of_freedom == all);
        CHECK(clash.count_active() == all);
        CHECK(std::abs(clash.selection.neglected) < 1e-9 * clash.selection.total);
    }
}

TEST_CASE("one degree of freedom is never a base, and never two", "[hard]") {
    Clash clash;

    clash.select(1);

    CHECK(clash.selection.degrees_of_freedom <= 1);
    CHECK(clash.count_active() == clash.selection.degrees_of_freedom);
    CHECK(clash.selection.neglected <= clash.selection.total);
}
