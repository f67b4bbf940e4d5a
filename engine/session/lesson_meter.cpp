#include "session/lesson_meter.h"

#include "core/load_error.h"
#include "core/units.h"
#include "math/angles.h"
#include "molecule/measure.h"
#include "molecule/select.h"
#include "simulation/grip_queries.h"
#include "simulation/select_in_world.h"
#include "view/hydrogen_bonds.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace palpa {
namespace {

constexpr double not_of_world = std::numeric_limits<double>::quiet_NaN();

bool needs_single_atoms(LessonQuantity quantity) {
    return quantity == LessonQuantity::Dihedral || quantity == LessonQuantity::MapCells;
}

Vec3 centre_of(const World& world, const std::vector<std::uint32_t>& atoms) {
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t atom : atoms) sum += world.resource<AtomTable>().positions[atom];
    return sum / static_cast<double>(atoms.size());
}

double dihedral_deg(const World& world, const std::vector<std::vector<std::uint32_t>>& atoms,
                    std::size_t first) {
    const std::vector<Vec3>& places = world.resource<AtomTable>().positions;
    const auto place = [&](std::size_t i) { return places[atoms[first + i].front()]; };
    return degrees_per_radian * find_dihedral(place(0), place(1), place(2), place(3));
}

std::vector<std::uint32_t> list_selected(const std::vector<bool>& chosen) {
    std::vector<std::uint32_t> atoms;
    for (std::size_t i = 0; i < chosen.size(); ++i)
        if (chosen[i]) atoms.push_back(static_cast<std::uint32_t>(i));
    return atoms;
}

}  // namespace

std::size_t map_cell(double phi_deg, double psi_deg) noexcept {
    constexpr auto side = static_cast<double>(lesson_map_side);
    const auto along = [](double angle_deg) {
        const double cell = std::floor((angle_deg + 180) / 360 * side);
        return static_cast<std::size_t>(std::clamp(cell, 0.0, side - 1));
    };
    return along(psi_deg) * lesson_map_side + along(phi_deg);
}

LessonMeter::LessonMeter(const SceneDescription& scene, const World& world)
    : scene_(scene), starts_(scene.lesson.size()) {
    measures_.values.assign(scene.lesson.size(), not_of_world);
    atoms_.resize(scene.lesson.size());
    sites_.resize(scene.lesson.size());
    edition_ = world.resource<AtomEdition>();
    for (std::size_t i = 0; i < scene.lesson.size(); ++i) find_atoms(world, i);
    for (std::size_t i = 0; i < scene.lesson.size(); ++i) {
        const LessonQuantity quantity = scene.lesson[i].quantity;
        if (quantity == LessonQuantity::Way) starts_[i] = centre_of(world, atoms_[i].front());
        if (quantity != LessonQuantity::MapCells || map_step_) continue;
        map_step_ = i;
        measures_.map.assign(lesson_map_side * lesson_map_side, 0);
    }
    if (!scene.lesson.empty()) measure(world);
}

// Throws LoadError where the step is of nothing that is there.
void LessonMeter::find_atoms(const World& world, std::size_t i) {
    atoms_[i].clear();
    sites_[i].clear();
    const LessonStepDescription& step = scene_.lesson[i];
    const std::string key = fmt::format("lesson.{}.of", step.name);
    std::vector<Atoms> found;
    std::vector<BondSites> sites;
    for (const std::string& text : step.of) {
        const std::vector<bool> chosen = select_in_world(world, parse_selection(text, key));
        const Atoms atoms = list_selected(chosen);
        const bool is_right =
            needs_single_atoms(step.quantity) ? atoms.size() == 1 : !atoms.empty();
        if (!is_right) {
            throw LoadError(
                scene_.place_of(key),
                fmt::format("'{}' selects {} atoms by \"{}\"; expected {}", key, atoms.size(), text,
                            needs_single_atoms(step.quantity) ? "one" : "some"));
        }
        found.push_back(atoms);
        if (step.quantity == LessonQuantity::HydrogenBonds)
            sites.push_back(find_bond_sites(world.resource<AtomTable>(), chosen));
    }
    if (step.quantity == LessonQuantity::Way && step.of.empty())
        found.push_back(held_atoms(world, hand_at(world, 0)));
    if (step.quantity == LessonQuantity::Way && found.front().empty()) {
        throw LoadError(
            scene_.place_of(key),
            fmt::format("'{}' is missing and the hand holds nothing; expected a selection", key));
    }
    atoms_[i] = std::move(found);
    sites_[i] = std::move(sites);
}

void LessonMeter::measure(const World& world) {
    if (scene_.lesson.empty()) return;
    if (!(edition_ == world.resource<AtomEdition>())) {
        edition_ = world.resource<AtomEdition>();
        for (std::size_t i = 0; i < scene_.lesson.size(); ++i) {
            try {
                find_atoms(world, i);
            } catch (const LoadError&) {  // what the step is of was removed: it cannot be done
                continue;
            }
        }
    }
    add_work(world);
    if (map_step_ && !atoms_[*map_step_].empty()) visit_map(world, atoms_[*map_step_]);
    for (std::size_t i = 0; i < scene_.lesson.size(); ++i) measures_.values[i] = value_of(world, i);
}

void LessonMeter::add_work(const World& world) {
    const Entity hand = hand_at(world, 0);
    if (!world.find<Contact>(hand)) {
        last_.reset();
        return;
    }
    const ContactModel& contact = contact_of(world, hand).sent.model;
    const Pull now{contact.molecule.place_angstrom,
                   contact.force_newton / units::newton_per_kcal_per_mol_angstrom,
                   contact.grip_number};
    if (last_ && last_->grip_number == now.grip_number)
        work_ -= 0.5 * (last_->force + now.force).dot(now.place - last_->place);
    last_ = now;
}

void LessonMeter::visit_map(const World& world, const std::vector<Atoms>& atoms) {
    measures_.phi_deg = dihedral_deg(world, atoms, 0);
    measures_.psi_deg = dihedral_deg(world, atoms, 1);
    measures_.map[map_cell(measures_.phi_deg, measures_.psi_deg)] = 1;
}

double LessonMeter::value_of(const World& world, std::size_t step) const {
    const std::vector<Atoms>& atoms = atoms_[step];
    const LessonStepDescription& asked = scene_.lesson[step];
    switch (asked.quantity) {
        case LessonQuantity::Work:
            return work_;
        case LessonQuantity::MapCells:
            return static_cast<double>(std::ranges::count(measures_.map, 1));
        case LessonQuantity::Between:
        case LessonQuantity::Dihedral:
        case LessonQuantity::HydrogenBonds:
        case LessonQuantity::Way:
            break;
        default:
            return not_of_world;
    }
    if (atoms.empty()) return not_of_world;
    if (asked.quantity == LessonQuantity::Between)
        return (centre_of(world, atoms[1]) - centre_of(world, atoms[0])).norm();
    if (asked.quantity == LessonQuantity::Dihedral) return dihedral_deg(world, atoms, 0);
    if (asked.quantity == LessonQuantity::HydrogenBonds) {
        return static_cast<double>(
            count_hydrogen_bonds(world.resource<AtomTable>(), sites_[step][0], sites_[step][1]));
    }
    return (centre_of(world, atoms[0]) - *starts_[step]).norm();
}

}  // namespace palpa
