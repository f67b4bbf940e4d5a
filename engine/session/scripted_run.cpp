#include "session/scripted_run.h"

#include "core/files.h"
#include "core/units.h"
#include "molecule/select.h"
#include "session/coordinates.h"
#include "session/reading.h"
#include "simulation/atom_directory.h"
#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/select_in_world.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>
#include <variant>

namespace palpa {
namespace {

using Json = nlohmann::ordered_json;

std::string one_line(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json as_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json read_hand(const World& world, Entity hand, const ServoTick& tick) {
    const std::string held = held_address(world, hand, *list_atoms(world));
    Json json;
    json["holds"] = held.empty() ? Json() : Json(held);
    json["distance_angstrom"] = !held.empty() ? Json(read_tick(tick).distance_angstrom) : Json();
    json["molecule_nN"] = as_json(1e9 * tick.contact.force_newton);
    json["hand_N"] = as_json(tick.sent_newton);
    json["handle_mm"] = as_json(1e3 * tick.reading.position_m);
    return json;
}

// Of an address, of which the molecule is there, or of a selection.
std::vector<std::uint32_t> list_named_atoms(const World& world, const std::string& text) {
    std::vector<std::uint32_t> atoms;
    const std::optional<Address> address = find_address(text);
    if (const Entity molecule = address ? molecule_called(world, address->molecule) : Entity{};
        molecule != Entity{}) {
        const std::string part =
            address->atom.empty() ? address->residue : address->residue + " " + address->atom;
        atoms = part.empty() ? all_atoms_of(world, molecule) : atoms_called(world, molecule, part);
        return numbers_of(world, {molecule, std::move(atoms)});
    }
    const std::vector<bool> chosen = select_in_world(world, parse_selection(text, "read"));
    for (std::uint32_t i = 0; i < chosen.size(); ++i)
        if (chosen[i]) atoms.push_back(i);
    return atoms;
}

// How many they are, and where, by mass and one by one.
void add_atoms(const World& world, const std::string& text, Json& json) {
    const std::vector<std::uint32_t> atoms = list_named_atoms(world, text);
    const AtomTable& table = world.resource<AtomTable>();
    if (atoms.empty()) throw LoadError({"read"}, fmt::format("'{}' names no atom", text));
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    Json places = Json::array();
    for (const std::uint32_t atom : atoms) {
        sum += table.mass[atom] * table.positions[atom];
        mass += table.mass[atom];
        places.push_back(as_json(table.positions[atom]));
    }
    json["atoms"] = atoms.size();
    json["centre_angstrom"] = mass > 0 ? as_json(sum / mass) : Json();
    json["places_angstrom"] = std::move(places);
}

Json list_words() {
    Json words = Json::array();
    for (const FieldNote& note : list_run_commands())
        words.push_back({{"key", note.key}, {"value", note.type}, {"meaning", note.meaning}});
    return words;
}

}  // namespace

ScriptedRun::ScriptedRun(const SceneDescription& scene, ScriptEnds ends)
    : scene_(scene), ends_(std::move(ends)) {}

void ScriptedRun::add(std::span<const ServoTick> ticks) {
    ticks_.assign(ticks.begin(), ticks.end());
}

void ScriptedRun::before_step(World& world, const EditFunction& edit) {
    if (left_ > 0) {
        --left_;
        return;
    }
    if (std::exchange(is_passing_, false)) answer_ok(world);
    while (!is_over_) {
        const std::optional<std::string> line = ends_.next_line();
        ++place_.line;
        if (!line) {
            is_over_ = true;
        } else if (take_line(*line, world, edit)) {
            return;
        }
    }
}

bool ScriptedRun::take_line(const std::string& line, World& world, const EditFunction& edit) {
    try {
        const std::optional<RunCommand> command = parse_run_command(line, scene_, place_);
        return command && apply(*command, world, edit);
    } catch (const LoadError& error) {
        has_refused_ = true;
        std::string what = error.what();
        // The line's number stands beside it.
        const std::string own = to_string(place_) + ": ";
        if (what.starts_with(own)) what.erase(0, own.size());
        ends_.answer(one_line({{"ok", false}, {"error", what}, {"line", place_.line}}));
        return false;
    }
}

bool ScriptedRun::apply(const RunCommand& command, World& world, const EditFunction& edit) {
    const auto visit = [&](const auto& action) {
        using Action = std::decay_t<decltype(action)>;
        if constexpr (std::is_same_v<Action, EditAction>) {
            edit({0, command.hand, action, place_});
            answer_ok(world);
        } else if constexpr (std::is_same_v<Action, StepCommand>) {
            pass(static_cast<std::uint64_t>(action.steps));
        } else if constexpr (std::is_same_v<Action, RunForCommand>) {
            const double steps = action.seconds / world.resource<Clock>().period_s;
            pass(static_cast<std::uint64_t>(std::max(std::ceil(steps - 1e-6), 1.0)));
        } else if constexpr (std::is_same_v<Action, HandCommand>) {
            ends_.lead(command.hand, 1e-3 * Vec3(action.place_mm.data()));
            answer_ok(world);
        } else if constexpr (std::is_same_v<Action, ReadCommand>) {
            answer_reading(world, action.atoms);
        } else if constexpr (std::is_same_v<Action, SaveCommand>) {
            save(world, action.file);
            answer_ok(world);
        } else if constexpr (std::is_same_v<Action, HelpCommand>) {
            ends_.answer(one_line({{"ok", true}, {"words", list_words()}}));
        } else {
            static_assert(std::is_same_v<Action, QuitCommand>);
            is_over_ = true;
            answer_ok(world);
        }
    };
    std::visit(visit, command.action);
    return is_passing_;
}

// The first of them begins now.
void ScriptedRun::pass(std::uint64_t steps) noexcept {
    left_ = steps - 1;
    is_passing_ = true;
}

void ScriptedRun::answer_ok(const World& world) {
    ends_.answer(one_line({{"ok", true},
                           {"time_s", ticks_.front().reading.time_s},
                           {"steps", world.resource<Clock>().steps}}));
}

void ScriptedRun::answer_reading(const World& world, const std::string& atoms) {
    Json json{{"ok", true},
              {"time_s", ticks_.front().reading.time_s},
              {"steps", world.resource<Clock>().steps},
              {"energy_kcal_per_mol", ticks_.front().contact.potential_kcal_per_mol}};
    const std::vector<Entity> hands = find_hands(world);
    for (std::size_t i = 0; i < ticks_.size(); ++i)
        json["hands"].push_back(read_hand(world, hands.at(i), ticks_[i]));
    json["marks"] = Json::array();
    world.each<Mark>([&](Entity, const Mark& mark) { json["marks"].push_back(mark.value); });
    if (!atoms.empty()) add_atoms(world, atoms, json);
    ends_.answer(one_line(json));
}

void ScriptedRun::save(const World& world, const std::string& file) const {
    const std::string title =
        fmt::format("{}, after {} s", scene_.title, ticks_.front().reading.time_s);
    std::vector<TextFile> files = format_coordinates(world, select_atoms(world, {}), file, title);
    for (TextFile& each : files)
        each.existing = check_output(each.path, coordinates_mark(each.path), ends_.overwrites);
    write_text_files(files);
}

}  // namespace palpa
