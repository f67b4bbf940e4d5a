#include "prepare/build_positions.h"

#include "core/assertion.h"
#include "forces/torsion.h"
#include "prepare/bond_graph.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>

namespace palpa {
namespace {

using std::numbers::pi;

constexpr double shortest = 1e-6;           // Å, or a sine: below it there is no direction
constexpr double flat = pi / 12;            // how far from flat a table may have a flat dihedral
constexpr double tetrahedral = 1.91063324;  // rad, acos(-1/3)
constexpr double contact = 3;               // Å; heavy atoms are seldom nearer unless bonded

// Zero where there is none.
Vec3 find_unit(const Vec3& v) noexcept {
    const double length = v.norm();
    return length > shortest ? Vec3(v / length) : Vec3::Zero();
}

// Some direction at a right angle; of a zero vector any.
Vec3 find_perpendicular(const Vec3& v) noexcept {
    Eigen::Index smallest = 0;
    v.cwiseAbs().minCoeff(&smallest);
    const Vec3 normal = find_unit(v.cross(Vec3::Unit(smallest)));
    return normal.isZero() ? Vec3::Unit(2) : normal;
}

Vec3 find_unit_or(const Vec3& v, const Vec3& otherwise) noexcept {
    const Vec3 unit = find_unit(v);
    return unit.isZero() ? otherwise : unit;
}

// Where d stands as seen from c, in a chain a-b-c-d of this angle and dihedral.
Vec3 find_chain_direction(const Vec3& a, const Vec3& b, const Vec3& c, double angle,
                          double dihedral) noexcept {
    const Vec3 axis = find_unit_or(c - b, Vec3::Unit(0));
    const Vec3 normal = find_unit_or(find_unit(b - a).cross(axis), find_perpendicular(axis));
    return -std::cos(angle) * axis + std::sin(angle) * (std::cos(dihedral) * normal.cross(axis) +
                                                        std::sin(dihedral) * normal);
}

// The two directions at these angles from two unit vectors; where there is none, in their plane.
std::array<Vec3, 2> find_directions(const Vec3& u, const Vec3& v, double from_u,
                                    double from_v) noexcept {
    const double along = std::clamp(u.dot(v), -1.0, 1.0), sine2 = 1 - along * along;
    const Vec3 normal = find_unit_or(u.cross(v), find_perpendicular(u));
    if (sine2 < shortest) {
        const Vec3 across = normal.cross(find_unit_or(u, Vec3::Unit(0)));
        const Vec3 middle = std::cos(from_u) * u;
        return {find_unit_or(middle + std::sin(from_u) * normal, normal),
                find_unit_or(middle - std::sin(from_u) * normal, across)};
    }
    const double a = (std::cos(from_u) - along * std::cos(from_v)) / sine2;
    const double b = (std::cos(from_v) - along * std::cos(from_u)) / sine2;
    const Vec3 in_plane = a * u + b * v;
    const double height = std::sqrt(std::max(0.0, 1 - in_plane.squaredNorm()));
    return {find_unit_or(in_plane + height * normal, normal),
            find_unit_or(in_plane - height * normal, normal)};
}

double wrapped(double angle) noexcept { return std::remainder(angle, 2 * pi); }

class Builder {
public:
    Builder(const Connectivity& connectivity, const Topology& topology,
            std::span<const AtomCoordinate> lines, std::span<Vec3> positions)
        : graph_(connectivity, topology),
          exclusions_(topology.exclusions),
          lines_(lines),
          positions_(positions) {
        std::vector<std::array<std::uint32_t, 2>> ends;
        for (std::uint32_t i = 0; i < lines.size(); ++i) {
            ends.push_back({lines[i].atoms[0], i});
            ends.push_back({lines[i].atoms[3], i});
        }
        lines_of_ = Lists(ends, positions.size());
    }

