#include "prepare/choose_states.h"

#include "prepare/anchor_grid.h"
#include "prepare/hydrogen_bonds.h"

#include <fmt/format.h>
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

constexpr double flip_price = 0.8;      // hydrogen bonds
constexpr double charge_price = 0.9;    // likewise
constexpr double frequent_gain = 0.02;  // of HSE, so that it wins among equals
constexpr double least_partner = 0.3;   // what counts as a hydrogen bond
constexpr std::size_t most_combinations = 20'000;

// The atoms of an amide or a ring: the axis, then what turns.
struct Turned {
    std::array<std::string_view, 2> axis;
    std::vector<std::string_view> atoms;
};

Turned turned_of(std::string_view residue) {
    if (residue == "ASN") return {{"CB", "CG"}, {"OD1", "ND2"}};
    if (residue == "GLN") return {{"CG", "CD"}, {"OE1", "NE2"}};
    return {{"CB", "CG"}, {"ND1", "CD2", "CE1", "NE2"}};
}

Vec3 half_turn(const Vec3& place, const Vec3& on_axis, const Vec3& axis) {
    const Vec3 from = place - on_axis;
    return on_axis + 2 * axis * axis.dot(from) - from;
}

// One way in which a group may be.
struct State {
    bool is_flipped = false;
    std::string_view histidine;
    double price = 0;  // hydrogen bonds
    std::vector<HydrogenSite> sites;
    double with_fixed = 0;  // what the sites score with all that does not change
};

struct Group {
    ResidueRange residue;
    std::vector<State> states;
    std::vector<std::size_t> near;  // other groups, rising
    std::size_t chosen = 0;
};

class StateChooser {
public:
    StateChooser(const Structure& structure, const StateSettings& settings)
        : structure_(structure),
          settings_(settings),
          residues_(find_residues(structure)),
          fixed_(find_hydrogen_sites(structure, residues_)) {
        for (const Vec3& water : settings.waters) {
            HydrogenSite site;
            site.place = water;
            site.role = HydrogenRole::Both;
            site.atom = of_water;
            fixed_.push_back(std::move(site));
        }
    }

    std::vector<ChosenState> choose() {
        for (const ResidueRange& residue : residues_) add_group(residue);
        score_with_fixed();
        find_near_groups();
        for (const std::vector<std::size_t>& cluster : find_clusters()) settle(cluster);
        drop_flips_without_partner();
        for (std::size_t i = 0; i < groups_.size(); ++i) tell(i);
        std::sort(result_.begin(), result_.end(),
                  [](const ChosenState& a, const ChosenState& b) { return a.residue < b.residue; });
        return std::move(result_);
    }

private:
    static constexpr std::size_t of_water = static_cast<std::size_t>(-1);

    std::string_view name_of(const ResidueRange& residue) const {
        return structure_.names[residue.first].residue;
    }

    bool is_given(const ResidueRange& residue) const {
        return std::binary_search(settings_.given.begin(), settings_.given.end(), residue.first);
    }

    std::size_t hydrogens(const ResidueRange& residue, std::string_view heavy) const {
        const auto atom = find_atom(structure_, residue, heavy);
        return atom ? hydrogens_on(structure_, residue, *atom).size() : 0;
    }

    void add_group(const ResidueRange& residue) {
        const std::string_view name = name_of(residue);
        const bool is_histidine = name == "HIS";
        if (!is_histidine && name != "ASN" && name != "GLN") return add_given_ring(residue);
        if (is_given(residue)) return;
        const Turned turned = turned_of(name);
        const auto is_there = [&](std::string_view atom) {
            return find_atom(structure_, residue, atom).has_value();
        };
        const bool is_whole =
            is_there(turned.axis[1]) && std::ranges::all_of(turned.atoms, is_there);
        if (is_histidine && !is_whole) {
            result_.push_back(
                {residue.first, "HSE", false, 0, "its ring is not complete in the file", false});
            return;
        }
        if (!is_whole) return;
        std::size_t given = 0;
        for (const std::string_view atom : turned.atoms) given += hydrogens(residue, atom);
        if (is_histidine && given > 0 && tell_by_hydrogens(residue)) return;
        Group group{residue, {}, {}, 0};
        add_states(group, false);
        if (settings_.may_flip && given == 0 && is_there(turned.axis[0])) add_states(group, true);
        groups_.push_back(std::move(group));
    }

