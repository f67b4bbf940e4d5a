#include "view/find_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace palpa {
namespace {

using Cell = std::array<std::int64_t, 3>;

// The atoms that are there, sorted by cubes as wide as what must be kept clear around one.
class Taken {
public:
    Taken(std::span<const glm::vec3> atoms, double gap) : gap_(gap) {
        for (const glm::vec3& atom : atoms) {
            const Vec3 place(atom.x, atom.y, atom.z);
            // Nothing is far from what is nowhere.
            if (place.allFinite() && place.cwiseAbs().maxCoeff() < farthest) add(place);
        }
        std::ranges::sort(atoms_, {}, &Atom::cell);
    }

    static constexpr double farthest = 1e6;  // Å

    bool is_free(const Vec3& place) const {
        const Cell middle = cell_of(place);
        for (std::int64_t x = middle[0] - 1; x <= middle[0] + 1; ++x) {
            for (std::int64_t y = middle[1] - 1; y <= middle[1] + 1; ++y) {
                // Cells along z stand in a row.
                const Cell first{x, y, middle[2] - 1}, last{x, y, middle[2] + 1};
                const auto end = std::ranges::upper_bound(atoms_, last, {}, &Atom::cell);
                for (auto i = std::ranges::lower_bound(atoms_, first, {}, &Atom::cell); i != end;
                     ++i) {
                    if ((i->place - place).squaredNorm() < gap_ * gap_) return false;
                }
            }
        }
        return true;
    }

private:
    struct Atom {
        Cell cell;
        Vec3 place;
    };

    void add(const Vec3& place) { atoms_.push_back({cell_of(place), place}); }

    Cell cell_of(const Vec3& place) const {
        Cell cell{};
        for (int i = 0; i < 3; ++i)
            cell[static_cast<std::size_t>(i)] =
                static_cast<std::int64_t>(std::floor(place[i] / gap_));
        return cell;
    }

    double gap_;
    std::vector<Atom> atoms_;
};

// Steps to the right, up and towards the eye.
struct GridPlace {
    int right, up, back;

    int distance2() const { return right * right + up * up + back * back; }
};

constexpr int inner_steps2 = 8 * 8, outer_steps = 16;

// Places more than the root of `from2` steps from the middle, and at most `outer_steps`, in the
// order in which they are tried.
std::vector<GridPlace> list_shell(int from2) {
    constexpr int to = outer_steps;
    std::vector<GridPlace> places;
    for (int right = -to; right <= to; ++right) {
        for (int up = -to; up <= to; ++up) {
            for (int back = -to; back <= to; ++back) {
                const GridPlace place{right, up, back};
                if (place.distance2() > from2 && place.distance2() <= to * to)
                    places.push_back(place);
            }
        }
    }
    std::ranges::sort(places, {}, [](const GridPlace& place) {
        return std::tuple(place.distance2(), std::abs(place.back), -place.back, -place.up,
                          -place.right);
    });
    return places;
}

Vec3 as_double(const glm::vec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

std::optional<Vec3> find_room(std::span<const glm::vec3> taken, const Newcomer& newcomer,
                              const OrbitCamera& camera) {
    constexpr double farthest_angstrom = 1e4;  // that an edit may name
    const Taken there(taken, newcomer.gap);
    const Vec3 middle = as_double(camera.target), right = as_double(rightward(camera)),
               up = as_double(upward(camera)), back = as_double(backward(camera));
    const auto has_room = [&](const Vec3& place) {
        return std::ranges::all_of(newcomer.atoms,
                                   [&](const Vec3& atom) { return there.is_free(place + atom); });
    };
    double spacing = 1;
    std::vector<GridPlace> shell = list_shell(-1);
    for (; spacing < farthest_angstrom; spacing *= 2) {
        for (const GridPlace& step : shell) {
            Vec3 place = middle + spacing * (step.right * right + step.up * up + step.back * back);
            if (place.cwiseAbs().maxCoeff() > farthest_angstrom) continue;
            if (has_room(place)) return place;
        }
        shell = list_shell(inner_steps2);
    }
    return std::nullopt;
}

}  // namespace palpa