    BuiltPositions build() {
        place_heavy_atoms();
        for (std::uint32_t atom = 0; atom < positions_.size(); ++atom) {
            if (!graph_.is_hydrogen(atom) && is_placed(atom)) place_hydrogens(atom);
        }
        for (std::uint32_t atom = 0; atom < positions_.size(); ++atom) {
            if (!is_placed(atom)) result_.unplaced.push_back(atom);
        }
        return std::move(result_);
    }

private:
    // A dihedral reference-pivot-centre-atom.
    struct Turn {
        std::optional<std::uint32_t> reference;
        double dihedral;
        PlacedBy by;
    };
    // A way to place some of a centre's neighbours, as directions from there.
    using Option = std::vector<Vec3>;

    bool is_placed(std::uint32_t atom) const noexcept { return positions_[atom].allFinite(); }

    Vec3 direction(std::uint32_t from, std::uint32_t to) const noexcept {
        return find_unit(positions_[to] - positions_[from]);
    }

    std::vector<std::uint32_t> placed_neighbours(std::uint32_t atom) const {
        std::vector<std::uint32_t> found;
        for (const std::uint32_t other : graph_.neighbours(atom)) {
            if (is_placed(other)) found.push_back(other);
        }
        return found;
    }

    // Without parameters, what follows from the number of neighbours.
    double angle(std::uint32_t a, std::uint32_t centre, std::uint32_t c) const noexcept {
        const std::optional<double> theta0 = graph_.find_angle(a, centre, c);
        if (theta0) return *theta0;
        return graph_.neighbours(centre).size() == 3 ? 2 * pi / 3 : tetrahedral;
    }

    void place(std::uint32_t atom, std::uint32_t centre, const Vec3& towards, PlacedBy by) {
        positions_[atom] = positions_[centre] + graph_.bond_length(centre, atom) * towards;
        result_.placed.push_back({atom, by});
    }

    // How far the dihedrals of the table's lines that end in these atoms are from what they should
    // be, rad, as far as their atoms have places.
    double disagreement(std::span<const std::uint32_t> atoms) const noexcept {
        double sum = 0;
        for (const std::uint32_t atom : atoms) {
            for (const std::uint32_t number : lines_of_.of(atom)) {
                const auto& [a, b, c, d] = lines_[number].atoms;
                if (!(is_placed(a) && is_placed(b) && is_placed(c) && is_placed(d))) continue;
                const double now =
                    evaluate_torsion(positions_[a], positions_[b], positions_[c], positions_[d])
                        .angle;
                sum += std::abs(wrapped(now - lines_[number].dihedral));
            }
        }
        return sum;
    }

    // Places the atoms the way that agrees best with the table; of equals the first.
    void place_best(std::span<const std::uint32_t> atoms, std::uint32_t centre,
                    std::span<const Option> options, PlacedBy by) {
        const auto put = [&](const Option& option) {
            for (std::size_t i = 0; i < atoms.size(); ++i) {
                positions_[atoms[i]] =
                    positions_[centre] + graph_.bond_length(centre, atoms[i]) * option[i];
            }
        };
        std::size_t best = 0;
        double least = 0;
        for (std::size_t i = 0; i < options.size(); ++i) {
            put(options[i]);
            const double error = disagreement(atoms);
            // Half a degree: what is equal but for rounding is equal.
            if (i > 0 && error > least - pi / 360) continue;
            best = i;
            least = error;
        }
        put(options[best]);
        for (const std::uint32_t atom : atoms) result_.placed.push_back({atom, by});
    }

    Turn find_turn(std::uint32_t atom, std::uint32_t centre, std::uint32_t pivot) const noexcept {
        for (const std::uint32_t number : lines_of_.of(atom)) {
            const AtomCoordinate& line = lines_[number];
            if (line.is_improper) continue;
            std::array<std::uint32_t, 4> chain = line.atoms;
            if (chain[3] != atom) std::reverse(chain.begin(), chain.end());
            if (chain[1] != pivot || chain[2] != centre || !is_placed(chain[0])) continue;
            const double flat_value = pi * std::round(line.dihedral / pi);
            const bool is_flat = graph_.is_planar(pivot) && graph_.is_planar(centre) &&
                                 std::abs(line.dihedral - flat_value) < flat;
            return {chain[0], is_flat ? flat_value : line.dihedral, PlacedBy::Table};
        }
        std::optional<std::uint32_t> reference;
        for (const std::uint32_t other : graph_.neighbours(pivot)) {
            if (other == centre || !is_placed(other)) continue;
            if (!reference || (graph_.is_hydrogen(*reference) && !graph_.is_hydrogen(other)))
                reference = other;
        }
        return {reference, pi, PlacedBy::Guess};
    }

