#include "view/clip.h"

#include "view/build_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

namespace palpa {
namespace {

constexpr float beside = 2;        // Å
constexpr std::size_t cells = 96;  // either way, over what the molecule covers

// How far away the molecule in hand is at most, for the places of the picture that it covers.
class Silhouette {
public:
    Silhouette(std::uint32_t grabbed_atoms, const OrbitCamera& camera, const FrameScene& frame)
        : right_(rightward(camera)),
          up_(upward(camera)),
          back_(backward(camera)),
          eye_(camera.target + camera.distance * back_) {
        std::vector<Place> places;
        for (const SphereShape& sphere : frame.spheres) {
            if (sphere.pick >= grabbed_atoms) continue;
            const std::optional<Place> place = find_place(sphere.centre);
            if (!place) continue;
            places.push_back(*place);
            places.back().reach = (sphere.radius + beside) / place->depth;
        }
        if (places.empty()) return;
        low_ = {places[0].x, places[0].y};
        std::array<float, 2> high = low_;
        for (const Place& place : places) {
            low_ = {std::min(low_[0], place.x - place.reach),
                    std::min(low_[1], place.y - place.reach)};
            high = {std::max(high[0], place.x + place.reach),
                    std::max(high[1], place.y + place.reach)};
        }
        size_ = {high[0] - low_[0], high[1] - low_[1]};
        farthest_.assign(cells * cells, 0);
        for (const Place& place : places) cover(place);
    }

    bool is_hiding(const glm::vec3& point) const {
        if (farthest_.empty()) return false;
        const std::optional<Place> place = find_place(point);
        if (!place) return true;  // behind the camera
        const float x = (place->x - low_[0]) / size_[0], y = (place->y - low_[1]) / size_[1];
        if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) return false;
        return place->depth < farthest_[cell_at(y) * cells + cell_at(x)];
    }

private:
    // In the picture's plane at a distance of 1, and how far away.
    struct Place {
        float x, y, depth;
        float reach = 0;
    };

    std::optional<Place> find_place(const glm::vec3& point) const {
        constexpr float nearest = 0.1F;  // Å
        const glm::vec3 off = point - eye_;
        const float depth = -glm::dot(off, back_);
        if (!(depth > nearest)) return std::nullopt;
        return Place{glm::dot(off, right_) / depth, glm::dot(off, up_) / depth, depth};
    }

    static std::size_t cell_at(float share) {
        const float last = static_cast<float>(cells - 1);
        return static_cast<std::size_t>(std::clamp(share * static_cast<float>(cells), 0.0F, last));
    }

    void cover(const Place& place) {
        const auto first = [&](float middle, std::size_t axis) {
            return cell_at((middle - place.reach - low_[axis]) / size_[axis]);
        };
        const auto last = [&](float middle, std::size_t axis) {
            return cell_at((middle + place.reach - low_[axis]) / size_[axis]);
        };
        const auto middle_of = [&](std::size_t cell, std::size_t axis) {
            return low_[axis] +
                   size_[axis] * (static_cast<float>(cell) + 0.5F) / static_cast<float>(cells);
        };
        for (std::size_t row = first(place.y, 1); row <= last(place.y, 1); ++row) {
            for (std::size_t column = first(place.x, 0); column <= last(place.x, 0); ++column) {
                const float dx = middle_of(column, 0) - place.x, dy = middle_of(row, 1) - place.y;
                if (dx * dx + dy * dy > place.reach * place.reach) continue;
                float& depth = farthest_[row * cells + column];
                depth = std::max(depth, place.depth);
            }
        }
    }

    glm::vec3 right_, up_, back_, eye_;
    std::array<float, 2> low_{}, size_{1, 1};
    std::vector<float> farthest_;  // by rows of cells; 0 where it covers nothing
};

// Places of a frame, told apart to the bit: a bond ends where its atom is.
class Places {
public:
    void add(const glm::vec3& place) { places_.insert(key(place)); }
    bool has(const glm::vec3& place) const { return places_.contains(key(place)); }

private:
    using Key = std::tuple<float, float, float>;
    static Key key(const glm::vec3& p) { return {p.x, p.y, p.z}; }
    std::set<Key> places_;
};

// Atoms to which the dashes of a hydrogen bond lead.
Places find_bonded(const FrameScene& frame) {
    constexpr float gap = 0.2F;  // Å, at most from an atom to its dash
    std::vector<glm::vec3> ends;
    for (const ConeShape& cone : frame.cones) {
        if (cone.pick == hydrogen_bond_pick) ends.insert(ends.end(), {cone.a, cone.b});
    }
    Places bonded;
    for (const SphereShape& sphere : frame.spheres) {
        const auto is_at = [&](const glm::vec3& end) {
            return glm::distance(end, sphere.centre) < sphere.radius + gap;
        };
        if (std::ranges::any_of(ends, is_at)) bonded.add(sphere.centre);
    }
    return bonded;
}

}  // namespace

void clip_in_front(std::uint32_t grabbed_atoms, const OrbitCamera& camera, FrameScene& frame) {
    const Silhouette silhouette(grabbed_atoms, camera, frame);
    const auto is_of_others = [&](std::uint32_t pick) {
        return pick >= grabbed_atoms && pick < first_sign_pick;
    };
    const Places bonded = find_bonded(frame);
    const auto is_in_view = [&](const glm::vec3& a, const glm::vec3& b) {
        return (!silhouette.is_hiding(a) && !silhouette.is_hiding(b)) || bonded.has(a) ||
               bonded.has(b);
    };
    Places ends, kept;  // of bonds, and of those that are left
    for (const ConeShape& cone : frame.cones) {
        if (!is_of_others(cone.pick)) continue;
        for (const glm::vec3& end : {cone.a, cone.b}) {
            ends.add(end);
            if (is_in_view(cone.a, cone.b)) kept.add(end);
        }
    }
    std::erase_if(frame.cones, [&](const ConeShape& cone) {
        return is_of_others(cone.pick) && !is_in_view(cone.a, cone.b);
    });
    std::erase_if(frame.spheres, [&](const SphereShape& sphere) {
        if (!is_of_others(sphere.pick)) return false;
        return ends.has(sphere.centre) ? !kept.has(sphere.centre)
                                       : silhouette.is_hiding(sphere.centre);
    });
}

}  // namespace palpa
