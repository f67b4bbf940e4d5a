#include "simulation/remote_engine.h"

#include "core/interrupt.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/units.h"
#include "core/wall_clock.h"
#include "formats/gro.h"
#include "formats/index_file.h"
#include "formats/psf.h"
#include "molecule/element.h"
#include "scene/find_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "simulation/sources.h"
#include "simulation/systems/gather_springs.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace palpa {
namespace {

// ---- atoms -------------------------------------------------------------------------------------

struct ElementData {
    const char* symbol;
    double mass;    // amu
    bool can_bond;  // covalently
};

constexpr ElementData elements[] = {
    {"H", 1.008, true},    {"C", 12.011, true},   {"N", 14.007, true},   {"O", 15.999, true},
    {"F", 18.998, true},   {"NA", 22.990, false}, {"MG", 24.305, false}, {"P", 30.974, true},
    {"S", 32.06, true},    {"CL", 35.45, true},   {"K", 39.098, false},  {"CA", 40.078, false},
    {"MN", 54.938, false}, {"FE", 55.845, false}, {"CU", 63.546, false}, {"ZN", 65.38, false},
    {"SE", 78.971, true},  {"BR", 79.904, true},  {"I", 126.904, true}};

const ElementData& element_of(std::string_view symbol) {
    const auto* const found = std::ranges::find(
        elements, symbol, [](const ElementData& e) { return std::string_view(e.symbol); });
    // No mass where it is not known, as of virtual sites.
    static constexpr ElementData unknown{"", 0, false};
    return found == std::end(elements) ? unknown : *found;
}

std::string element_of_mass(double mass) {
    if (mass < 4.5) return mass > 0 ? "H" : "";
    const auto nearest = std::ranges::min_element(
        elements, {}, [&](const ElementData& element) { return std::abs(element.mass - mass); });
    return nearest->symbol;
}

void add_atom(const AtomName& name, const Vec3& place, std::string element, double mass,
              double charge, const std::string& type, AtomTable& table) {
    table.names.push_back(name);
    table.positions.push_back(place);
    table.element.push_back(std::move(element));
    table.mass.push_back(mass);
    table.charge.push_back(charge);
    table.sqrt_epsilon.push_back(0);
    table.half_rmin.push_back(0);
    table.b_factor.push_back(0);
    const auto found = std::ranges::find(table.type_names, type);
    table.type.push_back(static_cast<std::uint32_t>(found - table.type_names.begin()));
    if (found == table.type_names.end()) table.type_names.push_back(type);
}

// Pairs nearer than their covalent radii and 0.4 Å, in cells of the largest such distance.
void add_bonds_by_distance(AtomRange range, AtomTable& table) {
    constexpr double slack = 0.4, cell = 3.2;  // Å
    using Cell = std::tuple<int, int, int>;
    const auto cell_of = [&](std::uint32_t i, int dx, int dy, int dz) {
        const Vec3 place = table.positions[i] / cell;
        return Cell{static_cast<int>(std::floor(place.x())) + dx,
                    static_cast<int>(std::floor(place.y())) + dy,
                    static_cast<int>(std::floor(place.z())) + dz};
    };
    std::map<Cell, std::vector<std::uint32_t>> cells;
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
        for (int neighbour = 0; neighbour < 27; ++neighbour) {
            const auto found =
                cells.find(cell_of(i, neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1));
            if (found == cells.end()) continue;
            for (const std::uint32_t j : found->second) {
                const ElementData &a = element_of(table.element[i]),
                                  &b = element_of(table.element[j]);
                if (!a.can_bond || !b.can_bond || (a.mass < 2 && b.mass < 2)) continue;
                const double reach = covalent_radius(a.symbol) + covalent_radius(b.symbol) + slack;
                if ((table.positions[i] - table.positions[j]).squaredNorm() < reach * reach)
                    table.bonds.push_back({j, i});
            }
        }
        cells[cell_of(i, 0, 0, 0)].push_back(i);
    }
}

