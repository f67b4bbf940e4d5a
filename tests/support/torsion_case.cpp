#include "tests/support/torsion_case.h"

#include "tests/support/paths.h"
#include "tests/support/reference_case.h"
#include "tests/support/solvation_of.h"

#include <Eigen/Cholesky>
#include <array>
#include <cstddef>
#include <utility>

namespace palpa::test {

FlexibleCase read_flexible_case(const std::filesystem::path& folder, const std::string& name,
                                const std::string& frames) {
    const std::filesystem::path path = folder / (name + ".ff.json");
    FlexibleCase result;
    const ReferenceCase reference = read_reference_case(path);
    result.topology = reference.topology;
    result.connectivity.file = path.string();
    for (const ReferenceAtom& atom : reference.atoms) {
        result.connectivity.names.push_back(
            {"A", atom.residue, std::to_string(atom.number), atom.name});
        result.connectivity.mass.push_back(atom.mass);
        result.connectivity.type.push_back(atom.type);
    }
    for (const Bond& bond : result.topology.bonds) {
        result.connectivity.bonds.push_back({bond.a, bond.b});
    }
    result.positions = read_reference_frames(folder / (name + "." + frames + ".json"))[0].positions;
    return result;
}

FlexibleCase alanine_dipeptide() { return read_flexible_case(test_data(""), "ala_dipeptide"); }

FlexibleCase tetrapeptide() { return read_flexible_case(test_data(""), "tetra_aera_c36m"); }

FlexibleCase solvated(FlexibleCase c) {
    c.topology.solvation = solvation_of(c.connectivity.type);
    return c;
}

FlexibleCase with_copy(FlexibleCase c, const Vec3& away) {
    const auto atoms = static_cast<std::uint32_t>(c.topology.size());
    const auto copy = [&](auto& terms, auto... atom) {
        const std::size_t count = terms.size();
        for (std::size_t i = 0; i < count; ++i) {
            auto term = terms[i];
            ((term.*atom += atoms), ...);
            terms.push_back(term);
        }
    };
    Topology& t = c.topology;
    copy(t.bonds, &Bond::a, &Bond::b);
    copy(t.angles, &Angle::a, &Angle::b, &Angle::c);
    copy(t.urey_bradleys, &UreyBradley::a, &UreyBradley::c);
    copy(t.dihedrals, &Dihedral::a, &Dihedral::b, &Dihedral::c, &Dihedral::d);
    copy(t.impropers, &Improper::a, &Improper::b, &Improper::c, &Improper::d);
    for (std::size_t i = 0, count = t.cmap_terms.size(); i < count; ++i) {
        CmapTerm term = t.cmap_terms[i];
        for (std::uint32_t& atom : term.phi) atom += atoms;
        for (std::uint32_t& atom : term.psi) atom += atoms;
        t.cmap_terms.push_back(term);
    }
    for (std::size_t i = 0, count = t.exclusions.pairs14.size(); i < count; ++i) {
        const auto [a, b] = t.exclusions.pairs14[i];
        t.exclusions.pairs14.push_back({a + atoms, b + atoms});
    }
    const auto excluded = static_cast<std::uint32_t>(t.exclusions.atoms.size());
    for (std::uint32_t i = 0; i < excluded; ++i) {
        t.exclusions.atoms.push_back(t.exclusions.atoms[i] + atoms);
    }
    for (std::uint32_t i = 0; i < atoms; ++i) {
        t.exclusions.first.push_back(t.exclusions.first[i + 1] + excluded);
        t.charge.push_back(t.charge[i]);
        t.type.push_back(t.type[i]);
        c.connectivity.mass.push_back(c.connectivity.mass[i]);
        c.connectivity.type.push_back(c.connectivity.type[i]);
        c.connectivity.names.push_back(c.connectivity.names[i]);
        c.connectivity.names.back().segment = "B";
    }
    if (t.solvation) t.solvation = solvation_of(c.connectivity.type);
    for (std::size_t i = 0, count = c.connectivity.bonds.size(); i < count; ++i) {
        const auto [a, b] = c.connectivity.bonds[i];
        c.connectivity.bonds.push_back({a + atoms, b + atoms});
    }
    const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(2, -1, 1).normalized()).toRotationMatrix();
    for (std::uint32_t i = 0; i < atoms; ++i) {
        c.positions.emplace_back(turn * (c.positions[i] - c.positions[0]) + c.positions[0] + away);
    }
    return c;
}

