#include "assembly/tree.h"

#include "core/load_error.h"
#include "math/eigenvectors.h"

#include <fmt/format.h>
#include <algorithm>
#include <numeric>
#include <string>

namespace palpa {
namespace {

constexpr std::size_t most_handles = 3;

// A body or a copy of one, before it has a place in the tree.
struct Leaf {
    std::uint32_t body;
    std::uint32_t links = 0;
    std::array<std::uint32_t, most_handles> link{};
};

// The bodies as a graph in which no leaf has more than three links.
struct LeafGraph {
    std::vector<Leaf> leaves;
    // Leaves at the ends of each link, parent side first; the ground is no_node.
    std::vector<std::array<std::uint32_t, 2>> ends;
};

void add_end(LeafGraph& graph, std::uint32_t leaf, std::uint32_t link, std::size_t end) {
    Leaf& at = graph.leaves[leaf];
    at.link[at.links++] = link;
    graph.ends[link][end] = leaf;
}

LeafGraph build_leaf_graph(const TorsionBodies& bodies, std::vector<double>& copies) {
    const auto count = static_cast<std::uint32_t>(bodies.bodies.size());
    std::vector<std::vector<std::uint32_t>> children(count);
    for (std::uint32_t b = 0; b < count; ++b) {
        if (!bodies.is_base(b)) children[bodies.bodies[b].parent].push_back(b);
    }
    LeafGraph graph;
    graph.ends.assign(count, {no_node, no_node});
    copies.assign(count, 1);
    for (std::uint32_t b = 0; b < count; ++b) {
        // The link to the parent and those to the children; of several copies the first and the
        // last have two of them, those between one.
        std::size_t left = 1 + children[b].size();
        if (left > most_handles) copies[b] = static_cast<double>(left - 2);
        auto leaf = static_cast<std::uint32_t>(graph.leaves.size());
        graph.leaves.push_back({b});
        add_end(graph, leaf, b, 1);
        for (const std::uint32_t child : children[b]) {
            --left;
            const bool is_last_place = graph.leaves[leaf].links + 1 == most_handles;
            if (is_last_place && left > 1) {
                const auto seam = static_cast<std::uint32_t>(graph.ends.size());
                graph.ends.push_back({no_node, no_node});
                add_end(graph, leaf, seam, 0);
                leaf = static_cast<std::uint32_t>(graph.leaves.size());
                graph.leaves.push_back({b});
                add_end(graph, leaf, seam, 1);
            }
            add_end(graph, leaf, child, 0);
        }
    }
    return graph;
}

// Divides a graph of leaves again and again, at the link that leaves the smallest larger half with
// no part of more than three handles.
class Divider {
public:
    Divider(const LeafGraph& graph, AssemblyTree& tree)
        : graph_(graph),
          tree_(tree),
          part_of_(graph.leaves.size(), no_node),
          below_(graph.leaves.size()) {}

    // The leaves that can be reached from one, as a tree of nodes; returns its root.
    std::uint32_t divide_all(std::uint32_t start, std::uint32_t ground) {
        std::vector<std::uint32_t> leaves{start};
        part_of_[start] = part_;
        for (std::size_t i = 0; i < leaves.size(); ++i) {
            for_neighbours(leaves[i], [&](std::uint32_t other, std::uint32_t) {
                if (part_of_[other] == part_) return;
                part_of_[other] = part_;
                leaves.push_back(other);
            });
        }
        return divide(leaves, {ground}, 0);
    }

private:
    using Links = std::vector<std::uint32_t>;

    // What a walk through a part finds at each leaf of what lies beyond it.
    struct Below {
        std::uint32_t arrival;  // the link by which the leaf was reached
        std::uint32_t leaves;
        std::uint32_t handles;
    };

    template <class Visit>
    void for_neighbours(std::uint32_t leaf, const Visit& visit) const {
        const Leaf& at = graph_.leaves[leaf];
        for (std::uint32_t i = 0; i < at.links; ++i) {
            const auto [a, b] = graph_.ends[at.link[i]];
            const std::uint32_t other = a == leaf ? b : a;
            if (other != no_node) visit(other, at.link[i]);
        }
    }

