#include "prepare/choose_states.h"

#include "molecule/point_grid.h"
#include "prepare/hydrogen_bonds.h"
#include "prepare/turned_sites.h"

#include <fmt/format.h>
#include <algorithm>
#include <utility>

namespace palpa {
namespace {

constexpr double flip_price = 0.6;      // hydrogen bonds
constexpr double charge_price = 0.9;    // likewise
constexpr double frequent_gain = 0.02;  // of HSE, so that it wins among equals
constexpr double least_partner = 0.3;   // what counts as a hydrogen bond
constexpr std::size_t most_combinations = 20'000;

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

    static bool is_among(std::span<const std::size_t> firsts, const ResidueRange& residue) {
        return std::binary_search(firsts.begin(), firsts.end(), residue.first);
    }

    std::size_t hydrogens(const ResidueRange& residue, std::string_view heavy) const {
        const auto atom = find_atom(structure_, residue, heavy);
        return atom ? hydrogens_on(structure_, residue, *atom).size() : 0;
    }

    void add_group(const ResidueRange& residue) {
        const std::string_view name = name_of(residue);
        const bool is_histidine = name == "HIS";
        if (!is_histidine && name != "ASN" && name != "GLN") return add_given_ring(residue);
        if (is_among(settings_.given, residue)) return;
        const TurnedAtoms turned = turned_atoms_of(name);
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
        const bool may_flip = settings_.may_flip && given == 0 && is_there(turned.axis[0]);
        if (may_flip && !is_among(settings_.held, residue)) add_states(group, true);
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
        const TurnedAtoms turned = turned_atoms_of("HIS");
        if (!std::ranges::all_of(turned.atoms, is_there) || !is_there("CG")) return;
        for (HydrogenSite& site : find_turned_sites(structure_, residue, false, state)) {
            fixed_.push_back(std::move(site));
        }
    }

    void add_states(Group& group, bool is_flipped) {
        const double price = is_flipped ? flip_price : 0;
        if (name_of(group.residue) != "HIS") {
            group.states.push_back({is_flipped,
                                    {},
                                    price,
                                    find_turned_sites(structure_, group.residue, is_flipped, {}),
                                    0});
            return;
        }
        for (const std::string_view state : {"HSE", "HSD", "HSP"}) {
            const double more = state == "HSP" ? charge_price : state == "HSE" ? -frequent_gain : 0;
            if (state == "HSP" && !has_acid_near(group.residue)) continue;
            group.states.push_back({is_flipped, state, price + more,
                                    find_turned_sites(structure_, group.residue, is_flipped, state),
                                    0});
        }
    }

    bool has_acid_near(const ResidueRange& residue) const {
        return std::ranges::any_of(fixed_, [&](const HydrogenSite& site) {
            if (site.role != HydrogenRole::Taker || !site.is_charged) return false;
            return std::ranges::any_of(turned_atoms_of("HIS").atoms, [&](std::string_view name) {
                const auto atom = find_atom(structure_, residue, name);
                return atom &&
                       (structure_.positions[*atom] - site.place).norm() < hydrogen_bond_reach;
            });
        });
    }

    bool is_own(const Group& group, const HydrogenSite& site) const {
        return site.atom >= group.residue.first && site.atom < group.residue.end();
    }

    void score_with_fixed() {
        std::vector<Vec3> places;
        for (const HydrogenSite& site : fixed_) places.push_back(site.place);
        const PointGrid grid(std::move(places));
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
        const PointGrid grid(std::move(places));
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
                                        gives ? "donates to" : "accepts from", atom_name(other),
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
                result.reason = "no hydrogen bond decides; the more frequent tautomer was used";
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

}  // namespace palpa
