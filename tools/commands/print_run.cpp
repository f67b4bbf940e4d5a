#include "tools/commands/print_run.h"

#include "core/text.h"
#include "core/units.h"
#include "devices/mouse_handle.h"
#include "haptics/gains.h"
#include "math/eigenvectors.h"
#include "session/accuracy_report.h"
#include "session/plan_hand.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/solver.h"

#include <fmt/format.h>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace palpa {
namespace {

constexpr double force_nN = units::newton_per_kcal_per_mol_angstrom * 1e9;  // of one of ours

// A note on methods that do not bring all surroundings to rest in a step.
constexpr const char* unrelaxed_note =
    "incomplete in each step: the force can be several times that of relaxed surroundings;\n       "
    "       statics.method = \"second-order\" relaxes them completely";

int freedom_of_hands(const World& world) {
    int freedom = 0;
    world.each<Grip>([&](Entity, const Grip& grip) { freedom += grip.freedom; });
    return freedom;
}

void print_relaxation(const RelaxationSummary& r) {
    if (r.renewals == 0) fmt::print("  relaxation  {}\n", unrelaxed_note);
    if (r.estimates > 0) {
        fmt::print(
            "  error       median {:.3g} pN, 90 % of steps below {:.3g} pN, estimated against "
            "complete\n              relaxation\n",
            r.error_median_pN, r.error_90_pN);
    }
    if (r.renewals > 0) {
        fmt::print("  model       {} renewals; {} snaps released {:.1f} kcal/mol\n", r.renewals,
                   r.snaps, r.released);
        fmt::print(
            "  renewals    median {:.1f} ms for a step with a renewal; other steps: median {:.2f} "
            "ms,\n              90 % below {:.2f} ms, 99 % below {:.2f} ms\n",
            1e-3 * r.renewal_median_us, 1e-3 * r.between_median_us, 1e-3 * r.between_90_us,
            1e-3 * r.between_99_us);
    }
}

// Prints what moves by itself, and how it came to rest.
void print_mobile(const World& world, const JointRelaxReport& r) {
    const StartReport& report = world.resource<StartReport>();
    const Eigen::Index coordinates = model_of(world).coordinates;
    fmt::print("  freedom     {} degrees of freedom: {} joints, {} of bases; {} more of the hand\n",
               coordinates, report.joints, coordinates - static_cast<Eigen::Index>(report.joints),
               freedom_of_hands(world));
    if (report.joints_held > 0) {
        fmt::print("  region      {} joints outside of the region are fixed\n", report.joints_held);
    }
    if (const ModelAtoms& atoms = model_atoms_of(world); !atoms.in_table.empty()) {
        fmt::print("  atoms       {} can move, {} fixed ones near them exert forces, {} in all\n",
                   model_of(world).mobile_atoms.size(),
                   atoms.in_table.size() - model_of(world).mobile_atoms.size(),
                   world.resource<AtomTable>().size());
    }
    fmt::print(
        "  relaxed     {:.3f} to {:.3f} kcal/mol in {} steps, largest move {:.3f} Å, remaining rms "
        "force {:.3g} kcal/mol per radian and Å\n",
        r.energy_before, r.energy_after, r.steps, r.largest_move, r.rms_force);
    const ContactModel start = contact_at(world, 0).model;
    fmt::print("  start       {:.3f} kcal/mol, {:.3f} nN\n", start.potential_kcal_per_mol,
               start.force_newton.norm() * 1e9);
    if (!follows_by_model(world)) fmt::print("  relaxation  {}\n", unrelaxed_note);
}

// How much of the handle's way a molecule takes where it is stiffest, along and across.
void print_gains(const SceneDescription& scene, const World& world, double distance) {
    if (!coupling_of(world, hand_at(world, 0)).is_guarded || !moves_in_space(world) ||
        !scene.hands.front().grab.atom.empty())
        return;
    const FieldSum field = field_on_grabbed_at(world, distance);
    GuardedSettings guarded =
        build_servo_settings(scene, world, 0).guarded.value_or(GuardedSettings{});
    guarded.gain_shape = GainShape::Tensor;
    const GuardedGain gain =
        guarded_gain(guarded, units::newton_per_kcal_per_mol_angstrom * field.force,
                     units::newton_per_metre_per_kcal_per_mol_angstrom2 * field.stiffness);
    const Vec3 cm = find_eigenvalues(gain.tensor) / units::angstrom_per_metre * 100;
    fmt::print(
        "  gain        {:.2f} cm of handle per Å there; with coupling.gain_shape = \"tensor\" "
        "{:.2f}, {:.2f} and {:.2f} cm\n",
        cm.z(), cm.x(), cm.y(), cm.z());
}

// The stiffness caps of the scene's device and of the mouse.
void print_cap(const SceneDescription& scene, const World& world) {
    const auto cap_with = [&](const DeviceSpec& device) {
        return build_servo_settings(scene, world, 0, device)
            .guarded.value_or(GuardedSettings{})
            .device_cap_N_per_m;
    };
    if (!coupling_of(world, hand_at(world, 0)).is_guarded) return;
    MouseHandleSettings mouse = mouse_handle_of(hand_model(scene.hands.front().grip));
    mouse.delay_ticks = static_cast<int>(device_of(scene, 0).servo_delay_ticks);
    fmt::print(
        "  cap         {:.4g} N/m on the hand with the scene's device ({:.3g} N s/m), {:.4g} N/m "
        "by "
        "mouse; other devices by their own viscosity\n",
        cap_with(describe_emulated_device(scene, 0)), device_of(scene, 0).viscosity_N_s_per_m,
        cap_with(MouseHandle(mouse).spec()));
}

// Prints where a relaxed molecule begins.
void print_relaxed(const World& world, const RelaxReport& r) {
    const ContactModel start = contact_at(world, 0).model;
    fmt::print(
        "  relaxed     {:.3f} to {:.3f} kcal/mol in {} evaluations, moved {:.3f} Å, turned "
        "{:.2f}°, remaining force {:.3f} pN\n",
        r.energy_before, r.energy_after, r.evaluations, r.displacement,
        r.angle * 180 / std::numbers::pi, r.force * force_nN * 1e3);
    const Vec3 springs = units::newton_per_metre_per_kcal_per_mol_angstrom2 *
                         find_eigenvalues(field_on_grabbed(world).stiffness);
    fmt::print("  start       {:.3f} kcal/mol, {:.3f} nN; {:.1f}, {:.1f} and {:.1f} N/m\n",
               start.potential_kcal_per_mol, start.force_newton.norm() * 1e9, springs.x(),
               springs.y(), springs.z());
}

// On a line: where it rests, and the strongest attraction beyond.
void print_rest(const World& world, double rest) {
    const LineForce line = force_along_line_at(world, rest);
    fmt::print("  rest        {:.3f} kcal/mol at {:.3f} Å, {:.1f} N/m\n", line.energy, rest,
               line.stiffness * units::newton_per_metre_per_kcal_per_mol_angstrom2);
    double strongest = 0, where = 0;
    for (double distance = rest; distance < 30; distance += 0.001) {
        const double attraction = -force_along_line_at(world, distance).force * force_nN;
        if (attraction > strongest) {
            strongest = attraction;
            where = distance;
        }
    }
    fmt::print("  attraction  {:.3f} nN at {:.2f} Å, felt as {:.3f} N\n", strongest, where,
               hand_force(coupling_of(world, hand_at(world, 0)).laws.force, strongest * 1e-9));
}

// Prints what each hand holds if there are several.
void print_hands(const SceneDescription& scene) {
    if (scene.hands.size() < 2) return;
    std::vector<std::string> held;
    for (const HandDescription& hand : scene.hands) {
        const GrabDescription& grab = hand.grab;
        held.push_back(grab.molecule.empty() ? "nothing"
                       : grab.atom.empty()   ? grab.molecule
                                             : grab.molecule + ":" + grab.atom + " by a spring");
    }
    fmt::print("  hands       {}: {}\n", held.size(), fmt::join(held, ", "));
}

}  // namespace

