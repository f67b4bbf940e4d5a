#include "molecule/surface/polygonise.h"

#include "core/assertion.h"

#include <algorithm>
#include <cstddef>

namespace palpa {
namespace {

constexpr unsigned corners_of_cell = 8;
constexpr unsigned edges_of_cell = 12;

struct CellEdge {
    unsigned axis = 0, low = 0;  // the lower corner
};

constexpr std::array<CellEdge, edges_of_cell> make_edges() {
    std::array<CellEdge, edges_of_cell> edges{};
    std::size_t count = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
        for (unsigned corner = 0; corner < corners_of_cell; ++corner)
            if ((corner >> axis & 1U) == 0) edges[count++] = {axis, corner};
    return edges;
}
constexpr std::array<CellEdge, edges_of_cell> cell_edges = make_edges();

unsigned edge_between(unsigned a, unsigned b) {
    for (unsigned e = 0; e < edges_of_cell; ++e)
        if (cell_edges[e].low == std::min(a, b) && (a ^ b) == 1U << cell_edges[e].axis) return e;
    return edges_of_cell;
}

// Corners of the face across `axis`, on the upper side or not, counter-clockwise from outside of
// the cell.
std::array<unsigned, 4> corners_of_face(unsigned axis, bool upper) {
    const unsigned u = 1U << (axis + 1) % 3, v = 1U << (axis + 2) % 3;
    const unsigned base = upper ? 1U << axis : 0;
    std::array<unsigned, 4> corners{base, base | u, base | u | v, base | v};
    if (!upper) std::swap(corners[1], corners[3]);
    return corners;
}

bool on_one_face(unsigned a, unsigned b) {
    for (unsigned axis = 0; axis < 3; ++axis) {
        for (const unsigned side : {0U, 1U}) {
            const auto lies = [&](unsigned e) {
                return cell_edges[e].axis != axis && (cell_edges[e].low >> axis & 1U) == side;
            };
            if (lies(a) && lies(b)) return true;
        }
    }
    return false;
}

using Triangle = std::array<std::uint8_t, 3>;

// Cuts the loop's part from `first` to `last`, whose chord is given, into triangles. A diagonal
// within a face of the cell could meet the neighbour's; no cut makes one.
bool cut_loop(const std::vector<unsigned>& loop, std::size_t first, std::size_t last,
              std::vector<Triangle>& out) {
    if (last - first < 2) return true;
    const std::size_t had = out.size();
    const auto may_cut = [&](std::size_t a, std::size_t b) {
        return b - a == 1 || !on_one_face(loop[a], loop[b]);
    };
    for (std::size_t middle = first + 1; middle < last; ++middle) {
        if (!may_cut(first, middle) || !may_cut(middle, last)) continue;
        if (cut_loop(loop, first, middle, out) && cut_loop(loop, middle, last, out)) {
            out.push_back({static_cast<std::uint8_t>(loop[first]),
                           static_cast<std::uint8_t>(loop[middle]),
                           static_cast<std::uint8_t>(loop[last])});
            return true;
        }
        out.resize(had);
    }
    return false;
}

// On each face a segment runs around every row of corners that are inside, from the edge before it
// to the edge behind it. Segments of all faces close to loops.
std::vector<Triangle> triangles_of(unsigned inside) {
    std::array<unsigned, edges_of_cell> next{};
    next.fill(edges_of_cell);
    const auto is_inside = [&](unsigned corner) { return (inside >> corner & 1U) != 0; };
    for (unsigned axis = 0; axis < 3; ++axis) {
        for (const bool upper : {false, true}) {
            const auto corners = corners_of_face(axis, upper);
            for (unsigned i = 0; i < 4; ++i) {
                if (is_inside(corners[i]) || !is_inside(corners[(i + 1) % 4])) continue;
                unsigned last = i + 1;
                while (is_inside(corners[(last + 1) % 4])) ++last;
                next[edge_between(corners[i], corners[(i + 1) % 4])] =
                    edge_between(corners[last % 4], corners[(last + 1) % 4]);
            }
        }
    }
    std::vector<Triangle> triangles;
    for (unsigned start = 0; start < edges_of_cell; ++start) {
        std::vector<unsigned> loop;
        for (unsigned edge = start; next[edge] != edges_of_cell;) {
            loop.push_back(edge);
            const unsigned follower = next[edge];
            next[edge] = edges_of_cell;
            edge = follower;
        }
        if (loop.empty()) continue;
        [[maybe_unused]] const bool is_cut = cut_loop(loop, 0, loop.size() - 1, triangles);
        PALPA_ASSERT(is_cut);
    }
    return triangles;
}

struct CellTable {
    std::vector<Triangle> triangles;
    std::array<std::size_t, 257> starts{};
};

CellTable build_table() {
    CellTable table;
    for (unsigned inside = 0; inside < 256; ++inside) {
        const std::vector<Triangle> triangles = triangles_of(inside);
        table.triangles.insert(table.triangles.end(), triangles.begin(), triangles.end());
        table.starts[inside + 1] = table.triangles.size();
    }
    return table;
}

// Numbers of the vertices on a block's edges.
using EdgeVertices = std::array<std::array<std::uint32_t, points_of_block>, 3>;

void find_crossings(const BlockSamples& samples, LatticeSurface& surface, EdgeVertices& numbers) {
    constexpr std::array<std::size_t, 3> step{point_index(1, 0, 0), point_index(0, 1, 0),
                                              point_index(0, 0, 1)};
    // Vertices never lie on lattice points, where those of several edges would be one.
    constexpr float margin = 1e-3F;
    for (int z = 0; z < block_points; ++z) {
        for (int y = 0; y < block_points; ++y) {
            for (int x = 0; x < block_points; ++x) {
                const std::array<int, 3> point{x, y, z};
                const std::size_t here = point_index(x, y, z);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    if (point[axis] == block_cells) continue;
                    const float a = samples[here], b = samples[here + step[axis]];
                    if ((a > 0) == (b > 0)) continue;
                    numbers[axis][here] = static_cast<std::uint32_t>(surface.vertices.size());
                    surface.vertices.push_back({point, static_cast<int>(axis),
                                                std::clamp(a / (a - b), margin, 1 - margin)});
                }
            }
        }
    }
}

}  // namespace

