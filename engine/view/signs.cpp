#include "view/signs.h"

#include "view/lines.h"
#include "view/palette.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace palpa {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr glm::vec3 ring_colour{0.02F};

// A line that starts at a place, and how wide around it there must be room.
struct Ray {
    glm::vec3 from, along;
    float clearance;
};

// Where the ray is inside of a sphere, widened by the clearance; nothing where they do not meet.
struct Stretch {
    float begin = 0, end = 0;
    bool is_empty() const { return !(begin < end); }
};
Stretch inside(const Ray& ray, const SphereShape& sphere) {
    const glm::vec3 off = sphere.centre - ray.from;
    const float middle = glm::dot(off, ray.along);
    const float reach = sphere.radius + ray.clearance;
    const float square = reach * reach - (glm::dot(off, off) - middle * middle);
    if (!(square > 0)) return {};
    const float half = std::sqrt(square);
    return {middle - half, middle + half};
}

// How far it is from the ray's start out of the molecule: to the first gap among its atoms that is
// no bond's.
float way_out(const Ray& ray, const HeldMolecule& held, const FrameScene& frame) {
    constexpr float widest_bond_gap = 1.5F;  // Å
    std::vector<Stretch> stretches;
    for (const SphereShape& sphere : frame.spheres) {
        if (!has_atom(held.atoms, sphere.pick)) continue;
        const Stretch stretch = inside(ray, sphere);
        if (!stretch.is_empty() && stretch.end > 0) stretches.push_back(stretch);
    }
    std::ranges::sort(stretches, {}, &Stretch::begin);
    float out = 0;
    for (const Stretch& stretch : stretches) {
        if (stretch.begin > out + widest_bond_gap) break;
        out = std::max(out, stretch.end);
    }
    return out;
}

// How far it is from there to the next atom of others.
float free_way(const Ray& ray, float start, const HeldMolecule& held, const FrameScene& frame) {
    float free = std::numeric_limits<float>::infinity();
    for (const SphereShape& sphere : frame.spheres) {
        if (has_atom(held.atoms, sphere.pick) || sphere.pick >= first_sign_pick) continue;
        const Stretch stretch = inside(ray, sphere);
        if (!stretch.is_empty() && stretch.end > start) {
            free = std::min(free, std::max(stretch.begin - start, 0.0F));
        }
    }
    return free;
}

float head_length(float arrow, float decade) { return std::min(0.55F * decade, 0.6F * arrow); }

std::string with_unit(double value, const char* unit) {
    return value < 0.1 ? fmt::format("{:.0f} p{}", 1e3 * value, unit)
                       : fmt::format("{:.3g} n{}", value, unit);
}

}  // namespace

float decade_of(const HeldMolecule& held, const FrameScene& frame) {
    constexpr float share = 0.12F, least = 0.8F, most = 2.4F;  // of the molecule's radius; Å
    float radius = 0;
    for (const SphereShape& sphere : frame.spheres) {
        if (!has_atom(held.atoms, sphere.pick)) continue;
        radius = std::max(radius, glm::distance(sphere.centre, held.centre));
    }
    return std::clamp(share * radius, least, most);
}

float arrow_length(double force_nN, float decade) {
    if (!(force_nN > least_shown_nN)) return 0;
    const double decades = std::log10(std::min(force_nN, most_shown_nN) / least_shown_nN);
    return static_cast<float>(decades) * decade;
}

void add_arrow(const glm::vec3& tail, const glm::vec3& tip, float decade, std::uint32_t pick,
               FrameScene& frame) {
    const float length = glm::distance(tail, tip);
    if (!(length > 0)) return;
    const float head = head_length(length, decade);
    const glm::vec3 neck = tip - head / length * (tip - tail);
    add_stick(tail, neck, {0.11F * decade, force_colour, pick}, frame);
    add_head(neck, tip, {std::min(0.3F * decade, 0.6F * head), force_colour, pick}, frame);
}

std::string force_in_words(double force_nN) { return with_unit(force_nN, "N"); }

void add_force(const glm::vec3& force_nN, const HeldMolecule& held, FrameScene& frame,
               std::vector<ViewLabel>& labels) {
    const auto size = static_cast<double>(glm::length(force_nN));
    if (!(size > least_shown_nN)) return;
    const float decade = decade_of(held, frame);
    const float length = arrow_length(size, decade);
    const float thin = 0.11F * decade, gap = 0.15F * decade;
    const float head = head_length(length, decade);

    const glm::vec3 along = force_nN / static_cast<float>(size);
    const Ray ahead{held.place, along, thin}, behind{held.place, -along, thin};
    const float out_ahead = way_out(ahead, held, frame) + gap;
    const float out_behind = way_out(behind, held, frame) + gap;
    const float free_ahead = free_way(ahead, out_ahead, held, frame);
    const float free_behind = free_way(behind, out_behind, held, frame);
    const bool comes_from_behind = free_ahead < length + gap && free_behind > free_ahead + decade;
    const glm::vec3 tail =
        held.place + (comes_from_behind ? -(out_behind + length) : out_ahead) * along;

    const glm::vec3 tip = tail + length * along;
    add_arrow(tail, tip, decade, arrow_pick, frame);
    for (int tick = 1; static_cast<float>(tick) * decade < length - head; ++tick) {
        const glm::vec3 place = tail + static_cast<float>(tick) * decade * along;
        add_disc(place, along, {0.19F * decade, ring_colour, arrow_pick}, frame);
        labels.push_back({place, fmt::format("{:g}", least_shown_nN * std::pow(10, tick)), true});
    }
    labels.push_back({comes_from_behind ? tail : tip, force_in_words(size)});
}

