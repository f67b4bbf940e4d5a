#include "prepare/orient.h"

#include "core/assertion.h"
#include "field/pair_field.h"
#include "forces/torsion.h"
#include "math/eigenvectors.h"
#include "molecule/point_grid.h"
#include "prepare/bond_graph.h"
#include "prepare/turning_groups.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

namespace palpa {
namespace {

using std::numbers::pi;
using Quaternion = Eigen::Quaterniond;

constexpr double least_gain = 1e-3;  // kcal/mol; below it nothing has changed
constexpr double least_turn = 0.05;  // Å; below it others need not look again
constexpr double influence = 6;      // Å; within it others look again
constexpr double near_range = 6;     // Å; all that a first look at a water's rotations counts
constexpr int looks = 2;             // how often a water looks at all rotations, not at small ones
constexpr double grid_step = pi / 18;  // rad
constexpr double fine_step = pi / 720;

// All rotations, about 30 degree apart: directions on a spiral over the sphere, each with a turn
// about itself.
std::vector<Quaternion> make_rotations() {
    constexpr int directions = 32, turns = 10;
    std::vector<Quaternion> rotations;
    for (int i = 0; i < directions; ++i) {
        const double z = 1 - (2.0 * i + 1) / directions, around = i * pi * (3 - std::sqrt(5.0));
        const double radius = std::sqrt(1 - z * z);
        const Vec3 direction(radius * std::cos(around), radius * std::sin(around), z);
        const Quaternion to_direction = turn_between(Vec3::UnitZ(), direction);
        for (int j = 0; j < turns; ++j) {
            rotations.push_back(to_direction *
                                Eigen::AngleAxisd(2 * pi * j / turns, Vec3::UnitZ()));
        }
    }
    return rotations;
}

class Orienter {
public:
    Orienter(const Connectivity& connectivity, const Topology& topology,
             std::span<const std::uint32_t> built, const OrientSettings& settings,
             std::span<Vec3> positions)
        : topology_(topology),
          settings_(settings),
          positions_(positions),
          graph_(connectivity, topology),
          groups_(find_turning_groups(graph_, built, positions.size(), settings)),
          rotations_(make_rotations()),
          excluded_(find_excluded(topology)),
          pairs14_(find_pairs14(topology)),
          grid_(find_anchors()),
          of_centre_(find_groups_of_centres()),
          nonbonded_(nonbonded_settings(settings)),
          is_waiting_(groups_.size(), true),
          looks_(groups_.size(), 0) {
        add_terms();
    }

    OrientReport run() {
        OrientReport report;
        for (const TurningGroup& group : groups_) {
            OrientedGroup& entry = report.groups.emplace_back();
            entry.kind = group.kind;
            entry.atom = group.centre;
            entry.moved = group.moved;
            entry.dihedral_before = dihedral(group);
            entry.energy_before = energy_now(group);
        }
        settle(report);
        for (std::size_t i = 0; i < groups_.size(); ++i) {
            report.groups[i].dihedral_after = dihedral(groups_[i]);
            report.groups[i].energy_after = energy_now(groups_[i]);
        }
        report.energy_change = change_;
        return report;
    }

private:
    // An atom that a moved one interacts with, and by which numbers.
    struct Partner {
        Vec3 place;
        double charges;  // C q q', kcal Å/mol
        double epsilon, rmin2;
    };

    struct Partners {
        std::vector<Partner> all;
        std::size_t near = 0;  // how many, the first ones, are within near_range of the centre
    };
    enum class Extent { Near, All };

    // Both ways round, beside what `Exclusions` holds.
    static Lists find_excluded(const Topology& topology) {
        std::vector<std::array<std::uint32_t, 2>> entries;
        for (std::uint32_t i = 0; i < topology.size(); ++i) {
            for (const std::uint32_t j : topology.exclusions.of(i)) {
                entries.push_back({i, j});
                entries.push_back({j, i});
            }
        }
        return {entries, topology.size()};
    }
    static Lists find_pairs14(const Topology& topology) {
        std::vector<std::array<std::uint32_t, 2>> entries;
        for (const auto& [i, j] : topology.exclusions.pairs14) {
            entries.push_back({i, j});
            entries.push_back({j, i});
        }
        return {entries, topology.size()};
    }

