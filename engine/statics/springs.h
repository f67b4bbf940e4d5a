// Springs on atoms: a hand on an atom or a residue, a restraint between atoms.
#pragma once
#include "math/vec.h"
#include "statics/torsion_model.h"

#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// A spring from the centre of mass of some atoms to a fixed point, or to the centre of mass of
// other atoms. E = k (|x - y| - length)^2/2.
struct ModelSpring {
    std::vector<std::uint32_t> atoms = {};        // x is their centre of mass; one or more
    double k = 0;                                 // kcal/mol/Å^2
    Vec3 place = Vec3::Zero();                    // y, Å, without other atoms
    std::vector<std::uint32_t> other_atoms = {};  // y is their centre of mass
    double length = 0;                            // rest length, Å

    friend bool operator==(const ModelSpring&, const ModelSpring&) = default;
};

// The state of a spring. If both ends of a spring with a rest length coincide, its direction is
// undefined and its force zero.
struct SpringPull {
    Vec3 stretch;   // x - y, Å
    double k;       // k (1 - length/|x - y|), kcal/mol/Å^2: k times the stretch is the force on y
    double energy;  // kcal/mol
};

Vec3 find_centre_of_mass(const TorsionModel& model, std::span<const std::uint32_t> atoms,
                         std::span<const Vec3> positions) noexcept;

// Position of the other end, Å.
Vec3 find_other_end(const TorsionModel& model, const ModelSpring& spring,
                    std::span<const Vec3> positions) noexcept;

SpringPull find_spring_pull(const TorsionModel& model, const ModelSpring& spring,
                            std::span<const Vec3> positions) noexcept;

// Force on its other end, kcal/mol/Å.
Vec3 find_spring_force(const TorsionModel& model, const ModelSpring& spring,
                       std::span<const Vec3> positions) noexcept;

// -d(that force)/d(its other end), kcal/mol/Å^2: k along the spring and k (1 - length/|x - y|)
// across it. Zero if the direction is undefined.
Mat3 find_spring_stiffness(const TorsionModel& model, const ModelSpring& spring,
                           std::span<const Vec3> positions) noexcept;

// Adds the forces of a spring and returns its energy.
double add_spring_forces(const TorsionModel& model, const ModelSpring& spring,
                         std::span<const Vec3> positions, std::span<Vec3> forces) noexcept;

// Calls `visit` for each atom of a spring with its share of the force, by mass; a negative share
// has the opposite direction.
template <class Visit>
void visit_pulled(const TorsionModel& model, const ModelSpring& spring, const Visit& visit) {
    const auto visit_end = [&](std::span<const std::uint32_t> atoms, double sign) {
        double mass = 0;
        for (const std::uint32_t atom : atoms) mass += model.masses[atom];
        for (const std::uint32_t atom : atoms) visit(atom, sign * model.masses[atom] / mass);
    };
    visit_end(spring.atoms, 1);
    visit_end(spring.other_atoms, -1);
}

}  // namespace palpa