    // Puts the leaves of a part into the order of a walk in which everything beyond a leaf follows
    // it at once, and counts.
    void walk(std::span<std::uint32_t> leaves, const Links& handles) {
        const std::uint32_t part = part_of_[leaves[0]];
        std::vector<std::array<std::uint32_t, 2>> waiting{{leaves[0], no_node}};
        std::size_t count = 0;
        while (!waiting.empty()) {
            const auto [leaf, arrival] = waiting.back();
            waiting.pop_back();
            leaves[count++] = leaf;
            below_[leaf] = {arrival, 1, 0};
            for_neighbours(leaf, [&](std::uint32_t other, std::uint32_t link) {
                if (part_of_[other] == part && link != arrival) waiting.push_back({other, link});
            });
        }
        for (const std::uint32_t link : handles) {
            for (const std::uint32_t leaf : graph_.ends[link]) {
                if (leaf != no_node && part_of_[leaf] == part) ++below_[leaf].handles;
            }
        }
        for (std::size_t i = leaves.size(); i-- > 1;) {
            const Below& below = below_[leaves[i]];
            const auto [a, b] = graph_.ends[below.arrival];
            Below& before = below_[a == leaves[i] ? b : a];
            before.leaves += below.leaves;
            before.handles += below.handles;
        }
    }

    // The position of the leaf before which to cut.
    std::size_t find_cut(std::span<const std::uint32_t> leaves, std::size_t handles) const {
        std::size_t best = 0, smallest = 0;
        for (std::size_t i = 1; i < leaves.size(); ++i) {
            const Below& below = below_[leaves[i]];
            if (below.handles + 1 > most_handles || handles - below.handles + 1 > most_handles)
                continue;
            const std::size_t larger =
                std::max<std::size_t>(below.leaves, leaves.size() - below.leaves);
            if (best == 0 || larger < smallest) {
                best = i;
                smallest = larger;
            }
        }
        return best;
    }

    std::uint32_t divide(std::span<std::uint32_t> leaves, const Links& handles, std::size_t depth) {
        AssemblyNode node;
        node.handles = static_cast<std::uint32_t>(handles.size());
        std::ranges::copy(handles, node.links.begin());
        if (leaves.size() == 1) {
            node.body = graph_.leaves[leaves[0]].body;
            tree_.depth = std::max(tree_.depth, depth);
            return add_node(node);
        }
        walk(leaves, handles);
        const std::size_t cut = find_cut(leaves, handles.size());
        const Below below = below_[leaves[cut]];
        std::rotate(leaves.begin() + static_cast<std::ptrdiff_t>(cut),
                    leaves.begin() + static_cast<std::ptrdiff_t>(cut + below.leaves), leaves.end());
        node.link = below.arrival;
        const std::size_t near = leaves.size() - below.leaves;
        std::array parts{leaves.first(near), leaves.subspan(near)};
        // The child side of the link is B.
        const bool is_far_b = graph_.ends[node.link][1] == parts[1][0];
        if (!is_far_b) std::swap(parts[0], parts[1]);

        std::array<Links, 2> links;
        for (const std::size_t side : {0, 1}) {
            ++part_;
            for (const std::uint32_t leaf : parts[side]) part_of_[leaf] = part_;
            for (std::size_t i = 0; i < handles.size(); ++i) {
                if (!leads_out_of(handles[i], part_)) continue;
                node.side[i] = static_cast<std::uint8_t>(side);
                node.number[i] = static_cast<std::uint8_t>(links[side].size());
                links[side].push_back(handles[i]);
            }
            links[side].push_back(node.link);
        }
        node.a = divide(parts[0], links[0], depth + 1);
        node.b = divide(parts[1], links[1], depth + 1);
        return add_node(node);
    }

    bool leads_out_of(std::uint32_t link, std::uint32_t part) const {
        return std::ranges::any_of(graph_.ends[link], [&](std::uint32_t leaf) {
            return leaf != no_node && part_of_[leaf] == part;
        });
    }

    std::uint32_t add_node(AssemblyNode node) {
        const auto number = static_cast<std::uint32_t>(tree_.nodes.size());
        if (!node.is_leaf()) {
            node.part = tree_.parts++;
            node.first_handle = tree_.handles;
            node.first_pair = tree_.pairs;
            tree_.handles += node.handles;
            tree_.pairs += node.handles * (node.handles + 1) / 2;
            tree_.nodes[node.a].parent = tree_.nodes[node.b].parent = number;
        }
        tree_.nodes.push_back(node);
        return number;
    }

