// Two rigid molecules in two hands, and the contact models that a simulation would give them: a
// reference in double for what the servo makes of it.
#pragma once
#include "core/units.h"
#include "field/pair_field.h"
#include "haptics/exchange.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace palpa::test {

// A rigid molecule; its reference atom is the first.
struct RigidBody {
    std::vector<Vec3> shape;  // Å, from the reference atom
    std::vector<double> charge, sqrt_epsilon, half_rmin;
    Vec3 counterpart = Vec3::Zero();  // Å, from where its place is measured

    void add(const Vec3& from_reference, double q, double epsilon, double rmin_2) {
        shape.push_back(from_reference);
        charge.push_back(q);
        sqrt_epsilon.push_back(std::sqrt(epsilon));
        half_rmin.push_back(rmin_2);
    }
    Vec3 reference(const MoleculePose& pose) const { return counterpart + pose.place_angstrom; }
    std::vector<Vec3> at(const MoleculePose& pose) const {
        std::vector<Vec3> places;
        for (const Vec3& arm : shape) places.push_back(reference(pose) + pose.orientation * arm);
        return places;
    }
    Vec3 centre(const MoleculePose& pose) const {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& place : at(pose)) sum += place;
        return sum / static_cast<double>(shape.size());
    }
    FieldPoints view(const std::vector<Vec3>& places) const {
        return {places, charge, sqrt_epsilon, half_rmin};
    }
};

// TIP3P, with the Lennard-Jones numbers that CHARMM gives its hydrogens.
inline RigidBody water_body() {
    RigidBody water;
    water.add(Vec3::Zero(), -0.834, 0.1521, 1.7682);
    water.add(Vec3(0.9572, 0, 0), 0.417, 0.046, 0.2245);
    water.add(Vec3(-0.2399872, 0.926627, 0), 0.417, 0.046, 0.2245);
    return water;
}

inline RigidBody sphere_body(double charge) {
    RigidBody sphere;
    sphere.add(Vec3::Zero(), charge, 0.2, 1.9);
    return sphere;
}

// Both hands: slot 0 and 1.
struct TwoHeld {
    std::array<RigidBody, 2> bodies;
    RigidBody environment;  // at its counterpart; of no atom unless added
    std::array<bool, 2> turns{false, false};
    double period_s = 0.001;
    Mat3 projector = Mat3::Identity();  // onto what both may do
    bool is_compliant = false;

    static constexpr PairRule rule{units::charmm_coulomb_constant};

    // Of the other molecule on that hand's, in double.
    FieldSum mutual(std::size_t hand, const std::array<MoleculePose, 2>& poses) const {
        const std::size_t other = 1 - hand;
        const std::vector<Vec3> own = bodies[hand].at(poses[hand]);
        const std::vector<Vec3> others = bodies[other].at(poses[other]);
        return evaluate_pair_field(bodies[hand].view(own), bodies[other].view(others), rule);
    }
    // Of what no hand holds.
    FieldSum around(std::size_t hand, const std::array<MoleculePose, 2>& poses) const {
        const std::vector<Vec3> own = bodies[hand].at(poses[hand]), others = environment.at({});
        return evaluate_pair_field(bodies[hand].view(own), environment.view(others), rule);
    }
    Vec3 newton(std::size_t hand, const std::array<MoleculePose, 2>& poses) const {
        return units::newton_per_kcal_per_mol_angstrom *
               (mutual(hand, poses).force + around(hand, poses).force);
    }

    // After a step that found both there.
    LocalContactModel contact(std::size_t hand, const std::array<MoleculePose, 2>& poses) const {
        const RigidBody& own = bodies[hand];
        const std::size_t other = 1 - hand;
        const Vec3 centre = own.centre(poses[hand]);
        const FieldSum held = mutual(hand, poses), still = around(hand, poses);
        LocalContactModel contact;
        contact.model.molecule = poses[hand];
        contact.model.turns_with_handle = turns[hand];
        contact.model.projector = projector;
        contact.model.force_newton = projector * newton(hand, poses);
        contact.model.torque_newton_metre =
            units::joule_per_kcal_per_mol *
            (held.torque_about(centre) + still.torque_about(centre));
        contact.model.stiffness_matrix_N_per_m =
            units::newton_per_metre_per_kcal_per_mol_angstrom2 *
            (projector * (held.stiffness + still.stiffness) * projector);
        contact.model.period_s = period_s;
        contact.model.is_compliant = is_compliant;
        LocalField& field = contact.field;
        field.group = own.at(poses[hand]);
        field.centre = centre;
        field.pivot = own.reference(poses[hand]);
        for (const Vec3& arm : own.shape) field.radius = std::max(field.radius, arm.norm());
        const std::vector<Vec3> atoms = environment.at({});
        field.frozen = build_frozen_field(own.view(field.group), environment.view(atoms), rule);
        field.at_step = evaluate_frozen_field(field.frozen, field.group);
        field.has_atoms = true;
        const std::vector<Vec3> others = bodies[other].at(poses[other]);
        HeldField& mutual_field = field.held.emplace_back();
        mutual_field.hand = other;
        mutual_field.then = {poses[other], 0};
        mutual_field.pivot = bodies[other].reference(poses[other]);
        mutual_field.frozen =
            build_frozen_field(own.view(field.group), bodies[other].view(others), rule);
        mutual_field.at_step = evaluate_frozen_field(mutual_field.frozen, field.group);
        contact.model.clearance_angstrom =
            std::max(0.0, std::min(field.at_step.clearance, mutual_field.at_step.clearance));
        return contact;
    }
};

using LiveArray = std::array<std::optional<LiveMolecule>, 2>;

inline LiveArray live_at(const std::array<MoleculePose, 2>& poses) {
    return {LiveMolecule{poses[0], 0}, LiveMolecule{poses[1], 0}};
}

}  // namespace palpa::test