using AtomKey = std::tuple<std::string, std::string, std::string, std::string>;

AtomKey key_of(const AtomName& name, bool has_segments) {
    return {has_segments ? name.segment : "", name.residue, name.number, name.atom};
}

// The engine's atoms as a file has them; masses where it has them.
struct EngineFile {
    std::vector<AtomName> names;
    std::vector<double> masses;
    bool has_segments = false;
};

EngineFile read_engine_file(const std::filesystem::path& path) {
    if (is_topology(path)) {
        Connectivity connectivity = read_psf(path);
        return {std::move(connectivity.names), std::move(connectivity.mass), true};
    }
    return {read_gro(path).names, {}, false};
}

EngineAtoms match_names(const SceneDescription& scene, const AtomTable& table) {
    const std::filesystem::path& path = scene.engine->atoms;
    const EngineFile file = read_engine_file(path);
    std::map<AtomKey, std::vector<std::int32_t>> places;
    for (std::size_t i = 0; i < file.names.size(); ++i)
        places[key_of(file.names[i], file.has_segments)].push_back(static_cast<std::int32_t>(i));
    EngineAtoms atoms{std::vector<std::int32_t>(file.names.size(), -1), {}};
    const bool has_masses =
        !file.masses.empty() &&
        std::ranges::none_of(scene.molecules, [](const MoleculeDescription& molecule) {
            return molecule.topology.empty() && !is_topology(molecule.structure);
        });
    for (std::size_t i = 0; i < table.size(); ++i) {
        const AtomName& name = table.names[i];
        const auto found = places.find(key_of(name, file.has_segments));
        if (found == places.end() || found->second.size() != 1) {
            throw LoadError(
                scene.place_of("engine.atoms"),
                fmt::format("{} has {} atoms named {} {} {}; expected exactly one, to match {} of "
                            "the scene",
                            path.string(), found == places.end() ? 0 : found->second.size(),
                            name.residue, name.number, name.atom, to_string(name)));
        }
        const std::int32_t at = found->second.front();
        constexpr double most_off = 0.1;  // amu
        const auto place = static_cast<std::size_t>(at);
        if (has_masses && std::abs(file.masses[place] - table.mass[i]) > most_off) {
            throw LoadError(
                scene.place_of("engine.atoms"),
                fmt::format("{} has {} with {} amu, but the scene has it with {} amu; expected the "
                            "same atom",
                            path.string(), to_string(name), file.masses[place], table.mass[i]));
        }
        atoms.in_table[place] = static_cast<std::int32_t>(i);
        atoms.in_engine.push_back(at);
    }
    return atoms;
}

EngineAtoms match_index(const SceneDescription& scene, const AtomTable& table) {
    const std::filesystem::path& path = scene.engine->atoms;
    const IndexGroup group = read_index_file(path).front();
    EngineAtoms atoms{std::vector<std::int32_t>(group.atoms.size(), -1),
                      std::vector<std::int32_t>(table.size(), -1)};
    for (std::size_t i = 0; i < group.atoms.size(); ++i) {
        const std::uint32_t atom = group.atoms[i];
        if (atom >= table.size() || atoms.in_engine[atom] >= 0) {
            throw LoadError(
                {path.string(), group.line},
                fmt::format(
                    "group '{}' has atom {} {}; expected each of the scene's {} atoms at most once",
                    group.name, atom + 1,
                    atom >= table.size() ? "that the scene does not have" : "twice", table.size()));
        }
        atoms.in_table[i] = static_cast<std::int32_t>(atom);
        atoms.in_engine[atom] = static_cast<std::int32_t>(i);
    }
    if (group.atoms.empty())
        throw LoadError({path.string(), group.line}, "has no atoms; expected at least one");
    return atoms;
}

// ---- holds -------------------------------------------------------------------------------------

