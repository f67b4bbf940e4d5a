#include "ligands/charge_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace palpa {
namespace {

// Draw towards 0, in units of an equation: one equation says one atom's charge.
constexpr double chi_ridge = 1, extra_ridge = 2;

// A mean over n atoms counts n / (n + this): those of single atoms would be noise.
constexpr double residual_ridge = 0.3;

constexpr std::size_t first_residual = static_cast<std::size_t>(Surroundings::Kinds);

std::size_t index_of(std::map<std::string, std::size_t>& indices, const std::string& type) {
    return indices.emplace(type, indices.size()).first->second;
}

// To three decimals, the sum kept: what rounding leaves goes to the atoms that it moved most.
void round_charges(std::vector<double>& charges, int total) {
    std::vector<long> thousandths;
    for (const double charge : charges) thousandths.push_back(std::lround(1000 * charge));
    long left = 1000L * total - std::accumulate(thousandths.begin(), thousandths.end(), 0L);
    std::vector<std::size_t> order(charges.size());
    std::iota(order.begin(), order.end(), 0);
    const double sign = left > 0 ? 1 : -1;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const auto lost = [&](std::size_t i) {
            return sign * (1000 * charges[i] - static_cast<double>(thousandths[i]));
        };
        return lost(a) > lost(b);
    });
    for (std::size_t i = 0; left != 0; i = (i + 1) % order.size()) {
        const long step = left > 0 ? 1 : -1;
        thousandths[order[i]] += step;
        left -= step;
    }
    for (std::size_t i = 0; i < charges.size(); ++i) {
        charges[i] = static_cast<double>(thousandths[i]) / 1000;
    }
}

}  // namespace

ChargeModel::ChargeModel(std::span<const ModelCompound> compounds) {
    fit_increments(compounds);
    fit_residuals(compounds);
}

// Normal equations: some hundred unknowns, ten thousands of equations of few terms each.
void ChargeModel::fit_increments(std::span<const ModelCompound> compounds) {
    std::map<std::string, std::size_t> types;
    std::map<std::pair<std::string, std::string>, std::size_t> pairs;
    for (const ModelCompound& compound : compounds) {
        for (const std::string& type : compound.types) index_of(types, type);
        for (const GraphBond& bond : compound.graph.bonds) {
            const auto [low, high] = std::minmax(compound.types[bond.a], compound.types[bond.b]);
            if (low != high) pairs.emplace(std::pair(low, high), pairs.size());
        }
    }
    const auto size = static_cast<Eigen::Index>(types.size() + pairs.size());
    if (size == 0) return;
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    for (Eigen::Index i = 0; i < size; ++i) {
        normal(i, i) = i < static_cast<Eigen::Index>(types.size()) ? chi_ridge : extra_ridge;
    }
    for (const ModelCompound& compound : compounds) {
        for (std::uint32_t i = 0; i < compound.graph.size(); ++i) {
            std::map<Eigen::Index, double> row;
            const std::string& own = compound.types[i];
            for (const std::uint32_t bond : compound.seen.bonds[i]) {
                const std::string& other = compound.types[other_end(compound.graph.bonds[bond], i)];
                if (own == other) continue;
                row[static_cast<Eigen::Index>(types.at(other))] += 1;
                row[static_cast<Eigen::Index>(types.at(own))] -= 1;
                const auto [low, high] = std::minmax(own, other);
                const std::size_t pair = types.size() + pairs.at({low, high});
                row[static_cast<Eigen::Index>(pair)] += own == low ? 1 : -1;
            }
            const double charge = compound.charges[i] - compound.seen.charge[i];
            for (const auto& [a, x] : row) {
                right(a) += x * charge;
                for (const auto& [b, y] : row) normal(a, b) += x * y;
            }
        }
    }
    const Eigen::VectorXd found = normal.llt().solve(right);
    for (const auto& [type, index] : types) chi_[type] = found(static_cast<Eigen::Index>(index));
    for (const auto& [pair, index] : pairs) {
        extra_[pair] = found(static_cast<Eigen::Index>(types.size() + index));
    }
}

void ChargeModel::fit_residuals(std::span<const ModelCompound> compounds) {
    std::vector<std::vector<double>> left;
    for (const ModelCompound& compound : compounds) {
        std::vector<double>& of = left.emplace_back();
        for (std::uint32_t i = 0; i < compound.graph.size(); ++i) {
            of.push_back(compound.charges[i] -
                         by_bonds(compound.graph, compound.seen, compound.types, i));
        }
    }
    for (std::size_t level = first_residual; level < surroundings_levels; ++level) {
        std::map<std::uint64_t, std::pair<double, int>> sums;
        for (std::size_t c = 0; c < compounds.size(); ++c) {
            for (std::size_t i = 0; i < left[c].size(); ++i) {
                auto& [sum, count] = sums[compounds[c].keys[i][level]];
                sum += left[c][i];
                ++count;
            }
        }
        for (const auto& [key, sum] : sums) {
            residuals_[level][key] = sum.first / (sum.second + residual_ridge);
        }
        for (std::size_t c = 0; c < compounds.size(); ++c) {
            for (std::size_t i = 0; i < left[c].size(); ++i) {
                left[c][i] -= residuals_[level].at(compounds[c].keys[i][level]);
            }
        }
    }
}

double ChargeModel::flow(const std::string& to, const std::string& from) const {
    if (to == from) return 0;
    const auto chi = [&](const std::string& type) {
        const auto found = chi_.find(type);
        return found == chi_.end() ? 0 : found->second;
    };
    const auto [low, high] = std::minmax(to, from);
    const auto extra = extra_.find({low, high});
    const double pair = extra == extra_.end() ? 0 : extra->second;
    return chi(from) - chi(to) + (to == low ? pair : -pair);
}

double ChargeModel::by_bonds(const MoleculeGraph& graph, const Perceived& seen,
                             const std::vector<std::string>& types, std::uint32_t atom) const {
    double charge = seen.charge[atom];
    for (const std::uint32_t bond : seen.bonds[atom]) {
        charge += flow(types[atom], types[other_end(graph.bonds[bond], atom)]);
    }
    return charge;
}

std::vector<double> ChargeModel::charges_of(const MoleculeGraph& graph, const Perceived& seen,
                                            const std::vector<EnvironmentKeys>& keys,
                                            const std::vector<std::string>& types) const {
    std::vector<double> charges, doubt;
    for (std::uint32_t i = 0; i < graph.size(); ++i) {
        double charge = by_bonds(graph, seen, types, i);
        std::size_t known = 0;
        for (std::size_t level = first_residual; level < surroundings_levels; ++level) {
            const auto found = residuals_[level].find(keys[i][level]);
            if (found == residuals_[level].end()) break;
            charge += found->second;
            known = level;
        }
        charges.push_back(charge);
        doubt.push_back(graph.is_hydrogen(i) ? 0.01
                                             : static_cast<double>(surroundings_levels - known));
    }
    // Flows add up to nothing; residuals do not. Atoms whose surroundings are known least take it.
    const double excess =
        std::accumulate(charges.begin(), charges.end(), 0.0) - total_charge(graph);
    const double all = std::accumulate(doubt.begin(), doubt.end(), 0.0);
    for (std::size_t i = 0; i < charges.size(); ++i) charges[i] -= excess * doubt[i] / all;
    round_charges(charges, total_charge(graph));
    return charges;
}

}  // namespace palpa