    // The state that the file's hydrogens say.
    bool tell_by_hydrogens(const ResidueRange& residue) {
        const bool delta = hydrogens(residue, "ND1") > 0, epsilon = hydrogens(residue, "NE2") > 0;
        if (!delta && !epsilon) return false;
        const std::string_view state = delta && epsilon ? "HSP" : delta ? "HSD" : "HSE";
        const std::string_view where = delta && epsilon ? "hydrogens on ND1 and NE2"
                                       : delta          ? "a hydrogen on ND1"
                                                        : "a hydrogen on NE2";
        result_.push_back(
            {residue.first, state, false, 0, fmt::format("the file has {}", where), false});
        add_fixed_ring(residue, state);
        return true;
    }

    void add_given_ring(const ResidueRange& residue) {
        const std::string_view name = name_of(residue);
        if (name == "HSD" || name == "HSE" || name == "HSP") add_fixed_ring(residue, name);
    }

    void add_fixed_ring(const ResidueRange& residue, std::string_view state) {
        const auto is_there = [&](std::string_view atom) {
            return find_atom(structure_, residue, atom).has_value();
        };
        const Turned turned = turned_of("HIS");
        if (!std::ranges::all_of(turned.atoms, is_there) || !is_there("CG")) return;
        for (HydrogenSite& site : sites_of(residue, false, state)) {
            fixed_.push_back(std::move(site));
        }
    }

    void add_states(Group& group, bool is_flipped) {
        const double price = is_flipped ? flip_price : 0;
        if (name_of(group.residue) != "HIS") {
            group.states.push_back(
                {is_flipped, {}, price, sites_of(group.residue, is_flipped, {}), 0});
            return;
        }
        for (const std::string_view state : {"HSE", "HSD", "HSP"}) {
            const double more = state == "HSP" ? charge_price : state == "HSE" ? -frequent_gain : 0;
            if (state == "HSP" && !has_acid_near(group.residue)) continue;
            group.states.push_back(
                {is_flipped, state, price + more, sites_of(group.residue, is_flipped, state), 0});
        }
    }

    bool has_acid_near(const ResidueRange& residue) const {
        return std::ranges::any_of(fixed_, [&](const HydrogenSite& site) {
            if (site.role != HydrogenRole::Taker || !site.is_charged) return false;
            return std::ranges::any_of(turned_of("HIS").atoms, [&](std::string_view name) {
                const auto atom = find_atom(structure_, residue, name);
                return atom &&
                       (structure_.positions[*atom] - site.place).norm() < hydrogen_bond_reach;
            });
        });
    }

    Vec3 place_of(const ResidueRange& residue, std::string_view atom, bool is_flipped) const {
        const std::size_t index = find_atom(structure_, residue, atom).value_or(residue.first);
        const Vec3& place = structure_.positions[index];
        if (!is_flipped) return place;
        const Turned turned = turned_of(name_of(residue));
        const auto on = [&](std::string_view name) -> const Vec3& {
            return structure_
                .positions[find_atom(structure_, residue, name).value_or(residue.first)];
        };
        const Vec3 axis = on(turned.axis[1]) - on(turned.axis[0]);
        return axis.norm() > 0 ? half_turn(place, on(turned.axis[1]), axis.normalized()) : place;
    }

    std::vector<HydrogenSite> sites_of(const ResidueRange& residue, bool is_flipped,
                                       std::string_view histidine) const {
        return histidine.empty() ? amide_sites(residue, is_flipped)
                                 : ring_sites(residue, is_flipped, histidine);
    }

