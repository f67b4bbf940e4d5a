#include "tools/print_run.h"

#include "core/text.h"
#include "core/units.h"
#include "haptics/gains.h"
#include "session/feel.h"
#include "session/plan_hand.h"
#include "session/run_headless.h"
#include "simulation/probe.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace palpa {
namespace {

// Until a step answers with all surroundings at rest (second order), flexible scenes say this.
constexpr const char* unrelaxed_note =
    "not complete in a step: the force can be several times that of surroundings\n"
    "              at rest (README.md, Limits)";

// What moves by itself, and how it came to rest.
void print_flexible(const Simulation& simulation, const Flexible& flexible) {
    const JointRelaxReport& r = flexible.relaxed;
    fmt::print("  freedom     {} degrees: {} joints, {} of bases; {} more of the hand\n",
               flexible.model.coordinates, flexible.joints,
               flexible.model.coordinates - static_cast<Eigen::Index>(flexible.joints),
               simulation.touch.model.active_freedom - flexible.model.coordinates);
    if (flexible.joints_held > 0) {
        fmt::print("  region      {} joints further away are held\n", flexible.joints_held);
    }
    fmt::print(
        "  relaxed     {:.3f} to {:.3f} kcal/mol in {} steps, moved {:.3f} Å at most, rms "
        "force {:.3g} kcal/mol left\n",
        r.energy_before, r.energy_after, r.steps, r.largest_move, r.rms_force);
    const TouchModel start = simulation.touch.model;
    fmt::print("  start       {:.3f} kcal/mol, {:.3f} nN\n", start.potential_kcal_per_mol,
               start.force_newton.norm() * 1e9);
    fmt::print("  relaxation  {}\n", unrelaxed_note);
}

// How much of the handle's way a molecule takes where it is stiffest, along and across.
void print_gains(const SceneDescription& scene, const Simulation& simulation, double distance) {
    if (!simulation.is_guarded || !moves_in_space(simulation) || !scene.grab.atom.empty()) return;
    const FieldSum field = field_on_grabbed_at(simulation, distance);
    GuardedSettings guarded =
        build_servo_settings(scene, simulation).guarded.value_or(GuardedSettings{});
    guarded.gain_shape = GainShape::Tensor;
    const GuardedGain gain =
        guarded_gain(guarded, units::newton_per_kcal_per_mol_angstrom * field.force,
                     units::newton_per_metre_per_kcal_per_mol_angstrom2 * field.stiffness);
    const Eigen::SelfAdjointEigenSolver<Mat3> along(gain.tensor, Eigen::EigenvaluesOnly);
    const Vec3 cm = along.eigenvalues() / units::angstrom_per_metre * 100;
    fmt::print(
        "  gain        {:.2f} cm of handle for an Å there; with coupling.gain_shape = \"tensor\" "
        "{:.2f}, {:.2f} and {:.2f}\n",
        cm.z(), cm.x(), cm.y(), cm.z());
}

}  // namespace

void print_line(const SceneDescription& scene, const Simulation& simulation,
                ProgressLine& progress) {
    constexpr double nN = units::newton_per_kcal_per_mol_angstrom * 1e9;
    if (simulation.flexible) {
        print_flexible(simulation, *simulation.flexible);
    } else if (simulation.relaxed) {
        const RelaxReport& r = *simulation.relaxed;
        const TouchModel start = simulation.touch.model;
        fmt::print(
            "  relaxed     {:.3f} to {:.3f} kcal/mol in {} evaluations, moved {:.3f} Å, turned "
            "{:.2f}°, {:.3f} pN left\n",
            r.energy_before, r.energy_after, r.evaluations, r.displacement,
            r.angle * 180 / std::numbers::pi, r.force * nN * 1e3);
        const Vec3 springs = units::newton_per_metre_per_kcal_per_mol_angstrom2 *
                             Eigen::SelfAdjointEigenSolver<Mat3>(
                                 field_on_grabbed(simulation).stiffness, Eigen::EigenvaluesOnly)
                                 .eigenvalues();
        fmt::print("  start       {:.3f} kcal/mol, {:.3f} nN; {:.1f}, {:.1f} and {:.1f} N/m\n",
                   start.potential_kcal_per_mol, start.force_newton.norm() * 1e9, springs.x(),
                   springs.y(), springs.z());
    } else if (const std::optional<double> rest = equilibrium_distance(simulation)) {
        const LineForce line = force_along_line_at(simulation, *rest);
        fmt::print("  rest        {:.3f} kcal/mol at {:.3f} Å, {:.1f} N/m\n", line.energy, *rest,
                   line.stiffness * units::newton_per_metre_per_kcal_per_mol_angstrom2);
        double strongest = 0, where = 0;
        for (double distance = *rest; distance < 30; distance += 0.001) {
            const double attraction = -force_along_line_at(simulation, distance).force * nN;
            if (attraction > strongest) {
                strongest = attraction;
                where = distance;
            }
        }
        fmt::print("  attraction  {:.3f} nN at {:.2f} Å, felt as {:.3f} N\n", strongest, where,
                   hand_force(simulation.laws.force, strongest * 1e-9));
    }
    // In space these are places on a line along x, and no distances.
    const bool in_space = moves_in_space(simulation);
    const char* const along = in_space ? "x = " : "";
    // A spring is pulled at; its molecule is not moved against others.
    const bool on_spring = !scene.grab.atom.empty();
    tell(progress.stages(), "looking for where it repels");
    const std::optional<double> wall =
        on_spring ? std::nullopt
                  : repulsion_distance(simulation, scene.hand.peak_nN / nN,
                                       in_space ? grabbed_distance(simulation) : 30);
    progress.wipe();
    if (wall) {
        fmt::print("  {}   {} nN at {}{:.3f} Å, felt as {:.3f} N\n",
                   in_space ? "resists  " : "repulsion", scene.hand.peak_nN, along, *wall,
                   hand_force(simulation.laws.force, scene.hand.peak_nN * 1e-9));
    }
    const FeltStiffness stiffest = stiffest_place(scene, simulation, progress.stages());
    progress.wipe();
    const double calm =
        calm_stiffness(scene, hand_model(static_cast<Grip>(scene.hand.grip)), simulation.period_s);
    fmt::print("  stiffest    {:.3g} N/m felt at {}{:.3f} Å, this hand keeps {:.3g} N/m calm\n",
               stiffest.newton_per_metre, along, stiffest.angstrom, calm);
    print_gains(scene, simulation, stiffest.angstrom);
}

