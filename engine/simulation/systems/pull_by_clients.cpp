#include "simulation/systems/pull_by_clients.h"

#include "simulation/client_pull.h"
#include "simulation/held.h"
#include "simulation/resources.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr double client_spring = 100;  // Å, from an atom to the end that pulls at it

// Springs of hands and restraints, which stand before those of clients.
std::size_t count_own_springs(const World& world) noexcept {
    std::size_t own = 0;
    world.each<Grip>([&](Entity, const Grip& grip) { own += grip.spring >= 0 ? 1 : 0; });
    world.each<Restraint>([&](Entity, const Restraint&) { ++own; });
    return std::min(own, world.resource<TorsionState>().springs.size());
}

const ClientPull* find_client_pull(const World& world) noexcept {
    const ClientPull* const pull = world.find_resource<ClientPull>();
    return pull && pull->of == world.resource<AtomTable>().size() ? pull : nullptr;
}

// The model's number of an atom that may be pulled.
std::optional<std::uint32_t> find_pulled_atom(const World& world, std::uint32_t in_table) noexcept {
    const std::optional<std::uint32_t> atom = model_atoms_of(world).in_model(in_table);
    const TorsionModel& model = model_of(world);
    if (!atom || !std::ranges::binary_search(model.mobile_atoms, *atom)) return {};
    const auto molecule = model.tree.molecule_of[model.tree.bodies.body_of[*atom]];
    bool is_in_hand = false;
    world.each<Grip>([&](Entity, const Grip& grip) {
        is_in_hand |= grip.spring < 0 && grip.base == static_cast<std::int32_t>(molecule);
    });
    if (is_in_hand) return {};
    return atom;
}

// The end stays ahead of the atom, so that the force hardly depends on its way.
Spring build_client_spring(std::uint32_t atom, const Vec3& place, const Vec3& force) {
    Spring spring;
    spring.atoms = {atom};
    spring.k = force.norm() / client_spring;
    spring.place = place + force.normalized() * client_spring;
    return spring;
}

}  // namespace

void pull_by_clients(World& world, const StepInput& /*input*/) {
    if (!world.find_resource<ClientPull>() || !has_mobile(world)) return;
    TorsionState& state = world.resource<TorsionState>();
    const auto first =
        state.springs.begin() + static_cast<std::ptrdiff_t>(count_own_springs(world));
    const std::vector<Spring> before(std::make_move_iterator(first),
                                     std::make_move_iterator(state.springs.end()));
    state.springs.erase(first, state.springs.end());
    const ClientPull* const pull = find_client_pull(world);
    if (!pull) return;
    const double slack = world.find_resource<SecondOrder>() ? 0.02 : 0;
    std::size_t next = 0;
    for (std::size_t i = 0; i < pull->atoms.size(); ++i) {
        const Vec3& force = pull->forces[i];
        const std::optional<std::uint32_t> atom = find_pulled_atom(world, pull->atoms[i]);
        if (!atom || force.isZero(0)) continue;
        const Vec3& place = state.positions[*atom];
        Spring spring = build_client_spring(*atom, place, force);
        if (next < before.size() && before[next].atoms == spring.atoms &&
            (before[next].k * (before[next].place - place) - force).norm() < slack * force.norm())
            spring = before[next];
        state.springs.push_back(std::move(spring));
        ++next;
    }
}

bool is_pulled_by_clients(const World& world) noexcept {
    return has_mobile(world) && world.find_resource<ClientPull>() &&
           world.resource<TorsionState>().springs.size() > count_own_springs(world);
}

double find_client_energy(const World& world) noexcept {
    if (!is_pulled_by_clients(world)) return 0;
    const TorsionState& state = world.resource<TorsionState>();
    double energy = 0;
    for (std::size_t i = count_own_springs(world); i < state.springs.size(); ++i)
        energy += find_spring_pull(model_of(world), state.springs[i], state.positions).energy;
    return energy;
}

std::size_t count_pulls_without_effect(const World& world) noexcept {
    const ClientPull* const pull = world.find_resource<ClientPull>();
    if (!pull) return 0;
    if (!find_client_pull(world) || !has_mobile(world)) return pull->atoms.size();
    return static_cast<std::size_t>(std::ranges::count_if(
        pull->atoms, [&](std::uint32_t atom) { return !find_pulled_atom(world, atom); }));
}

}  // namespace palpa