void add_torque(const glm::vec3& torque_angstrom_nN, const HeldMolecule& held, FrameScene& frame,
                std::vector<ViewLabel>& labels) {
    const auto size = static_cast<double>(glm::length(torque_angstrom_nN));
    if (!(size > least_shown_angstrom_nN)) return;
    constexpr float each = pi / 3, most = 11 * pi / 6;  // rad
    const float sweep =
        std::min(each * static_cast<float>(std::log10(size / least_shown_angstrom_nN)), most);
    const float decade = decade_of(held, frame);
    const float radius = 0.8F * decade, thin = 0.07F * decade;
    const glm::vec3 axis = torque_angstrom_nN / static_cast<float>(size);
    const float out = way_out({held.centre, axis, radius + thin}, held, frame);
    const glm::vec3 foot = held.centre + out * axis;
    const glm::vec3 middle = foot + 0.5F * decade * axis;
    const glm::vec3 top = middle + 0.35F * decade * axis;
    add_stick(foot, top, {0.5F * thin, force_colour, torque_pick}, frame);

    const auto [right, up] = across(axis);
    const float head = std::min(0.5F * decade / radius, 0.6F * sweep);  // rad
    const Arc arc{middle, right, up, radius, sweep - head};
    add_arc(arc, {thin, force_colour, torque_pick}, frame);
    const glm::vec3 neck = arc.place(sweep - head);
    const glm::vec3 tangent = glm::normalize(arc.place(sweep) - neck);
    add_head(neck, neck + head * radius * tangent, {0.22F * decade, force_colour, torque_pick},
             frame);
    labels.push_back({arc.place(sweep), with_unit(size, "N Å")});
}

std::vector<float> find_drawn_radii(const FrameScene& frame, std::size_t atoms) {
    std::vector<float> radii(atoms, 0);
    for (const SphereShape& sphere : frame.spheres)
        if (sphere.pick < atoms) radii[sphere.pick] = sphere.radius;
    return radii;
}

void add_hydrogen_bonds(const AtomTable& atoms, std::span<const HydrogenBond> bonds,
                        FrameScene& frame, std::vector<ViewLabel>& labels) {
    constexpr float dash = 0.16F, radius = 0.06F, least = 0.2F;  // Å
    constexpr std::size_t most_labels = 4;
    if (bonds.empty()) return;
    const std::vector<float> radius_of = find_drawn_radii(frame, atoms.size());
    std::size_t drawn = 0;
    for (const HydrogenBond& bond : bonds) {
        const auto place_of = [&](std::uint32_t atom) {
            return glm::vec3(atoms.positions[atom].x(), atoms.positions[atom].y(),
                             atoms.positions[atom].z());
        };
        const glm::vec3 from = place_of(bond.hydrogen), to = place_of(bond.acceptor);
        const glm::vec3 along = glm::normalize(to - from);
        const glm::vec3 a = from + (radius_of[bond.hydrogen] + radius) * along;
        const glm::vec3 b = to - (radius_of[bond.acceptor] + radius) * along;
        if (!(glm::dot(b - a, along) > least)) continue;
        add_dashes(a, b, dash, {radius, hydrogen_bond_colour, hydrogen_bond_pick}, frame);
        if (drawn++ == 0 || bonds.size() <= most_labels) {
            labels.push_back({0.5F * (a + b), fmt::format("{:.2f} Å", bond.length)});
        }
    }
}

void add_snap(const glm::vec3& place, double released, FrameScene& frame,
              std::vector<ViewLabel>& labels) {
    constexpr float radius = 1.1F, thick = 0.06F;  // Å
    for (const glm::vec3 axis : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)}) {
        const auto [first, second] = across(axis);
        add_arc({place, first, second, radius, 2 * pi}, {thick, force_colour, snap_pick}, frame, 2);
    }
    labels.push_back({place, fmt::format("snap, {:.0f} kcal/mol released", released)});
}

void add_wish(const glm::vec3& place, const glm::vec3& wish, const glm::vec3& towards_eye,
              FrameScene& frame) {
    constexpr float shown_from = 0.1F, dash = 0.22F, thread = 0.035F;  // Å
    constexpr float ring = 0.50F, thick = 0.05F;
    const float length = glm::distance(place, wish);
    if (!(length > shown_from)) return;
    add_dashes(place, place + std::max(1 - ring / length, 0.5F) * (wish - place), dash,
               {thread, wish_colour, wish_pick}, frame);
    const auto [right, up] = across(glm::normalize(towards_eye));
    add_arc({wish, right, up, ring, 2 * pi}, {thick, wish_colour, wish_pick}, frame);
}

}  // namespace palpa