    std::vector<Vec3> find_anchors() {
        std::vector<Vec3> anchors(positions_.begin(), positions_.end());
        for (TurningGroup& group : groups_) {
            for (const std::uint32_t atom : group.moved) {
                anchors[atom] = positions_[group.centre];
                const double reach = (positions_[atom] - positions_[group.centre]).norm();
                group.reach = std::max(group.reach, reach);
            }
            largest_reach_ = std::max(largest_reach_, group.reach);
        }
        return anchors;
    }

    Lists find_groups_of_centres() const {
        std::vector<std::array<std::uint32_t, 2>> entries;
        for (std::uint32_t i = 0; i < groups_.size(); ++i) {
            entries.push_back({groups_[i].centre, i});
        }
        return {entries, positions_.size()};
    }

    void add_terms() {
        std::vector<std::array<std::uint32_t, 2>> entries;
        for (std::uint32_t i = 0; i < groups_.size(); ++i) {
            for (const std::uint32_t atom : groups_[i].moved) entries.push_back({atom, i});
        }
        const Lists groups_of(entries, positions_.size());
        const auto add = [&](const auto& terms, std::vector<std::uint32_t> TurningGroup::* into) {
            for (std::uint32_t i = 0; i < terms.size(); ++i) {
                for (const std::uint32_t atom : {terms[i].a, terms[i].b, terms[i].c, terms[i].d}) {
                    for (const std::uint32_t number : groups_of.of(atom)) {
                        std::vector<std::uint32_t>& list = groups_[number].*into;
                        if (list.empty() || list.back() != i) list.push_back(i);
                    }
                }
            }
        };
        add(topology_.dihedrals, &TurningGroup::dihedrals);
        add(topology_.impropers, &TurningGroup::impropers);
    }

    // Of the first moved atom about the axis.
    double dihedral(const TurningGroup& group) const noexcept {
        if (!group.axis) return 0;
        for (const std::uint32_t other : graph_.neighbours(*group.axis)) {
            if (other == group.centre || graph_.is_hydrogen(other)) continue;
            return evaluate_torsion(positions_[other], positions_[*group.axis],
                                    positions_[group.centre], positions_[group.moved[0]])
                .angle;
        }
        return 0;
    }

    // Lists for each moved atom of the group what it interacts with beside the group itself, as
    // things stand. Those out of reach of the cutoff whatever the group does are left out.
    void gather(const TurningGroup& group) {
        if (partners_.size() < group.moved.size()) partners_.resize(group.moved.size());
        for (Partners& list : partners_) list.all.clear();
        const auto is_moved = [&](std::uint32_t atom) {
            return std::find(group.moved.begin(), group.moved.end(), atom) != group.moved.end();
        };
        const auto add = [&](std::size_t slot, std::uint32_t atom, const LennardJonesTable& table) {
            const std::uint32_t own = group.moved[slot];
            const LennardJonesPair& pair = table.row(topology_.type[own])[topology_.type[atom]];
            partners_[slot].all.push_back(
                {positions_[atom],
                 nonbonded_.coulomb_constant * topology_.charge[own] * topology_.charge[atom],
                 pair.epsilon, pair.rmin * pair.rmin});
        };
        const Vec3 centre = positions_[group.centre];
        const double range = settings_.cutoff + group.reach;
        near_.clear();
        grid_.visit_near(centre, range + largest_reach_, [&](std::uint32_t atom) {
            if ((positions_[atom] - centre).squaredNorm() < range * range && !is_moved(atom))
                near_.push_back(atom);
        });
        for (std::size_t slot = 0; slot < group.moved.size(); ++slot) {
            const auto excluded = excluded_.of(group.moved[slot]);
            for (const std::uint32_t atom : near_) {
                if (std::find(excluded.begin(), excluded.end(), atom) == excluded.end())
                    add(slot, atom, topology_.lennard_jones);
            }
            for (const std::uint32_t atom : pairs14_.of(group.moved[slot])) {
                if (!is_moved(atom)) add(slot, atom, topology_.lennard_jones14);
            }
            std::vector<Partner>& all = partners_[slot].all;
            const auto near_end = std::partition(all.begin(), all.end(), [&](const Partner& other) {
                return (other.place - centre).squaredNorm() < near_range * near_range;
            });
            partners_[slot].near = static_cast<std::size_t>(near_end - all.begin());
        }
    }