void print_line(const SceneDescription& scene, const World& world, ProgressLine& progress) {
    print_hands(scene);
    const StartReport& report = world.resource<StartReport>();
    if (report.joints_at_rest) {
        print_mobile(world, *report.joints_at_rest);
    } else if (report.rigid) {
        print_relaxed(world, *report.rigid);
    } else if (!world.find<Grip>(hand_at(world, 0))) {
        fmt::print("  in hand     nothing\n");
    } else if (const std::optional<double> rest = equilibrium_distance(world)) {
        print_rest(world, *rest);
    }
    if (!world.find<Grip>(hand_at(world, 0))) return print_cap(scene, world);
    // In space these are places on a line along x, and no distances.
    const bool in_space = moves_in_space(world);
    const char* const along = in_space ? "x = " : "";
    // A spring is pulled at; its molecule is not moved against others.
    const bool on_spring = !scene.hands.front().grab.atom.empty();
    tell(progress.stages(), "searching for the repulsive wall");
    const std::optional<double> wall =
        on_spring ? std::nullopt
                  : repulsion_distance(world, scene.hands.front().peak_nN / force_nN,
                                       in_space ? grabbed_distance(world) : 30);
    progress.wipe();
    if (wall) {
        fmt::print("  {}   {} nN at {}{:.3f} Å, felt as {:.3f} N\n",
                   in_space ? "resists  " : "repulsion", scene.hands.front().peak_nN, along, *wall,
                   hand_force(coupling_of(world, hand_at(world, 0)).laws.force,
                              scene.hands.front().peak_nN * 1e-9));
    }
    const FeltStiffness stiffest = stiffest_place(scene, world, progress.stages());
    progress.wipe();
    const double calm = calm_stiffness(scene, 0, hand_model(scene.hands.front().grip),
                                       world.resource<Clock>().period_s);
    fmt::print(
        "  stiffest    {:.3g} N/m on the hand at {}{:.3f} Å; this hand is stable up to {:.3g} "
        "N/m\n",
        stiffest.newton_per_metre, along, stiffest.angstrom, calm);
    print_gains(scene, world, stiffest.angstrom);
    print_cap(scene, world);
}

