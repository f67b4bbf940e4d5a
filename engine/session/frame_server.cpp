#include "session/frame_server.h"

#include "core/load_error.h"
#include "core/wall_clock.h"
#include "molecule/atoms.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "simulation/systems/pull_by_clients.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace palpa {
namespace {

constexpr double picoseconds_per_s = 1e12;

int find_rate(const ServeOptions& options, const World& world) {
    constexpr double frames_per_s = 30;
    if (options.rate > 0) return options.rate;
    return std::max(
        1, static_cast<int>(std::lround(1 / (frames_per_s * world.resource<Clock>().period_s))));
}

ImdServerOptions build_server_options(const ServeOptions& options, const World& world) {
    return {.address = options.address,
            .port = options.port,
            .version = options.version,
            .session = {.time = true, .energies = true, .coordinates = true},
            .atoms = world.resource<AtomTable>().size(),
            .rate = find_rate(options, world),
            .may_pause = options.may_pause};
}

double find_potential(const World& world) {
    return has_mobile(world)
               ? find_energy(world)
               : contact_of(world, hand_at(world, 0)).sent.model.potential_kcal_per_mol;
}

ImdFrame build_imd_frame(const World& world) {
    const Clock& clock = world.resource<Clock>();
    const double step_ps = clock.period_s * picoseconds_per_s;
    constexpr std::uint64_t largest = std::numeric_limits<std::int32_t>::max();
    const auto potential = static_cast<float>(find_potential(world));
    ImdFrame frame;
    frame.time = ImdTime{.step_ps = step_ps,
                         .now_ps = static_cast<double>(clock.steps) * step_ps,
                         .step = static_cast<std::int64_t>(clock.steps)};
    frame.energies = ImdEnergies{.step = static_cast<std::int32_t>(std::min(clock.steps, largest)),
                                 .total = potential,
                                 .potential = potential};
    frame.coordinates = world.resource<AtomTable>().positions;
    return frame;
}

}  // namespace

FrameServer::FrameServer(const ServeOptions& options, const World& world)
    : options_(options),
      atoms_(world.resource<AtomTable>().size()),
      server_(build_server_options(options, world)) {
    if (server_.problem().empty()) return;
    throw LoadError({"--serve"}, fmt::format("{}; expected a port that is free, and an address of "
                                             "this machine",
                                             server_.problem()));
}

std::string FrameServer::place() const {
    const bool is_of_6 = options_.address.find(':') != std::string::npos;
    return fmt::format("{}{}{}:{}", is_of_6 ? "[" : "", options_.address, is_of_6 ? "]" : "",
                       server_.port());
}

void FrameServer::poll(int at_most_ms) { server_.poll(wall_clock_s(), at_most_ms); }

void FrameServer::send(const World& world) {
    atoms_ = world.resource<AtomTable>().size();
    server_.change_atoms(atoms_);
    note_without_effect(world);
    if (server_.count_step()) server_.send(build_imd_frame(world));
}

std::optional<ClientPull> FrameServer::take_pull() {
    const ImdPull& asked = server_.pull();
    const std::size_t count = std::min(asked.atoms.size(), most_client_pulls);
    if (count < asked.atoms.size()) {
        note_once(noted_many_,
                  fmt::format("forces on {} atoms were received, only the first {} are used",
                              asked.atoms.size(), count));
    }
    ClientPull pull{{}, {}, atoms_};
    for (std::size_t i = 0; i < count; ++i) {
        const double norm = asked.forces[i].norm();
        const double share = norm > strongest_client_pull ? strongest_client_pull / norm : 1;
        if (share < 1) {
            note_once(noted_strong_,
                      fmt::format("a force of {:.3g} kcal/mol/Å was received and reduced to {:.4g} "
                                  "kcal/mol/Å: the limit for one atom is 10 nN",
                                  norm, strongest_client_pull));
        }
        pull.atoms.push_back(static_cast<std::uint32_t>(asked.atoms[i]));
        pull.forces.emplace_back(share * asked.forces[i]);
    }
    if (pull.atoms == pull_.atoms && pull.forces == pull_.forces) return {};
    if (pull.atoms.empty()) noted_strong_ = noted_many_ = noted_without_effect_ = false;
    pull_ = pull;
    return pull;
}

// What acted in the last step.
void FrameServer::note_without_effect(const World& world) {
    const ClientPull* const pull = world.find_resource<ClientPull>();
    if (noted_without_effect_ || !pull || pull_.atoms.empty() || !(*pull == pull_)) return;
    const std::size_t without_effect = count_pulls_without_effect(world);
    if (without_effect == 0) return;
    note_once(noted_without_effect_,
              fmt::format("forces on {} of {} atoms have no effect: these atoms are fixed, or a "
                          "hand holds their whole molecule",
                          without_effect, pull->atoms.size()));
}

void FrameServer::note_once(bool& was_noted, std::string text) {
    if (!std::exchange(was_noted, true)) notes_.push_back(std::move(text));
}

std::vector<std::string> FrameServer::take_notes() {
    std::vector<std::string> notes = server_.take_notes();
    for (std::string& note : std::exchange(notes_, {})) notes.push_back(std::move(note));
    return notes;
}

}  // namespace palpa