namespace {

// What had to be felt, and what gave way for it.
void print_feel(const Feel& f) {
    if (const auto range = f.range_pN) {
        fmt::print("  to feel     {:.6g} to {:.6g} pN, felt as {:.3f} to {:.3f} N\n", (*range)[0],
                   (*range)[1], f.ends_newton[0], f.ends_newton[1]);
    }
    fmt::print("  stiffness   {:.1f} % of the cap felt at most\n", 100 * f.stiffest_share);
    if (const auto within_pN = f.within_pN; within_pN && f.audits > 0) {
        fmt::print(
            "  {}   would have given a force within {:.3g} pN of this one half of the time, "
            "within {:.3g} pN\n              nine tenths of it, within {:.6g} pN {:.1f} % of it "
            "({} comparisons)\n",
            f.steps > 0 ? "all joints" : "all pairs ", f.median_pN, f.ninety_pN, *within_pN,
            100 * f.within_share, f.audits);
        if (f.steps > 0) {
            fmt::print(
                "              {:.1f} degrees of freedom and {:.1f} steps in a period on average\n",
                f.active, f.steps);
        }
    } else if (f.within_pN) {
        fmt::print("  compared    with nothing: too short a run, or not guarded\n");
    }
    const std::vector<std::string> gave_way = find_yielding(f).all();
    if (gave_way.empty()) fmt::print("  gave way    nothing\n");
    for (const std::string& what : gave_way) fmt::print("  gave way    {}\n", what);
}

}  // namespace

void print_summary(const SceneDescription& scene, const Summary& s) {
    fmt::print("{}: {} s, mode {}, T_s = {} ms, {} hand, friction {} N, stroke {}\n",
               printable(scene.title), scene.seconds,
               coupling_mode_names[static_cast<std::size_t>(scene.coupling.mode)], scene.period_ms,
               hand_names[scene.hand.grip], scene.device.friction_N,
               stroke_names[static_cast<std::size_t>(scene.hand.stroke)]);
    if (s.is_on_axis) {
        fmt::print("  felt        {:.3f} N of attraction and {:.3f} N of repulsion at most\n",
                   s.largest_attraction_N, s.largest_repulsion_N);
    } else {
        fmt::print("  felt        {:.3f} N at most\n", s.largest_felt_N);
    }
    if (!s.ripple) {
        fmt::print("  ripple      too short a run to tell\n");
    } else {
        fmt::print("  ripple      {:.3f} N rms above 3 Hz towards the end", s.ripple->rms);
        // What is slower is the stroke, of which the measure keeps a part.
        if (s.ripple->rms > 0.02) {
            fmt::print("{}at {:.1f} Hz", s.ripple->hertz < 3 ? ", the stroke itself " : ", ",
                       s.ripple->hertz);
        }
        fmt::print("\n");
    }
    fmt::print("  net work    {:+.4f} J on the hand\n", s.net_work_J);
    fmt::print("  molecule    {:.3f} Å at the closest, {:.3f} Å at the end\n", s.closest_angstrom,
               s.last_angstrom);
    if (s.journey) {
        const Journey& j = *s.journey;
        fmt::print("  journey     centre of mass up to {:.2f} Å from its start", j.farthest);
        // What a spring holds is bonded to others.
        if (std::isfinite(j.closest) && scene.grab.atom.empty()) {
            fmt::print(
                ", heavy atoms {:.2f} Å from all others there;\n              {:.2f} Å at the "
                "closest",
                j.clearance, j.closest);
        }
        fmt::print("; at the end {:.2f} Å rms from where they started\n", j.last_rmsd);
    }
    if (s.activity) {
        const Activity& a = *s.activity;
        fmt::print(
            "  active      {:.1f} degrees of freedom on average, chosen {} times; {:.1f} % of "
            "steps "
            "within the budget\n",
            a.active, a.choices, 100 * a.within_budget);
    }
    if (s.feel) print_feel(*s.feel);
    if (s.journey) fmt::print("  relaxation  {}\n", unrelaxed_note);
    fmt::print("  clamped     {:.1f} % of the time\n", 100 * s.clamped_share);
    fmt::print("  step        {:.2f} µs median, {:.2f} µs p99 of {} steps\n", s.step_median_us,
               s.step_p99_us, s.steps);
}

}  // namespace palpa