TorsionBodies bodies_of(const FlexibleCase& c, const JointRules& rules) {
    return build_bodies(c.connectivity, build_joints(c.connectivity, rules));
}

TorsionModel model_of(const FlexibleCase& c, const std::vector<BaseFreedom>& freedoms,
                      const JointRules& rules) {
    const TorsionBodies bodies = bodies_of(c, rules);
    std::vector<MoleculeBase> bases;
    const std::size_t atoms = c.positions.size() / freedoms.size();
    for (std::size_t m = 0; m < freedoms.size(); ++m) {
        bases.push_back({freedoms[m], static_cast<std::uint32_t>(m * atoms)});
    }
    return build_torsion_model(bodies, c.connectivity.mass, c.positions, c.topology, bases);
}

TorsionModel forceless_model(const TorsionCase& c, BaseFreedom freedom, std::uint32_t pivot) {
    Topology topology;
    topology.charge.assign(c.masses.size(), 0);
    topology.type.assign(c.masses.size(), 0);
    topology.lennard_jones = build_lennard_jones_table(std::vector<LennardJonesType>{{0, 1}}, {});
    topology.lennard_jones14 = topology.lennard_jones;
    topology.exclusions.first.assign(c.masses.size() + 1, 0);
    return build_torsion_model(c.bodies, c.masses, c.positions, topology,
                               std::vector<MoleculeBase>(c.bodies.molecules(), {freedom, pivot}));
}

Coordinates random_move(const TorsionModel& model, double size, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-size, size);
    Coordinates move(model.coordinates);
    for (double& value : move) value = uniform(random);
    return move;
}

TorsionState state_after(const TorsionModel& model, double size, std::uint32_t seed) {
    std::mt19937 random(seed);
    TorsionState state = build_torsion_state(model);
    add_move(model, random_move(model, size, random), state);
    return state;
}

PeptidePair peptide_pair(const std::array<BaseFreedom, 2>& bases) {
    PeptidePair pair{model_of(with_copy(tetrapeptide(), {12, 5, -2}), {bases[0], bases[1]}), {}};
    pair.state = state_after(pair.model, 0.03, 21);
    return pair;
}

Eigen::MatrixXd find_jacobian(const TorsionModel& model, const TorsionState& state) {
    constexpr double h = 1e-3;
    const auto atoms = static_cast<Eigen::Index>(state.positions.size());
    Eigen::MatrixXd jacobian(3 * atoms, model.coordinates);
    for (Eigen::Index c = 0; c < model.coordinates; ++c) {
        const auto moved = [&](double by) {
            TorsionState there = state;
            add_move(model, by * Coordinates::Unit(model.coordinates, c), there);
            return there.positions;
        };
        const auto up = moved(h), down = moved(-h), up2 = moved(2 * h), down2 = moved(-2 * h);
        for (Eigen::Index i = 0; i < atoms; ++i) {
            const auto at = static_cast<std::size_t>(i);
            jacobian.block<3, 1>(3 * i, c) =
                (8 * (up[at] - down[at]) - (up2[at] - down2[at])) / (12 * h);
        }
    }
    return jacobian;
}

Eigen::VectorXd stacked(const std::vector<Vec3>& vectors) {
    Eigen::VectorXd result(static_cast<Eigen::Index>(3 * vectors.size()));
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        result.segment<3>(static_cast<Eigen::Index>(3 * i)) = vectors[i];
    }
    return result;
}

Coordinates find_accelerations(const TorsionModel& model, const TorsionState& state) {
    const Eigen::MatrixXd J = find_jacobian(model, state);
    Eigen::VectorXd mass(J.rows());
    for (Eigen::Index i = 0; i < mass.size(); ++i) {
        mass[i] = model.masses[static_cast<std::size_t>(i / 3)];
    }
    return (J.transpose() * mass.asDiagonal() * J)
        .ldlt()
        .solve(J.transpose() * stacked(state.forces));
}

}  // namespace palpa::test
