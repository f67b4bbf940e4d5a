#include "statics/term_derivatives.h"

#include "core/repeatable.h"
#include "forces/pair_hessian.h"
#include "forces/term_hessians.h"

#include <algorithm>
#include <array>
#include <map>

namespace palpa {
namespace {

using Atoms4 = std::array<std::uint32_t, 4>;
using Atoms2 = std::array<std::uint32_t, 2>;

// ---- which coordinates change a term --------------------------------------------------------

// Whether a body's joint moves atoms of a term against others: those on its axis stay where they
// are whatever turns.
template <std::size_t Count>
bool changes(const Body& body, const std::array<std::uint32_t, Count>& atoms, std::uint32_t moved) {
    bool moves = false, leaves = false;
    for (std::size_t i = 0; i < Count; ++i) {
        const bool is_moved = (moved >> i & 1U) != 0;
        if (body.parent != no_body && atoms[i] == body.axis[is_moved ? 1 : 0]) continue;
        (is_moved ? moves : leaves) = true;
    }
    return moves && leaves;
}

// From each atom's body to its base.
template <std::size_t Count>
void add_path(const TorsionBodies& bodies, const std::array<std::uint32_t, Count>& atoms,
              TermPaths& paths) {
    std::map<std::uint32_t, std::uint32_t> moved;
    for (std::size_t i = 0; i < Count; ++i) {
        for (std::uint32_t b = bodies.body_of[atoms[i]]; b != no_body; b = bodies.bodies[b].parent)
            moved[b] |= 1U << i;
    }
    for (const auto& [body, of_term] : moved) {
        if (changes(bodies.bodies[body], atoms, of_term)) paths.steps.push_back({body, of_term});
    }
    paths.first.push_back(paths.steps.size());
}

template <class Term, class AtomsOf>
TermPaths build_paths(const TorsionBodies& bodies, const std::vector<Term>& terms,
                      const AtomsOf& atoms_of) {
    TermPaths paths;
    paths.first.push_back(0);
    for (const Term& term : terms) add_path(bodies, atoms_of(term), paths);
    return paths;
}

// ---- a term over these coordinates ----------------------------------------------------------

// A coordinate that changes a term, of which some vectors are what matters.
template <int Vectors>
struct TermColumn {
    Eigen::Index column;
    CoordinateKind kind;
    std::uint32_t body;                           // no_body: the end of a spring
    Vec3 axis;                                    // of a turn; zero of a displacement
    Eigen::Matrix<double, 3 * Vectors, 1> along;  // how the vectors change
    // Sum over the moved atoms of how they go x dE/dx: what a turn farther in makes of that.
    Vec3 turning;
};

template <int Vectors>
void add_columns(const LocalCoordinates& coordinates, const TermHessian<Vectors>& term,
                 std::span<const TermColumn<Vectors>> columns, Eigen::Ref<Eigen::MatrixXd>& half) {
    for (std::size_t j = 0; j < columns.size(); ++j) {
        const TermColumn<Vectors>& b = columns[j];
        const Eigen::Matrix<double, 3 * Vectors, 1> force = term.hessian * b.along;
        for (std::size_t i = 0; i <= j; ++i) {
            const TermColumn<Vectors>& a = columns[i];
            double value = a.along.dot(force);
            if (a.body != b.body) {
                if (b.body != no_body && coordinates.carries(a.body, b.body))
                    value += a.axis.dot(b.turning);
            } else if (a.kind == b.kind) {
                // Of a rotation vector both orders count alike.
                value += 0.5 * (a.axis.dot(b.turning) + b.axis.dot(a.turning));
            }
            half(a.column, b.column) += i == j ? 0.5 * value : value;
        }
    }
}

class TermSum {
public:
    TermSum(const TorsionModel& model, const LocalCoordinates& coordinates,
            const TorsionState& state, std::span<const CoordinateMotion> motions,
            Eigen::Ref<Eigen::MatrixXd>& half)
        : model_(model), coordinates_(coordinates), state_(state), motions_(motions), half_(half) {}

    const Vec3& place(std::uint32_t atom) const { return state_.positions[atom]; }

