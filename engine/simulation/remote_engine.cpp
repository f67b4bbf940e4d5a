#include "simulation/remote_engine.h"

#include "core/interrupt.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/units.h"
#include "core/wall_clock.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "simulation/systems/gather_springs.h"

#include <fmt/format.h>
#include <algorithm>
#include <utility>

namespace palpa {
namespace {

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

ImdClientOptions client_options(const EngineDescription& engine, std::size_t atoms) {
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
                engine.atoms->listed_in, engine.atoms->in_table.size(),
                engine.client->other_atoms());
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

void set_remote_engine(const EngineDescription& settings, EngineAtoms atoms, World& world) {
    RemoteEngine engine;
    engine.settings = settings;
    engine.client = std::make_shared<ImdClient>(client_options(settings, atoms.in_table.size()));
    engine.atoms = std::make_shared<const EngineAtoms>(std::move(atoms));
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