    // As forces/nonbonded.h has FSHIFT and VSWITCH. Inside the core the energy stays what it is at
    // its edge.
    double pair_energy(const Vec3& place, const Partner& partner) const noexcept {
        const double c2 = settings_.cutoff * settings_.cutoff;
        const double m2 = settings_.switch_from * settings_.switch_from;
        const double r2 =
            std::max((place - partner.place).squaredNorm(), pair_core_radius * pair_core_radius);
        if (r2 >= c2) return 0;
        const double r = std::sqrt(r2), left = 1 - r / settings_.cutoff, s2 = partner.rmin2 / r2;
        const double s6 = s2 * s2 * s2;
        double lennard_jones = partner.epsilon * (s6 * s6 - 2 * s6);
        if (r2 > m2) {
            const double width = c2 - m2;
            lennard_jones *=
                (c2 - r2) * (c2 - r2) * (c2 + 2 * r2 - 3 * m2) / (width * width * width);
        }
        return lennard_jones + partner.charges / r * left * left;
    }

    // Of what was gathered, at the group's present positions.
    double energy(const TurningGroup& group, Extent extent) const noexcept {
        double sum = 0;
        for (std::size_t slot = 0; slot < group.moved.size(); ++slot) {
            const Vec3 place = positions_[group.moved[slot]];
            const std::span<const Partner> all = partners_[slot].all;
            for (const Partner& partner :
                 extent == Extent::All ? all : all.first(partners_[slot].near)) {
                sum += pair_energy(place, partner);
            }
        }
        const auto angle = [&](const auto& term) {
            return evaluate_torsion(positions_[term.a], positions_[term.b], positions_[term.c],
                                    positions_[term.d])
                .angle;
        };
        for (const std::uint32_t number : group.dihedrals) {
            const Dihedral& term = topology_.dihedrals[number];
            sum += term.k * (1 + std::cos(term.multiplicity * angle(term) - term.phase));
        }
        for (const std::uint32_t number : group.impropers) {
            const Improper& term = topology_.impropers[number];
            const double off = std::remainder(angle(term) - term.psi0, 2 * pi);
            sum += term.k * off * off;
        }
        return sum;
    }

    double energy_now(const TurningGroup& group) {
        gather(group);
        return energy(group, Extent::All);
    }

    void put(const TurningGroup& group, std::span<const Vec3> start,
             const Quaternion& rotation) noexcept {
        const Mat3 matrix = rotation.toRotationMatrix();
        const Vec3 centre = positions_[group.centre];
        for (std::size_t i = 0; i < group.moved.size(); ++i) {
            positions_[group.moved[i]] = centre + matrix * (start[i] - centre);
        }
    }

    std::vector<Vec3> places(const TurningGroup& group) const {
        std::vector<Vec3> result;
        for (const std::uint32_t atom : group.moved) result.push_back(positions_[atom]);
        return result;
    }

    // The best rotation of a group so far, from where it started.
    struct Search {
        std::vector<Vec3> start;
        double energy;
        Quaternion rotation = Quaternion::Identity();
    };

    bool attempt(const TurningGroup& group, const Quaternion& rotation, Extent extent,
                 Search& search) {
        put(group, search.start, rotation);
        const double here = energy(group, extent);
        if (!(here < search.energy)) return false;
        search.energy = here;
        search.rotation = rotation;
        return true;
    }

    void look_around_axis(const TurningGroup& group, const Vec3& axis, Search& search) {
        for (int i = 1; i * grid_step < group.period - 1e-9; ++i) {
            attempt(group, Quaternion(Eigen::AngleAxisd(i * grid_step, axis)), Extent::All, search);
        }
    }

    void look_at_rotations(const TurningGroup& group, Search& search) {
        Search near{search.start, energy(group, Extent::Near)};
        for (const Quaternion& rotation : rotations_) {
            attempt(group, rotation, Extent::Near, near);
        }
        attempt(group, near.rotation, Extent::All, search);
    }

