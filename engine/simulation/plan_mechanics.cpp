#include "simulation/plan_mechanics.h"

#include "assembly/region_bodies.h"
#include "charmm/cut_topology.h"
#include "core/load_error.h"
#include "simulation/bonded_terms.h"
#include "simulation/grip_queries.h"
#include "simulation/mobile_joints.h"
#include "simulation/region.h"
#include "simulation/systems/gather_springs.h"

#include <fmt/format.h>
#include <functional>
#include <span>
#include <utility>

namespace palpa {
namespace {

BaseFreedom freedom_of(Motion motion) {
    if (motion == Motion::Free) return BaseFreedom::Free;
    return motion == Motion::TranslateAndTurn ? BaseFreedom::Turning : BaseFreedom::Held;
}

// Finds the base of each bonded molecule, by the motion of the scene's molecules that its atoms
// belong to. A molecule with atoms outside of a region is fixed.
std::vector<MoleculeBase> find_bases(const TorsionBodies& bodies, std::span<const ScenePart> parts,
                                     const std::optional<Region>& region) {
    const std::vector<std::uint32_t> molecule_of = molecules_of(bodies);
    std::vector<std::optional<MoleculeBase>> found(bodies.molecules());
    for (const std::uint32_t atom : region ? region->atoms : std::vector<std::uint32_t>{}) {
        std::optional<MoleculeBase>& base = found[molecule_of[bodies.body_of[atom]]];
        if (!base && region->is_inside[atom] == 0) base = MoleculeBase{BaseFreedom::Held, atom};
    }
    for (const ScenePart& part : parts) {
        const BaseFreedom freedom = freedom_of(part.mobility.motion);
        const auto set = [&](std::uint32_t atom) {
            const std::uint32_t body = bodies.body_of[atom];
            std::optional<MoleculeBase>& base = found[molecule_of[body]];
            if (!base && bodies.is_base(body)) base = MoleculeBase{freedom, atom};
        };
        set(part.reference_atom);
        for (std::uint32_t i = 0; i < part.atoms.count; ++i) set(part.atoms.first + i);
    }
    std::vector<MoleculeBase> bases;
    for (const std::optional<MoleculeBase>& base : found) {
        bases.push_back(base.value_or(MoleculeBase{}));
    }
    return bases;
}

// A hand has hold of one base only.
void check_one_piece(const TextPlace& place, const Molecule& held,
                     const std::function<std::uint32_t(std::uint32_t)>& piece_of) {
    for (std::uint32_t i = 0; i < held.atoms.count; ++i) {
        if (piece_of(held.atoms.first + i) == piece_of(held.reference_atom)) continue;
        throw LoadError(place,
                        fmt::format("'{}' has parts without bonds between them; expected one "
                                    "bonded molecule, or a free one held by a spring (grab.atom)",
                                    held.name));
    }
}

// Leaves nothing in a plan but what a region needs.
void cut_plan(const Region& region, MechanicsPlan& plan) {
    if (region.atoms.size() == region.is_inside.size()) return;
    CutBodies cut = cut_bodies(plan.bodies, region.atoms);
    plan.atoms.in_table = region.atoms;
    std::vector<MoleculeBase> bases;
    for (const std::uint32_t molecule : cut.molecules) {
        bases.push_back(plan.bases[molecule]);
        bases.back().pivot = plan.atoms.in_model(bases.back().pivot).value();
    }
    plan.bodies = std::move(cut.bodies);
    plan.bases = std::move(bases);
}

}  // namespace

MechanicsPlan plan_mechanics(World& world) {
    const Connectivity& connectivity = *bonded_terms(world).connectivity;
    const std::vector<ScenePart> parts = list_parts(world);
    const std::optional<Region> region = find_region(world);
    SceneJoints joints =
        find_joints(world, connectivity, world.resource<AtomTable>().positions, parts, region);
    std::vector<std::uint32_t> base_atoms;
    if (region) {
        const auto cuts = find_region_cuts(connectivity, region->is_inside, joints.joints.springs);
        joints.joints.springs.insert(joints.joints.springs.end(), cuts.begin(), cuts.end());
        for (std::uint32_t i = 0; i < region->is_inside.size(); ++i) {
            if (region->is_inside[i] == 0) base_atoms.push_back(i);
        }
    }
    for (const ScenePart& part : parts) base_atoms.push_back(part.reference_atom);
    MechanicsPlan plan{{}, build_bodies(connectivity, joints.joints, base_atoms), {}, 0, 0};
    plan.bases = find_bases(plan.bodies, parts, region);
    if (region) cut_plan(*region, plan);
    plan.joints = joints.joints.joints.size();
    plan.joints_held = joints.held;
    return plan;
}

std::vector<HeldPart> find_held(const World& world, const MechanicsPlan& plan) {
    const std::vector<std::uint32_t> molecule_of = molecules_of(plan.bodies);
    const auto piece_of = [&](std::uint32_t atom) {
        return molecule_of[plan.bodies.body_of[plan.atoms.in_model(atom).value()]];
    };
    const ScenePlaces& places = world.resource<ScenePlaces>();
    std::vector<HeldPart> held;
    const std::vector<Entity> hands = find_hands(world);
    world.each<Grip>([&](Entity hand, const Grip& grip) {
        const Molecule& molecule = *world.find<Molecule>(grip.molecule);
        HeldPart& part = held.emplace_back();
        if (const Spring* const spring = world.find<Spring>(hand)) {
            part.base = piece_of(molecule.atoms.first + spring->ends.front().atoms.front());
            part.spring = find_model_spring(world, plan.atoms, *spring);
        } else {
            part.base = piece_of(molecule.reference_atom);
            const auto number = std::ranges::find(hands, hand) - hands.begin() + 1;
            check_one_piece(
                places.place_of(hands.size() == 1 ? "grab.molecule"
                                                  : fmt::format("hand[{}].grab.molecule", number)),
                molecule, piece_of);
        }
    });
    return held;
}

TorsionModel build_model(World& world, const MechanicsPlan& plan, std::vector<MoleculeBase> bases) {
    const BondedTerms& terms = bonded_terms(world);
    const std::vector<Vec3>& positions = world.resource<AtomTable>().positions;
    const std::vector<std::uint32_t>& atoms = plan.atoms.in_table;
    if (atoms.empty()) {
        return build_torsion_model(plan.bodies, terms.connectivity->mass, positions,
                                   *terms.topology, std::move(bases));
    }
    std::vector<double> masses;
    std::vector<Vec3> places;
    for (const std::uint32_t atom : atoms) {
        masses.push_back(terms.connectivity->mass[atom]);
        places.push_back(positions[atom]);
    }
    return build_torsion_model(plan.bodies, std::move(masses), std::move(places),
                               cut_topology(*terms.topology, atoms), std::move(bases));
}

}  // namespace palpa
