#include "tools/run.h"

#include "app/run_window.h"
#include "core/interrupt.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/units.h"
#include "devices/emulated_omni.h"
#include "devices/open_device.h"
#include "devices/two_hands.h"
#include "haptics/gains.h"
#include "scene/fields.h"
#include "scene/read_scene.h"
#include "session/feel.h"
#include "session/plan_hand.h"
#include "session/recording.h"
#include "session/run_headless.h"
#include "simulation/probe.h"
#include "simulation/simulation.h"
#include "simulation/step.h"
#include "tools/relax.h"
#include "tools/render.h"
#include "tools/window_devices.h"
#include "view/first_view.h"

#include <fmt/format.h>
#include <unistd.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace palpa {
namespace {

// Shown where a person watches, over a line of its own.
void show_progress(double share) {
    fmt::print(stderr, "\r{:3.0f} %", 100 * share);
    if (share >= 1) fmt::print(stderr, "\r      \r");
    std::fflush(stderr);
}

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

// What the molecule will meet on its line, found by looking along it.
void print_line(const SceneDescription& scene, const Simulation& simulation) {
    constexpr double nN = units::newton_per_kcal_per_mol_angstrom * 1e9;
    if (simulation.flexible) {
        print_flexible(simulation, *simulation.flexible);
    } else if (simulation.relaxed) {
        const RelaxReport& r = *simulation.relaxed;
        const TouchModel start = simulation.touch.model;
        fmt::print(
            "  relaxed     {:.3f} to {:.3f} kcal/mol in {} looks, moved {:.3f} Å, turned "
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
    // A spring is pulled at; its molecule is not moved against others.
    const bool on_spring = !scene.grab.atom.empty();
    if (const std::optional<double> wall =
            on_spring ? std::nullopt
                      : repulsion_distance(
                            simulation, scene.hand.peak_nN / nN,
                            moves_in_space(simulation) ? grabbed_distance(simulation) : 30)) {
        fmt::print("  repulsion   {} nN at {:.3f} Å, felt as {:.3f} N\n", scene.hand.peak_nN, *wall,
                   hand_force(simulation.laws.force, scene.hand.peak_nN * 1e-9));
    }
    const FeltStiffness stiffest = stiffest_place(scene, simulation);
    const double calm =
        calm_stiffness(scene, hand_model(static_cast<Grip>(scene.hand.grip)), simulation.period_s);
    fmt::print("  stiffest    {:.3g} N/m felt at {:.3f} Å, this hand keeps {:.3g} N/m calm\n",
               stiffest.newton_per_metre, stiffest.angstrom, calm);
    print_gains(scene, simulation, stiffest.angstrom);
}

// What had to be felt, and what gave way for it.
void print_feel(const Feel& f) {
    if (const auto range = f.range_pN) {
        fmt::print("  to feel     {:.6g} to {:.6g} pN, felt as {:.3f} to {:.3f} N\n", (*range)[0],
                   (*range)[1], f.ends_newton[0], f.ends_newton[1]);
    }
    fmt::print("  stiffness   {:.1f} % of the cap felt at most\n", 100 * f.stiffest_share);
    if (const auto within_pN = f.within_pN; within_pN && f.audits > 0) {
        fmt::print(
            "  exactness   {:.1f} % of the time within {:.6g} pN, by {} audits; half of it within "
            "{:.3g}, nine tenths within {:.3g}\n",
            100 * f.within_share, *within_pN, f.audits, f.median_pN, f.ninety_pN);
        if (f.steps > 0) {
            fmt::print(
                "              {:.1f} degrees of freedom and {:.1f} steps in a period on average\n",
                f.active, f.steps);
        }
    } else if (f.within_pN) {
        fmt::print("  exactness   no audit: too short a run, or not guarded\n");
    }
    const std::vector<std::string> gave_way = find_yielding(f).all();
    if (gave_way.empty()) fmt::print("  gave way    nothing\n");
    for (const std::string& what : gave_way) fmt::print("  gave way    {}\n", what);
}

void print_summary(const SceneDescription& scene, const Summary& s) {
    fmt::print("{}: {} s, mode {}, T_s = {} ms, {} hand, friction {} N, stroke {}\n",
               printable(scene.title), scene.seconds,
               coupling_mode_names[static_cast<std::size_t>(scene.coupling.mode)], scene.period_ms,
               hand_names[scene.hand.grip], scene.device.friction_N,
               stroke_names[static_cast<std::size_t>(scene.hand.stroke)]);
    fmt::print("  felt        {:.3f} N of attraction and {:.3f} N of repulsion at most\n",
               s.largest_attraction_N, s.largest_repulsion_N);
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
        fmt::print(
            "  journey     centre of mass up to {:.2f} Å from its start, heavy atoms {:.2f} Å "
            "from all others there;\n              {:.2f} Å at the closest; at the end {:.2f} Å "
            "rms from where they started\n",
            j.farthest, j.clearance, j.closest, j.last_rmsd);
    }
    if (s.activity) {
        const Activity& a = *s.activity;
        fmt::print(
            "  active      {:.1f} degrees of freedom on average, chosen {} times; {:.1f} % of the "
            "weighted\n              squares of accelerations neglected; {:.1f} % of steps within "
            "the budget\n",
            a.active, a.choices, 100 * a.neglected_share, 100 * a.within_budget);
    }
    if (s.feel) print_feel(*s.feel);
    fmt::print("  clamped     {:.1f} % of the time\n", 100 * s.clamped_share);
    fmt::print("  step        {:.2f} µs median, {:.2f} µs p99 of {} steps\n", s.step_median_us,
               s.step_p99_us, s.steps);
}

// A frame that cannot be drawn or written is the last one; the run goes on.
void write_frame(std::unique_ptr<FrameWriter>& writer, Simulation& simulation) {
    if (!writer) return;
    try {
        writer->write(simulation);
    } catch (const std::runtime_error& error) {
        fmt::print(stderr, "warning: no more frames: {}\n", error.what());
        writer.reset();
    }
}

// Without a window nobody is there.
void check_headless(const std::string& device) {
    const DeviceMaker& maker = device_maker_called(device);
    if (maker.is_emulated && !maker.needs_window) return;
    throw LoadError({fmt::format("--device {}", device)},
                    "is held by a person and needs the window; expected it without --headless");
}

// Of the hand that holds the other molecule; null where nobody does. An emulated one stands still.
std::unique_ptr<Device> open_second(const RunOptions& options, EmulatedOmniSettings emulated) {
    if (!options.second) return nullptr;
    const DeviceMaker& maker = device_maker_called(*options.second);
    if (maker.needs_window || (options.headless && !maker.is_emulated)) {
        throw LoadError({fmt::format("--second {}", *options.second)},
                        maker.is_emulated || !options.headless
                            ? "is led by the window; expected it as --device"
                            : "is held by a person and needs the window; expected it without "
                              "--headless");
    }
    emulated.script = {};
    return open_device(*options.second, {.emulated = emulated}).device;
}

// Two equal handles with a spring between them are as one of half the mass and damping.
void hold_with_both_hands(SceneDescription& scene) {
    DeviceDescription& device = scene.device;
    device.inertia_kg = in_series(device.inertia_kg, device.inertia_kg);
    device.viscosity_N_s_per_m = in_series(device.viscosity_N_s_per_m, device.viscosity_N_s_per_m);
}

// Asked for, or else chosen last.
SoundChoice build_sound_choice(const RunOptions& options, PreferencesFile& preferences) {
    return {.is_on = options.sound || preferences.now().sound.value_or(false),
            .remember = [&preferences](bool is_on) {
                Preferences chosen = preferences.now();
                chosen.sound = is_on;
                preferences.keep(chosen);
            }};
}

int run_in_window(const SceneDescription& scene, const Simulation& simulation,
                  EmulatedOmniSettings settings, const RunOptions& options) {
    if (options.record) {
        throw LoadError(
            {"--record"},
            "a session in a window cannot be recorded yet; expected --headless with it");
    }
    if (options.play && options.device && *options.device != "emulated") {
        throw LoadError({"--play"}, "is of the emulated hand; expected it without --device");
    }
    const Existing shot_existing =
        options.last_shot ? check_output(*options.last_shot, picture_mark, options.overwrites)
                          : Existing::Refuse;
    // A window needs somebody.
    if (!settings.hand) settings.hand = hand_model(Grip::Medium);
    const std::unique_ptr<Device> second = open_second(options, settings);
    if (!options.play) give_to_mouse(settings);
    PreferencesFile preferences(find_preferences_file());
    WindowDevices devices(settings, preferences, second.get());
    const WindowDevice first =
        devices.open_first(options.play ? std::optional<std::string>("emulated") : options.device);
    if (!devices.notice().empty()) fmt::print(stderr, "warning: {}\n", devices.notice());
    const WindowReport report = run_window(scene, *first.device,
                                           {.view = first_settings(scene.view, simulation),
                                            .width = options.width,
                                            .height = options.height,
                                            .screenshots = options.screenshots,
                                            .last_shot = options.last_shot,
                                            .last_shot_existing = shot_existing,
                                            .last_shot_s = options.last_shot_s,
                                            .orders = first.orders,
                                            .mouse_reach_m = options.play ? 0 : first.mouse_reach_m,
                                            .pads = &devices.pads(),
                                            .devices = options.play ? DeviceMenu() : devices.menu(),
                                            .sound = build_sound_choice(options, preferences),
                                            .notice = devices.notice(),
                                            .lose_device_at = options.lose_device_at,
                                            .validation = options.validation});
    SceneDescription played = scene;
    if (!options.play) played.hand.stroke = Stroke::Path;  // wherever the mouse went
    played.coupling = report.settings.coupling;
    played.period_ms = report.settings.period_ms;
    played.seconds = static_cast<double>(report.summary.ticks) / servo_rate_hz;
    if (options.json) {
        fmt::print("{}", format_summary(played, report.summary));
        return 0;
    }
    print_summary(played, report.summary);
    fmt::print("  drawn       {} frames, {:.1f} ms median, scale {:.2f} at the end\n",
               report.frames, report.median_frame_ms, report.render_scale);
    if (!scene.lesson.empty()) {
        fmt::print("  lesson      {} of {} steps done\n", report.lesson_steps_done,
                   scene.lesson.size());
    }
    return 0;
}

}  // namespace

EmulatedOmniSettings build_emulated_omni(const SceneDescription& scene,
                                         const Simulation& simulation) {
    return {
        .dynamics = {scene.device.inertia_kg, scene.device.viscosity_N_s_per_m},
        .friction_newton = scene.device.friction_N,
        .encoder_step_m = scene.device.encoder_step_mm * 1e-3,
        .hand = hand_model(static_cast<Grip>(scene.hand.grip)),
        .script = plan_hand(scene, simulation, omni_half_workspace_m.x()),
    };
}

void give_to_mouse(EmulatedOmniSettings& settings) {
    settings.driver = HandDriver::Mouse;
    settings.script = {};
    // A mouse has no workspace: half a metre either way stands for that.
    settings.half_workspace_m = Vec3::Constant(0.5);
    // A person who sees the molecule lag overcomes the handle's friction; a mouse has none.
    settings.friction_newton = 0;
}

double mouse_reach_m(const EmulatedOmniSettings& settings) {
    const double stiffness = settings.hand ? settings.hand->stiffness_N_per_m : 0;
    return live_hand_newton / std::max(stiffness, 1.0);
}

ProgressFunction find_progress(bool json) {
    return isatty(STDERR_FILENO) != 0 && !json ? ProgressFunction(show_progress)
                                               : ProgressFunction();
}

void print_scene_keys() {
    fmt::print("| key | value | unless given | meaning |\n| --- | --- | --- | --- |\n");
    for (const FieldNote& field : list_fields()) {
        fmt::print("| `{}` | {} | {} | {} |\n", field.key, field.type, field.fallback,
                   field.meaning);
    }
}

int run_command(const RunOptions& options) {
    SceneDescription scene = read_scene(options.scene, options.settings);
    if (options.record && options.headless && !options.check_only) {
        check_record_folder(*options.record, options.overwrites);
    }
    Simulation simulation = load_simulation(scene, show_relaxing());
    const EmulatedOmniSettings settings = build_emulated_omni(scene, simulation);
    if (options.second) hold_with_both_hands(scene);
    std::vector<std::string> warnings = list_warnings(scene, simulation, settings.script);
    if (options.check_only) {
        fmt::print("{}: nothing wrong found\n", scene.file.string());
        print_line(scene, simulation);
        for (const std::string& warning : warnings) {
            fmt::print("  warning: {}\n", printable(warning));
        }
        return 0;
    }
    if (options.headless && (options.last_shot || options.play || options.sound)) {
        throw LoadError({options.play    ? "--play"
                         : options.sound ? "--sound"
                                         : "--shot"},
                        "is of a window; expected it without --headless");
    }
    if (options.headless && options.device) check_headless(*options.device);
    if (!options.headless)
        return exit_code_after(run_in_window(scene, simulation, settings, options));
    std::unique_ptr<FrameWriter> writer;
    if (options.record && options.frames_per_second > 0) {
        try {  // its complaints about the size come before a recording is begun
            writer = std::make_unique<FrameWriter>(*options.record / "frames", options.frame_width,
                                                   options.frame_height, scene.view);
        } catch (const GpuError& error) {
            warnings.push_back(fmt::format("no frames are drawn: {}", error.what()));
        }
    }
    // A signal ends the program at once until here, however long a file takes to be read.
    std::unique_ptr<Device> device =
        open_device(options.device.value_or("emulated"), {.emulated = settings}).device;
    const std::unique_ptr<Device> second = open_second(options, settings);
    if (second) device = std::make_unique<TwoHands>(std::move(device), *second);
    note_interrupts();  // a recording that is begun is ended in order
    std::optional<Recording> recording;
    if (options.record) recording.emplace(*options.record, scene, options.overwrites);
    if (options.record && (options.second || options.device.value_or("emulated") != "emulated")) {
        warnings.emplace_back(
            "session.toml of this recording plays the scene's own hand; whoever runs it again has "
            "to name --device and --second again");
    }
    FrameClock frames;
    if (writer) frames = {options.frames_per_second, [&] { write_frame(writer, simulation); }};
    for (const std::string& warning : warnings) {
        fmt::print(stderr, "warning: {}\n", printable(warning));
    }

    const Summary summary = run_headless(
        scene, simulation, *device, warnings, recording ? &*recording : nullptr,
        find_progress(options.json), frames, {}, [] { return noted_interrupt() != 0; });
    if (noted_interrupt() != 0) scene.seconds = static_cast<double>(summary.ticks) / servo_rate_hz;
    for (std::size_t i = warnings.size(); i < summary.warnings.size(); ++i) {
        fmt::print(stderr, "warning: {}\n", printable(summary.warnings[i]));
    }
    if (options.json) {
        fmt::print("{}", format_summary(scene, summary));
    } else {
        print_summary(scene, summary);
        if (options.record) fmt::print("recorded in {}\n", options.record->string());
    }
    return exit_code_after(0);
}

}  // namespace palpa
