#include "scene/check_scene.h"

#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace palpa {
namespace {

std::string_view name_of(Motion motion) { return motion_names[static_cast<std::size_t>(motion)]; }

// The molecule that a field names; null where a problem is reported.
const MoleculeDescription* find_named(const SceneDescription& scene, Problems& problems,
                                      const std::string& key, const std::string& name) {
    if (name.empty()) return nullptr;  // already reported
    std::vector<std::string_view> names;
    for (const MoleculeDescription& molecule : scene.molecules) {
        if (molecule.name == name) return &molecule;
        names.emplace_back(molecule.name);
    }
    problems.add(
        problems.place_of(key),
        fmt::format("'{}' is \"{}\", which is not a molecule of this scene; expected one of {}{}",
                    key, name, fmt::join(names, ", "), near_name_hint(name, names)));
    return nullptr;
}

// Whether another hand moves the molecule as a whole.
bool is_moved_by_other(const SceneDescription& scene, const HandTables& by) {
    return std::ranges::any_of(list_hands(scene), [&](const HandTables& other) {
        return other.grab_key != by.grab_key && other.grab.atom.empty() &&
               other.grab.molecule == by.grab.molecule;
    });
}

// Whether the hand can do something with the molecule.
bool check_grabbed(const SceneDescription& scene, const HandTables& by,
                   const MoleculeDescription& grabbed, Problems& problems) {
    const bool by_spring = !by.grab.atom.empty();
    const bool is_flexible = grabbed.shape == Shape::Flexible;
    const bool yields = grabbed.motion == Motion::Free ||
                        (grabbed.motion == Motion::Fixed && is_flexible) ||
                        (is_moved_by_other(scene, by) &&
                         (is_flexible || grabbed.motion == Motion::TranslateAndTurn ||
                          !scene.statics.relaxes_start));
    const bool is_moved = grabbed.motion == Motion::AlongX || grabbed.motion == Motion::Translate ||
                          grabbed.motion == Motion::TranslateAndTurn ||
                          grabbed.motion == Motion::WithHandle;
    if (by_spring ? yields : is_moved) return true;
    const std::string key = by.grab_key + ".molecule";
    problems.add(
        problems.place_of(key),
        fmt::format("'{}' is \"{}\", whose motion is \"{}\"; expected {}", key, by.grab.molecule,
                    name_of(grabbed.motion),
                    by_spring ? fmt::format("a molecule that is free, or fixed and flexible, "
                                            "because the hand pulls it by a spring ({}.atom)",
                                            by.grab_key)
                              : "a molecule that the hand can move: along-x, translate, "
                                "translate-and-turn or with-handle"));
    return false;
}

void check_start(const HandTables& by, bool along_x, Problems& problems) {
    const std::string distance = by.hand_key + ".start_angstrom";
    const std::string offset = by.hand_key + ".start_offset_angstrom";
    if (along_x && by.hand.start_offset_angstrom != std::array<double, 3>{}) {
        problems.add(problems.place_of(offset),
                     fmt::format("'{}' applies to a molecule that moves in space, and this one "
                                 "moves along x; expected {}",
                                 offset, distance));
    }
    if (!along_x && by.hand.start_angstrom) {
        problems.add(problems.place_of(distance),
                     fmt::format("'{}' applies to a molecule that moves along x, and this one "
                                 "moves in space; expected {}",
                                 distance, offset));
    }
}

// What the hand holds; null where a problem is reported.
const MoleculeDescription* check_hold(const SceneDescription& scene, const HandTables& by,
                                      Problems& problems) {
    const std::string from = by.grab_key + ".measured_from";
    const MoleculeDescription* const origin =
        find_named(scene, problems, from, by.grab.measured_from);
    if (origin && origin->motion != Motion::Fixed && !scene.engine) {
        problems.add(problems.place_of(from),
                     fmt::format("'{}' is \"{}\", whose motion is \"{}\"; expected a fixed "
                                 "molecule",
                                 from, by.grab.measured_from, name_of(origin->motion)));
    }
    const MoleculeDescription* const grabbed =
        find_named(scene, problems, by.grab_key + ".molecule", by.grab.molecule);
    if (scene.engine) return grabbed;  // which moves everything
    if (!grabbed || !check_grabbed(scene, by, *grabbed, problems)) return nullptr;
    check_start(by, grabbed->motion == Motion::AlongX, problems);
    return grabbed;
}

void check_motions(const SceneDescription& scene,
                   std::span<const MoleculeDescription* const> grabbed, Problems& problems) {
    for (const MoleculeDescription& molecule : scene.molecules) {
        const std::string key = "molecules." + molecule.name + ".motion";
        const bool by_itself = molecule.motion == Motion::Fixed || molecule.motion == Motion::Free;
        if (!by_itself && std::ranges::find(grabbed, &molecule) == grabbed.end()) {
            problems.add(
                problems.place_of(key),
                fmt::format("'{}' is \"{}\", but {}; expected fixed or free", key,
                            name_of(molecule.motion),
                            scene.hands.size() > 1 ? "no hand holds it (hand[N].grab.molecule)"
                                                   : "the hand moves only grab.molecule"));
        }
        if (molecule.motion == Motion::AlongX && scene.has_statics()) {
            problems.add(problems.place_of(key),
                         fmt::format("'{}' is \"along-x\" in a scene with molecules that move by "
                                     "themselves; expected translate or translate-and-turn",
                                     key));
        }
        if (molecule.motion == Motion::WithHandle && scene.has_statics() &&
            scene.statics.relaxes_start) {
            problems.add(
                problems.place_of(key),
                fmt::format(
                    "'{}' is \"with-handle\" in a scene with molecules that move by themselves, "
                    "which is not supported; expected translate or translate-and-turn",
                    key));
        }
    }
}

void check_grab(const SceneDescription& scene, Problems& problems) {
    std::vector<const MoleculeDescription*> grabbed;
    const bool is_unread = problems.any();  // an empty name may be one that is missing
    for (const HandTables& hand : list_hands(scene)) {
        const bool is_empty = hand.grab.molecule.empty() && !is_unread;
        if (!is_empty) grabbed.push_back(check_hold(scene, hand, problems));
        if (!is_empty || hand.hand.stroke != Stroke::InOut) continue;
        const std::string stroke = hand.hand_key + ".stroke";
        problems.add(problems.place_of(stroke),
                     fmt::format("'{}' is \"in-out\", but the hand holds nothing; expected "
                                 "\"hold\" or \"path\"",
                                 stroke));
    }
    // Without the right molecules in hand, what the others do is no problem of its own.
    if (scene.engine || std::ranges::find(grabbed, nullptr) != grabbed.end()) return;
    check_motions(scene, grabbed, problems);
    if (!scene.joints.around.empty())
        find_named(scene, problems, "joints.around", scene.joints.around);
    if (scene.joints.region_angstrom && scene.joints.within_angstrom) {
        problems.add(problems.place_of("joints.within_angstrom"),
                     "'joints.within_angstrom' and 'joints.region_angstrom' are both given; "
                     "expected one of them");
    }
}

// As the system reads numbers: fewer than four parts are one too.
bool is_host_in_numbers(std::string_view host) {
    constexpr std::int64_t most_parts = 4, most = 255;
    std::int64_t parts = 0;
    for (std::size_t begin = 0; begin <= host.size(); ++parts) {
        const std::size_t end = std::min(host.find('.', begin), host.size());
        const std::string_view part = host.substr(begin, end - begin);
        if (part.empty() || part.find_first_not_of("0123456789") != part.npos) return false;
        const auto number = find_integer(part);
        if (!number || *number > most) return false;
        begin = end + 1;
    }
    return parts <= most_parts;
}

void check_engine(const EngineDescription& engine, Problems& problems) {
    if (!is_engine_address(engine.address)) {
        problems.add(problems.place_of("engine.address"),
                     fmt::format("'engine.address' is \"{}\"; expected HOST:PORT with a numeric "
                                 "host, such as \"127.0.0.1:8888\"",
                                 engine.address));
    }
    if (engine.program == EngineProgram::Lammps && engine.rate == 1) {
        problems.add(problems.place_of("engine.rate"),
                     "'engine.rate' is 1, but LAMMPS accepts forces only if it sends every second "
                     "step or fewer; expected 2 or more, or 0 for the rate of its input");
    }
}

void check_camera(const std::string& key, const std::array<double, 3>& camera, Problems& problems) {
    const auto [azimuth, elevation, zoom] = camera;
    if (std::abs(elevation) <= 90 && zoom >= 0.01 && zoom <= 100) return;
    problems.add(
        problems.place_of(key),
        fmt::format("'{}' is [{}, {}, {}]; expected [azimuth, elevation, zoom]: azimuth in "
                    "degrees, elevation from -90 to 90 degrees, zoom factor from 0.01 to 100",
                    key, azimuth, elevation, zoom));
}

void check_saved_views(const SceneDescription& scene, Problems& problems) {
    std::vector<std::string_view> names;
    for (const SavedView& saved : scene.view.saved) {
        const std::string key = fmt::format("view.saved[{}]", names.size() + 1);
        check_camera(key + ".camera", saved.camera, problems);
        if (std::ranges::find(names, saved.name) != names.end()) {
            problems.add(
                problems.place_of(key + ".name"),
                fmt::format(
                    "'{}.name' is \"{}\", the name of an earlier view; expected a different name",
                    key, saved.name));
        }
        names.emplace_back(saved.name);
    }
    for (const LessonStepDescription& step : scene.lesson) {
        if (step.view.empty() || std::ranges::find(names, step.view) != names.end()) continue;
        const std::string key = fmt::format("lesson.{}.view", step.name);
        problems.add(problems.place_of(key),
                     fmt::format("'{}' is \"{}\"; expected a saved view: {}", key, step.view,
                                 names.empty() ? "[[view.saved]] has none"
                                               : fmt::format("{}", fmt::join(names, ", "))));
    }
}

void check_view(const ViewDescription& view, const SceneDescription& scene, Problems& problems) {
    find_named(scene, problems, "view.look_at", view.look_at);
    check_camera("view.camera", view.camera, problems);
    check_saved_views(scene, problems);
}

}  // namespace

