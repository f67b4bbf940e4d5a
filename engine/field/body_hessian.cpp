#include "field/body_hessian.h"

#include "core/assertion.h"
#include "field/hessian_job.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

namespace palpa {
namespace {

// ---- the plan -------------------------------------------------------------------------------

// All that hang on a body directly before it, and first those on the child that most hang on: so
// few sums wait at a time.
std::vector<std::uint32_t> order_bodies(std::span<const std::uint32_t> parents) {
    const auto bodies = static_cast<std::uint32_t>(parents.size());
    std::vector<std::uint32_t> behind(bodies, 1);
    std::vector<std::vector<std::uint32_t>> children(bodies);
    std::vector<std::uint32_t> waiting, order;
    for (std::uint32_t b = bodies; b-- > 0;) {
        if (parents[b] == no_number) continue;
        behind[parents[b]] += behind[b];
        children[parents[b]].push_back(b);
    }
    for (std::uint32_t b = 0; b < bodies; ++b) {
        std::ranges::stable_sort(children[b], {}, [&](std::uint32_t c) { return behind[c]; });
        if (parents[b] == no_number) waiting.push_back(b);
    }
    // Backwards: a body, then what is attached to it, those to which most are attached last.
    while (!waiting.empty()) {
        const std::uint32_t body = waiting.back();
        waiting.pop_back();
        order.push_back(body);
        waiting.insert(waiting.end(), children[body].rbegin(), children[body].rend());
    }
    std::ranges::reverse(order);
    return order;
}

void add_columns(const BodyTreeView& tree, HessianPlan& plan) {
    const auto bodies = static_cast<std::uint32_t>(tree.parents.size());
    std::vector<std::uint32_t> first_motion(bodies + 1, 0);
    for (std::uint32_t b = 0; b < bodies; ++b)
        first_motion[b + 1] = first_motion[b] + tree.motions[b];
    for (const std::uint32_t b : order_bodies(tree.parents)) {
        HessianColumn column;
        column.body = b;
        column.first_atom = static_cast<std::uint32_t>(plan.atoms.size());
        for (std::uint32_t a = tree.first_atom[b]; a < tree.first_atom[b + 1]; ++a)
            plan.atoms.push_back(tree.atoms[a]);
        column.end_atom = static_cast<std::uint32_t>(plan.atoms.size());
        column.first_motion = static_cast<std::uint32_t>(plan.motions.size());
        for (std::uint32_t k = first_motion[b]; k < first_motion[b + 1]; ++k)
            plan.motions.push_back(k);
        column.end_motion = static_cast<std::uint32_t>(plan.motions.size());
        plan.columns.push_back(column);
    }
}

// The first child hands its slot on to its parent; a body without children takes one that is free.
void choose_slots(const BodyTreeView& tree, HessianPlan& plan) {
    std::vector<std::uint32_t> slot_of(tree.parents.size(), no_number), free;
    for (HessianColumn& column : plan.columns) {
        std::uint32_t& own = slot_of[column.body];
        column.is_leaf = own == no_number;
        if (own == no_number && free.empty()) {
            own = plan.slots++;
        } else if (own == no_number) {
            own = free.back();
            free.pop_back();
        }
        column.step.slot = own;
        const std::uint32_t parent = tree.parents[column.body];
        if (parent != no_number) {
            if (slot_of[parent] == no_number) slot_of[parent] = own;
            column.step.to = slot_of[parent];
        }
        if (column.step.to != own) free.push_back(own);
    }
}

void add_panels(HessianPlan& plan) {
    std::size_t lane = hessian_lanes;
    for (std::uint32_t c = 0; c < plan.columns.size(); ++c) {
        const HessianColumn& column = plan.columns[c];
        const std::size_t atoms = column.end_atom - column.first_atom;
        const std::size_t pieces =
            std::max<std::size_t>(1, (atoms + hessian_places - 1) / hessian_places);
        for (std::size_t piece = 0; piece < pieces; ++piece, ++lane) {
            if (lane == hessian_lanes) {
                HessianPanel& panel = plan.panels.emplace_back();
                panel.column.fill(no_number);
                for (auto& places : panel.atoms) places.fill(no_number);
                panel.first_column = c;
                lane = 0;
            }
            HessianPanel& panel = plan.panels.back();
            panel.column[lane] = c;
            if (piece == 0) panel.is_first |= static_cast<std::uint16_t>(1U << lane);
            if (piece + 1 == pieces) panel.is_last |= static_cast<std::uint16_t>(1U << lane);
            const std::size_t begin = piece * atoms / pieces, end = (piece + 1) * atoms / pieces;
            for (std::size_t k = begin; k < end; ++k)
                panel.atoms[k - begin][lane] = plan.atoms[column.first_atom + k];
        }
    }
}

// Of what is attached to a body the first panel with a piece decides.
void find_first_blocks(const BodyTreeView& tree, HessianPlan& plan) {
    for (HessianColumn& column : plan.columns) column.first_block = no_number;
    const auto lower = [](std::uint32_t& at, std::uint32_t to) { at = std::min(at, to); };
    for (const HessianPanel& panel : plan.panels) {
        const std::uint32_t block = plan.columns[panel.first_column].first_motion / hessian_block;
        for (const std::uint32_t c : panel.column) {
            if (c != no_number) lower(plan.columns[c].first_block, block);
        }
    }
    std::vector<std::uint32_t> column_of(plan.columns.size());
    for (std::uint32_t c = 0; c < plan.columns.size(); ++c) column_of[plan.columns[c].body] = c;
    for (const HessianColumn& column : plan.columns) {
        const std::uint32_t parent = tree.parents[column.body];
        if (parent != no_number)
            lower(plan.columns[column_of[parent]].first_block, column.first_block);
    }
}

// By place, zero where there is no solvation: volume, strength, scale and offset.
class SolvationNumbers {
public:
    explicit SolvationNumbers(const SolvationParameters& parameters) : parameters_(parameters) {}