    std::vector<HydrogenSite> amide_sites(const ResidueRange& residue, bool is_flipped) const {
        const Turned turned = turned_of(name_of(residue));
        const auto place = [&](std::string_view atom) {
            return place_of(residue, atom, is_flipped);
        };
        const Vec3 c = place(turned.axis[1]), o = place(turned.atoms[0]),
                   n = place(turned.atoms[1]);
        const auto atom = [&](std::string_view name) {
            return find_atom(structure_, residue, name).value_or(residue.first);
        };
        HydrogenSite taker{o, HydrogenRole::Taker, false, {}, 65 * pi / 180, atom(turned.atoms[0])};
        HydrogenSite giver{n, HydrogenRole::Giver, false, {}, 30 * pi / 180, atom(turned.atoms[1])};
        const Vec3 to_o = o - c, to_n = n - c;
        const Vec3 normal = to_o.cross(to_n);
        if (to_o.norm() > 0) taker.outward = {to_o.normalized()};
        if (normal.norm() > 0) {
            // Both hydrogens are in the plane, 60 degrees to either side of the bond.
            for (const double angle : {pi / 3, -pi / 3}) {
                giver.outward.push_back(Eigen::AngleAxisd(angle, normal.normalized()) *
                                        to_n.normalized());
            }
        }
        return {taker, giver};
    }

    std::vector<HydrogenSite> ring_sites(const ResidueRange& residue, bool is_flipped,
                                         std::string_view state) const {
        constexpr std::array<std::array<std::string_view, 3>, 4> corners{{{"ND1", "CG", "CE1"},
                                                                          {"CE1", "ND1", "NE2"},
                                                                          {"NE2", "CE1", "CD2"},
                                                                          {"CD2", "NE2", "CG"}}};
        std::vector<HydrogenSite> sites;
        for (const auto& [name, one, other] : corners) {
            HydrogenSite site;
            site.place = place_of(residue, name, is_flipped);
            site.atom = find_atom(structure_, residue, name).value_or(residue.first);
            site.half_angle = 30 * pi / 180;
            const Vec3 outward = 2 * site.place - place_of(residue, one, is_flipped) -
                                 place_of(residue, other, is_flipped);
            if (outward.norm() > 0) site.outward = {outward.normalized()};
            const bool has_hydrogen =
                state == "HSP" || (name == "ND1" ? state == "HSD" : state == "HSE");
            site.role = name[0] == 'C' ? HydrogenRole::Carbon
                        : has_hydrogen ? HydrogenRole::Giver
                                       : HydrogenRole::Taker;
            sites.push_back(std::move(site));
        }
        return sites;
    }

    bool is_own(const Group& group, const HydrogenSite& site) const {
        return site.atom >= group.residue.first && site.atom < group.residue.end();
    }

    void score_with_fixed() {
        std::vector<Vec3> places;
        for (const HydrogenSite& site : fixed_) places.push_back(site.place);
        const AnchorGrid grid(std::move(places));
        for (Group& group : groups_) {
            for (State& state : group.states) {
                for (const HydrogenSite& site : state.sites) {
                    grid.visit_near(site.place, hydrogen_bond_reach, [&](std::uint32_t i) {
                        if (!is_own(group, fixed_[i])) {
                            state.with_fixed += score_contact(site, fixed_[i]);
                        }
                    });
                }
            }
        }
    }

    void find_near_groups() {
        std::vector<Vec3> places;
        for (const Group& group : groups_) places.push_back(group.states[0].sites[0].place);
        const AnchorGrid grid(std::move(places));
        constexpr double ring =
            2.5;  // Å, from any of a group's sites to any other, both ways round
        for (std::size_t i = 0; i < groups_.size(); ++i) {
            grid.visit_near(groups_[i].states[0].sites[0].place, hydrogen_bond_reach + 4 * ring,
                            [&](std::uint32_t j) {
                                if (j != i && may_meet(groups_[i], groups_[j])) {
                                    groups_[i].near.push_back(j);
                                }
                            });
            std::sort(groups_[i].near.begin(), groups_[i].near.end());
        }
    }

    static bool may_meet(const Group& a, const Group& b) {
        return std::ranges::any_of(a.states, [&](const State& one) {
            return std::ranges::any_of(
                b.states, [&](const State& other) { return score_between(one, other) != 0; });
        });
    }

    static double score_between(const State& a, const State& b) {
        double sum = 0;
        for (const HydrogenSite& one : a.sites) {
            for (const HydrogenSite& other : b.sites) sum += score_contact(one, other);
        }
        return sum;
    }