bool is_engine_address(std::string_view address) {
    const std::size_t colon = address.rfind(':');
    if (colon == address.npos) return false;
    const std::string_view host = address.substr(0, colon);
    const std::int64_t port = find_integer(address.substr(colon + 1)).value_or(0);
    return (host == "localhost" || is_host_in_numbers(host)) && port >= 1 && port <= 65535;
}

void check_edits(const SceneDescription& scene, Problems& problems) {
    if (problems.any()) return;  // of a key that is wrong nothing was kept
    for (std::size_t i = 0; i < scene.edits.size(); ++i)
        check_edit(scene.edits[i], scene.hands.size(), fmt::format("edits[{}].", i + 1), problems);
}

void check_edit(const EditDescription& edit, std::size_t hands, const std::string& path,
                Problems& problems) {
    const std::string whose = path + "hand";
    if (edit.hand >= hands) {
        problems.add(
            problems.place_of(whose),
            fmt::format("'{}' is \"{}\", but the scene has {}; expected \"first\"{}{}", whose,
                        edit_hand_names.at(edit.hand),
                        hands == 1 ? "one hand" : fmt::format("{} hands", hands),
                        hands == 1   ? ""
                        : hands == 2 ? " or \"second\""
                                     : fmt::format(" to \"{}\"", edit_hand_names.at(hands - 1)),
                        hands < most_hands ? ", or another table [[hand]]" : ""));
    }
    const EditAction& action = edit.action;
    const std::string key = path + std::string(edit_names[action.index()]);
    const auto check = [&](const auto& one) {
        if constexpr (requires { one.check(key, problems); }) one.check(key, problems);
    };
    std::visit(check, action);
}