namespace {

// Prints what had to be felt, and which of these requirements were not met.
void print_accuracy(const AccuracyReport& f) {
    if (const auto range = f.range_pN) {
        fmt::print("  range       {:.6g} to {:.6g} pN, felt as {:.3f} to {:.3f} N\n", (*range)[0],
                   (*range)[1], f.ends_newton[0], f.ends_newton[1]);
    }
    fmt::print("  stiffness   at most {:.1f} % of the cap\n", 100 * f.stiffest_share);
    if (const auto within_pN = f.within_pN; within_pN && f.estimates > 0) {
        fmt::print(
            "  {}   compared with the rendered force: median error {:.3g} pN, 90 % below {:.3g} "
            "pN,\n              within {:.6g} pN for {:.1f} % of {} comparisons\n",
            f.steps > 0 ? "all joints" : "all pairs ", f.median_pN, f.ninety_pN, *within_pN,
            100 * f.within_share, f.estimates);
        if (f.steps > 0) {
            fmt::print(
                "              {:.1f} degrees of freedom and {:.1f} steps in a period on average\n",
                f.active, f.steps);
        }
    }
    const std::vector<std::string> not_met = find_unmet(f).all();
    if (not_met.empty()) fmt::print("  not met     nothing\n");
    for (const std::string& what : not_met) fmt::print("  not met     {}\n", what);
}

void print_travel(const std::string& title, const HandTravel& travel) {
    const double moved_cm = 100 * travel.handle_m, lost_cm = 100 * travel.lost_m;
    fmt::print("  {} {:.1f} cm of the handle in {} {}; {:.1f} cm lost ({:.1f} %)\n", title,
               moved_cm, travel.strokes, travel.strokes == 1 ? "stroke" : "strokes", lost_cm,
               moved_cm > 0 ? 100 * lost_cm / moved_cm : 0.0);
    if (travel.at_stop_s > 0) {
        fmt::print(
            "              for {:.1f} s the handle was at its end: press the clutch, move back, "
            "let "
            "go\n",
            travel.at_stop_s);
    }
}

void print_clipping(const Summary& s) {
    fmt::print("  clipping    {:.1f} % of the time\n", 100 * s.clamped_share);
}

std::string describe_hand(const SceneDescription& scene, std::size_t slot) {
    const HandDescription& hand = scene.hands.at(slot);
    return fmt::format("mode {}, {} hand, friction {} N, stroke {}",
                       coupling_mode_names[static_cast<std::size_t>(coupling_of(scene, slot).mode)],
                       grip_names[static_cast<std::size_t>(hand.grip)],
                       device_of(scene, slot).friction_N,
                       stroke_names[static_cast<std::size_t>(hand.stroke)]);
}

void print_other_hand(const SceneDescription& scene, std::size_t slot, const Summary& s) {
    fmt::print("  hand {}      {}\n", slot + 1, describe_hand(scene, slot));
    fmt::print("  felt        at most {:.3f} N; net work {:+.4f} J on the hand\n", s.largest_felt_N,
               s.net_work_J);
    if (!scene.engine && s.last_angstrom != 0)
        fmt::print("  molecule    at the end {:.3f} Å\n", s.last_angstrom);
    if (s.accuracy) print_accuracy(*s.accuracy);
    print_travel("travel     ", s.travel);
    print_clipping(s);
}

}  // namespace