    std::vector<std::vector<std::size_t>> find_clusters() const {
        std::vector<std::vector<std::size_t>> clusters;
        std::vector<bool> is_listed(groups_.size(), false);
        for (std::size_t i = 0; i < groups_.size(); ++i) {
            if (is_listed[i]) continue;
            std::vector<std::size_t> cluster{i};
            is_listed[i] = true;
            for (std::size_t next = 0; next < cluster.size(); ++next) {
                for (const std::size_t other : groups_[cluster[next]].near) {
                    if (is_listed[other]) continue;
                    is_listed[other] = true;
                    cluster.push_back(other);
                }
            }
            clusters.push_back(std::move(cluster));
        }
        return clusters;
    }

    // Of a group in a state, the others as chosen.
    double score(const Group& group, std::size_t state) const {
        const State& own = group.states[state];
        double sum = own.with_fixed - own.price;
        for (const std::size_t other : group.near) {
            sum += score_between(own, groups_[other].states[groups_[other].chosen]);
        }
        return sum;
    }

    double score(const std::vector<std::size_t>& cluster) const {
        double sum = 0;
        for (const std::size_t i : cluster) {
            const Group& group = groups_[i];
            const State& own = group.states[group.chosen];
            sum += own.with_fixed - own.price;
            for (const std::size_t other : group.near) {
                if (other < i) continue;
                sum += score_between(own, groups_[other].states[groups_[other].chosen]);
            }
        }
        return sum;
    }

    void settle(const std::vector<std::size_t>& cluster) {
        std::size_t combinations = 1;
        for (const std::size_t i : cluster) {
            combinations = std::min(combinations * groups_[i].states.size(), most_combinations + 1);
        }
        if (combinations > most_combinations) return settle_in_turn(cluster);
        double best = score(cluster);
        std::vector<std::size_t> chosen(cluster.size(), 0);
        for (std::size_t number = 1; number < combinations; ++number) {
            std::size_t rest = number;
            for (const std::size_t i : cluster) {
                groups_[i].chosen = rest % groups_[i].states.size();
                rest /= groups_[i].states.size();
            }
            const double here = score(cluster);
            if (here <= best + 1e-9) continue;
            best = here;
            for (std::size_t k = 0; k < cluster.size(); ++k) chosen[k] = groups_[cluster[k]].chosen;
        }
        for (std::size_t k = 0; k < cluster.size(); ++k) groups_[cluster[k]].chosen = chosen[k];
    }

    void settle_in_turn(const std::vector<std::size_t>& cluster) {
        constexpr int most_sweeps = 20;
        bool is_still = false;
        for (int sweep = 0; sweep < most_sweeps && !is_still; ++sweep) {
            is_still = true;
            for (const std::size_t i : cluster)
                is_still = !choose_best(groups_[i], true) && is_still;
        }
    }

    // Whether another state is better, the others as they are.
    bool choose_best(Group& group, bool may_flip) const {
        const std::size_t before = group.chosen;
        double best = -1e9;
        for (std::size_t state = 0; state < group.states.size(); ++state) {
            if (group.states[state].is_flipped && !may_flip) continue;
            const double here = score(group, state);
            if (here <= best + 1e-9) continue;
            best = here;
            group.chosen = state;
        }
        return group.chosen != before;
    }

    // Hydrogen bonds of a state, those to C-H left out.
    double bonds(const Group& group, std::size_t number) const {
        double sum = 0;
        for_contacts(group, group.states[number],
                     [&](const HydrogenSite& own, const HydrogenSite&, double score) {
                         if (own.role != HydrogenRole::Carbon && score > least_partner)
                             sum += score;
                     });
        return sum;
    }

    template <class Visit>
    void for_contacts(const Group& group, const State& state, const Visit& visit) const {
        for (const HydrogenSite& own : state.sites) {
            for (const HydrogenSite& other : fixed_) {
                if ((other.place - own.place).squaredNorm() >
                        hydrogen_bond_reach * hydrogen_bond_reach ||
                    is_own(group, other)) {
                    continue;
                }
                visit(own, other, score_contact(own, other));
            }
            for (const std::size_t i : group.near) {
                const Group& there = groups_[i];
                for (const HydrogenSite& other : there.states[there.chosen].sites) {
                    visit(own, other, score_contact(own, other));
                }
            }
        }
    }