EngineHold build_hold(const AtomTable& table, std::vector<std::uint32_t> atoms) {
    EngineHold hold;
    hold.atoms = std::move(atoms);
    double mass = 0;
    for (const std::uint32_t atom : hold.atoms) mass += table.mass[atom];
    for (const std::uint32_t atom : hold.atoms) {
        hold.shares.push_back(mass > 0 ? table.mass[atom] / mass
                                       : 1.0 / static_cast<double>(hold.atoms.size()));
    }
    hold.middle = hold.smoothed = find_middle(table, hold);
    return hold;
}

ImdClientOptions client_options(const SceneDescription& scene, std::size_t atoms) {
    const EngineDescription& engine = *scene.engine;
    ImdClientOptions options;
    const std::size_t colon = engine.address.rfind(':');
    options.address = engine.address.substr(0, colon);
    options.port = static_cast<std::uint16_t>(
        find_integer(std::string_view(engine.address).substr(colon + 1)).value_or(imd_port));
    options.limits.atoms = atoms;
    if (engine.program == EngineProgram::Gromacs && engine.protocol != EngineProtocol::Three)
        options.units = imd_units_of_gromacs;
    if (engine.program == EngineProgram::Lammps) options.units = imd_units_of_namd;
    options.rate = static_cast<int>(engine.rate);
    if (engine.protocol != EngineProtocol::Any)
        options.version = engine.protocol == EngineProtocol::Two ? 2 : 3;
    // Who asks for version 3 means it.
    options.pulls_in_version_3 = engine.protocol == EngineProtocol::Three;
    options.late_after_s = engine.late_s;
    // One that gave up stays in the backlog of an engine that has a client, and LAMMPS ends over
    // it.
    options.answer_within_s = std::max(options.answer_within_s, engine.wait_s);
    constexpr double again_s = 0.5;
    options.retry_after_s = again_s;
    return options;
}

// Another attempt would find the same.
bool is_another_engine(const ImdClient& client) {
    return client.lack() == ImdLack::Version || client.lack() == ImdLack::Atoms;
}

// Of all molecules, where it is one.
std::string find_list_of_atoms(const SceneDescription& scene) {
    const auto file_of = [](const MoleculeDescription& molecule) {
        return molecule.topology.empty() ? molecule.structure : molecule.topology;
    };
    std::filesystem::path file = scene.engine->atoms;
    if (file.empty()) file = file_of(scene.molecules.front());
    const bool is_one = !scene.engine->atoms.empty() ||
                        std::ranges::all_of(scene.molecules, [&](const auto& molecule) {
                            return file_of(molecule) == file;
                        });
    return is_one ? file.string() : "the scene";
}

// How long a step waits for a frame. Once frames have ceased it looks for them only briefly.
double patience_s(const RemoteEngine& engine) {
    if (!engine.is_awaited) return 0;
    if (engine.frames == 0) return engine.settings.wait_s;
    constexpr double lost_s = 0.1;
    const bool comes = engine.client->state() == ImdState::Connected;
    return comes ? engine.settings.late_s : std::min(lost_s, engine.settings.late_s);
}

void note_frame(RemoteEngine& engine, double time_s) {
    constexpr double newest = 0.1;
    if (engine.frames > 0 && !engine.lost_at_s) {
        const double interval = (time_s - engine.frame_time_s) /
                                static_cast<double>(engine.client->frames() - engine.frames);
        engine.frame_interval_s +=
            (engine.frame_interval_s > 0 ? newest : 1) * (interval - engine.frame_interval_s);
    }
    engine.frame_time_s = time_s;
    engine.lost_at_s.reset();
}

// The advice for an engine that does not send.
std::string advise(const RemoteEngine& engine) {
    const std::string usual = "expected an engine that listens there and sends frames";
    switch (engine.client->lack()) {
        case ImdLack::Answer:
            // It was there before.
            if (engine.frames > 0) return usual;
            return usual + ": start it first, or wait longer (engine.wait_s)";
        case ImdLack::Handshake:
            return "another client may be connected; expected a free engine (LAMMPS accepts one "
                   "client at a time, and ends when a client gives up)";
        case ImdLack::Frame:
            return "expected frames: wait longer (engine.wait_s)";
        case ImdLack::Version:
            return "leave engine.protocol out to take any";
        case ImdLack::Atoms:
            return fmt::format(
                "{} lists {} atoms, the engine sends {}: give the structure of what it sends",
                engine.listed_in, engine.atoms->in_table.size(), engine.client->other_atoms());
        default:
            return usual;
    }
}