    const LeafGraph& graph_;
    AssemblyTree& tree_;
    std::vector<std::uint32_t> part_of_;  // the part that a leaf is in so far
    std::vector<Below> below_;            // of each leaf
    std::uint32_t part_ = 0;              // the newest
};

void add_molecules(AssemblyTree& tree) {
    tree.molecule_of = molecules_of(tree.bodies);
    for (std::uint32_t b = 0; b < tree.bodies.bodies.size(); ++b) {
        if (tree.bodies.is_base(b)) tree.bases.push_back(b);
    }
}

// Lists by body, from entries of body and anything; in the order of entries.
template <class Entry>
void group_by_body(std::span<const std::pair<std::uint32_t, Entry>> entries, std::size_t bodies,
                   std::vector<std::uint32_t>& first, std::vector<Entry>& grouped) {
    first.assign(bodies + 1, 0);
    for (const auto& [body, entry] : entries) ++first[body + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> next = first;
    grouped.resize(entries.size());
    for (const auto& [body, entry] : entries) grouped[next[body]++] = entry;
}

void add_shares(AssemblyTree& tree, std::span<const double> masses) {
    const TorsionBodies& bodies = tree.bodies;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> owned, shared;
    for (std::uint32_t atom = 0; atom < bodies.body_of.size(); ++atom) {
        owned.emplace_back(bodies.body_of[atom], atom);
    }
    shared = owned;
    for (std::uint32_t b = 0; b < bodies.bodies.size(); ++b) {
        if (bodies.is_base(b)) continue;
        const auto& [parent, axis] = bodies.bodies[b];
        shared.emplace_back(b, axis[0]);
        shared.emplace_back(parent, axis[1]);
    }
    std::vector<double> sharers(masses.size(), 0);
    for (const auto& [body, atom] : shared) sharers[atom] += 1;
    std::vector<std::pair<std::uint32_t, AtomShare>> shares;
    for (const auto& [body, atom] : shared) {
        shares.push_back({body, {atom, masses[atom] / sharers[atom]}});
    }
    group_by_body<AtomShare>(shares, bodies.bodies.size(), tree.first_share, tree.shares);
    group_by_body<std::uint32_t>(owned, bodies.bodies.size(), tree.first_atom, tree.atoms);
}

// By the moments of inertia about the centre: nothing turns about the line.
bool is_in_line(std::span<const AtomShare> shares, std::span<const Vec3> positions) {
    Vec3 centre = Vec3::Zero();
    double mass = 0;
    for (const AtomShare& share : shares) {
        centre += share.mass * positions[share.atom];
        mass += share.mass;
    }
    centre /= mass;
    Mat3 spread = Mat3::Zero();
    for (const AtomShare& share : shares) {
        const Vec3 arm = positions[share.atom] - centre;
        spread += share.mass * arm * arm.transpose();
    }
    const Vec3 moments = find_eigenvectors(spread).values;
    return moments[1] <= 1e-6 * moments[2];
}

void find_linear_bodies(AssemblyTree& tree, std::span<const Vec3> positions) {
    std::vector<std::uint32_t> bodies_of(tree.bases.size(), 0);
    for (const std::uint32_t molecule : tree.molecule_of) ++bodies_of[molecule];
    std::vector<std::string> problems;
    for (std::size_t b = 0; b < tree.bodies.bodies.size(); ++b) {
        const auto shares =
            std::span(tree.shares)
                .subspan(tree.first_share[b], tree.first_share[b + 1] - tree.first_share[b]);
        const bool is_linear = is_in_line(shares, positions);
        tree.is_linear.push_back(is_linear ? 1 : 0);
        if (!is_linear || bodies_of[tree.molecule_of[b]] == 1) continue;
        problems.push_back(
            fmt::format("a rotatable bond next to atom {} has only collinear atoms on one side, so "
                        "it cannot turn; expected it to be rigid (joints.rigid)",
                        tree.atoms[tree.first_atom[b]] + 1));
    }
    if (problems.empty()) return;
    const std::string first = problems.front();
    problems.erase(problems.begin());
    throw LoadError({}, first, problems);
}

}  // namespace

AssemblyTree build_assembly_tree(const TorsionBodies& bodies, std::span<const double> masses,
                                 std::span<const Vec3> positions) {
    AssemblyTree tree;
    tree.bodies = bodies;
    add_molecules(tree);
    add_shares(tree, masses);
    find_linear_bodies(tree, positions);
    const LeafGraph graph = build_leaf_graph(bodies, tree.copies);
    tree.links = static_cast<std::uint32_t>(graph.ends.size());
    Divider divider(graph, tree);
    for (const std::uint32_t base : tree.bases) {
        tree.roots.push_back(divider.divide_all(graph.ends[base][1], base));
    }
    return tree;
}

}  // namespace palpa
