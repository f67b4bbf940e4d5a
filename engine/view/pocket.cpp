#include "view/pocket.h"

#include "simulation/components.h"
#include "simulation/held.h"
#include "simulation/resources.h"
#include "view/build_frame.h"
#include "view/in_hand.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>

namespace palpa {
namespace {

constexpr double near_by = 4.5;       // Å
constexpr float longest_step = 4.5F;  // Å, from one CA to the next
constexpr float tube_radius = 0.30F;  // Å
constexpr int pieces_a_residue = 6;

// Places by cells as wide as what is near, so that only neighbouring ones are looked at.
class PlacesByCell {
public:
    explicit PlacesByCell(std::span<const Vec3> places) {
        for (const Vec3& place : places) places_.push_back({cell_of(place), place});
        std::ranges::sort(places_, {}, &Entry::cell);
        for (const Entry& entry : places_) box_.extend(entry.place);
    }

    bool has_near(const Vec3& of) const {
        if (!(box_.squaredExteriorDistance(of) < near_by * near_by)) return false;
        const auto [x, y, z] = cell_of(of);
        for (const double dx : {-1, 0, 1}) {
            for (const double dy : {-1, 0, 1}) {
                const Cell last{x + dx, y + dy, z + 1};
                auto entry = std::ranges::lower_bound(places_, Cell{x + dx, y + dy, z - 1}, {},
                                                      &Entry::cell);
                for (; entry != places_.end() && entry->cell <= last; ++entry) {
                    if ((entry->place - of).squaredNorm() < near_by * near_by) return true;
                }
            }
        }
        return false;
    }

private:
    using Cell = std::array<double, 3>;
    struct Entry {
        Cell cell;
        Vec3 place;
    };
    static Cell cell_of(const Vec3& place) {
        const Vec3 cell = (place / near_by).array().floor();
        return {cell.x(), cell.y(), cell.z()};
    }

    std::vector<Entry> places_;
    Eigen::AlignedBox3d box_;
};

// Which atoms of others are near to the grabbed molecule.
std::vector<bool> find_near(const World& world) {
    const std::vector<Vec3>& places = world.resource<AtomTable>().positions;
    const std::vector<bool> held = find_in_hand(world);
    std::vector<Vec3> in_hand;
    for (std::size_t i = 0; i < held.size(); ++i)
        if (held[i]) in_hand.push_back(places[i]);
    const PlacesByCell by_cell(in_hand);
    std::vector<bool> near(places.size(), false);
    for (std::size_t i = 0; i < places.size(); ++i)
        near[i] = !held[i] && by_cell.has_near(places[i]);
    return near;
}

// Of one molecule: another one beside it may have the same names.
void add_residues(const AtomTable& atoms, AtomRange range, std::vector<ResidueSpan>& residues) {
    const std::size_t end = range.first + range.count;
    for (std::size_t first = range.first; first < end;) {
        ResidueSpan residue{first, first + 1, 0};
        while (residue.end < end && is_same_residue(atoms.names[residue.end], atoms.names[first]))
            ++residue.end;
        residue.alpha = residue.end;
        for (std::size_t i = first; i < residue.end; ++i) {
            const bool is_calcium = residue.end - first == 1;
            if (atoms.names[i].atom == "CA" && !is_calcium) residue.alpha = i;
        }
        residues.push_back(residue);
        first = residue.end;
    }
}

void add_tube(std::span<const std::size_t> alphas, std::span<const Vec3> places,
              std::span<const glm::vec3> colours, FrameScene& frame) {
    // The ends stand three times, so that the curve begins and ends there.
    const auto count = static_cast<std::ptrdiff_t>(alphas.size());
    const auto atom_at = [&](std::ptrdiff_t i) {
        return alphas[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, count - 1))];
    };
    const auto control = [&](std::ptrdiff_t i) { return as_float(places[atom_at(i)]); };
    const auto curve = [&](std::ptrdiff_t i, float t) {
        const float u = 1 - t;
        return (u * u * u * control(i - 1) + (3 * t * t * t - 6 * t * t + 4) * control(i) +
                (3 * u * u * u - 6 * u * u + 4) * control(i + 1) + t * t * t * control(i + 2)) /
               6.0F;
    };
    for (std::ptrdiff_t i = -1; i < count; ++i) {
        for (int piece = 0; piece < pieces_a_residue; ++piece) {
            const auto at = [&](int k) {
                return curve(i, static_cast<float>(k) / pieces_a_residue);
            };
            const std::size_t atom = atom_at(piece < pieces_a_residue / 2 ? i : i + 1);
            const auto pick = static_cast<std::uint32_t>(atom);
            const glm::vec3 a = at(piece), b = at(piece + 1);
            frame.cones.push_back(
                {a, b, tube_radius, tube_radius, colours[atom], colours[atom], pick});
            frame.spheres.push_back({b, tube_radius, colours[atom], pick});
        }
    }
    frame.spheres.push_back(
        {curve(-1, 0), tube_radius, colours[atom_at(0)], static_cast<std::uint32_t>(atom_at(0))});
}

}  // namespace

std::vector<ResidueSpan> find_residues(const World& world) {
    const AtomTable& atoms = world.resource<AtomTable>();
    const Grip* const grip = world.find<Grip>(first_hand(world));
    std::vector<ResidueSpan> residues;
    world.each<Molecule>([&](Entity entity, const Molecule& molecule) {
        if (!grip || entity != grip->molecule) add_residues(atoms, molecule.atoms, residues);
    });
    return residues;
}

std::vector<bool> find_pocket(const World& world, std::span<const ResidueSpan> residues) {
    const std::vector<bool> near = find_near(world);
    std::vector<bool> shown(world.resource<AtomTable>().size(), false);
    for (const ResidueSpan& residue : residues) {
        const auto begin = near.begin();
        const bool stands = residue.alpha == residue.end ||
                            std::any_of(begin + static_cast<std::ptrdiff_t>(residue.first),
                                        begin + static_cast<std::ptrdiff_t>(residue.end),
                                        [](bool is_near) { return is_near; });
        for (std::size_t i = residue.first; i < residue.end; ++i) shown[i] = stands;
    }
    return shown;
}

void add_backbones(const AtomTable& atoms, std::span<const ResidueSpan> residues,
                   std::span<const glm::vec3> colours, FrameScene& frame) {
    std::vector<std::size_t> alphas;
    const auto finish = [&] {
        if (alphas.size() > 1) add_tube(alphas, atoms.positions, colours, frame);
        alphas.clear();
    };
    for (const ResidueSpan& residue : residues) {
        if (residue.alpha == residue.end) continue;
        if (!alphas.empty()) {
            const std::size_t last = alphas.back();
            const bool follows =
                atoms.names[last].segment == atoms.names[residue.alpha].segment &&
                (atoms.positions[last] - atoms.positions[residue.alpha]).norm() < longest_step;
            if (!follows) finish();
        }
        alphas.push_back(residue.alpha);
    }
    finish();
}

}  // namespace palpa