    template <int Vectors, std::size_t Count>
    void add(std::span<const TermStep> path, const std::array<std::uint32_t, Count>& atoms,
             const Shares<Vectors, Count>& shares, const TermHessian<Vectors>& term) {
        std::array<Vec3, Count> gradients;
        for (std::size_t i = 0; i < Count; ++i) {
            gradients[i].setZero();
            for (std::size_t v = 0; v < Vectors; ++v) {
                gradients[i] +=
                    shares[v][i] * term.gradient.template segment<3>(static_cast<int>(3 * v));
            }
        }
        std::vector<TermColumn<Vectors>>& columns = columns_of<Vectors>();
        columns.clear();
        for (const TermStep& step : path) {
            for (const CarriedCoordinate& carried : coordinates_.of(step.body)) {
                TermColumn<Vectors> column = start_column<Vectors>(carried, step.body);
                const CoordinateMotion& motion = motion_of(carried);
                for (std::size_t i = 0; i < Count; ++i) {
                    if ((step.atoms >> i & 1U) == 0) continue;
                    const Vec3 velocity = motion.velocity_at(place(atoms[i]));
                    for (std::size_t v = 0; v < Vectors; ++v) {
                        column.along.template segment<3>(static_cast<int>(3 * v)) +=
                            shares[v][i] * velocity;
                    }
                    column.turning += velocity.cross(gradients[i]);
                }
                columns.push_back(column);
            }
        }
        add_columns<Vectors>(coordinates_, term, columns, half_);
    }

    // Whether a dihedral angle is that of one joint, but for a constant: then it is all that
    // changes.
    bool is_about_joint(std::span<const TermStep> path, const Atoms4& atoms) const {
        if (path.size() != 1) return false;
        const Body& body = model_.tree.bodies.bodies[path[0].body];
        return body.parent != no_body &&
               std::minmax(body.axis[0], body.axis[1]) == std::minmax(atoms[1], atoms[2]);
    }

    void add_about_joint(std::uint32_t body, double second) {
        const Eigen::Index column = coordinates_.of(body)[0].column;
        half_(column, column) += 0.5 * second;
    }

    // A spring's vector is that from one centre of mass to another, or to a place.
    void add_spring(const ModelSpring& spring, std::span<const LocalCoordinates::SpringEnd> ends) {
        const SpringPull pull = find_spring_pull(model_, spring, state_.positions);
        TermHessian<1> term;
        term.gradient = pull.k * pull.stretch;
        term.hessian = find_spring_stiffness(model_, spring, state_.positions);
        std::vector<TermColumn<1>>& columns = columns_of<1>();
        columns.clear();
        const std::size_t total =
            spring.other_atoms.empty() ? 0 : spring.atoms.size() + spring.other_atoms.size();
        for (const auto& [body, moved] : find_moved(spring)) {
            if (moved.count == total) continue;
            for (const CarriedCoordinate& carried : coordinates_.of(body)) {
                TermColumn<1> column = start_column<1>(carried, body);
                const CoordinateMotion& motion = motion_of(carried);
                column.along = motion.axis.cross(moved.moment - moved.share * motion.point) +
                               moved.share * motion.shift;
                column.turning = column.along.cross(term.gradient);
                columns.push_back(column);
            }
        }
        for (const LocalCoordinates::SpringEnd& end : ends) {
            for (int axis = 0; axis < 3; ++axis) {
                columns.push_back({end.column + axis, CoordinateKind::Shift, no_body, Vec3::Zero(),
                                   -Vec3::Unit(axis), Vec3::Zero()});
            }
        }
        add_columns<1>(coordinates_, term, columns, half_);
    }

private:
    // What of a spring's atoms a body carries.
    struct Moved {
        std::size_t count = 0;
        double share = 0;
        Vec3 moment = Vec3::Zero();  // sum of share times place
    };

    std::map<std::uint32_t, Moved> find_moved(const ModelSpring& spring) const {
        std::map<std::uint32_t, Moved> result;
        const TorsionBodies& bodies = model_.tree.bodies;
        visit_pulled(model_, spring, [&](std::uint32_t atom, double share) {
            for (std::uint32_t b = bodies.body_of[atom]; b != no_body;
                 b = bodies.bodies[b].parent) {
                Moved& moved = result[b];
                ++moved.count;
                moved.share += share;
                moved.moment += share * place(atom);
            }
        });
        return result;
    }

    const CoordinateMotion& motion_of(const CarriedCoordinate& carried) const {
        return motions_[static_cast<std::size_t>(carried.column)];
    }

    template <int Vectors>
    TermColumn<Vectors> start_column(const CarriedCoordinate& carried, std::uint32_t body) const {
        TermColumn<Vectors> column{carried.column,          carried.kind, body,
                                   motion_of(carried).axis, {},           Vec3::Zero()};
        column.along.setZero();
        return column;
    }