    std::array<float, 4> of(std::uint32_t atom) const {
        if (parameters_.volume.empty()) return {};
        const double scale = std::sqrt(std::numbers::log2e) * parameters_.inverse_lambda[atom];
        return {static_cast<float>(parameters_.volume[atom]),
                static_cast<float>(parameters_.strength[atom]), static_cast<float>(scale),
                static_cast<float>(scale * parameters_.radius[atom])};
    }

private:
    const SolvationParameters& parameters_;
};

void add_numbers(const PairParameters& parameters, const SolvationNumbers& solvation,
                 HessianPlan& plan) {
    for (const std::uint32_t atom : plan.atoms) {
        plan.charge.push_back(static_cast<float>(parameters.charge[atom]));
        plan.sqrt_epsilon.push_back(static_cast<float>(parameters.sqrt_epsilon[atom]));
        plan.half_rmin.push_back(static_cast<float>(parameters.half_rmin[atom]));
        const auto [volume, strength, scale, offset] = solvation.of(atom);
        plan.volume.push_back(volume);
        plan.strength.push_back(strength);
        plan.scale.push_back(scale);
        plan.offset.push_back(offset);
    }
    for (const HessianPanel& panel : plan.panels) {
        auto& of_panel = plan.row_numbers.emplace_back();
        for (std::size_t k = 0; k < hessian_places; ++k) {
            for (std::size_t lane = 0; lane < hessian_lanes; ++lane) {
                const std::uint32_t atom = panel.atoms[k][lane];
                if (atom == no_number) continue;
                of_panel[k].charge.at[lane] = static_cast<float>(parameters.charge[atom]);
                of_panel[k].epsilon12.at[lane] =
                    static_cast<float>(12 * parameters.sqrt_epsilon[atom]);
                of_panel[k].half_rmin.at[lane] = static_cast<float>(parameters.half_rmin[atom]);
                const auto [volume, strength, scale, offset] = solvation.of(atom);
                of_panel[k].volume.at[lane] = volume;
                of_panel[k].strength.at[lane] = strength;
                of_panel[k].scale.at[lane] = scale;
                of_panel[k].offset.at[lane] = offset;
            }
        }
    }
}

using LeftOut = std::vector<std::vector<std::uint32_t>>;

LeftOut find_left_out(std::size_t atoms, std::span<const std::array<std::uint32_t, 2>> pairs) {
    LeftOut left_out(atoms);
    for (const auto& [i, j] : pairs) {
        left_out[i].push_back(j);
        left_out[j].push_back(i);
    }
    for (std::vector<std::uint32_t>& of_atom : left_out) std::ranges::sort(of_atom);
    return left_out;
}

// Each pair of bodies counts once, with the one that comes first as row.
void add_mask(const HessianPanel& panel, std::uint32_t c, const LeftOut& left_out,
              HessianPlan& plan) {
    plan.masks_of.push_back({c, plan.masks.size()});
    const HessianColumn& column = plan.columns[c];
    for (std::size_t k = 0; k < hessian_places; ++k) {
        for (std::uint32_t a = column.first_atom; a < column.end_atom; ++a) {
            std::uint16_t bits = 0;
            for (std::size_t lane = 0; lane < hessian_lanes; ++lane) {
                const std::uint32_t atom = panel.atoms[k][lane];
                if (atom == no_number || panel.column[lane] >= c) continue;
                if (!std::ranges::binary_search(left_out[atom], plan.atoms[a]))
                    bits |= static_cast<std::uint16_t>(1U << lane);
            }
            plan.masks.push_back(bits);
        }
    }
}

void add_masks(const LeftOut& left_out, std::span<const std::uint32_t> column_of,
               HessianPlan& plan) {
    for (HessianPanel& panel : plan.panels) {
        panel.first_mask = static_cast<std::uint32_t>(plan.masks_of.size());
        std::vector<std::uint32_t> columns;
        for (const std::uint32_t c : panel.column) {
            if (c != no_number) columns.push_back(c);
        }
        for (const auto& places : panel.atoms) {
            for (const std::uint32_t atom : places) {
                if (atom == no_number) continue;
                for (const std::uint32_t other : left_out[atom]) {
                    if (column_of[other] > panel.first_column) columns.push_back(column_of[other]);
                }
            }
        }
        std::ranges::sort(columns);
        const auto [end, last] = std::ranges::unique(columns);
        columns.erase(end, last);
        for (const std::uint32_t c : columns) add_mask(panel, c, left_out, plan);
        panel.end_mask = static_cast<std::uint32_t>(plan.masks_of.size());
    }
}

void add_extras(std::span<const std::array<std::uint32_t, 2>> replaced,
                std::span<const std::uint32_t> column_of, HessianPlan& plan) {
    struct Place {
        std::uint32_t panel = 0, lane = 0;
    };
    std::vector<Place> place_of(column_of.size());
    for (std::uint32_t p = 0; p < plan.panels.size(); ++p) {
        for (const auto& places : plan.panels[p].atoms) {
            for (std::uint32_t lane = 0; lane < hessian_lanes; ++lane) {
                if (places[lane] != no_number) place_of[places[lane]] = {p, lane};
            }
        }
    }
    struct Found {
        std::uint32_t panel;
        HessianExtra extra;
    };
    std::vector<Found> found;
    for (std::uint32_t n = 0; n < replaced.size(); ++n) {
        auto [i, j] = replaced[n];
        if (column_of[i] == column_of[j]) continue;
        if (column_of[i] > column_of[j]) std::swap(i, j);
        found.push_back({place_of[i].panel, {column_of[j], place_of[i].lane, i, j, n}});
    }
    std::ranges::sort(found, {}, [](const Found& f) {
        return std::tuple(f.panel, f.extra.column, f.extra.number);
    });
    for (const Found& f : found) plan.extras.push_back(f.extra);
    std::size_t next = 0;
    for (std::uint32_t p = 0; p < plan.panels.size(); ++p) {
        plan.panels[p].first_extra = static_cast<std::uint32_t>(next);
        while (next < found.size() && found[next].panel == p) ++next;
        plan.panels[p].end_extra = static_cast<std::uint32_t>(next);
    }
}

// ---- the sums -------------------------------------------------------------------------------

void start(const HessianPlan& plan, const Vec3& origin, std::span<const Vec3> positions,
           std::span<const Vec6> screws, std::size_t rows, HessianSums& sums) {
    sums.blocks = (rows + hessian_block - 1) / hessian_block;
    sums.products.assign(rows * sums.blocks, {});
    sums.wrenches.assign(plan.blocks(), {});
    sums.rows.assign(plan.columns.size(), Mat6::Zero());
    HessianSums::Workspace& workspace = sums.workspace;
    workspace.x.resize(plan.atoms.size());
    workspace.y.resize(plan.atoms.size());
    workspace.z.resize(plan.atoms.size());
    workspace.column_slots.resize(plan.slots);
    workspace.has_started.assign(plan.slots, 0);
    workspace.panel.resize(plan.motions.size());
    workspace.row_slots.resize(plan.slots * plan.blocks());
    workspace.screws.clear();
    for (const std::uint32_t motion : plan.motions) {
        std::array<double, 6>& screw = workspace.screws.emplace_back();
        Eigen::Map<Vec6>(screw.data()) = screws[motion];
    }
    workspace.centre.clear();
    workspace.radius.clear();
    for (const HessianColumn& column : plan.columns) {
        Vec3 low = Vec3::Zero(), high = low;
        for (std::uint32_t a = column.first_atom; a < column.end_atom; ++a) {
            const Vec3 place = positions[plan.atoms[a]] - origin;
            low = a == column.first_atom ? place : low.cwiseMin(place);
            high = a == column.first_atom ? place : high.cwiseMax(place);
        }
        workspace.centre.push_back(0.5 * (low + high));
        workspace.radius.push_back(0.5 * (high - low).norm());
    }
}

Vec3 middle_of(const HessianPanel& panel, const HessianSums::Workspace& workspace) {
    Vec3 low = workspace.centre[panel.first_column], high = low;
    for (const std::uint32_t c : panel.column) {
        if (c == no_number) continue;
        low = low.cwiseMin(workspace.centre[c]);
        high = high.cwiseMax(workspace.centre[c]);
    }
    return 0.5 * (low + high);
}

void place_columns(const HessianPlan& plan, const Vec3& origin, std::span<const Vec3> positions,
                   HessianSums::Workspace& workspace) {
    for (std::size_t a = 0; a < plan.atoms.size(); ++a) {
        const Vec3 place = positions[plan.atoms[a]] - origin;
        workspace.x[a] = static_cast<float>(place.x());
        workspace.y[a] = static_cast<float>(place.y());
        workspace.z[a] = static_cast<float>(place.z());
    }
}

// What a lane's block is as a matrix about the origin.
Mat6 block_of(const HessianBlock& block, std::size_t lane, const Vec3& point) {
    const auto at = [&](const LaneDoubles& lanes) { return lanes.at[lane]; };
    const auto symmetric = [&](const std::array<LaneDoubles, 6>& s) {
        Mat3 m;
        m << at(s[0]), at(s[1]), at(s[2]), at(s[1]), at(s[3]), at(s[4]), at(s[2]), at(s[4]),
            at(s[5]);
        return m;
    };
    const auto vector = [&](const std::array<LaneDoubles, 3>& v) {
        return Vec3(at(v[0]), at(v[1]), at(v[2]));
    };
    const Mat3 P = cross_matrix(point),
               turns = symmetric(block.turns) + cross_matrix(vector(block.skew));
    Mat3 mixed;
    for (std::size_t i = 0; i < 9; ++i)
        mixed(static_cast<int>(i / 3), static_cast<int>(i % 3)) = at(block.mixed[i]);
    const Mat3 shifts = symmetric(block.shifts);
    // The velocity at the point is that at the origin less P times the turn.
    const Mat3 lower = mixed.transpose() + cross_matrix(vector(block.q)) - shifts * P;
    Mat6 result;
    result.topLeftCorner<3, 3>() = turns - mixed * P + P * lower;
    result.topRightCorner<3, 3>() = mixed + P * shifts;
    result.bottomLeftCorner<3, 3>() = lower;
    result.bottomRightCorner<3, 3>() = shifts;
    return result;
}

// What is not finite anywhere is in the sums over all rows, or all columns.
bool is_sound(const HessianSums& sums) {
    double sum = 0;
    for (const WrenchBlock& block : sums.wrenches) {
        for (const auto& of_motions : block.at) {
            for (const double value : of_motions) sum += value * 0;
        }
    }
    for (const Mat6& block : sums.rows) sum += block.sum() * 0;
    return std::isfinite(sum);
}

}  // namespace

HessianPlan build_hessian_plan(const BodyTreeView& tree, const PairParameters& parameters,
                               const SolvationParameters& solvation,
                               std::span<const std::array<std::uint32_t, 2>> left_out,
                               std::size_t first_replaced) {
    HessianPlan plan;
    add_columns(tree, plan);
    choose_slots(tree, plan);
    add_panels(plan);
    find_first_blocks(tree, plan);
    add_numbers(parameters, SolvationNumbers(solvation), plan);
    std::vector<std::uint32_t> column_of(parameters.charge.size(), no_number);
    for (std::uint32_t c = 0; c < plan.columns.size(); ++c) {
        for (std::uint32_t a = plan.columns[c].first_atom; a < plan.columns[c].end_atom; ++a)
            column_of[plan.atoms[a]] = c;
    }
    add_masks(find_left_out(column_of.size(), left_out), column_of, plan);
    add_extras(left_out.subspan(first_replaced), column_of, plan);
    return plan;
}

bool has_hessian_kernel(const PairScheme& scheme) noexcept {
    if (scheme.distance_dielectric) {
        return scheme.electrostatics == ElectrostaticCutoff::CubicShift &&
               scheme.van_der_waals == VanDerWaalsCutoff::SmoothSwitch;
    }
    if (scheme.solvation_end > 0) return false;
    return (scheme.electrostatics == ElectrostaticCutoff::None &&
            scheme.van_der_waals == VanDerWaalsCutoff::None) ||
           (scheme.electrostatics == ElectrostaticCutoff::ForceSwitch &&
            scheme.van_der_waals == VanDerWaalsCutoff::ForceSwitch);
}

bool update_hessian_sums(const HessianPlan& plan, const PairScheme& scheme,
                         std::span<const Vec3> positions, const Vec3& origin,
                         std::span<const Vec6> screws, std::span<const RadialSlopes> replaced,
                         std::size_t rows_wanted, HessianSums& sums) {
    PALPA_ASSERT(has_hessian_kernel(scheme) && screws.size() == plan.motions.size());
    start(plan, origin, positions, screws, rows_wanted, sums);
    HessianSums::Workspace& workspace = sums.workspace;
    HessianBlock rows;
    for (std::size_t p = 0; p < plan.panels.size(); ++p) {
        const HessianPanel& panel = plan.panels[p];
        const Vec3 middle = middle_of(panel, workspace);
        place_columns(plan, origin + middle, positions, workspace);
        run_hessian_panel({&plan, &scheme, p, middle, positions, origin, replaced, &workspace},
                          rows);
        carry_rows(plan, p, sums);
        for (std::size_t lane = 0; lane < hessian_lanes; ++lane) {
            if (panel.column[lane] == no_number) continue;
            sums.rows[plan.columns[panel.column[lane]].body] +=
                block_of(rows, lane, workspace.lane_points[lane]);
        }
    }
    return is_sound(sums);
}

}  // namespace palpa
