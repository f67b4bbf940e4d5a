#include "simulation/grip_queries.h"

#include "core/assertion.h"
#include "core/text.h"
#include "field/frozen_field.h"
#include "simulation/solver.h"
#include "simulation/systems/gather_springs.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace palpa {
bool is_mobile(const World& world, Entity hand) noexcept {
    return grip_of(world, hand).base >= 0 || find_spring_index(world, hand);
}

bool holds_whole(const World& world, Entity hand) noexcept { return !world.find<Spring>(hand); }

void hold_by_spring(World& world, Entity hand, AtomsOf atoms, double k) {
    world.set(hand, Spring{.ends = {std::move(atoms)}, .k = k, .owner = hand});
}

AtomsOf held_part_of(const World& world, Entity hand) {
    if (const Spring* const spring = world.find<Spring>(hand)) return spring->ends.front();
    const Entity molecule = grip_of(world, hand).molecule;
    return {molecule, all_atoms_of(world, molecule)};
}

HeldInState held_in_state(const World& world, Entity hand) noexcept {
    const std::optional<std::size_t> index = find_spring_index(world, hand);
    return {static_cast<std::uint32_t>(grip_of(world, hand).base),
            index ? static_cast<std::int32_t>(*index) : -1};
}

std::vector<Entity> find_hands(const World& world) {
    std::vector<Entity> hands;
    world.each<Hand>([&](Entity hand, const Hand&) { hands.push_back(hand); });
    return hands;
}

Entity hand_at(const World& world, std::size_t number) {
    Entity found;
    std::size_t i = 0;
    world.each<Hand>([&](Entity hand, const Hand&) {
        if (i++ == number) found = hand;
    });
    return found;
}

const Grip& grip_of(const World& world, Entity hand) noexcept {
    const Grip* const grip = world.find<Grip>(hand);
    PALPA_ASSERT(grip);
    return *grip;
}

const Contact& contact_of(const World& world, Entity hand) noexcept {
    const Contact* const contact = world.find<Contact>(hand);
    PALPA_ASSERT(contact);
    return *contact;
}

const LocalContactModel& contact_at(const World& world, std::size_t number) {
    return contact_of(world, hand_at(world, number)).sent;
}

const Coupling& coupling_of(const World& world, Entity hand) noexcept {
    const Coupling* const coupling = world.find<Coupling>(hand);
    PALPA_ASSERT(coupling);
    return *coupling;
}

AtomRange held_range(const World& world, Entity hand) noexcept {
    const Grip* const grip = world.find<Grip>(hand);
    return grip ? world.find<Molecule>(grip->molecule)->atoms : AtomRange{};
}

const ModelSpring* spring_of(const World& world, Entity hand) noexcept {
    const std::optional<std::size_t> index = find_spring_index(world, hand);
    return index ? &world.resource<TorsionState>().springs[*index] : nullptr;
}

std::vector<std::uint32_t> held_atoms(const World& world, Entity hand) {
    if (const ModelSpring* const spring = spring_of(world, hand)) {
        std::vector<std::uint32_t> atoms = spring->atoms;
        for (std::uint32_t& atom : atoms) atom = model_atoms_of(world).number_in_table(atom);
        return atoms;
    }
    const AtomRange range = held_range(world, hand);
    std::vector<std::uint32_t> atoms(range.count);
    std::iota(atoms.begin(), atoms.end(), range.first);
    return atoms;
}

Entity molecule_called(const World& world, std::string_view name) noexcept {
    Entity found;
    world.each<Molecule>([&](Entity entity, const Molecule& molecule) {
        if (molecule.name == name) found = entity;
    });
    return found;
}

std::vector<std::uint32_t> all_atoms_of(const World& world, Entity molecule) {
    std::vector<std::uint32_t> atoms(world.find<Molecule>(molecule)->atoms.count);
    std::iota(atoms.begin(), atoms.end(), 0U);
    return atoms;
}

std::vector<std::uint32_t> numbers_of(const World& world, const AtomsOf& atoms) {
    const std::uint32_t first = world.find<Molecule>(atoms.molecule)->atoms.first;
    std::vector<std::uint32_t> numbers;
    for (const std::uint32_t atom : atoms.atoms) numbers.push_back(first + atom);
    return numbers;
}

Vec3 middle_of(const World& world, const AtomsOf& atoms) {
    const AtomTable& table = world.resource<AtomTable>();
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    for (const std::uint32_t i : numbers_of(world, atoms)) {
        sum += table.mass[i] * table.positions[i];
        mass += table.mass[i];
    }
    return sum / mass;
}

