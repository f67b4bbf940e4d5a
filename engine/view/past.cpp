#include "view/past.h"

#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/remote_engine.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "view/elements.h"
#include "view/in_hand.h"
#include "view/lines.h"
#include "view/palette.h"
#include "view/picks.h"
#include "view/place.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <numbers>

namespace palpa {
namespace {

constexpr double shortest = 0.03, longest_step = 3;  // Å: less is no way, more no way that was gone
constexpr double no_way = 1e-3;
constexpr std::size_t most_points = 2000;

Vec3 centre_of(const AtomTable& atoms, std::span<const std::uint32_t> numbers) {
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    for (const std::uint32_t atom : numbers) {
        sum += atoms.mass[atom] * atoms.positions[atom];
        mass += atoms.mass[atom];
    }
    return mass > 0 ? Vec3(sum / mass) : atoms.positions[numbers.front()];
}

bool is_hydrogen(const AtomTable& atoms, std::size_t i) { return element_of(atoms, i) == "H"; }

// Hydrogens on carbon, which pictures of more than a few atoms leave out.
std::vector<bool> find_apolar_hydrogens(const AtomTable& atoms) {
    std::vector<bool> apolar(atoms.size(), false);
    for (const auto& [a, b] : atoms.bonds) {
        if (is_hydrogen(atoms, a) && element_of(atoms, b) == "C") apolar[a] = true;
        if (is_hydrogen(atoms, b) && element_of(atoms, a) == "C") apolar[b] = true;
    }
    return apolar;
}

double find_move(const AtomTable& atoms, std::span<const Vec3> start, std::size_t i) {
    return (atoms.positions[i] - start[i]).norm();
}

// What hands hold, if an atom of it has moved, and residues of the pocket of which one has.
std::vector<bool> find_moved(const World& world, std::span<const Vec3> start,
                             std::span<const ResidueSpan> residues,
                             const std::vector<bool>& pocket) {
    constexpr double of_held = 0.1, of_pocket = 0.5;  // Å
    const AtomTable& atoms = world.resource<AtomTable>();
    std::vector<bool> moved = find_held_atoms(world);
    bool has_held_moved = false;
    for (std::size_t i = 0; i < moved.size(); ++i)
        has_held_moved = has_held_moved || (moved[i] && find_move(atoms, start, i) > of_held);
    if (!has_held_moved) moved.assign(moved.size(), false);
    for (const ResidueSpan& residue : residues) {
        bool has_moved = false;
        for (std::size_t i = residue.first; i < residue.end; ++i)
            has_moved = has_moved || (pocket[i] && !is_hydrogen(atoms, i) &&
                                      find_move(atoms, start, i) > of_pocket);
        for (std::size_t i = residue.first; has_moved && i < residue.end; ++i)
            moved[i] = moved[i] || pocket[i];
    }
    return moved;
}

// Thin sticks where these were; without hydrogens on carbon.
void add_pale_atoms(const AtomTable& atoms, std::span<const Vec3> places,
                    const std::vector<bool>& chosen, FrameScene& frame) {
    constexpr float radius = 0.1F, alone = 0.25F, paleness = 0.72F;  // Å, Å, of 1
    const std::vector<bool> apolar = find_apolar_hydrogens(atoms);
    std::vector<bool> has_stick(atoms.size(), false);
    const auto colour_of = [&](std::size_t i) {
        return glm::mix(look_of(element_of(atoms, i)).colour, frame.background, paleness);
    };
    for (const auto& [a, b] : atoms.bonds) {
        if (!chosen[a] || !chosen[b] || apolar[a] || apolar[b]) continue;
        has_stick[a] = has_stick[b] = true;
        frame.cones.push_back({as_float(places[a]), as_float(places[b]), radius, radius,
                               colour_of(a), colour_of(b), ghost_pick});
    }
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        if (!chosen[i] || apolar[i]) continue;
        add_ball(as_float(places[i]), {has_stick[i] ? radius : alone, colour_of(i), ghost_pick},
                 frame);
    }
}

}  // namespace

void Past::follow(const World& world, const ViewMarks& marks) {
    const Clock& clock = world.resource<Clock>();
    if (!has_begun_ || clock.steps < steps_ || clock.resets != resets_) begin(world, marks.ghost);
    // Periods may change; the way is as old as the steps that it took.
    now_s_ += static_cast<double>(clock.steps - steps_) * clock.period_s;
    steps_ = clock.steps;
    see_new_molecules(world);
    if (!(marks.trail_s > 0)) return trails_.clear();
    for (const Entity hand : find_hands(world)) follow_hand(world, hand, marks.trail_s);
}

void Past::begin(const World& world, bool seeks_rest) {
    *this = Past();
    has_begun_ = true;
    steps_ = world.resource<Clock>().steps;
    resets_ = world.resource<Clock>().resets;
    if (!seeks_rest) return;
    for (const Entity hand : find_hands(world))
        if (const auto rest = find_resting_place(world, hand)) rests_.push_back(*rest);
}