std::span<const std::array<std::uint8_t, 3>> cell_triangles(unsigned inside) {
    static const CellTable table = build_table();
    return std::span(table.triangles)
        .subspan(table.starts[inside], table.starts[inside + 1] - table.starts[inside]);
}

void polygonise(const BlockSamples& samples, LatticeSurface& surface) {
    surface.vertices.clear();
    surface.indices.clear();
    EdgeVertices numbers;  // only those of crossings are written, and read
    find_crossings(samples, surface, numbers);
    if (surface.vertices.empty()) return;
    std::array<std::size_t, corners_of_cell> corner{};
    for (unsigned c = 0; c < corners_of_cell; ++c)
        corner[c] = point_index(static_cast<int>(c & 1U), static_cast<int>(c >> 1U & 1U),
                                static_cast<int>(c >> 2U));
    for (int z = 0; z < block_cells; ++z) {
        for (int y = 0; y < block_cells; ++y) {
            for (int x = 0; x < block_cells; ++x) {
                const std::size_t here = point_index(x, y, z);
                unsigned inside = 0;
                for (unsigned c = 0; c < corners_of_cell; ++c)
                    inside |= static_cast<unsigned>(samples[here + corner[c]] > 0) << c;
                if (inside == 0 || inside == 255) continue;
                for (const Triangle& triangle : cell_triangles(inside)) {
                    for (const std::uint8_t e : triangle)
                        surface.indices.push_back(
                            numbers[cell_edges[e].axis][here + corner[cell_edges[e].low]]);
                }
            }
        }
    }
}

}  // namespace palpa
