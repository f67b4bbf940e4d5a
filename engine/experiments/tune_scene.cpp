#include "experiments/tune_scene.h"

#include "core/assertion.h"
#include "core/interrupt.h"
#include "core/load_error.h"
#include "core/machine.h"
#include "core/translate.h"
#include "core/work_folder.h"
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "formats/crd.h"
#include "formats/psf.h"
#include "loading/load.h"
#include "math/eigenvectors.h"
#include "prepare/phosphates.h"
#include "prepare/region_choice.h"
#include "prepare/residues.h"
#include "prepare/scene_of.h"
#include "scene/description.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "statics/renewal.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>

namespace palpa {
namespace {

// The system as its scene has it: segments that are bonded are one.
struct SystemCopy {
    Structure structure;
    Connectivity connectivity;
    std::vector<std::vector<std::string>> joined;
    std::vector<SystemSegment> segments;
    HandChoice hand;
};

SystemCopy copy_for_scene(const PreparedSystem& system) {
    SystemCopy copy{system.structure, system.connectivity, {}, {}, {}};
    copy.joined = join_bonded_segments(copy.structure, copy.connectivity);
    copy.segments = find_segments(copy.structure, copy.connectivity);
    return copy;
}

void leave_if_interrupted() {
    if (noted_interrupt() != 0) throw Interrupted();
}

// What a stroke of the emulated hand found.
struct Played {
    double strong_pN = 0;    // force on what is held; 95 % of the time it is below
    double felt_newton = 0;  // at most, in any direction
    double moved_angstrom = 0;
    double median_us = 0, p99_us = 0;  // of a step, p99 without renewals
    double renewed = 0;                // share of the steps in which the model was renewed
};

Played play(const SceneDescription& scene, World& world, std::string_view stage,
            const StageFunction& on_stage) {
    std::vector<double> forces_pN;
    Played played;
    const auto watch = [&](const ServoTick& tick) {
        forces_pN.push_back(1e12 * tick.contact.force_newton.norm());
        const Vec3 felt = tick.sent_newton - tick.damping_newton;
        played.felt_newton = std::max(played.felt_newton, felt.norm());
    };
    EmulatedOmni device(build_emulated_omni(scene, world));
    const Summary summary = run_headless(
        scene, world, device, {}, nullptr, [&](double share) { tell(on_stage, stage, share); }, {},
        watch, [] { return noted_interrupt() != 0; });
    leave_if_interrupted();
    const auto strong =
        forces_pN.begin() + static_cast<std::ptrdiff_t>(forces_pN.size() * 95 / 100);
    std::ranges::nth_element(forces_pN, strong);
    played.strong_pN = strong == forces_pN.end() ? 0 : *strong;
    if (summary.unbinding) played.moved_angstrom = summary.unbinding->farthest;
    played.median_us = summary.step_median_us;
    played.p99_us = summary.step_p99_us;
    if (summary.relaxation && summary.steps > 0) {
        played.renewed =
            static_cast<double>(summary.relaxation->renewals) / static_cast<double>(summary.steps);
    }
    if (played.renewed > 0) played.p99_us = ordinary_p99(played.median_us, played.p99_us);
    return played;
}

constexpr double least_felt = 0.3, least_moved = 1;  // N, Å

double two_digits(double value) {
    const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
    return std::round(value / unit) * unit;
}

// Fewer for larger systems, so that it takes no more than some minutes.
std::int64_t relax_steps_for(std::size_t atoms) {
    constexpr std::size_t atom_steps = 16'000'000;
    return static_cast<std::int64_t>(std::clamp<std::size_t>(atom_steps / atoms, 100, 4000));
}

// About what a step takes.
double first_period_ms(std::size_t atoms) {
    constexpr double ms_per_atom = 5e-3, longest = 60;
    return std::clamp(std::ceil(ms_per_atom * static_cast<double>(atoms)), 1.0, longest);
}

// A scene on its way from a first try to the one that is written.
struct Tuning {
    SystemCopy copy;
    std::string title, topology_title;  // of files
    bool is_turned = true;              // the way out is +x
    bool may_hold_another = true;       // nothing was asked for
    bool measures = true;               // gains and period
    Structure rest;                     // the copy's atoms where their joints came to rest
    Vec3 way = Vec3::UnitX();
    SceneText text;
    SceneTuning tuning;
    JointRelaxReport relaxed;
    std::size_t joints = 0;
    double p99_us = 0;  // of a step, by which the period is
    std::string measured = "99 % of steps";

