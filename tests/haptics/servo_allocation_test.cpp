// A servo tick takes no memory: every allocation of this program is counted.
#include "core/units.h"
#include "haptics/servo.h"
#include "tests/support/two_held.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <new>
#include <span>
#include <utility>
#include <vector>

namespace {

thread_local bool is_counting = false;
thread_local int allocations = 0;

void* allocate(std::size_t size) {
    if (is_counting) ++allocations;
    void* const memory = std::malloc(size == 0 ? 1 : size);  // NOLINT: what new is made of
    if (!memory) throw std::bad_alloc();
    return memory;
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    if (is_counting) ++allocations;
    const auto step = static_cast<std::size_t>(alignment);
    void* const memory = std::aligned_alloc(step, (size + step - 1) / step * step);
    if (!memory) throw std::bad_alloc();
    return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }                        // NOLINT
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }  // NOLINT
void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept {
    std::free(memory);  // NOLINT
}
void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
    std::free(memory);  // NOLINT
}

using namespace palpa;

namespace {

LocalContactModel local_contact_of(std::size_t atoms) {
    std::vector<Vec3> places, own{Vec3(0, 0, 9), Vec3(1, 0, 10)};
    for (std::size_t i = 0; i < atoms; ++i)
        places.emplace_back(2.0 * static_cast<double>(i % 10), 2.0 * static_cast<double>(i / 10),
                            0);
    const std::vector<double> charge(atoms + 2, 0.1), epsilon(atoms + 2, 0.3), rmin(atoms + 2, 1.8);
    const std::vector<std::uint32_t> type(atoms + 2, 0);
    const auto of = [&](const std::vector<Vec3>& positions) {
        const std::size_t n = positions.size();
        return FieldPoints{positions, std::span(charge).first(n), std::span(epsilon).first(n),
                           std::span(rmin).first(n), std::span(type).first(n)};
    };
    LocalContactModel contact;
    contact.field.frozen =
        build_frozen_field(of(own), of(places), {units::charmm_coulomb_constant});
    contact.field.group = own;
    contact.field.at_step = evaluate_frozen_field(contact.field.frozen, own);
    contact.field.has_atoms = atoms > 0;
    contact.model.period_s = 0.005;
    return contact;
}

}  // namespace

static_assert(noexcept(step_servo(std::declval<const ServoSettings&>(), std::declval<ServoState&>(),
                                  std::declval<Exchange&>(), std::declval<const DeviceReading&>(),
                                  0.0)));
static_assert(noexcept(step_servos(std::declval<std::span<ServoHand>>(), 0.0)));

TEST_CASE("a servo tick allocates nothing, whatever it feels", "[haptics][servo]") {
    ServoSettings settings;
    settings.safety.is_full = GENERATE(false, true);
    const bool is_guarded = GENERATE(false, true);
    if (is_guarded) settings.guarded.emplace();
    Exchange exchange;
    ServoState state;
    // The counter counts.
    is_counting = true;
    allocations = 0;
    ::operator delete(::operator new(8));
    const int counted = allocations;
    is_counting = false;
    for (int tick = 0; tick < 500; ++tick) {
        // Fields of many sizes, no field, and one that single precision cannot do.
        if (tick % 5 == 0) {
            LocalContactModel contact = local_contact_of(static_cast<std::size_t>(tick % 40) * 5);
            if (tick % 35 == 0 && contact.field.has_atoms) contact.field.group[0] = Vec3(0, 0, 0.1);
            exchange.contact.post(contact);
        }
        const double time_s = 1e-3 * tick;
        const DeviceReading reading{time_s, Vec3(1e-3 * std::sin(time_s), 0, 0), 0, tick % 7 != 0,
                                    turn_of(Vec3(0, 0.1 * std::sin(time_s), 0))};
        is_counting = true;
        allocations = 0;
        (void)step_servo(settings, state, exchange, reading, time_s);
        is_counting = false;
        CHECK(allocations == 0);
    }
    CHECK(counted == 1);
}

TEST_CASE("a servo tick of two hands that touch each other allocates nothing",
          "[haptics][servo][held]") {
    test::TwoHeld pair{{test::water_body(), test::water_body()}, {}, {true, true}};
    std::vector<ServoHand> hands(2);
    std::array<MoleculePose, 2> poses;
    poses[1].place_angstrom.x() = 3;
    for (ServoHand& hand : hands) hand.settings.guarded.emplace();
    int counted = 0;
    for (int tick = 0; tick < 300; ++tick) {
        const double time_s = 1e-3 * tick;
        for (std::size_t i = 0; i < 2; ++i) {
            if (tick % 5 == 0) {
                LocalContactModel contact = pair.contact(i, poses);
                contact.field.has_atoms = tick % 35 != 0;
                hands[i].exchange.contact.post(contact);
            }
            const double way = (i == 0 ? 1e-3 : -2e-3) * std::sin(7 * time_s);
            hands[i].reading = {time_s, Vec3(way, 0, 0), 0, true, turn_of(Vec3(0, way, way))};
        }
        is_counting = true;
        allocations = 0;
        step_servos(hands, time_s);
        is_counting = false;
        counted += allocations;
        for (std::size_t i = 0; i < 2; ++i) poses[i] = hands[i].state.guarded.molecule;
    }
    CHECK(counted == 0);
    CHECK(poses[0].place_angstrom.norm() > 0);
}
