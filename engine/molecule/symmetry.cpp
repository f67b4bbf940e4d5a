#include "molecule/symmetry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <unordered_map>
#include <utility>

namespace palpa {
namespace {

constexpr double heaviest_hydrogen = 2.5;  // amu
constexpr std::uint32_t unplaced = std::numeric_limits<std::uint32_t>::max();

// Of the heavy atoms, by their place in the group.
struct Graph {
    std::vector<std::vector<std::uint32_t>> neighbours;
    std::vector<std::pair<double, std::size_t>>
        kind;  // mass, and bonds to atoms beside the group's
    std::vector<Vec3> positions;
};

Graph build_graph(const AtomTable& table, const std::vector<std::uint32_t>& atoms) {
    std::unordered_map<std::uint32_t, std::uint32_t> place_of;
    Graph graph;
    for (const std::uint32_t atom : atoms) {
        place_of.emplace(atom, static_cast<std::uint32_t>(place_of.size()));
        graph.kind.emplace_back(table.mass[atom], 0);
        graph.positions.push_back(table.positions[atom]);
    }
    graph.neighbours.resize(atoms.size());
    for (const auto& [a, b] : table.bonds) {
        const auto at_a = place_of.find(a), at_b = place_of.find(b);
        const bool has_a = at_a != place_of.end(), has_b = at_b != place_of.end();
        if (has_a && has_b) {
            graph.neighbours[at_a->second].push_back(at_b->second);
            graph.neighbours[at_b->second].push_back(at_a->second);
        } else if (has_a || has_b) {
            ++graph.kind[(has_a ? at_a : at_b)->second].second;
        }
    }
    return graph;
}

// Breadth first, so that each atom but the first of a piece is bonded to one before it.
std::vector<std::uint32_t> order_by_bonds(const Graph& graph) {
    std::vector<std::uint32_t> order;
    std::vector<bool> is_listed(graph.neighbours.size(), false);
    for (std::uint32_t first = 0; first < graph.neighbours.size(); ++first) {
        if (is_listed[first]) continue;
        is_listed[first] = true;
        order.push_back(first);
        for (std::size_t next = order.size() - 1; next < order.size(); ++next) {
            for (const std::uint32_t neighbour : graph.neighbours[order[next]]) {
                if (is_listed[neighbour]) continue;
                is_listed[neighbour] = true;
                order.push_back(neighbour);
            }
        }
    }
    return order;
}

class Search {
public:
    Search(const Graph& graph, std::size_t most)
        : graph_(graph),
          most_(most),
          order_(order_by_bonds(graph)),
          image_(graph.kind.size(), unplaced),
          is_used_(graph.kind.size(), false) {}

    std::vector<std::vector<std::uint32_t>> run() {
        std::vector<std::uint32_t> identity(graph_.kind.size());
        for (std::uint32_t i = 0; i < identity.size(); ++i) identity[i] = i;
        found_.push_back(std::move(identity));
        place(0);
        return std::move(found_);
    }

private:
    void place(std::size_t next) {
        if (found_.size() >= most_) return;
        if (next == order_.size()) {
            if (image_ != found_.front()) found_.push_back(image_);
            return;
        }
        const std::uint32_t atom = order_[next];
        for (const std::uint32_t image : list_candidates(atom)) {
            if (is_used_[image] || !fits(atom, image)) continue;
            image_[atom] = image;
            is_used_[image] = true;
            if (keeps_chirality(atom)) place(next + 1);
            image_[atom] = unplaced;
            is_used_[image] = false;
        }
    }

    std::vector<std::uint32_t> list_candidates(std::uint32_t atom) const {
        for (const std::uint32_t neighbour : graph_.neighbours[atom]) {
            if (image_[neighbour] != unplaced) return graph_.neighbours[image_[neighbour]];
        }
        return found_.front();  // all
    }

    bool fits(std::uint32_t atom, std::uint32_t image) const {
        const auto& of_atom = graph_.neighbours[atom];
        const auto& of_image = graph_.neighbours[image];
        if (graph_.kind[atom] != graph_.kind[image] || of_atom.size() != of_image.size())
            return false;
        return std::ranges::all_of(of_atom, [&](std::uint32_t neighbour) {
            return image_[neighbour] == unplaced ||
                   std::ranges::find(of_image, image_[neighbour]) != of_image.end();
        });
    }

    // Volume between unit vectors to three neighbours: 0.77 at a tetrahedral atom.
    double volume_at(std::uint32_t atom, const std::array<std::uint32_t, 3>& to) const {
        Mat3 arms;
        for (int i = 0; i < 3; ++i) {
            arms.col(i) =
                (graph_.positions[to[static_cast<std::size_t>(i)]] - graph_.positions[atom])
                    .normalized();
        }
        return arms.determinant();
    }

    // Of centres that an atom completes.
    bool keeps_chirality(std::uint32_t atom) const {
        return keeps_centre(atom) &&
               std::ranges::all_of(graph_.neighbours[atom], [&](std::uint32_t neighbour) {
                   return keeps_centre(neighbour);
               });
    }

    // Where it and three neighbours are placed.
    bool keeps_centre(std::uint32_t atom) const {
        constexpr double flat = 0.3;
        const auto& to = graph_.neighbours[atom];
        if (to.size() < 3 || image_[atom] == unplaced) return true;
        for (std::size_t i = 0; i < 3; ++i) {
            if (image_[to[i]] == unplaced) return true;
        }
        const double here = volume_at(atom, {to[0], to[1], to[2]});
        const double there = volume_at(image_[atom], {image_[to[0]], image_[to[1]], image_[to[2]]});
        return std::abs(here) <= flat || here * there >= 0;
    }

    const Graph& graph_;
    std::size_t most_;
    std::vector<std::uint32_t> order_, image_;
    std::vector<bool> is_used_;
    std::vector<std::vector<std::uint32_t>> found_;
};

}  // namespace

SymmetricAtoms find_symmetries(const AtomTable& table, std::span<const std::uint32_t> group,
                               std::size_t most) {
    SymmetricAtoms symmetric;
    std::ranges::copy_if(group, std::back_inserter(symmetric.atoms),
                         [&](std::uint32_t atom) { return table.mass[atom] > heaviest_hydrogen; });
    symmetric.symmetries = Search(build_graph(table, symmetric.atoms), most).run();
    return symmetric;
}

double find_square_distance(const SymmetricAtoms& group, const RigidMotion& motion,
                            std::span<const Vec3> from, std::span<const Vec3> to) {
    std::vector<Vec3> moved;
    for (const std::uint32_t atom : group.atoms) moved.push_back(motion * from[atom]);
    double least = std::numeric_limits<double>::infinity();
    for (const std::vector<std::uint32_t>& symmetry : group.symmetries) {
        double sum = 0;
        for (std::size_t i = 0; i < symmetry.size() && sum < least; ++i)
            sum += (moved[symmetry[i]] - to[group.atoms[i]]).squaredNorm();
        least = std::min(least, sum);
    }
    return least;
}

}  // namespace palpa