// The delay from the atoms' motion to the force on the hand, s: step, frame and low-pass filter.
double find_engine_delay(const World& world, const RemoteEngine& engine) noexcept {
    return world.resource<Clock>().period_s + engine.frame_interval_s +
           1e-3 * engine.settings.smoothing_ms;
}

double find_frame_rate(const RemoteEngine& engine) noexcept {
    return engine.frame_interval_s > 0 ? 1 / engine.frame_interval_s : 0;
}

}  // namespace

EngineSpring find_engine_spring(double k, const Vec3& stretch, double most) noexcept {
    const double distance = stretch.norm();
    if (k * distance <= most) return {k * stretch, k * Mat3::Identity()};
    const Vec3 along = stretch / distance;
    return {most * along, most / distance * (Mat3::Identity() - along * along.transpose())};
}

EngineSpring find_engine_spring(const World& world, Entity hand) noexcept {
    const EngineHold& hold = *world.find<EngineHold>(hand);
    if (!hold.is_live) return {};
    const double most = 1e-9 * find_solver<RemoteEngine>(world)->settings.most_force_nN /
                        units::newton_per_kcal_per_mol_angstrom;
    return find_engine_spring(world.find<Spring>(hand)->k, hold.smoothed - held_place(world, hand),
                              most);
}

Vec3 find_middle(const AtomTable& table, const EngineHold& hold) noexcept {
    Vec3 middle = Vec3::Zero();
    for (std::size_t i = 0; i < hold.atoms.size(); ++i)
        middle += hold.shares[i] * table.positions[hold.atoms[i]];
    return middle;
}

AtomRange add_engine_atoms(const Source& source, AtomTable& table) {
    const std::string unknown_type = "X";
    const Structure& structure = *source.structure;
    const Connectivity* const connectivity = source.connectivity.get();
    const std::string& segment = source.segment;
    AtomRange range{static_cast<std::uint32_t>(table.size()), 0};
    std::vector<std::int64_t> at(connectivity ? connectivity->names.size() : 0, -1);
    std::map<std::string, std::size_t> places;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        if (structure.names[i].segment != segment) continue;
        if (connectivity) {
            places.emplace(to_string(structure.names[i]), i);
            continue;
        }
        const AtomName& name = structure.names[i];
        const std::string element = find_element_of_name(name.atom, name.residue);
        add_atom(name, structure.positions[i], element, element_of(element).mass, 0, unknown_type,
                 table);
    }
    for (std::size_t i = 0; i < at.size(); ++i) {
        const AtomName& name = connectivity->names[i];
        if (name.segment != segment) continue;
        const auto found = places.find(to_string(name));
        if (found == places.end()) {
            throw LoadError(
                {connectivity->file, connectivity->lines[i]},
                fmt::format("atom {} has no coordinates in {}", to_string(name), structure.file));
        }
        at[i] = static_cast<std::int64_t>(table.size());
        // The name first: hydrogens may have been given mass of their neighbours.
        std::string element = find_element_of_name(name.atom, name.residue);
        if (element.empty()) element = element_of_mass(connectivity->mass[i]);
        add_atom(name, structure.positions[found->second], std::move(element),
                 connectivity->mass[i], connectivity->charge[i], connectivity->type[i], table);
    }
    range.count = static_cast<std::uint32_t>(table.size()) - range.first;
    if (range.count == 0) {
        throw LoadError({structure.file}, fmt::format("no segment '{}'", segment));
    }
    if (!connectivity) {
        add_bonds_by_distance(range, table);
        return range;
    }
    for (const auto& [a, b] : connectivity->bonds) {
        if (at[a] < 0 || at[b] < 0) continue;
        table.bonds.push_back(
            {static_cast<std::uint32_t>(at[a]), static_cast<std::uint32_t>(at[b])});
    }
    return range;
}