void Past::see_new_molecules(const World& world) {
    const std::vector<Vec3>& positions = world.resource<AtomTable>().positions;
    // An entity of a molecule that was taken back may become another's.
    std::erase_if(starts_, [&](const auto& start) { return !world.find<Molecule>(start.first); });
    world.each<Molecule>([&](Entity entity, const Molecule& molecule) {
        std::vector<Vec3>& start = starts_[entity];
        if (start.size() == molecule.atoms.count) return;
        const auto first = positions.begin() + molecule.atoms.first;
        start.assign(first, first + molecule.atoms.count);
    });
}

void Past::follow_hand(const World& world, Entity hand, double trail_s) {
    const Grip* const grip = world.find<Grip>(hand);
    Trail& trail = trails_[hand];
    std::deque<Point>& points = trail.points;
    while (!points.empty() && points.front().time_s < now_s_ - trail_s) points.pop_front();
    if (!grip) return;
    const Vec3 place = centre_of(world.resource<AtomTable>(), held_atoms(world, hand));
    const bool is_same = !points.empty() && trail.molecule == grip->molecule;
    const bool is_joined = is_same && (points.back().place - place).norm() < longest_step;
    trail.molecule = grip->molecule;
    // The newest point goes along with what is held until it is far enough from the one before.
    const bool is_now = is_joined && points.back().time_s == now_s_;
    const bool is_near = is_joined && points.size() > 1 && points.back().is_joined &&
                         (points[points.size() - 2].place - place).norm() < shortest;
    if (is_now || is_near) {
        points.back() = {now_s_, place, points.back().is_joined};
        return;
    }
    points.push_back({now_s_, place, is_joined});
    if (points.size() > most_points) points.pop_front();
}

std::vector<Vec3> Past::start_of_all(const World& world) const {
    std::vector<Vec3> start = world.resource<AtomTable>().positions;
    world.each<Molecule>([&](Entity entity, const Molecule& molecule) {
        const auto found = starts_.find(entity);
        if (found != starts_.end() && found->second.size() == molecule.atoms.count)
            std::ranges::copy(found->second, start.begin() + molecule.atoms.first);
    });
    return start;
}

void Past::add_ghost(const World& world, std::span<const ResidueSpan> residues,
                     const std::vector<bool>& pocket, FrameScene& frame,
                     std::vector<ViewLabel>& labels) const {
    const AtomTable& atoms = world.resource<AtomTable>();
    const std::vector<Vec3> start = start_of_all(world);
    add_pale_atoms(atoms, start, find_moved(world, start, residues, pocket), frame);
    constexpr float radius = 0.6F, thick = 0.035F;  // Å
    constexpr float pi = std::numbers::pi_v<float>;
    for (const Vec3& rest : rests_) {
        for (const glm::vec3 axis : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)}) {
            const auto [right, up] = across(axis);
            add_arc({as_float(rest), right, up, radius, 2 * pi}, {thick, rest_colour, rest_pick},
                    frame, 2);
        }
        labels.push_back({as_float(rest), "at rest", true});
    }
}

void Past::add_trail(double trail_s, FrameScene& frame) const {
    constexpr float thick = 0.1F, thin = 0.03F;  // Å
    const auto look_at = [&](const Point& point) {
        const auto age =
            static_cast<float>(std::clamp((now_s_ - point.time_s) / trail_s, 0.0, 1.0));
        return LineLook{glm::mix(thick, thin, age), glm::mix(grabbed_carbon, frame.background, age),
                        trail_pick};
    };
    for (const auto& [hand, trail] : trails_) {
        for (std::size_t i = 1; i < trail.points.size(); ++i) {
            const Point &before = trail.points[i - 1], &point = trail.points[i];
            if (!point.is_joined || (point.place - before.place).norm() < no_way) continue;
            add_stick(as_float(before.place), as_float(point.place), look_at(point), frame);
            add_ball(as_float(point.place), look_at(point), frame);
        }
    }
}

std::optional<Vec3> find_resting_place(const World& world, Entity hand) {
    constexpr std::size_t most_pairs = 2000;  // of which a search takes 0.1 s
    const Grip* const grip = world.find<Grip>(hand);
    const GripSettings* const settings = world.find<GripSettings>(hand);
    if (!grip || !settings || !places_atoms(world)) return std::nullopt;
    if (grip->freedom > 1) {
        const Vec3& offset = settings->start_offset;
        return grip->anchor + grip->line_origin - Vec3(0, offset.y(), offset.z());
    }
    const std::size_t pairs = held_range(world, hand).count * count_environment(world, hand);
    if (pairs > most_pairs) return std::nullopt;
    const std::optional<double> distance = equilibrium_distance(world, hand);
    if (!distance) return std::nullopt;
    return grip->anchor + grip->line_origin + *distance * Vec3::UnitX();
}

}  // namespace palpa