    Vec3 direction_of(const Turn& turn, std::uint32_t atom, std::uint32_t centre,
                      std::uint32_t pivot, double further = 0) const noexcept {
        const Vec3 start = turn.reference
                               ? positions_[*turn.reference]
                               : Vec3(positions_[pivot] +
                                      find_perpendicular(positions_[centre] - positions_[pivot]));
        return find_chain_direction(start, positions_[pivot], positions_[centre],
                                    angle(atom, centre, pivot), turn.dihedral + further);
    }

    // Å, to the nearest heavy atom that is not up to three bonds away; at most `contact`.
    double find_room(std::uint32_t atom) const noexcept {
        double least2 = contact * contact;
        for (std::uint32_t other = 0; other < positions_.size(); ++other) {
            const double distance2 = (positions_[other] - positions_[atom]).squaredNorm();
            // Of no atom without a place: a comparison with NaN is false.
            if (!(distance2 < least2) || other == atom || graph_.is_hydrogen(other)) continue;
            const auto excluded = exclusions_.of(std::min(atom, other));
            if (std::ranges::binary_search(excluded, std::max(atom, other))) continue;
            least2 = distance2;
        }
        return std::sqrt(least2);
    }

    // Where the bond between them is cut, one cannot be reached from the other.
    bool is_in_ring(std::uint32_t centre, std::uint32_t pivot) const {
        std::vector<std::uint32_t> seen{pivot};
        for (std::size_t i = 0, bonds_left = 7, end = 1; i < seen.size(); ++i) {
            if (i == end) {
                end = seen.size();
                if (--bonds_left == 0) return false;
            }
            for (const std::uint32_t other : graph_.neighbours(seen[i])) {
                if (other == centre && i > 0) return true;
                if (other == centre || std::ranges::count(seen, other) != 0) continue;
                seen.push_back(other);
            }
        }
        return false;
    }

    // An atom that the table has upon another, on a bond that turns freely, takes the roomiest of
    // the three staggered places.
    void avoid_contact(std::uint32_t atom, std::uint32_t centre, std::uint32_t pivot,
                       const Turn& turn) {
        if (graph_.is_planar(centre) || graph_.is_planar(pivot) || is_in_ring(centre, pivot))
            return;
        double room = find_room(atom);
        Vec3 best = positions_[atom];
        for (const double further : {2 * pi / 3, -2 * pi / 3}) {
            if (room >= contact) break;
            positions_[atom] =
                positions_[centre] +
                graph_.bond_length(centre, atom) * direction_of(turn, atom, centre, pivot, further);
            const double here = find_room(atom);
            if (here <= room) continue;
            room = here;
            best = positions_[atom];
        }
        positions_[atom] = best;
    }

    // Where a planar centre leaves room beside two neighbours: the angle around it that they do not
    // take, shared out as the parameters differ.
    Vec3 in_plane(std::uint32_t atom, std::uint32_t centre, std::uint32_t a,
                  std::uint32_t b) const noexcept {
        const Vec3 u = direction(centre, a), v = direction(centre, b);
        const double between = std::acos(std::clamp(u.dot(v), -1.0, 1.0));
        const double from_u =
            pi - 0.5 * between + 0.5 * (angle(atom, centre, a) - angle(atom, centre, b));
        const Vec3 across = find_unit_or(v - u.dot(v) * u, find_perpendicular(u));
        return find_unit_or(std::cos(from_u) * u - std::sin(from_u) * across, across);
    }