EngineAtoms find_engine_atoms(const SceneDescription& scene, const AtomTable& table) {
    const std::filesystem::path& path = scene.engine->atoms;
    const std::string ending = upper_case(path.extension().string());
    if (ending == ".NDX") return match_index(scene, table);
    if (!path.empty() && ending != ".PSF" && ending != ".GRO") {
        throw LoadError(
            scene.place_of("engine.atoms"),
            fmt::format(
                "'{}' is not a list of the engine's atoms; expected a .psf, .gro or .ndx file",
                path.string()));
    }
    if (!path.empty()) return match_names(scene, table);
    EngineAtoms atoms;
    for (std::size_t i = 0; i < table.size(); ++i)
        atoms.in_table.push_back(static_cast<std::int32_t>(i));
    atoms.in_engine = atoms.in_table;
    return atoms;
}

void set_remote_engine(const SceneDescription& scene, World& world) {
    RemoteEngine engine;
    engine.settings = *scene.engine;
    engine.atoms =
        std::make_shared<const EngineAtoms>(find_engine_atoms(scene, world.resource<AtomTable>()));
    engine.listed_in = find_list_of_atoms(scene);
    engine.client =
        std::make_shared<ImdClient>(client_options(scene, engine.atoms->in_table.size()));
    world.set_resource(Solver{std::move(engine)});
}

void hold_engine_atoms(World& world) {
    const AtomTable& table = world.resource<AtomTable>();
    std::vector<Entity> free;
    world.each<Hand>([&](Entity hand, const Hand&) {
        if (!world.find<Grip>(hand)) free.push_back(hand);
    });
    for (const Entity hand : free) {
        if (world.find<EngineHold>(hand)) world.remove<EngineHold>(hand);
    }
    std::vector<std::pair<Entity, EngineHold>> holds;
    world.write_each<Grip>([&](Entity hand, Grip& grip) {
        std::vector<std::uint32_t> atoms = numbers_of(world, held_part_of(world, hand));
        const EngineHold* const before = world.find<EngineHold>(hand);
        const bool is_same = before && before->atoms == atoms;
        holds.emplace_back(hand, is_same ? *before : build_hold(table, std::move(atoms)));
        const EngineHold& hold = holds.back().second;
        world.write<Spring>(hand)->place =
            is_same ? Vec3(grip.anchor + grip.pose.place_angstrom) : hold.smoothed;
        grip.base = -1;
    });
    for (auto& [hand, hold] : holds) world.set(hand, std::move(hold));
    world.set_resource(TorsionState{});
    gather_springs(world, {});
}

void carry_engine(const World& from, World& to) {
    const RemoteEngine* const engine = find_solver<RemoteEngine>(from);
    if (!engine) return;
    to.set_resource(Solver{*engine});
    to.write<AtomTable>().positions = from.resource<AtomTable>().positions;
    to.write_each<EngineHold>([](Entity, EngineHold& hold) { hold.is_live = false; });
}

