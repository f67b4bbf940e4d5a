#include "simulation/systems/pull_by_clients.h"

#include "simulation/client_pull.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "simulation/systems/gather_springs.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr double client_spring = 100;  // Å, from an atom to the end that pulls at it

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
    world.each<Grip>([&](Entity hand, const Grip& grip) {
        is_in_hand |= holds_whole(world, hand) && grip.base == static_cast<std::int32_t>(molecule);
    });
    if (is_in_hand) return {};
    return atom;
}

// An address of an atom as springs have it.
AtomsOf find_table_address(const World& world, std::uint32_t in_table) {
    AtomsOf address;
    world.each<Molecule>([&](Entity entity, const Molecule& molecule) {
        if (has_atom(molecule.atoms, in_table))
            address = {entity, {in_table - molecule.atoms.first}};
    });
    return address;
}

// The end stays ahead of the atom, so that the force hardly depends on its way.
Spring build_client_spring(AtomsOf atom, const Vec3& place, const Vec3& force, Entity owner) {
    Spring spring;
    spring.ends.push_back(std::move(atom));
    spring.k = force.norm() / client_spring;
    spring.place = place + force.normalized() * client_spring;
    spring.owner = owner;
    return spring;
}

}  // namespace

void pull_by_clients(World& world, const StepInput& /*input*/) {
    if (!world.find_resource<ClientPull>() && find_owner<Clients>(world) == Entity{}) return;
    const Entity clients = make_owner<Clients>(world);
    const std::vector<Entity> before = find_springs(world, clients);
    std::size_t next = 0;
    const ClientPull* const pull = find_client_pull(world);
    if (pull && has_mobile(world)) {
        const double slack = client_force_tolerance(world);
        for (std::size_t i = 0; i < pull->atoms.size(); ++i) {
            const Vec3& force = pull->forces[i];
            const std::optional<std::uint32_t> atom = find_pulled_atom(world, pull->atoms[i]);
            if (!atom || force.isZero(0)) continue;
            const Vec3& place = world.resource<TorsionState>().positions[*atom];
            const AtomsOf address = find_table_address(world, pull->atoms[i]);
            const Entity entity = next < before.size() ? before[next] : world.create();
            const Spring* const old = world.find<Spring>(entity);
            ++next;
            if (old && old->ends.front() == address &&
                (old->k * (old->place - place) - force).norm() < slack * force.norm())
                continue;
            world.set(entity, build_client_spring(address, place, force, clients));
        }
    }
    for (; next < before.size(); ++next) world.destroy(before[next]);
}

bool is_pulled_by_clients(const World& world) noexcept {
    const Entity clients = find_owner<Clients>(world);
    return clients != Entity{} &&
           std::ranges::any_of(find_springs(world, clients), [&](Entity spring) {
               return find_spring_index(world, spring).has_value();
           });
}

double find_client_energy(const World& world) noexcept {
    const Entity clients = find_owner<Clients>(world);
    return clients == Entity{} ? 0 : find_spring_energy(world, clients);
}

std::size_t count_pulls_without_effect(const World& world) noexcept {
    const ClientPull* const pull = world.find_resource<ClientPull>();
    if (!pull) return 0;
    if (!find_client_pull(world) || !has_mobile(world)) return pull->atoms.size();
    return static_cast<std::size_t>(std::ranges::count_if(
        pull->atoms, [&](std::uint32_t atom) { return !find_pulled_atom(world, atom); }));
}

}  // namespace palpa
