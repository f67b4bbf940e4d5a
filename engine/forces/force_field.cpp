#include "forces/force_field.h"

#include "core/assertion.h"
#include "forces/bonded.h"
#include "forces/cmap.h"

namespace palpa {

EnergyTerms add_forces(const Topology& topology, const NonbondedSettings& settings,
                       std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    PALPA_ASSERT(positions.size() == topology.size() && forces.size() == topology.size());
    EnergyTerms energy;
    energy.bond = add_bond_forces(topology.bonds, positions, forces);
    energy.angle = add_angle_forces(topology.angles, positions, forces);
    energy.urey_bradley = add_urey_bradley_forces(topology.urey_bradleys, positions, forces);
    energy.dihedral = add_dihedral_forces(topology.dihedrals, positions, forces);
    energy.improper = add_improper_forces(topology.impropers, positions, forces);
    energy.cmap = add_cmap_forces(topology.cmap_terms, topology.cmap_maps, positions, forces);
    const NonbondedEnergy pairs = add_nonbonded_forces(topology, settings, positions, forces);
    energy.lj = pairs.van_der_waals;
    energy.coulomb = pairs.electrostatic;
    const NonbondedEnergy pairs14 = add_nonbonded14_forces(topology, settings, positions, forces);
    energy.lj14 = pairs14.van_der_waals;
    energy.coulomb14 = pairs14.electrostatic;
    return energy;
}

}  // namespace palpa