    template <int Vectors>
    std::vector<TermColumn<Vectors>>& columns_of() {
        if constexpr (Vectors == 1) return columns1_;
        if constexpr (Vectors == 2) return columns2_;
        if constexpr (Vectors == 3) return columns3_;
        if constexpr (Vectors == 6) return columns6_;
    }

    const TorsionModel& model_;
    const LocalCoordinates& coordinates_;
    const TorsionState& state_;
    std::span<const CoordinateMotion> motions_;
    Eigen::Ref<Eigen::MatrixXd>& half_;
    std::vector<TermColumn<1>> columns1_;
    std::vector<TermColumn<2>> columns2_;
    std::vector<TermColumn<3>> columns3_;
    std::vector<TermColumn<6>> columns6_;
};

TorsionHessian torsion_of(const TermSum& sum, const Atoms4& atoms) {
    const auto& [a, b, c, d] = atoms;
    return find_torsion_hessian(sum.place(a) - sum.place(b), sum.place(b) - sum.place(c),
                                sum.place(d) - sum.place(c));
}

// As forces/torsion.h has it.
double angle_of(const TermSum& sum, const Atoms4& atoms) {
    const auto& [a, b, c, d] = atoms;
    const Vec3 F = sum.place(a) - sum.place(b), G = sum.place(b) - sum.place(c),
               H = sum.place(d) - sum.place(c);
    const Vec3 A = F.cross(G);
    return repeatable::atan2(G.norm() * H.dot(A), A.dot(H.cross(G)));
}

template <class Term>
void add_torsions(const std::vector<Term>& terms, const TermPaths& paths, TermSum& sum) {
    const auto atoms_of = [](const Term& t) { return Atoms4{t.a, t.b, t.c, t.d}; };
    for (std::size_t t = 0; t < terms.size();) {
        // Of one angle all multiplicities, which follow each other.
        const std::size_t first = t;
        const Atoms4 atoms = atoms_of(terms[t]);
        const auto slopes_at = [&](double angle) {
            Slopes slopes;
            for (; t < terms.size() && atoms_of(terms[t]) == atoms; ++t) {
                const Slopes own = find_slopes(terms[t], angle);
                slopes.first += own.first;
                slopes.second += own.second;
            }
            return slopes;
        };
        if (sum.is_about_joint(paths.of(first), atoms)) {
            sum.add_about_joint(paths.of(first)[0].body, slopes_at(angle_of(sum, atoms)).second);
            continue;
        }
        const TorsionHessian torsion = torsion_of(sum, atoms);
        const Slopes slopes = slopes_at(torsion.angle);
        sum.add<3, 4>(paths.of(first), atoms, torsion_shares,
                      torsion.of_energy(slopes.first, slopes.second));
    }
}

void add_cmap_terms(const Topology& topology, const TermPaths& paths, TermSum& sum) {
    constexpr Shares<6, 8> shares = [] {
        Shares<6, 8> result{};
        for (std::size_t v = 0; v < 3; ++v) {
            for (std::size_t i = 0; i < 4; ++i) {
                result[v][i] = result[v + 3][i + 4] = torsion_shares[v][i];
            }
        }
        return result;
    }();
    for (std::size_t t = 0; t < topology.cmap_terms.size(); ++t) {
        const CmapTerm& cmap = topology.cmap_terms[t];
        const TorsionHessian phi = torsion_of(sum, cmap.phi), psi = torsion_of(sum, cmap.psi);
        const CmapSlopes slopes =
            find_cmap_slopes(topology.cmap_maps[cmap.map], phi.angle, psi.angle);
        const TermHessian<3> of_phi = phi.of_energy(slopes.phi, slopes.phi_phi);
        const TermHessian<3> of_psi = psi.of_energy(slopes.psi, slopes.psi_psi);
        TermHessian<6> term;
        term.gradient << of_phi.gradient, of_psi.gradient;
        term.hessian.topLeftCorner<9, 9>() = of_phi.hessian;
        term.hessian.bottomRightCorner<9, 9>() = of_psi.hessian;
        term.hessian.topRightCorner<9, 9>() = slopes.phi_psi * phi.slope * psi.slope.transpose();
        term.hessian.bottomLeftCorner<9, 9>() = slopes.phi_psi * psi.slope * phi.slope.transpose();
        std::array<std::uint32_t, 8> atoms{};
        std::ranges::copy(cmap.phi, atoms.begin());
        std::ranges::copy(cmap.psi, atoms.begin() + 4);
        sum.add<6, 8>(paths.of(t), atoms, shares, term);
    }
}

void add_pairs14(const Topology& topology, const NonbondedSettings& settings,
                 const TermPaths& paths, TermSum& sum) {
    const TopologyPairHessian law(topology, settings);
    for (std::size_t t = 0; t < topology.exclusions.pairs14.size(); ++t) {
        const auto [i, j] = topology.exclusions.pairs14[t];
        const Vec3 d = sum.place(i) - sum.place(j);
        const auto [first, second] = law.three_bonds_apart(i, j, d.squaredNorm());
        TermHessian<1> term;
        term.gradient = first * d;
        term.hessian = first * Mat3::Identity() + second * d * d.transpose();
        sum.add<1, 2>(paths.of(t), Atoms2{i, j}, spring_shares, term);
    }
}

void add_bonds(const Topology& topology, const ModelPaths& paths, TermSum& sum) {
    const auto add = [&](std::span<const TermStep> path, const Atoms2& atoms, double k, double r0) {
        sum.add<1, 2>(path, atoms, spring_shares,
                      find_spring_hessian(k, r0, sum.place(atoms[0]) - sum.place(atoms[1])));
    };
    for (std::size_t t = 0; t < topology.bonds.size(); ++t) {
        const Bond& bond = topology.bonds[t];
        add(paths.bonds.of(t), {bond.a, bond.b}, bond.k, bond.r0);
    }
    for (std::size_t t = 0; t < topology.urey_bradleys.size(); ++t) {
        const UreyBradley& term = topology.urey_bradleys[t];
        add(paths.urey_bradleys.of(t), {term.a, term.c}, term.k, term.s0);
    }
}

void add_angles(const Topology& topology, const TermPaths& paths, TermSum& sum) {
    for (std::size_t t = 0; t < topology.angles.size(); ++t) {
        const Angle& angle = topology.angles[t];
        const Vec3& middle = sum.place(angle.b);
        sum.add<2, 3>(
            paths.of(t), std::array{angle.a, angle.b, angle.c}, angle_shares,
            find_angle_hessian(angle, sum.place(angle.a) - middle, sum.place(angle.c) - middle));
    }
}

}  // namespace

ModelPaths build_model_paths(const TorsionModel& model) {
    const Topology& topology = model.topology;
    const TorsionBodies& bodies = model.tree.bodies;
    const auto four = [](const auto& t) { return Atoms4{t.a, t.b, t.c, t.d}; };
    ModelPaths paths;
    paths.bonds =
        build_paths(bodies, topology.bonds, [](const Bond& t) { return Atoms2{t.a, t.b}; });
    paths.angles = build_paths(bodies, topology.angles,
                               [](const Angle& t) { return std::array{t.a, t.b, t.c}; });
    paths.urey_bradleys = build_paths(bodies, topology.urey_bradleys,
                                      [](const UreyBradley& t) { return Atoms2{t.a, t.c}; });
    paths.dihedrals = build_paths(bodies, topology.dihedrals, four);
    paths.impropers = build_paths(bodies, topology.impropers, four);
    paths.cmap_terms = build_paths(bodies, topology.cmap_terms, [](const CmapTerm& t) {
        return std::array{t.phi[0], t.phi[1], t.phi[2], t.phi[3],
                          t.psi[0], t.psi[1], t.psi[2], t.psi[3]};
    });
    paths.pairs14 =
        build_paths(bodies, topology.exclusions.pairs14, [](const Atoms2& pair) { return pair; });
    return paths;
}

void add_term_derivatives(const TorsionModel& model, const LocalCoordinates& coordinates,
                          const ModelPaths& paths, const NonbondedSettings& settings,
                          const TorsionState& state, std::span<const CoordinateMotion> motions,
                          Eigen::Ref<Eigen::MatrixXd> half) {
    const Topology& topology = model.topology;
    TermSum sum(model, coordinates, state, motions, half);
    add_bonds(topology, paths, sum);
    add_angles(topology, paths.angles, sum);
    add_torsions(topology.dihedrals, paths.dihedrals, sum);
    add_torsions(topology.impropers, paths.impropers, sum);
    add_cmap_terms(topology, paths.cmap_terms, sum);
    add_pairs14(topology, settings, paths.pairs14, sum);
    for (std::size_t s = 0; s < state.springs.size(); ++s) {
        std::vector<LocalCoordinates::SpringEnd> ends;
        std::ranges::copy_if(coordinates.ends, std::back_inserter(ends),
                             [&](const auto& end) { return end.spring == s; });
        sum.add_spring(state.springs[s], ends);
    }
}

}  // namespace palpa
