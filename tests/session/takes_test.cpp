// Any molecule, residue or atom is taken while a scene runs: what the hand is sent never jumps, and
// what it feels from the first tick on is what pulls at what it holds now.
#include "core/units.h"
#include "devices/emulated_omni.h"
#include "field/pair_field.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "tests/support/emulated_hand.h"
#include "tests/support/paths.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

using Settings = std::vector<std::string>;

// All pairs in double, or the spring, where the servo has what the hand holds.
Vec3 true_force(const World& world, Entity hand, const MoleculePose& pose) {
    World there = world;
    place_held(there, hand, pose);
    const Grip& grip = grip_of(there, hand);
    Vec3 force;
    const Spring* const spring = there.find<Spring>(hand);
    if (!spring) {
        force = grip.projector * field_on_held(there, hand).force;
    } else {
        const Vec3 end = grip.anchor + pose.place_angstrom;
        force = spring->k * (middle_of(there, spring->ends.front()) - end);
    }
    return units::newton_per_kcal_per_mol_angstrom * force;
}

// By which the other hand pulls at the same molecule, where this one holds all of it.
Vec3 pull_of_other(const World& world, Entity hand) {
    Vec3 force = Vec3::Zero();
    const Grip& grip = grip_of(world, hand);
    world.each<Grip, Spring>([&](Entity other, const Grip& pulling, const Spring& spring) {
        if (other == hand || pulling.molecule != grip.molecule || !holds_whole(world, hand)) return;
        const Vec3 end = pulling.anchor + pulling.pose.place_angstrom;
        force += spring.k * (end - middle_of(world, spring.ends.front()));
    });
    return units::newton_per_kcal_per_mol_angstrom * force;
}

// What a hand must feel in a tick: what pulls where the last step left what it holds, and of what
// the atoms around it change on the way from there the share that was confirmed.
Vec3 expected_force(const World& world, Entity hand, const ContactModel& contact) {
    const Vec3 then = true_force(world, hand, grip_of(world, hand).pose);
    const Vec3 now = true_force(world, hand, contact.molecule);
    return then + pull_of_other(world, hand) + contact.prediction_gain * (now - then);
}

// Where a hand holds something else than in the tick before.
struct NewHold {
    double second = 0;
    std::size_t hand = 0;
    Vec3 sent_before = Vec3::Zero();
    double largest_step = 0;                         // N, in the ticks from then on
    Vec3 felt = Vec3::Zero(), truth = Vec3::Zero();  // N, on what it holds now
    Vec3 law = Vec3::Zero();                         // that the force law makes of it
    bool holds = true, held = true;                  // now, and before
};

struct TakesRun {
    std::vector<NewHold> changes;
    double largest_step = 0;  // N, between two ticks, of any hand
    double largest_force = 0;
    std::size_t let_go = 0;  // ticks in which a hand held nothing
};

// With the scene's emulated hands.
TakesRun run_takes(SceneDescription scene, const std::vector<EditDescription>& edits) {
    scene.edits = edits;
    World world = load_world(scene);
    std::vector<std::unique_ptr<EmulatedOmni>> omnis;
    std::vector<Device*> devices;
    for (std::size_t i = 0; i < find_hands(world).size(); ++i) {
        omnis.push_back(std::make_unique<EmulatedOmni>(test::build_played_omni(scene, world, i)));
        devices.push_back(omnis.back().get());
    }
    struct Last {
        Vec3 sent = Vec3::Zero();
        std::optional<std::uint32_t> grip_number;
        bool held = true;
    };
    std::vector<Last> last(devices.size());
    TakesRun result;
    std::uint64_t tick = 0;
    const auto watch = [&](std::span<const ServoTick> ticks) {
        for (std::size_t i = 0; i < ticks.size(); ++i) {
            const ServoTick& now = ticks[i];
            const Entity hand = find_hands(world)[i];
            const ContactModel& contact = now.contact;
            if (last[i].grip_number) {
                result.largest_step =
                    std::max(result.largest_step, (now.sent_newton - last[i].sent).norm());
            }
            result.largest_force = std::max(result.largest_force, now.sent_newton.norm());
            if (contact.is_still) ++result.let_go;
            if (last[i].grip_number && *last[i].grip_number != contact.grip_number) {
                NewHold change{static_cast<double>(tick) * servo_tick_s, i, last[i].sent};
                change.holds = !contact.is_still;
                change.held = last[i].held;
                if (change.holds) {
                    change.felt = contact.force_newton;
                    change.truth = expected_force(world, hand, contact);
                    change.law = hand_force(coupling_of(world, hand_at(world, 0)).laws.force,
                                            contact.force_newton);
                }
                result.changes.push_back(change);
            }
            // As long as a force is under way, and longer.
            const double second = static_cast<double>(tick) * servo_tick_s;
            for (NewHold& change : result.changes) {
                constexpr double soon_s = 0.015;
                if (change.hand != i || second > change.second + soon_s) continue;
                change.largest_step =
                    std::max(change.largest_step, (now.sent_newton - last[i].sent).norm());
            }
            last[i] = {now.sent_newton, contact.grip_number, !contact.is_still};
        }
        ++tick;
    };
    (void)run_headless(scene, world, devices, {}, nullptr, {}, {}, watch);
    return result;
}