    void refine(const TurningGroup& group, std::span<const Vec3> axes, double step,
                Search& search) {
        for (int tries = 0; step > fine_step && tries < 64; ++tries) {
            bool is_better = false;
            for (const Vec3& axis : axes) {
                for (const double angle : {step, -step}) {
                    const Quaternion rotation =
                        (Quaternion(Eigen::AngleAxisd(angle, axis)) * search.rotation).normalized();
                    is_better = attempt(group, rotation, Extent::All, search) || is_better;
                }
            }
            if (!is_better) step /= 2;
        }
    }

    // Turns the group to where its energy is lowest; returns the change, 0 if it stayed.
    double turn(std::size_t number) {
        const TurningGroup& group = groups_[number];
        gather(group);
        Search search{places(group), energy(group, Extent::All)};
        const std::vector<Vec3> start = search.start;
        const double before = search.energy;
        if (group.axis) {
            const Vec3 bond = positions_[group.centre] - positions_[*group.axis];
            const Vec3 axis = bond.norm() > 0 ? Vec3(bond.normalized()) : Vec3::UnitX();
            look_around_axis(group, axis, search);
            refine(group, std::array{axis}, grid_step / 2, search);
        } else {
            if (looks_[number]++ < looks) look_at_rotations(group, search);
            refine(group, std::array<Vec3, 3>{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}, pi / 12,
                   search);
        }
        if (search.energy > before - least_gain) {
            put_back(group, start);
            return 0;
        }
        put(group, start, search.rotation);
        double moved = 0;
        for (std::size_t i = 0; i < start.size(); ++i) {
            moved = std::max(moved, (positions_[group.moved[i]] - start[i]).norm());
        }
        if (moved > least_turn) wake_around(group.centre, number);
        return search.energy - before;
    }

    void put_back(const TurningGroup& group, std::span<const Vec3> start) noexcept {
        for (std::size_t i = 0; i < start.size(); ++i) positions_[group.moved[i]] = start[i];
    }

    void wake_around(std::uint32_t atom, std::size_t but) {
        grid_.visit_near(positions_[atom], influence, [&](std::uint32_t other) {
            for (const std::uint32_t number : of_centre_.of(other)) {
                if (number != but) is_waiting_[number] = true;
            }
        });
    }

    // Turns group after group until none has a reason to.
    void settle(OrientReport& report) {
        report.is_settled = false;
        for (int sweep = 0; sweep < settings_.sweep_limit; ++sweep) {
            bool is_still = true;
            for (std::size_t i = 0; i < groups_.size(); ++i) {
                if (!is_waiting_[i]) continue;
                is_waiting_[i] = false;
                is_still = false;
                change_ += turn(i);
            }
            if (is_still) {
                report.is_settled = true;
                return;
            }
            ++report.sweeps;
        }
    }

    const Topology& topology_;
    const OrientSettings& settings_;
    std::span<Vec3> positions_;
    BondGraph graph_;
    std::vector<TurningGroup> groups_;
    std::vector<Quaternion> rotations_;
    Lists excluded_, pairs14_;
    double largest_reach_ = 0;  // Å
    PointGrid grid_;
    Lists of_centre_;  // groups by their centre
    NonbondedSettings nonbonded_;

    std::vector<bool> is_waiting_;  // groups whose surroundings changed
    std::vector<int> looks_;        // by group, see `looks`
    double change_ = 0;             // kcal/mol, so far
    // Of the group at hand, for `energy`.
    std::vector<Partners> partners_;  // by moved atom
    std::vector<std::uint32_t> near_;
};

}  // namespace

NonbondedSettings nonbonded_settings(const OrientSettings& settings) noexcept {
    return {.electrostatics = ElectrostaticCutoff::ForceShift,
            .van_der_waals = VanDerWaalsCutoff::Switch,
            .switch_from = settings.switch_from,
            .cutoff = settings.cutoff};
}

OrientReport orient_groups(const Connectivity& connectivity, const Topology& topology,
                           std::span<const std::uint32_t> built, const OrientSettings& settings,
                           std::span<Vec3> positions) {
    PALPA_ASSERT(connectivity.names.size() == positions.size() &&
                 topology.size() == positions.size());
    return Orienter(connectivity, topology, built, settings, positions).run();
}

}  // namespace palpa