namespace {

void check_hand(const HandTables& by, bool is_remote, Problems& problems) {
    const HandDescription& h = by.hand;
    const std::string stroke = by.hand_key + ".stroke", path = by.hand_key + ".path";
    const auto check = [&](bool right, const std::string& key, const std::string& what) {
        if (!right) problems.add(problems.place_of(key), fmt::format("'{}' {}", key, what));
    };
    check(h.stroke != Stroke::InOut || !is_remote, stroke,
          "is \"in-out\", which does not work with a remote engine ([engine]); expected \"hold\", "
          "\"path\" or \"lead\"");
    check(
        !by.grab.place_angstrom || !by.grab.atom.empty() || is_remote,
        by.grab_key + ".place_angstrom",
        fmt::format("is the end of a spring, but the hand holds '{}' as a whole; expected {}.atom "
                    "as well",
                    by.grab.molecule, by.grab_key));
    check(h.stroke != Stroke::InOut || h.grip != HandGrip::None, stroke,
          "is \"in-out\", but with the grip \"none\" nobody moves the handle; expected \"hold\", "
          "or another grip");
    const bool has_path = h.stroke == Stroke::Path || h.stroke == Stroke::Lead;
    check(!has_path || !h.path.empty(), stroke,
          fmt::format("is \"{}\", but '{}' has no point; expected [[time, place], ...]",
                      stroke_names[static_cast<std::size_t>(h.stroke)], path));
    check(h.stroke != Stroke::Lead || h.grip != HandGrip::None, stroke,
          "is \"lead\", but with the grip \"none\" nobody moves the handle; expected another grip");
    const auto turns = [](const PathPoint& point) {
        return point.turn_deg != PathPoint{}.turn_deg;
    };
    check(h.stroke != Stroke::Lead || std::ranges::none_of(h.path, turns), path,
          fmt::format("turns the handle, but '{}' is \"lead\", which does not turn it; expected "
                      "[s, Å] or [s, Å, Å, Å]",
                      stroke));
    for (std::size_t i = 1; i < h.path.size(); ++i) {
        check(h.path[i].time_s > h.path[i - 1].time_s, path,
              fmt::format("has the time {} s after {} s; expected ascending times",
                          h.path[i].time_s, h.path[i - 1].time_s));
    }
}

// How many selections the quantity is of, at least and at most.
std::array<std::size_t, 2> count_selections(LessonQuantity quantity) {
    switch (quantity) {
        case LessonQuantity::Between:
        case LessonQuantity::HydrogenBonds:
            return {2, 2};
        case LessonQuantity::Dihedral:
            return {4, 4};
        case LessonQuantity::MapCells:
            return {5, 5};
        case LessonQuantity::Way:
            return {0, 1};
        default:
            return {0, 0};
    }
}

// `check(right, key, what)` adds a problem where that is not right.
template <class Check>
void check_lesson_step(const LessonStepDescription& step, const std::string& key,
                       const Check& check) {
    const bool has_bounds = step.at_least || step.at_most;
    if (const auto& question = step.question) {
        check(!has_bounds, key,
              fmt::format(
                  "'{}' has both a question and bounds (at_least, at_most); expected one of them",
                  key));
        check(question->right <= static_cast<std::int64_t>(question->answers.size()),
              key + ".question.right",
              fmt::format("'{}.question.right' is {}; expected the number of one of the {} answers",
                          key, question->right, question->answers.size()));
        check(question->why.size() == question->answers.size(), key + ".question.why",
              fmt::format(
                  "'{}.question.why' has {} texts for {} answers; expected one for each answer",
                  key, question->why.size(), question->answers.size()));
        return;
    }
    check(has_bounds, key,
          fmt::format("'{}' has neither at_least nor at_most; expected one or both, or a question",
                      key));
    const auto [fewest, most] = count_selections(step.quantity);
    check(step.of.size() >= fewest && step.of.size() <= most, key + ".of",
          fmt::format("'{}.of' has {} selections, but {} needs {}", key, step.of.size(),
                      lesson_quantity_names[static_cast<std::size_t>(step.quantity)], most));
    for (std::size_t i = 1; i < step.operator_path.size(); ++i) {
        check(
            step.operator_path[i].time_s > step.operator_path[i - 1].time_s, key + ".operator_path",
            fmt::format("'{}.operator_path' has the time {} s after {} s; expected ascending times",
                        key, step.operator_path[i].time_s, step.operator_path[i - 1].time_s));
    }
}

void check_ranges(const SceneDescription& scene, Problems& problems) {
    const auto check = [&](bool right, const std::string& key, const std::string& what) {
        if (!right) problems.add(problems.place_of(key), what);
    };
    const StaticsDescription& statics = scene.statics;
    const bool is_adaptive =
        statics.budget_us.has_value() || statics.active < StaticsDescription{}.active;
    check(!is_adaptive || method_of(statics) == RelaxMethod::QuasiStatic, "statics.method",
          fmt::format("'statics.method' is \"{}\", which always moves all degrees of freedom; "
                      "expected quasi-static with statics.{}",
                      relax_method_names[static_cast<std::size_t>(method_of(statics))],
                      statics.budget_us ? "budget_us" : "active"));
    const bool has_solvent = scene.force_field.solvent != Solvent::None;
    check(!has_solvent || !scene.statics.cutoff_angstrom, "statics.cutoff_angstrom",
          fmt::format("'statics.cutoff_angstrom' is {}, but force_field.solvent = \"{}\" has "
                      "cutoffs of its own (9 and 9.5 Å); expected no cutoff, or solvent = \"none\"",
                      scene.statics.cutoff_angstrom.value_or(0),
                      solvent_names[static_cast<std::size_t>(scene.force_field.solvent)]));
    for (std::size_t i = 0; i < scene.restraints.size(); ++i)
        scene.restraints[i].check(fmt::format("restraints[{}]", i + 1), problems);
    for (const MoleculeDescription& molecule : scene.molecules) {
        const std::string anchors = fmt::format("molecules.{}.anchors", molecule.name);
        for (auto i = molecule.anchors.begin(); i != molecule.anchors.end(); ++i) {
            check(std::find(molecule.anchors.begin(), i, *i) == i, anchors,
                  fmt::format("'{}' names \"{}\" twice; expected each once", anchors, *i));
        }
        const std::string key = fmt::format("molecules.{}.structural_water", molecule.name);
        check(has_solvent || !molecule.structural_water, key,
              fmt::format("'{}' is true, but the scene has no implicit solvent; expected "
                          "force_field.solvent = \"eef1-sb\", or leave this key out",
                          key));
    }
    check(std::abs(scene.period_ms - std::round(scene.period_ms)) < 1e-9, "run.period_ms",
          fmt::format("'run.period_ms' is {}; expected a whole number of ms (servo ticks)",
                      scene.period_ms));
    for (const LessonStepDescription& step : scene.lesson) {
        const std::string key = "lesson." + step.name;
        check_lesson_step(step, key, check);
        check(!(step.at_least && step.at_most) || *step.at_least <= *step.at_most, key + ".at_most",
              fmt::format(
                  "'{}.at_most' is below at_least, so no value can pass; expected at_least or more",
                  key));
    }
}

}  // namespace