std::vector<std::uint32_t> atoms_called(const World& world, Entity molecule,
                                        std::string_view name) {
    const std::vector<std::string_view> words = split_words(name);
    std::vector<std::uint32_t> found;
    if (words.empty() || words.size() > 2) return found;
    const AtomRange range = world.find<Molecule>(molecule)->atoms;
    if (words[0].starts_with('#')) {
        const auto number = find_integer(words[0].substr(1));
        const bool is_there = words.size() == 1 && number && *number >= 1 && *number <= range.count;
        if (is_there) found.push_back(static_cast<std::uint32_t>(*number - 1));
        return found;
    }
    for (std::uint32_t i = 0; i < range.count; ++i) {
        const AtomName& atom = world.resource<AtomTable>().names[range.first + i];
        if (atom.number == words[0] && (words.size() == 1 || atom.atom == words[1]))
            found.push_back(i);
    }
    return found;
}

namespace {

// The rotation of a molecule since the mechanics were built; none outside of them.
Quat find_turn(const World& world, Entity molecule) {
    const TorsionModel& model = model_of(world);
    const auto atom =
        model_atoms_of(world).in_model(world.find<Molecule>(molecule)->reference_atom);
    if (!atom || *atom >= model.reference.size()) return Quat::Identity();
    const std::uint32_t body = model.tree.bodies.body_of[*atom];
    return world.resource<TorsionState>().turns[model.tree.molecule_of[body]];
}

}  // namespace

Quat orientation_of(const World& world, Entity molecule) {
    const RigidShape* const shape = world.find<RigidShape>(molecule);
    const Quat turn = find_turn(world, molecule);
    return shape ? Quat(turn * shape->orientation) : turn;
}

void set_shape(World& world, Entity entity, const Quat& orientation) {
    const Molecule& molecule = *world.find<Molecule>(entity);
    const std::vector<Vec3>& positions = world.resource<AtomTable>().positions;
    RigidShape shape{{}, find_turn(world, entity).conjugate() * orientation};
    const Mat3 back = orientation.toRotationMatrix().transpose();
    const bool is_turned = orientation.coeffs() != Quat::Identity().coeffs();
    for (std::uint32_t i = 0; i < molecule.atoms.count; ++i) {
        const Vec3 arm = positions[molecule.atoms.first + i] - positions[molecule.reference_atom];
        shape.atoms.push_back(is_turned ? Vec3(back * arm) : arm);
    }
    world.set(entity, std::move(shape));
}

Vec3 held_place(const World& world, Entity hand) noexcept {
    const Grip& grip = grip_of(world, hand);
    if (const ModelSpring* const spring = spring_of(world, hand)) return spring->place;
    if (grip.base >= 0) {
        const std::uint32_t pivot =
            model_of(world).bases[static_cast<std::size_t>(grip.base)].pivot;
        return world.resource<TorsionState>().positions[pivot];
    }
    const Molecule& molecule = *world.find<Molecule>(grip.molecule);
    return world.resource<AtomTable>().positions[molecule.reference_atom];
}

void place_held(World& world, Entity hand, const MoleculePose& pose) noexcept {
    Grip& grip = *world.write<Grip>(hand);
    const Quat turned = (pose.orientation * grip.pose.orientation.conjugate()).normalized();
    grip.pose = pose;
    const Vec3 reference = grip.anchor + pose.place_angstrom;
    if (is_mobile(world, hand)) {
        move_mobile(world, hand, reference - held_place(world, hand), turned);
        copy_positions(world);
        return;
    }
    const RigidShape& shape = *world.find<RigidShape>(grip.molecule);
    const std::uint32_t first = world.find<Molecule>(grip.molecule)->atoms.first;
    std::vector<Vec3>& positions = world.write<AtomTable>().positions;
    const Mat3 turn = pose.orientation.toRotationMatrix();
    for (std::size_t i = 0; i < shape.atoms.size(); ++i)
        positions[first + i] = reference + turn * shape.atoms[i];
}

Vec3 centre_of_mass(const AtomTable& atoms, AtomRange range) noexcept {
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
        sum += atoms.mass[i] * atoms.positions[i];
        mass += atoms.mass[i];
    }
    return mass > 0 ? Vec3(sum / mass) : atoms.positions[range.first];
}

FieldPoints points_of(const AtomTable& atoms, AtomRange range) noexcept {
    const auto part = [&](const auto& column) {
        return std::span(column).subspan(range.first, range.count);
    };
    FieldPoints points{part(atoms.positions), part(atoms.charge), part(atoms.sqrt_epsilon),
                       part(atoms.half_rmin), part(atoms.type)};
    const SolvationColumns& solvation = atoms.solvation;
    if (!solvation.volume.empty()) {
        points.solvation = {part(solvation.volume), part(solvation.strength),
                            part(solvation.inverse_lambda), part(solvation.radius)};
    }
    return points;
}