    std::string scene() const {
        return format_scene(copy.structure, copy.segments, copy.hand, way, text, tuning);
    }
    std::vector<TextFile> files() const {
        std::vector<TextFile> all{{"scene.toml", scene()},
                                  {text.structure, format_crd(rest, title)}};
        if (!copy.joined.empty()) {
            all.push_back({text.topology, format_psf(copy.connectivity, topology_title)});
        }
        return all;
    }
};

// Where the table of the scene's atoms has the copy's.
std::vector<std::uint32_t> find_table_order(const SystemCopy& copy) {
    std::vector<std::uint32_t> order;
    for (const SystemSegment& segment : copy.segments)
        order.insert(order.end(), segment.atoms.begin(), segment.atoms.end());
    return order;
}

// Joints turn where charges act in full; the scene begins where they end.
void bring_to_rest(const std::filesystem::path& folder, const StageFunction& on_stage,
                   Tuning& tuning) {
    const World world = load_world(read_scene(folder / "scene.toml"), on_stage);
    const StartReport& report = world.resource<StartReport>();
    PALPA_ASSERT(report.joints_at_rest);  // the scene says so
    if (!report.joints_at_rest) return;
    tuning.relaxed = *report.joints_at_rest;
    tuning.joints = report.joints;
    const std::vector<std::uint32_t> order = find_table_order(tuning.copy);
    const std::vector<Vec3> rest = reference_positions(world);
    for (std::size_t i = 0; i < order.size(); ++i) tuning.rest.positions[order[i]] = rest[i];
    tuning.tuning.relax_steps.reset();
    if (report.joints_at_rest->end != RelaxEnd::Converged) tuning.tuning.relax_steps = 0;
}

// As `align` does it, far below what matters, so that every compiler writes the same file.
double rounded(double value) { return std::round(value * 1e6) / 1e6; }

void take_way(const Vec3& way, Tuning& tuning) {
    tuning.way = way;
    if (!tuning.is_turned) return;
    std::vector<Vec3>& positions = tuning.rest.positions;
    const Mat3 turn = turn_between(way, Vec3::UnitX()).toRotationMatrix();
    Vec3 middle = Vec3::Zero();
    for (const Vec3& place : positions) middle += place / static_cast<double>(positions.size());
    for (Vec3& place : positions) place = (turn * (place - middle)).unaryExpr(&rounded);
    tuning.way = Vec3::UnitX();
}

void write_scene(const std::filesystem::path& folder, const Tuning& tuning) {
    for (const TextFile& file : tuning.files()) {
        write_text_file(folder / file.path, file.text, Existing::Replace);
    }
}

// `settings`: over the file.
Played play_written(const std::filesystem::path& folder, std::string_view stage,
                    const std::vector<std::string>& settings, const StageFunction& on_stage,
                    const Tuning& tuning) {
    write_scene(folder, tuning);
    const SceneDescription scene = read_scene(folder / "scene.toml", settings);
    World world = load_world(scene, on_stage);
    return play(scene, world, stage, on_stage);
}

void set_period(const Played& played, Tuning& tuning) {
    tuning.p99_us = played.p99_us;
    tuning.tuning.period_ms = choose_period_ms(1e-3 * played.p99_us);
    tuning.tuning.measured_on = machine_name();
    tuning.measured = played.renewed > 0 ? "99 % of steps without a renewal" : "99 % of steps";
    tuning.tuning.period_note = fmt::format(
        "1.5 times what {} took here, 5 ms at least: {:.2f} ms ({:.2f} ms in the "
        "median), {}.",
        tuning.measured, 1e-3 * played.p99_us, 1e-3 * played.median_us, machine_name());
}

void set_region(Tuning& tuning) {
    const SystemCopy& copy = tuning.copy;
    const RegionChoice region = choose_region(copy.structure, copy.segments, copy.hand.held);
    tuning.tuning.region_angstrom = region.angstrom;
    tuning.tuning.region_note = fmt::format(
        "{} of {} atoms lie within it (limit {}, so that a step takes milliseconds); all other "
        "atoms are fixed.",
        region.atoms, count_mobile_atoms(copy.segments), most_atoms_of_region);
}

void set_coupling(const Played& first, Tuning& tuning) {
    tuning.tuning.feel_pN = choose_range(first.strong_pN);
    tuning.tuning.coupling_note = fmt::format(
        "For 95 % of its stroke the emulated hand found forces up to {:.0f} pN: one tenth of that "
        "is felt as 0.3 N, three times that as 2.7 N.",
        first.strong_pN);
}

constexpr std::string_view scene_heading = "Scene";  // of the report

void report_hand(const Tuning& tuning, Report& report) {
    const HandChoice& hand = tuning.copy.hand;
    report.add(
        scene_heading,
        fmt::format(
            "in the hand: {} ({}; to choose another: --grab SEGMENT:RESIDUE or --grab SEGMENT)",
            hand.words, hand.reason));
    if (!tuning.tuning.region_note.empty()) {
        report.add(scene_heading,
                   fmt::format("joints.region_angstrom = {} around the hand: {}",
                               *tuning.tuning.region_angstrom, tuning.tuning.region_note));
    }
    for (const std::vector<std::string>& names : tuning.copy.joined) {
        report.add(
            scene_heading,
            fmt::format("segments bonded to each other, which form one molecule of the scene: {}",
                        fmt::join(names, ", ")));
    }
    report.add(
        scene_heading,
        fmt::format("{} joints can turn, in {}; relaxed from {:.2f} to {:.2f} kcal/mol in {} "
                    "steps, largest move of an atom {:.2f} Å (relaxed.crd)",
                    tuning.joints,
                    tuning.text.solvent == Solvent::None ? "vacuum" : "EEF1-SB's implicit water",
                    tuning.relaxed.energy_before, tuning.relaxed.energy_after, tuning.relaxed.steps,
                    tuning.relaxed.largest_move));
    if (tuning.relaxed.end != RelaxEnd::Converged) {
        report.add(scene_heading,
                   fmt::format("not yet at rest: an rms force of {:.3g} kcal/mol per "
                               "radian and Å remains; relax further with palpa relax",
                               tuning.relaxed.rms_force));
    }
}

void report_scene(const Played& played, const Tuning& tuning, Report& report) {
    report_hand(tuning, report);
    if (const auto range = tuning.tuning.feel_pN) {
        report.add(scene_heading,
                   fmt::format("guarded coupling; forces of {} to {} pN are felt as 0.3 "
                               "to 2.7 N",
                               (*range)[0], (*range)[1]));
    }
    report.add(scene_heading,
               fmt::format("period {} ms: {} took {:.2f} ms here", tuning.tuning.period_ms,
                           tuning.measured, 1e-3 * tuning.p99_us));
    report.add(scene_heading,
               fmt::format("the emulated hand felt up to {:.2f} N and moved what it holds "
                           "by {:.2f} Å",
                           played.felt_newton, played.moved_angstrom));
    if (played.felt_newton < least_felt || played.moved_angstrom < least_moved) {
        report.warn(fmt::format(
            "in the scene the emulated hand felt up to {:.2f} N and moved what it holds by {:.2f} "
            "Å; expected {} N and {} Å at least: --grab takes something else into the hand",
            played.felt_newton, played.moved_angstrom, least_felt, least_moved));
    }
}

// The hand is out from 3 to 4 s (prepare/scene_of.h).
constexpr const char* way_out_only = "run.seconds=3.5";

// The stroke's way out with constant gains, or across where what is held does not move that way.
Played try_ways(const std::filesystem::path& folder, const StageFunction& on_stage,
                Tuning& tuning) {
    const Structure rest = tuning.rest;
    const Vec3 out = find_way_out(rest, tuning.copy.hand.held);
    const Vec3 across = out.unitOrthogonal();
    Played best;
    best.moved_angstrom = -1;
    Vec3 best_way = out;
    for (const Vec3& way : {out, across, Vec3(out.cross(across))}) {
        tuning.rest = rest;
        take_way(way, tuning);
        const Played played = play_written(folder, for_translation("measuring the forces"),
                                           {way_out_only}, on_stage, tuning);
        if (played.moved_angstrom > best.moved_angstrom) {
            best = played;
            best_way = way;
        }
        if (best.moved_angstrom > least_moved) break;
    }
    tuning.rest = rest;
    take_way(best_way, tuning);
    return best;
}

void rest_region(const std::filesystem::path& folder, const StageFunction& on_stage,
                 Tuning& tuning) {
    set_region(tuning);
    tuning.tuning.relax_steps = relax_steps_for(tuning.rest.names.size());
    write_scene(folder, tuning);
    bring_to_rest(folder, on_stage, tuning);
}

// Plays with constant gains and a period that depends on the number of atoms alone.
Played play_first(const std::filesystem::path& folder, const StageFunction& on_stage,
                  Tuning& tuning) {
    tuning.tuning.period_ms = first_period_ms(tuning.rest.names.size());
    return try_ways(folder, on_stage, tuning);
}

// Plays with the gains and the period that follow from the first play.
Played tune_coupling(const Played& first, const std::filesystem::path& folder,
                     const StageFunction& on_stage, Tuning& tuning) {
    set_coupling(first, tuning);
    set_period(first, tuning);
    const Played played = play_written(folder, for_translation("playing the scene"), {way_out_only},
                                       on_stage, tuning);
    if (choose_period_ms(1e-3 * played.p99_us) > tuning.tuning.period_ms)
        set_period(played, tuning);
    return played;
}

bool holds_chain(const Tuning& tuning) {
    constexpr std::size_t most_of_ligand = 300;  // atoms
    const HandChoice& hand = tuning.copy.hand;
    return hand.atom.empty() && hand.held.size() > most_of_ligand;
}

void describe_hand(Tuning& tuning) {
    tuning.text.about =
        fmt::format("In the hand: {}. The emulated hand pulls it by 4 Å and brings it back.",
                    tuning.copy.hand.words);
}

// Says why no hand can move what it holds; empty where one can. The time of steps does not count,
// so that a scene has the same in the hand on every machine.
std::string describe_firmness(const Played& played) {
    constexpr double most_renewed = 0.1;  // the hand waits for every renewal
    if (played.moved_angstrom < least_moved)
        return fmt::format("moves by only {:.2f} Å", played.moved_angstrom);
    if (played.renewed > most_renewed)
        return fmt::format("needs a new model in {:.0f} % of the steps", 100 * played.renewed);
    return {};
}

// In place of a chain that is bound too firmly.
void hold_residue(const std::string& firmness, Tuning& tuning) {
    SystemCopy& copy = tuning.copy;
    const std::string chain = copy.hand.words;
    copy.hand = choose_residue(copy.structure, copy.segments);
    copy.hand.reason = fmt::format("{} {}; {}", chain, firmness, copy.hand.reason);
    describe_hand(tuning);
}

// Guesses, which the window replaces by what it measures.
void set_unmeasured(Tuning& tuning) {
    constexpr std::array<double, 2> usual_pN{100, 3000};
    take_way(find_way_out(tuning.rest, tuning.copy.hand.held), tuning);
    tuning.tuning.feel_pN = usual_pN;
    tuning.tuning.period_ms = first_period_ms(tuning.rest.names.size());
    tuning.tuning.coupling_note = tuning.tuning.period_note =
        "Not measured yet: the window does it while a hand plays.";
    tuning.tuning.measured_on = unmeasured;
}

TunedScene tune(PreparedSystem& system, Tuning& tuning, const StageFunction& tell_stage) {
    const WorkFolder scratch;
    const StageFunction on_stage = [&](std::string_view stage, std::optional<double> share) {
        leave_if_interrupted();
        tell(tell_stage, stage, share);
    };
    const std::filesystem::path& folder = scratch.path();
    write_prepared(system, folder, tuning.title, tuning.files());
    bring_to_rest(folder, on_stage, tuning);
    constexpr std::size_t base_freedom = 6;  // of what is in the hand
    if (!tuning.tuning.region_angstrom &&
        tuning.joints + base_freedom > static_cast<std::size_t>(most_second_order_coordinates)) {
        rest_region(folder, on_stage, tuning);
    }
    if (!tuning.measures && !holds_chain(tuning)) {
        set_unmeasured(tuning);
        report_hand(tuning, system.report);
        return {tuning.files(), tuning.copy.hand.words};
    }
    Played first = play_first(folder, on_stage, tuning);
    const std::string firmness = describe_firmness(first);
    if (tuning.may_hold_another && holds_chain(tuning) && !firmness.empty()) {
        hold_residue(firmness, tuning);
        if (tuning.tuning.region_angstrom) rest_region(folder, on_stage, tuning);
        first = play_first(folder, on_stage, tuning);
    }
    const Played played = tune_coupling(first, folder, on_stage, tuning);
    report_scene(played, tuning, system.report);
    return {tuning.files(), tuning.copy.hand.words, played.felt_newton, played.moved_angstrom};
}

// Bonds whose barriers are guesses, of each copy of an approximate residue.
std::vector<std::string> find_rigid(const Structure& structure,
                                    const std::vector<ApproximatePart>& parts) {
    std::vector<std::string> rigid;
    for (const ApproximatePart& part : parts) {
        if (part.rigid_bonds.empty()) continue;
        for (const ResidueRange& residue : find_residues(structure)) {
            const AtomName& name = structure.names[residue.first];
            if (name.residue != part.residue) continue;
            for (const std::vector<std::string>& bond : part.rigid_bonds) {
                rigid.push_back(
                    fmt::format("{} {} {}", name.segment, name.number, fmt::join(bond, " ")));
            }
        }
    }
    return rigid;
}

}  // namespace

std::array<double, 2> choose_range(double strong_pN) {
    constexpr double weakest = 10, strongest = 3e5;  // so that the key takes what comes of it
    const double strong = std::clamp(strong_pN, weakest, strongest);
    return {two_digits(strong / 10), two_digits(3 * strong)};
}

double choose_period_ms(double p99_ms) {
    constexpr double headroom = 1.5, shortest = 5, longest = 1000;
    return std::clamp(std::ceil(headroom * p99_ms), shortest, longest);
}

double ordinary_p99(double median, double p99) {
    constexpr double ordinary = 10;
    return std::min(p99, ordinary * median);
}

std::vector<HandOffer> list_hands(const PreparedSystem& system) {
    const SystemCopy copy = copy_for_scene(system);
    std::vector<HandOffer> offers;
    for (HandChoice& choice : list_hand_choices(copy.structure, copy.segments)) {
        std::string grab = offers.empty() ? std::string() : grab_of(choice);
        std::string words = translated_words(copy.structure, choice);
        offers.push_back({std::move(grab), std::move(words), std::move(choice.held)});
    }
    return offers;
}

TunedScene tune_scene(PreparedSystem& system, const std::string& grab, bool is_aligned,
                      bool measures, const std::string& name, const std::string& title,
                      const StageFunction& on_stage) {
    tell(on_stage, for_translation("choosing what the hand holds"));
    Tuning tuning;
    tuning.copy = copy_for_scene(system);
    tuning.copy.hand = choose_hand(tuning.copy.structure, tuning.copy.segments, grab);
    tuning.title = title;
    tuning.topology_title = topology_title(system, title);
    tuning.text.solvent = system.solvent;
    if (system.reduced_phosphates > 0) tuning.text.dielectric = nucleic_dielectric;
    tuning.is_turned = !is_aligned;
    tuning.measures = measures;
    tuning.may_hold_another = grab.empty();
    tuning.rest = tuning.copy.structure;
    tuning.text.title = name;
    describe_hand(tuning);
    for (const ApproximatePart& part : system.approximate) {
        tuning.text.approximate.push_back(part.residue);
    }
    tuning.text.rigid = find_rigid(tuning.copy.structure, system.approximate);
    tuning.text.made_by = "palpa prepare; report.txt has every decision";
    if (!tuning.copy.joined.empty()) tuning.text.topology = "scene.psf";
    const std::size_t atoms = tuning.rest.names.size();
    if (count_mobile_atoms(tuning.copy.segments) > most_atoms_all_move) set_region(tuning);
    tuning.tuning.relax_steps = relax_steps_for(atoms);
    return tune(system, tuning, on_stage);
}

}  // namespace palpa