    // Away from all neighbours; where they cancel out, at a right angle to two of them.
    Vec3 away(std::uint32_t centre, std::span<const std::uint32_t> neighbours) const noexcept {
        Vec3 sum = Vec3::Zero();
        for (const std::uint32_t other : neighbours) sum += direction(centre, other);
        const Vec3 first = direction(centre, neighbours[0]);
        if (sum.norm() > 1e-3) return -sum.normalized();
        return find_unit_or(first.cross(direction(centre, neighbours.back())),
                            find_perpendicular(first));
    }

    // One more neighbour of the centre, beside those that have places.
    void place_one(std::uint32_t atom, std::uint32_t centre,
                   std::span<const std::uint32_t> placed) {
        const std::size_t degree = graph_.neighbours(centre).size();
        if (placed.empty()) {
            place(atom, centre, Vec3::Unit(0), PlacedBy::Guess);
        } else if (placed.size() == 1) {
            const Turn turn = find_turn(atom, centre, placed[0]);
            place(atom, centre, direction_of(turn, atom, centre, placed[0]), turn.by);
            if (!graph_.is_hydrogen(atom)) avoid_contact(atom, centre, placed[0], turn);
        } else if (placed.size() == 2 && graph_.is_planar(centre)) {
            place(atom, centre, in_plane(atom, centre, placed[0], placed[1]), PlacedBy::Neighbours);
        } else if (placed.size() == 2 && degree <= 4) {
            const auto sides =
                find_directions(direction(centre, placed[0]), direction(centre, placed[1]),
                                angle(atom, centre, placed[0]), angle(atom, centre, placed[1]));
            place_best(std::array{atom}, centre, std::array<Option, 2>{{{sides[0]}, {sides[1]}}},
                       PlacedBy::Neighbours);
        } else {
            place(atom, centre, away(centre, placed), PlacedBy::Neighbours);
        }
    }

    // Both hydrogens of a tetrahedral centre.
    void place_pair(std::span<const std::uint32_t> atoms, std::uint32_t centre,
                    std::span<const std::uint32_t> placed) {
        const Vec3 u = direction(centre, placed[0]), v = direction(centre, placed[1]);
        const Vec3 normal = find_unit_or(u.cross(v), find_perpendicular(u));
        const Vec3 bisector = find_unit_or(-(u + v), find_unit_or(normal.cross(u), Vec3::Unit(0)));
        const double half = 0.5 * angle(atoms[0], centre, atoms[1]);
        const Vec3 one = std::cos(half) * bisector + std::sin(half) * normal;
        const Vec3 other = std::cos(half) * bisector - std::sin(half) * normal;
        place_best(atoms, centre, std::array<Option, 2>{{{one, other}, {other, one}}},
                   PlacedBy::Neighbours);
    }

    // Three hydrogens on one neighbour.
    void place_three(std::span<const std::uint32_t> atoms, std::uint32_t centre,
                     std::uint32_t pivot) {
        // The table may give a dihedral for any one of them.
        std::size_t first = 0;
        Turn turn = find_turn(atoms[0], centre, pivot);
        for (std::size_t i = 1; i < 3 && turn.by == PlacedBy::Guess; ++i) {
            const Turn other = find_turn(atoms[i], centre, pivot);
            if (other.by == PlacedBy::Table) {
                turn = other;
                first = i;
            }
        }
        const auto option = [&](double further) {
            Option directions(3);
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t atom = atoms[(first + i) % 3];
                directions[(first + i) % 3] =
                    direction_of(turn, atom, centre, pivot, static_cast<double>(i) * further);
            }
            return directions;
        };
        place_best(atoms, centre, std::array{option(2 * pi / 3), option(-2 * pi / 3)}, turn.by);
    }

