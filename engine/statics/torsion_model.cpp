#include "statics/torsion_model.h"

#include "core/assertion.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <utility>

namespace palpa {
namespace {

// Tells whether atoms keep their distances whatever turns. Both atoms of a joint's bond lie on its
// axis and so are rigid in both bodies.
class RigidSets {
public:
    explicit RigidSets(const TorsionBodies& bodies) : bodies_(bodies) {}

    template <std::size_t Count>
    bool is_rigid(const std::array<std::uint32_t, Count>& atoms) const {
        const auto has_all = [&](std::uint32_t body) {
            return std::ranges::all_of(atoms,
                                       [&](std::uint32_t atom) { return is_in(body, atom); });
        };
        return std::ranges::any_of(atoms, [&](std::uint32_t atom) {
            const std::uint32_t body = bodies_.body_of[atom], parent = bodies_.bodies[body].parent;
            return has_all(body) || (parent != no_body && has_all(parent));
        });
    }

private:
    bool is_in(std::uint32_t body, std::uint32_t atom) const {
        const std::uint32_t own = bodies_.body_of[atom];
        if (own == body) return true;
        if (!bodies_.is_base(body) && bodies_.bodies[body].axis[0] == atom) return true;
        return bodies_.bodies[own].parent == body && bodies_.bodies[own].axis[1] == atom;
    }

    const TorsionBodies& bodies_;
};

void keep_moving_terms(const TorsionBodies& bodies, Topology& topology) {
    const RigidSets sets(bodies);
    std::erase_if(topology.bonds,
                  [&](const Bond& t) { return sets.is_rigid(std::array{t.a, t.b}); });
    std::erase_if(topology.angles,
                  [&](const Angle& t) { return sets.is_rigid(std::array{t.a, t.b, t.c}); });
    std::erase_if(topology.urey_bradleys,
                  [&](const UreyBradley& t) { return sets.is_rigid(std::array{t.a, t.c}); });
    std::erase_if(topology.dihedrals,
                  [&](const Dihedral& t) { return sets.is_rigid(std::array{t.a, t.b, t.c, t.d}); });
    std::erase_if(topology.impropers,
                  [&](const Improper& t) { return sets.is_rigid(std::array{t.a, t.b, t.c, t.d}); });
    std::erase_if(topology.cmap_terms,
                  [&](const CmapTerm& t) { return sets.is_rigid(t.phi) && sets.is_rigid(t.psi); });
    std::erase_if(topology.exclusions.pairs14,
                  [&](const std::array<std::uint32_t, 2>& pair) { return sets.is_rigid(pair); });
}

}  // namespace

TorsionModel build_torsion_model(const TorsionBodies& bodies, std::vector<double> masses,
                                 std::vector<Vec3> positions, const Topology& topology,
                                 std::vector<MoleculeBase> bases) {
    PALPA_ASSERT(masses.size() == topology.size() && positions.size() == topology.size());
    PALPA_ASSERT(bodies.body_of.size() == topology.size() && bases.size() == bodies.molecules());
    TorsionModel model;
    model.tree = build_assembly_tree(bodies, masses, positions);
    model.molecule_masses.assign(bases.size(), 0);
    for (std::size_t i = 0; i < masses.size(); ++i) {
        model.molecule_masses[model.tree.molecule_of[bodies.body_of[i]]] += masses[i];
    }
    model.masses = std::move(masses);
    model.reference = std::move(positions);
    model.bases = std::move(bases);
    model.topology = topology;
    keep_moving_terms(bodies, model.topology);
    model.fast = build_fast_force_field(model.topology);
    model.fast.atoms.groups = bodies.body_of;
    model.mobile_atoms.resize(model.masses.size());
    std::iota(model.mobile_atoms.begin(), model.mobile_atoms.end(), 0U);

    for (std::size_t body = 0; body < bodies.bodies.size(); ++body) {
        const bool is_base = bodies.is_base(body);
        const auto [j, k] = bodies.bodies[body].axis;
        model.axes.push_back(is_base ? Vec3(Vec3::Zero())
                                     : (model.reference[k] - model.reference[j]).normalized());
        model.coordinate_of_body.push_back(is_base ? -1 : model.coordinates);
        model.coordinates += is_base ? 0 : 1;
    }
    for (const MoleculeBase& base : model.bases) {
        const bool is_held = base.freedom == BaseFreedom::Held;
        model.coordinate_of_base.push_back(is_held ? -1 : model.coordinates);
        if (base.freedom == BaseFreedom::Turning) model.coordinates += 3;
        if (base.freedom == BaseFreedom::Free) model.coordinates += 6;
    }
    return model;
}

void fix_bases(const std::vector<std::uint8_t>& is_fixed, TorsionModel& model) {
    const AssemblyTree& tree = model.tree;
    std::optional<std::uint32_t> first;
    model.mobile_atoms.clear();
    for (std::uint32_t i = 0; i < tree.bodies.body_of.size(); ++i) {
        const std::uint32_t body = tree.bodies.body_of[i], molecule = tree.molecule_of[body];
        if (!tree.bodies.is_base(body) || is_fixed[molecule] == 0) {
            model.mobile_atoms.push_back(i);
            continue;
        }
        PALPA_ASSERT(model.bases[molecule].freedom == BaseFreedom::Held);
        if (!first) first = body;
        model.fast.atoms.groups[i] = *first;
    }
}

}  // namespace palpa