void print_summary(const SceneDescription& scene, const Summary& s) {
    fmt::print("{}: {} s, T_s = {} ms, {}{}\n", printable(scene.title), scene.seconds,
               scene.period_ms, scene.hands.size() > 1 ? "hand 1: " : "", describe_hand(scene, 0));
    if (s.is_on_axis) {
        fmt::print("  felt        at most {:.3f} N of attraction and {:.3f} N of repulsion\n",
                   s.largest_attraction_N, s.largest_repulsion_N);
    } else {
        fmt::print("  felt        at most {:.3f} N\n", s.largest_felt_N);
    }
    if (!s.ripple) {
        fmt::print("  ripple      not measured: the run is too short\n");
    } else {
        fmt::print("  ripple      {:.3f} N rms above 3 Hz at the end", s.ripple->rms);
        // What is slower is the stroke, of which the measure keeps a part.
        if (s.ripple->rms > 0.02) {
            fmt::print("{}at {:.1f} Hz", s.ripple->hertz < 3 ? ", the stroke itself " : ", ",
                       s.ripple->hertz);
        }
        fmt::print("\n");
    }
    fmt::print("  net work    {:+.4f} J on the hand\n", s.net_work_J);
    // A spring to an engine's atoms is measured from no other molecule.
    if (!scene.engine && s.closest_angstrom != 0) {
        fmt::print("  molecule    closest distance {:.3f} Å, at the end {:.3f} Å\n",
                   s.closest_angstrom, s.last_angstrom);
    }
    if (s.unbinding) {
        const UnbindingPath& j = *s.unbinding;
        fmt::print("  unbinding   centre of mass up to {:.2f} Å from its start", j.farthest);
        // What a spring holds is bonded to others.
        if (std::isfinite(j.closest) && scene.hands.front().grab.atom.empty()) {
            fmt::print(
                "; its nearest heavy atom there is {:.2f} Å away\n              (closest on the "
                "way {:.2f} Å)",
                j.clearance, j.closest);
            if (j.free_s)
                fmt::print("; free of others by {} Å after {:.1f} s", free_angstrom, *j.free_s);
        }
        fmt::print("; at the end rms displacement {:.2f} Å, of the backbone around it {:.2f} Å\n",
                   j.last_rmsd, j.last_backbone);
    }
    if (s.activity) {
        const Activity& a = *s.activity;
        fmt::print(
            "  active      {:.1f} degrees of freedom on average, selected {} times; {:.1f} % of "
            "steps within the time budget\n",
            a.active, a.choices, 100 * a.within_budget);
    }
    if (s.accuracy) print_accuracy(*s.accuracy);
    if (s.engine) {
        fmt::print(
            "  engine      {} frames, {:.0f} per second at the end; force delayed by {:.0f} ms; {} "
            "interruptions\n",
            s.engine->frames, s.engine->frames_per_s, 1e3 * s.engine->delay_s,
            s.engine->interruptions);
    }
    if (s.relaxation) print_relaxation(*s.relaxation);
    print_travel("travel     ", s.travel);
    print_clipping(s);
    for (std::size_t i = 0; i < s.other_hands.size(); ++i)
        print_other_hand(scene, i + 1, s.other_hands[i]);
    fmt::print("  step        {:.2f} µs median, {:.2f} µs p99 of {} steps\n", s.step_median_us,
               s.step_p99_us, s.steps);
}

void print_warnings(std::span<const std::string> warnings) {
    for (const std::string& warning : warnings) {
        fmt::print(stderr, "warning: {}\n", printable(warning));
    }
}

}  // namespace palpa