void check_coupling(const std::string& table, const CouplingDescription& c, Problems& problems) {
    const auto check = [&](bool right, std::string_view name, const std::string& what) {
        const std::string key = fmt::format("{}.{}", table, name);
        if (!right) problems.add(problems.place_of(key), fmt::format("'{}' {}", key, what));
    };
    check(c.F_h2_N > c.F_h1_N, "F_h2_N",
          fmt::format("is {} N; expected more than F_h1_N, {} N", c.F_h2_N, c.F_h1_N));
    check(c.A_d_max >= c.A_d_min, "A_d_max",
          fmt::format("is {}; expected A_d_min, {}, or more", c.A_d_max, c.A_d_min));
    check(c.F_hi_nN * 1e3 > 2 * c.F_lo_pN, "F_hi_nN",
          fmt::format("is {} nN; expected more than twice F_lo_pN, {} pN", c.F_hi_nN, c.F_lo_pN));
    if (const auto range = c.feel_pN) {
        const auto [weakest, strongest] = *range;
        check(strongest > weakest, "feel_pN",
              fmt::format("is [{}, {}]; expected the weaker force first", weakest, strongest));
        check(c.mode == CouplingMode::Guarded, "feel_pN",
              fmt::format("applies to guarded coupling, but {}.mode is {}; expected mode = "
                          "\"guarded\", or no feel_pN",
                          table, coupling_mode_names[static_cast<std::size_t>(c.mode)]));
        check(c.clamp_N >= truncation_newton, "clamp_N",
              fmt::format("is {} N, but with feel_pN forces reach {} N; expected that or more",
                          c.clamp_N, truncation_newton));
    }
}

void check_scene(const SceneDescription& scene, Problems& problems) {
    check_grab(scene, problems);
    if (scene.engine) check_engine(*scene.engine, problems);
    check_coupling("coupling", scene.coupling, problems);
    check_ranges(scene, problems);
    for (const HandTables& hand : list_hands(scene)) {
        check_hand(hand, scene.engine.has_value(), problems);
        if (hand.hand.coupling)
            check_coupling(hand.hand_key + ".coupling", *hand.hand.coupling, problems);
    }
    check_view(scene.view, scene, problems);
    check_edits(scene, problems);
}

}  // namespace palpa