EditDescription at(double second, EditAction action, std::size_t hand = 0) {
    return {second, hand, std::move(action), {"takes", 1, 0}};
}

const double slew_newton_per_tick = SafetySettings().slew_newton_per_s * servo_tick_s;

// What holds for every change in every scene.
void check_takes(const TakesRun& run) {
    CHECK(run.largest_step <= slew_newton_per_tick * (1 + 1e-9));
    for (const NewHold& change : run.changes) {
        INFO("at " << change.second << " s");
        if (!change.holds) continue;
        // The servo knows the atoms nearby, in single precision.
        CHECK(1e12 * (change.felt - change.truth).norm() <
              1e-4 * 1e12 * change.truth.norm() + 0.5);  // pN
        if (!change.held) continue;
        // It glides there in a tenth of a second; the handle goes on meanwhile.
        const double jump = (change.law - change.sent_before).norm();
        CHECK(change.largest_step < 0.02 * jump + 0.25);
    }
}

// Of a molecule: itself, all residues, and every so many atoms of each.
std::vector<std::string> list_addresses(const World& world, std::size_t every_atom,
                                        std::size_t every_residue = 1) {
    std::vector<std::string> addresses;
    world.each<Molecule>([&](Entity, const Molecule& molecule) {
        addresses.push_back(molecule.name);
        std::string number;
        std::size_t residues = 0;
        for (std::uint32_t i = 0; i < molecule.atoms.count; ++i) {
            const AtomName& atom = world.resource<AtomTable>().names[molecule.atoms.first + i];
            const bool is_first = atom.number != number;
            number = atom.number;
            if (is_first && residues++ % every_residue == 0)
                addresses.push_back(molecule.name + ":" + number);
            if (i % every_atom == 0)
                addresses.push_back(molecule.name + ":" + number + " " + atom.atom);
        }
    });
    return addresses;
}

// Every address once, by any hand in turn, at uneven times; after every third an undo, then a redo.
std::vector<EditDescription> take_all(std::vector<std::string> addresses, std::size_t hands,
                                      double first_s, double every_s, std::size_t most,
                                      double& end_s) {
    std::mt19937 random(7);
    std::ranges::shuffle(addresses, random);
    addresses.resize(std::min(addresses.size(), most));
    std::vector<EditDescription> edits;
    double now = first_s;
    const auto add = [&](EditAction action, std::size_t hand) {
        edits.push_back(at(now, std::move(action), hand));
        now += every_s * (0.7 + 0.1 * static_cast<double>(random() % 7));
    };
    std::size_t taken = 0;
    for (const std::string& address : addresses) {
        add(GrabEdit{address}, taken % hands);
        if (++taken % 3 != 0) continue;
        add(UndoEdit{}, 0);
        add(RedoEdit{}, 0);
    }
    end_s = now + every_s;
    return edits;
}

}  // namespace

