// What the steps of a lesson ask of the world: distances, dihedrals, hydrogen bonds, a map, work.
#pragma once
#include "ecs/world.h"
#include "math/vec.h"
#include "scene/description.h"
#include "simulation/resources.h"
#include "view/hydrogen_bonds.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace palpa {

// After the last step of the simulation, of all steps of the lesson: which one is on screen is not
// known here. Each looks at its own atoms alone.
struct LessonMeasures {
    // Of each step of the lesson; NaN where its quantity is none of the world (session/lesson.h).
    std::vector<double> values;
    // Of the first step that counts cells: which were visited, φ along a row from -180°, ψ by rows;
    // and where it is now. Empty: no step does.
    std::vector<std::uint8_t> map;
    double phi_deg = 0, psi_deg = 0;
};

// Cells of such a map along one side: 20° each.
inline constexpr std::size_t lesson_map_side = 18;

// The cell of two dihedrals, from -180° to 180°.
std::size_t map_cell(double phi_deg, double psi_deg) noexcept;

// Quantities in units of their names (scene/choices.h). Work is of what pulls the first hand's
// molecule, or its spring, against the way of the hand, by the trapezoidal rule over steps: what
// was done so far. Ways are counted from where the world stood at first.
class LessonMeter {
public:
    // Throws LoadError for a selection that is none or empty, and for several atoms where a
    // dihedral needs one.
    LessonMeter(const SceneDescription& scene, const World& world);

    // After each step of the simulation.
    void measure(const World& world);

    const LessonMeasures& measures() const noexcept { return measures_; }

private:
    using Atoms = std::vector<std::uint32_t>;

    void find_atoms(const World& world, std::size_t step);
    void add_work(const World& world);
    double value_of(const World& world, std::size_t step) const;
    void visit_map(const World& world, const std::vector<Atoms>& atoms);

    SceneDescription scene_;
    AtomEdition edition_;
    std::vector<std::vector<Atoms>> atoms_;      // of each step, of each selection
    std::vector<std::vector<BondSites>> sites_;  // the same of steps that count hydrogen bonds
    std::vector<std::optional<Vec3>> starts_;    // of steps that ask for a way
    std::optional<std::size_t> map_step_;
    struct Pull {
        Vec3 place, force;  // Å, kcal/mol/Å
        std::uint32_t grip_number = 0;
    };
    std::optional<Pull> last_;
    double work_ = 0;  // kcal/mol
    LessonMeasures measures_;
};

}  // namespace palpa