    void place_hydrogens(std::uint32_t centre) {
        std::vector<std::uint32_t> missing;
        for (const std::uint32_t other : graph_.neighbours(centre)) {
            if (graph_.is_hydrogen(other) && !is_placed(other)) missing.push_back(other);
        }
        const bool is_tetrahedral = graph_.neighbours(centre).size() == 4;
        for (std::span<const std::uint32_t> left = missing; !left.empty();) {
            const std::vector<std::uint32_t> placed = placed_neighbours(centre);
            if (is_tetrahedral && placed.size() == 1 && left.size() == 3) {
                place_three(left, centre, placed[0]);
                return;
            }
            if (is_tetrahedral && placed.size() == 2 && left.size() == 2) {
                place_pair(left, centre, placed);
                return;
            }
            place_one(left[0], centre, placed);
            left = left.subspan(1);
        }
    }

    // The neighbour to build a heavy atom on: one that settles where it is, if there is one.
    struct Base {
        std::uint32_t centre;
        bool is_guess;
    };
    std::optional<Base> find_base(std::uint32_t atom) const {
        std::optional<Base> base;
        for (const std::uint32_t centre : graph_.neighbours(atom)) {
            if (!is_placed(centre)) continue;
            const std::vector<std::uint32_t> placed = placed_neighbours(centre);
            if (placed.empty()) continue;
            const bool is_guess =
                placed.size() == 1 && find_turn(atom, centre, placed[0]).by == PlacedBy::Guess;
            if (!base || (base->is_guess && !is_guess)) base = Base{centre, is_guess};
        }
        return base;
    }

    // Those that the table or their surroundings settle first; a guess only where nothing else is
    // left to do.
    void place_heavy_atoms() {
        std::vector<std::uint32_t> missing;
        for (std::uint32_t atom = 0; atom < positions_.size(); ++atom) {
            if (!graph_.is_hydrogen(atom) && !is_placed(atom)) missing.push_back(atom);
        }
        for (bool may_guess = false;;) {
            const std::size_t before = missing.size();
            bool has_guessed = false;
            std::erase_if(missing, [&](std::uint32_t atom) {
                const std::optional<Base> base = find_base(atom);
                if (!base || has_guessed || (base->is_guess && !may_guess)) return false;
                has_guessed = base->is_guess;
                place_one(atom, base->centre, placed_neighbours(base->centre));
                close_ring(atom, base->centre);
                return true;
            });
            if (missing.empty() || (missing.size() == before && may_guess)) return;
            may_guess = missing.size() == before;
        }
    }

    // Moves an atom between two placed neighbours to where both bonds have their length, as near by
    // as that can be; leaves it alone where no place has them.
    void close_ring(std::uint32_t atom, std::uint32_t centre) {
        for (const std::uint32_t other : graph_.neighbours(atom)) {
            if (other == centre || !is_placed(other)) continue;
            const double r = graph_.bond_length(centre, atom), s = graph_.bond_length(other, atom);
            const Vec3 between = positions_[other] - positions_[centre];
            const double distance = between.norm();
            if (distance < shortest) continue;
            const Vec3 axis = between / distance;
            const double along = (distance * distance + r * r - s * s) / (2 * distance);
            const double radius2 = r * r - along * along;
            if (radius2 < 0) continue;
            const Vec3 now = positions_[atom] - positions_[centre];
            const Vec3 across = find_unit_or(now - now.dot(axis) * axis, find_perpendicular(axis));
            positions_[atom] = positions_[centre] + along * axis + std::sqrt(radius2) * across;
            return;
        }
    }

    BondGraph graph_;
    const Exclusions& exclusions_;
    std::span<const AtomCoordinate> lines_;
    Lists lines_of_;  // by their ends
    std::span<Vec3> positions_;
    BuiltPositions result_;
};

}  // namespace

BuiltPositions build_positions(const Connectivity& connectivity, const Topology& topology,
                               std::span<const AtomCoordinate> coordinates,
                               std::span<Vec3> positions) {
    PALPA_ASSERT(connectivity.names.size() == positions.size() &&
                 topology.size() == positions.size());
    return Builder(connectivity, topology, coordinates, positions).build();
}

}  // namespace palpa