TEST_CASE("what is taken under a force of newtons is felt gliding, and let go within the slew",
          "[session][takes][slow]") {
    // Forces between steps are compared with those of surroundings that stand still.
    const SceneDescription scene =
        read_scene(test::in_project("scenes/water"),
                   Settings{"mode=guarded", "statics.method=quasi-static",
                            "coupling.force_law=constant", "coupling.A_f=4e9", "seconds=4"});
    double strongest_s = 0;
    {
        // Where the hand feels most.
        World world = load_world(scene);
        EmulatedOmni device(test::build_played_omni(scene, world));
        double most = 0, now = 0;
        (void)run_headless(scene, world, device, {}, nullptr, {}, {}, [&](const ServoTick& tick) {
            if (tick.sent_newton.norm() > most) {
                most = tick.sent_newton.norm();
                strongest_s = now;
            }
            now += servo_tick_s;
        });
        REQUIRE(most > 1);
    }
    for (const char* const what : {"fixed", "moved:1", "fixed:1 H1"}) {
        INFO(what);
        const TakesRun taken = run_takes(scene, {at(strongest_s, GrabEdit{what})});
        check_takes(taken);
        REQUIRE(taken.changes.size() == 1);
        const NewHold& change = taken.changes.front();
        REQUIRE(change.sent_before.norm() > 1);
        CHECK((change.law - change.sent_before).norm() > 0.9);
        CHECK(change.largest_step < 0.1);
        // At the other molecule it is the other force.
        if (what == std::string("fixed")) CHECK(change.law.x() * change.sent_before.x() < 0);
    }
    const TakesRun let_go = run_takes(scene, {at(strongest_s, ReleaseEdit{})});
    check_takes(let_go);
    REQUIRE(let_go.changes.size() == 1);
    CHECK(let_go.changes.front().sent_before.norm() > 1);
    CHECK(let_go.let_go > 100);
    CHECK(let_go.largest_step == Approx(slew_newton_per_tick));
}

TEST_CASE("all of small scenes can be taken while they run, and no force jumps",
          "[session][takes][slow]") {
    struct Row {
        std::string file;
        Settings settings;
        std::size_t every_atom;
    };
    const std::string waters = test::in_project("scenes/water/"),
                      peptides = test::test_data("two_peptides");
    const Settings laws{"mode=guarded", "coupling.force_law=constant",
                        "coupling.displacement_law=constant", "coupling.A_f=2e9"};
    const auto with = [&](Settings more) {
        more.insert(more.end(), laws.begin(), laws.end());
        return more;
    };
    const auto row = GENERATE_COPY(values<Row>(
        {{waters + "scene.toml", {"mode=guarded"}, 1},
         {waters + "space.toml", {}, 1},
         {waters + "two-hands.toml", {}, 1},
         {waters + "two-hands.toml",
          {"molecules.left.motion=translate-and-turn", "molecules.right.motion=translate-and-turn"},
          1},
         {peptides, with({"molecules.held.shape=rigid", "molecules.resting.shape=rigid"}), 4},
         {peptides, with({}), 4}}));
    INFO(row.file);
    SceneDescription scene = read_scene(row.file, row.settings);
    scene.statics.method = RelaxMethod::QuasiStatic;
    const World world = load_world(scene);
    const std::size_t hands = find_hands(world).size();
    const std::vector<EditDescription> edits =
        take_all(list_addresses(world, row.every_atom), hands, 0.2, 0.05, 60, scene.seconds);
    REQUIRE(edits.size() > 10);

    const TakesRun taken = run_takes(scene, edits);

    check_takes(taken);
    // Undo and redo take hold anew with every hand.
    CHECK(taken.changes.size() >= edits.size());
    CHECK(taken.largest_force > 0.05);
}

TEST_CASE("of HIV protease any part can be taken while it runs", "[session][takes][slow]") {
    const std::string hiv = test::in_project("scenes/hiv/");
    const auto file =
        GENERATE_COPY(values<std::string>({hiv + "scene.toml", hiv + "two-hands.toml"}));
    INFO(file);
    SceneDescription scene = read_scene(file, Settings{"mode=guarded"});
    const World world = load_world(scene);
    const std::vector<EditDescription> edits = take_all(
        list_addresses(world, 97, 11), find_hands(world).size(), 0.1, 0.05, 80, scene.seconds);

    const TakesRun taken = run_takes(scene, edits);

    check_takes(taken);
    CHECK(taken.changes.size() >= edits.size());
    CHECK(taken.largest_force > 0.05);
}