bool take_newest_frame(World& world, RemoteEngine& engine) {
    ImdClient& client = *engine.client;
    const double begin = wall_clock_s();
    if (client.state() == ImdState::Closed) client.connect(begin);
    constexpr int slice_ms = 10;
    const std::uint64_t before = client.frames();
    const bool was_lost = engine.lost_at_s.has_value(), had_frames = engine.frames > 0;
    double time_s = begin;
    bool is_interrupted = false;
    do {
        client.poll(time_s, engine.is_awaited ? slice_ms : 0);
        time_s = wall_clock_s();
        is_interrupted = is_interrupted || client.state() != ImdState::Connected;
    } while (client.frames() == before && time_s - begin < patience_s(engine) &&
             noted_interrupt() == 0 && !(engine.is_awaited && is_another_engine(client)));
    const bool is_new = client.frames() != engine.frames && client.frame();
    if (is_new) {
        note_frame(engine, time_s);
        engine.frames = client.frames();
        std::vector<Vec3>& positions = world.write<AtomTable>().positions;
        const std::vector<Vec3>& sent = client.frame()->coordinates;
        for (std::size_t i = 0; i < sent.size(); ++i) {
            if (engine.atoms->in_table[i] >= 0)
                positions[static_cast<std::size_t>(engine.atoms->in_table[i])] = sent[i];
        }
    }
    // Also one that has ended meanwhile.
    if (is_interrupted && !was_lost && had_frames) ++engine.interruptions;
    if (client.state() != ImdState::Connected && !engine.lost_at_s) engine.lost_at_s = time_s;
    return is_new;
}

bool lacks_coordinates(const SceneDescription& scene) {
    return scene.engine &&
           std::ranges::any_of(scene.molecules, [](const MoleculeDescription& molecule) {
               return is_topology(molecule.structure);
           });
}

void await_engine(World& world, RemoteEngine& engine) {
    const bool before = std::exchange(engine.is_awaited, true);
    const bool came = take_newest_frame(world, engine);
    engine.is_awaited = before;
    if (came) return;
    throw EngineLost({"engine " + engine.settings.address},
                     engine.client->why() + "; " + advise(engine));
}

void leave_engine(World& world) {
    RemoteEngine* const engine = write_solver<RemoteEngine>(world);
    if (!engine || engine->client->state() == ImdState::Closed) return;
    constexpr double most_s = 1;
    constexpr int slice_ms = 10;
    const double begin = wall_clock_s();
    engine->client->disconnect(begin);
    for (double time_s = begin;
         engine->client->state() != ImdState::Closed && time_s - begin < most_s;
         time_s = wall_clock_s())
        engine->client->poll(time_s, slice_ms);
}

void pause_engine(World& world, bool is_paused) {
    RemoteEngine* const engine = write_solver<RemoteEngine>(world);
    if (!engine) return;
    is_paused ? engine->client->pause() : engine->client->resume();
    engine->client->poll(wall_clock_s(), 0);
}

void make_steps_wait(World& world) {
    if (RemoteEngine* const engine = write_solver<RemoteEngine>(world)) engine->is_awaited = true;
}

double find_engine_energy(const World& world) noexcept {
    const RemoteEngine* const engine = find_solver<RemoteEngine>(world);
    const ImdFrame* const frame = engine ? engine->client->frame() : nullptr;
    return frame && frame->energies ? frame->energies->potential : 0;
}

std::optional<EngineReport> report_engine(const World& world) {
    const RemoteEngine* const engine = find_solver<RemoteEngine>(world);
    if (!engine) return {};
    return EngineReport{engine->frames,           engine->interruptions,
                        find_frame_rate(*engine), find_engine_delay(world, *engine),
                        describe_engine(world),   advise(*engine)};
}

bool is_engine_gone(const World& world) noexcept {
    constexpr double give_up_s = 5;
    const RemoteEngine* const engine = find_solver<RemoteEngine>(world);
    if (!engine || !engine->is_awaited || !engine->lost_at_s) return false;
    const double most = engine->frames == 0 ? 0 : give_up_s;
    return wall_clock_s() - *engine->lost_at_s > most;
}

std::string describe_engine(const World& world) {
    const RemoteEngine* const engine = find_solver<RemoteEngine>(world);
    if (!engine) return {};
    const ImdClient& client = *engine->client;
    if (client.state() != ImdState::Connected) return client.why();
    if (!engine->refusal.empty()) return fmt::format("no force: {}", engine->refusal);
    return fmt::format("engine at {}: {:.0f} frames/s, force delayed by {:.0f} ms",
                       engine->settings.address, find_frame_rate(*engine),
                       1e3 * find_engine_delay(world, *engine));
}

}  // namespace palpa