    void drop_flips_without_partner() {
        for (Group& group : groups_) {
            if (!group.states[group.chosen].is_flipped) continue;
            const std::size_t flipped = group.chosen;
            choose_best(group, false);
            if (bonds(group, flipped) > bonds(group, group.chosen) + least_partner) {
                group.chosen = flipped;
            }
        }
    }

    std::string atom_name(const HydrogenSite& site) const {
        if (site.atom == of_water) return "a water";
        const AtomName& name = structure_.names[site.atom];
        const std::string& chain = chain_of(structure_, site.atom);
        return fmt::format("{} {}{}{} {}", name.residue, chain, chain.empty() ? "" : " ",
                           name.number, name.atom);
    }

    std::string reason_for(const Group& group, const State& state) const {
        std::vector<std::pair<double, std::string>> found;
        for_contacts(
            group, state, [&](const HydrogenSite& own, const HydrogenSite& other, double score) {
                if (score < 0.1 || own.role == HydrogenRole::Carbon) return;
                const bool gives = own.role == HydrogenRole::Giver;
                found.emplace_back(
                    -score, fmt::format("{} {} {}, {:.1f} Å", structure_.names[own.atom].atom,
                                        gives ? "gives to" : "takes from", atom_name(other),
                                        (own.place - other.place).norm()));
            });
        std::sort(found.begin(), found.end());
        std::string text;
        for (std::size_t i = 0; i < std::min<std::size_t>(found.size(), 3); ++i) {
            text += (i == 0 ? "" : "; ") + found[i].second;
        }
        return text;
    }

    bool has_two_takers(const Group& group, const State& state) const {
        std::size_t count = 0;
        for (const HydrogenSite& own : state.sites) {
            if (own.role == HydrogenRole::Carbon) continue;
            HydrogenSite giver = own;
            giver.role = HydrogenRole::Giver;
            bool has_taker = false;
            for_contacts(group, State{false, {}, 0, {giver}, 0},
                         [&](const HydrogenSite&, const HydrogenSite& other, double score) {
                             has_taker =
                                 has_taker || (other.role == HydrogenRole::Taker && score > 0.4);
                         });
            if (has_taker) ++count;
        }
        return count == 2;
    }

    void tell(std::size_t number) {
        Group& group = groups_[number];
        const std::size_t chosen = group.chosen;
        const State& state = group.states[chosen];
        if (!state.is_flipped && state.histidine.empty()) return;
        ChosenState result{group.residue.first,      state.histidine,
                           state.is_flipped,         0,
                           reason_for(group, state), false};
        if (state.is_flipped) {
            const double with = score(group, chosen);
            choose_best(group, false);
            result.gain = with + flip_price - score(group, group.chosen);
            group.chosen = chosen;
        }
        if (!state.histidine.empty()) {
            if (result.reason.empty()) {
                result.reason = "nothing near decides, the more frequent tautomer";
            }
            result.might_be_charged = state.histidine != "HSP" && has_two_takers(group, state);
        }
        result_.push_back(std::move(result));
    }

    const Structure& structure_;
    const StateSettings& settings_;
    const std::vector<ResidueRange> residues_;
    std::vector<HydrogenSite> fixed_;  // of all that does not change
    std::vector<Group> groups_;
    std::vector<ChosenState> result_;
};

}  // namespace

std::vector<ChosenState> choose_states(const Structure& structure, const StateSettings& settings) {
    return StateChooser(structure, settings).choose();
}

void flip(Structure& structure, const ResidueRange& residue) {
    const Turned turned = turned_of(structure.names[residue.first].residue);
    const auto one = find_atom(structure, residue, turned.axis[0]);
    const auto other = find_atom(structure, residue, turned.axis[1]);
    if (!one || !other) return;
    const Vec3 axis = structure.positions[*other] - structure.positions[*one];
    if (!(axis.norm() > 0)) return;
    for (const std::string_view name : turned.atoms) {
        const auto atom = find_atom(structure, residue, name);
        if (!atom) continue;
        structure.positions[*atom] =
            half_turn(structure.positions[*atom], structure.positions[*other], axis.normalized());
    }
}

}  // namespace palpa