GatheredPoints::GatheredPoints(const AtomTable& atoms, std::span<const std::uint32_t> numbers) {
    for (const std::uint32_t i : numbers) {
        positions.push_back(atoms.positions[i]);
        charge.push_back(atoms.charge[i]);
        sqrt_epsilon.push_back(atoms.sqrt_epsilon[i]);
        half_rmin.push_back(atoms.half_rmin[i]);
        type.push_back(atoms.type[i]);
        if (atoms.solvation.volume.empty()) continue;
        volume.push_back(atoms.solvation.volume[i]);
        strength.push_back(atoms.solvation.strength[i]);
        inverse_lambda.push_back(atoms.solvation.inverse_lambda[i]);
        radius.push_back(atoms.solvation.radius[i]);
    }
}

FieldPoints GatheredPoints::view() const noexcept {
    return {positions, charge, sqrt_epsilon,
            half_rmin, type,   {volume, strength, inverse_lambda, radius}};
}

FieldPoints held_points(const World& world, Entity hand) noexcept {
    return points_of(world.resource<AtomTable>(), held_range(world, hand));
}

std::vector<AtomRange> environment_of(const World& world, Entity hand) {
    const AtomRange held = held_range(world, hand);
    const std::uint32_t after = held.first + held.count;
    const auto all = static_cast<std::uint32_t>(world.resource<AtomTable>().size());
    std::vector<AtomRange> ranges;
    if (held.first > 0) ranges.push_back({0, held.first});
    if (after < all) ranges.push_back({after, all - after});
    return ranges;
}

std::size_t count_environment(const World& world, Entity hand) noexcept {
    return world.resource<AtomTable>().size() - held_range(world, hand).count;
}

PairRule pair_rule(const World& world) noexcept {
    const Interactions& interactions = world.resource<Interactions>();
    return {interactions.coulomb_constant, interactions.replaced_pairs, interactions.smooth};
}

FieldSum field_on_held(const World& world, Entity hand) {
    return field_on(world, hand, held_points(world, hand));
}

FieldSum field_on(const World& world, Entity hand, const FieldPoints& group) {
    FieldSum sum;
    bool is_first = true;
    for (const AtomRange& range : environment_of(world, hand)) {
        const FieldSum part = evaluate_pair_field(
            group, points_of(world.resource<AtomTable>(), range), pair_rule(world));
        sum = is_first ? part : sum + part;
        is_first = false;
    }
    return sum;
}

bool has_fast_pairs(const World& world, Entity hand) noexcept {
    const Grip* const grip = world.find<Grip>(hand);
    return grip && !is_mobile(world, hand) &&
           world.resource<Interactions>().precision == PairPrecision::Fast &&
           held_range(world, hand).count * count_environment(world, hand) >= fewest_fast_pairs;
}

FieldSum fast_field_on_held(const World& world, Entity hand) {
    if (!has_fast_pairs(world, hand)) return field_on_held(world, hand);
    const FieldPoints group = held_points(world, hand);
    FieldSum sum;
    for (const AtomRange& range : environment_of(world, hand)) {
        const FrozenField field = build_frozen_field(
            group, points_of(world.resource<AtomTable>(), range), pair_rule(world));
        sum = sum + evaluate_field_and_energies(field, group.positions);
    }
    return sum;
}

bool has_mobile(const World& world) noexcept { return !model_of(world).masses.empty(); }

const TorsionModel& model_of(const World& world) noexcept {
    return *world.resource<Mechanics>().model;
}

const ModelAtoms& model_atoms_of(const World& world) noexcept {
    return *world.resource<Mechanics>().atoms;
}

std::optional<std::uint32_t> ModelAtoms::in_model(std::uint32_t number_in_table) const noexcept {
    if (in_table.empty()) return number_in_table;
    const auto found = std::ranges::lower_bound(in_table, number_in_table);
    if (found == in_table.end() || *found != number_in_table) return {};
    return static_cast<std::uint32_t>(found - in_table.begin());
}

void put_in_table(const TorsionModel& model, const ModelAtoms& atoms,
                  const std::vector<Vec3>& positions, std::vector<Vec3>& table) {
    for (const std::uint32_t atom : model.mobile_atoms)
        table[atoms.number_in_table(atom)] = positions[atom];
}

std::vector<Vec3> reference_positions(const World& world) {
    std::vector<Vec3> positions = world.resource<AtomTable>().positions;
    put_in_table(model_of(world), model_atoms_of(world), model_of(world).reference, positions);
    return positions;
}

}  // namespace palpa
