#include "simulation/systems/follow_hands.h"

#include "core/assertion.h"
#include "core/units.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"

#include <cstddef>
#include <vector>

namespace palpa {
namespace {

// The new pose of what is held, and the gain that decided it.
struct Move {
    MoleculePose to;
    std::optional<double> displacement_gain = {};
};

Move find_move(const DisplacementLaw& law, const Grip& grip, const Hand& before,
               const HandPose& pose, const ContactModel& felt, std::uint32_t grip_number) noexcept {
    // A pose of the servo counts for the grip that it was computed for.
    if (pose.molecule) return {pose.grip_number == grip_number ? *pose.molecule : grip.pose};
    const double gain = displacement_gain(law, felt.force_newton.norm());
    const Vec3 handle_m = grip.projector * (pose.travel_m - before.travel_m);
    Move move{{grip.pose.place_angstrom + handle_m / gain * units::angstrom_per_metre,
               grip.pose.orientation},
              gain};
    if (grip.freedom == 6) {
        const Quat turned = pose.turn * before.turn.conjugate();
        move.to.orientation = (turned * grip.pose.orientation).normalized();
    }
    return move;
}

// Tests whether positions still resolve the shape of a molecule; farther out too few digits are
// left.
bool is_within_reach(const MoleculePose& pose) noexcept {
    constexpr double farthest = 1e6;  // Å
    return pose.place_angstrom.norm() < farthest && pose.orientation.coeffs().allFinite();
}

}  // namespace

void follow_hands(World& world, const StepInput& input) {
    StepReport& report = world.write<StepReport>();
    std::vector<MoleculePose> places;
    std::size_t slot = 0;
    world.write_each<Hand>([&](Entity entity, Hand& hand) {
        PALPA_ASSERT(input.hands.size() == input.felt.size());
        const Grip* const grip = world.find<Grip>(entity);
        report.moves.emplace_back();
        places.emplace_back();
        if (grip) places.back() = grip->pose;
        if (slot >= input.hands.size()) return;
        const HandPose& pose = input.hands[slot];
        const ContactModel& felt = input.felt[slot++];
        if (grip) {
            const Move move =
                find_move(coupling_of(world, entity).laws.displacement, *grip, hand, pose, felt,
                          contact_of(world, entity).sent.model.grip_number);
            report.finite = report.finite && is_within_reach(move.to);
            report.moves.back() = {(move.to.place_angstrom - grip->pose.place_angstrom).norm(),
                                   move.displacement_gain};
            places.back() = move.to;
        }
        hand.travel_m = pose.travel_m;
        hand.turn = pose.turn;
    });
    if (!report.finite) return;
    slot = 0;
    world.each<Hand>([&](Entity entity, const Hand&) {
        if (world.find<Grip>(entity)) place_held(world, entity, places[slot]);
        ++slot;
    });
}

void begin_grip(World& world, Entity hand, const HandPose& pose) noexcept {
    Hand& held = *world.write<Hand>(hand);
    held.travel_m = pose.travel_m;
    held.turn = pose.turn;
}

}  // namespace palpa
