// Whether triangles make closed surfaces, and of which kind.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace palpa::test {

struct MeshCount {
    bool is_closed = true;  // every edge belongs to two triangles, which pass it in opposite ways
    std::ptrdiff_t euler = 0;  // vertices - edges + triangles: 2 for every ball, 0 for every ring
};

inline MeshCount count_mesh(std::span<const std::uint32_t> indices) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    std::set<std::uint32_t> vertices(indices.begin(), indices.end());
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) ++edges[{indices[i + k], indices[i + (k + 1) % 3]}];
    MeshCount count;
    for (const auto& [edge, times] : edges) {
        if (times != 1 || !edges.contains({edge.second, edge.first})) count.is_closed = false;
    }
    count.euler = static_cast<std::ptrdiff_t>(vertices.size()) -
                  static_cast<std::ptrdiff_t>(edges.size() / 2) +
                  static_cast<std::ptrdiff_t>(indices.size() / 3);
    return count;
}

}  // namespace palpa::test
