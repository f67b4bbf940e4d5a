#include "devices/mouse_lead.h"

#include <catch2/catch.hpp>

using namespace palpa;

namespace {

// A hand that pulls by 12 mm at most, with its handle at 0.1 m.
MouseLead lead_at_rest() {
    MouseLead lead(0.012);
    lead.see(Vec3(0.1, 0, 0), 0.25e9);
    lead.rest();
    return lead;
}

}  // namespace

TEST_CASE("a way in the picture is A_d times as long for the handle, as far as the hand pulls",
          "[devices][mouse]") {
    MouseLead lead = lead_at_rest();

    lead.pull(Vec3(0, 0.2, 0));
    CHECK((lead.target_m() - Vec3(0.1, 0.2e-10 * 0.25e9, 0)).norm() < 1e-12);
    lead.rest();
    CHECK(lead.target_m() == Vec3(0.1, 0, 0));
    lead.pull(Vec3(0, 0.2, 0));
    CHECK((lead.ahead_m() - Vec3(0, 0.005, 0)).norm() < 1e-12);

    // Farther than it pulls it does not go, so that coming back is felt at once.
    lead.pull(Vec3(0, 100, 0));
    CHECK(lead.ahead_m().norm() == Approx(0.012));
    lead.pull(Vec3(0, -0.2, 0));
    CHECK(lead.ahead_m().norm() == Approx(0.007));
    // A model without a gain leaves the last one.
    lead.see(Vec3::Zero(), 0);
    CHECK(lead.displacement_gain() == 0.25e9);
}

TEST_CASE("a hand that clutches pulls at nothing, and takes hold where the handle is",
          "[devices][mouse]") {
    MouseLead lead = lead_at_rest();
    lead.pull(Vec3(0.2, 0, 0));
    lead.engage();  // it holds: nothing changes
    CHECK(lead.ahead_m().norm() == Approx(0.005));

    lead.clutch();
    CHECK(lead.is_clutched());
    CHECK(lead.ahead_m() == Vec3::Zero());
    lead.see(Vec3(0.02, 0, 0), 0.25e9);
    lead.engage();
    CHECK_FALSE(lead.is_clutched());
    CHECK(lead.target_m() == Vec3(0.02, 0, 0));
}
