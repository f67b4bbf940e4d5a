#include "view/clip.h"

#include "view/build_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr float clearance = 2;     // Å
constexpr std::size_t cells = 96;  // either way, over what the molecule covers

// How far away the molecule in hand is at most, for the places of the picture that it covers.
class Silhouette {
public:
    Silhouette(const AtomRange& held, const OrbitCamera& camera, const FrameScene& frame)
        : right_(rightward(camera)),
          up_(upward(camera)),
          back_(backward(camera)),
          eye_(camera.target + camera.distance * back_) {
        std::vector<Place> places;
        for (const SphereShape& sphere : frame.spheres) {
            if (!has_atom(held, sphere.pick)) continue;
            const std::optional<Place> place = find_place(sphere.centre);
            if (!place) continue;
            places.push_back(*place);
            places.back().reach = (sphere.radius + clearance) / place->depth;
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

// What is where an atom is.
struct Spot {
    bool is_hiding = false, is_bonded = false;    // to the molecule in hand, by a hydrogen bond
    bool has_stick = false, keeps_stick = false;  // of others
};

struct PlaceHash {
    std::size_t operator()(const glm::vec3& place) const noexcept {
        constexpr std::size_t prime = 1'000'003;
        const std::hash<float> hash;
        return (hash(place.x) * prime + hash(place.y)) * prime + hash(place.z);
    }
};

// By places that are the same bit for bit: a bond ends where its atom is.
using Spots = std::unordered_map<glm::vec3, Spot, PlaceHash>;

// The ends of all dashes of hydrogen bonds.
class Dashes {
public:
    explicit Dashes(const FrameScene& frame) {
        for (const ConeShape& cone : frame.cones) {
            if (cone.pick != hydrogen_bond_pick) continue;
            for (const glm::vec3& end : {cone.a, cone.b}) {
                ends_.push_back(end);
                low_ = glm::min(low_, end);
                high_ = glm::max(high_, end);
            }
        }
    }

    bool lead_to(const SphereShape& atom) const {
        constexpr float gap = 0.2F;  // Å, at most
        const float reach = atom.radius + gap;
        if (glm::clamp(atom.centre, low_ - reach, high_ + reach) != atom.centre) return false;
        return std::ranges::any_of(
            ends_, [&](const glm::vec3& end) { return glm::distance(end, atom.centre) < reach; });
    }

private:
    std::vector<glm::vec3> ends_;
    glm::vec3 low_{std::numeric_limits<float>::max()}, high_{std::numeric_limits<float>::lowest()};
};

Spots find_spots(const Silhouette& silhouette, const FrameScene& frame) {
    const Dashes dashes(frame);
    Spots spots;
    spots.reserve(frame.spheres.size());
    for (const SphereShape& sphere : frame.spheres) {
        Spot& spot = spots[sphere.centre];
        spot.is_hiding = silhouette.is_hiding(sphere.centre);
        spot.is_bonded = spot.is_bonded || dashes.lead_to(sphere);
    }
    return spots;
}

// Cuts away what a triangle's vertices say is in front; the mesh is open then.
template <class IsHiding>
void clip_mesh(MeshShape& mesh, const IsHiding& is_hiding) {
    std::vector<bool> hides;
    for (const MeshVertex& vertex : mesh.vertices) hides.push_back(is_hiding(vertex));
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto corners = std::span(mesh.indices).subspan(i, 3);
        if (std::ranges::any_of(corners, [&](std::uint32_t v) { return hides[v]; })) continue;
        kept.insert(kept.end(), corners.begin(), corners.end());
    }
    mesh.is_closed = mesh.is_closed && kept.size() == mesh.indices.size();
    mesh.indices = std::move(kept);
}

}  // namespace

void clip_in_front(const AtomRange& held, const OrbitCamera& camera, FrameScene& frame) {
    const Silhouette silhouette(held, camera, frame);
    const auto is_of_others = [&](std::uint32_t pick) {
        return !has_atom(held, pick) && pick < first_sign_pick;
    };
    Spots spots = find_spots(silhouette, frame);
    const auto find = [&](const glm::vec3& place) {
        const auto found = spots.find(place);
        return found == spots.end() ? nullptr : &found->second;
    };
    const auto is_hiding = [&](const glm::vec3& place, const Spot* spot) {
        return spot ? spot->is_hiding : silhouette.is_hiding(place);
    };
    std::erase_if(frame.cones, [&](const ConeShape& cone) {
        if (!is_of_others(cone.pick)) return false;
        Spot *const a = find(cone.a), *const b = find(cone.b);
        const bool hides = is_hiding(cone.a, a) || is_hiding(cone.b, b);
        const bool is_left = !hides || (a && a->is_bonded) || (b && b->is_bonded);
        for (Spot* const end : {a, b}) {
            if (!end) continue;
            end->has_stick = true;
            end->keeps_stick = end->keeps_stick || is_left;
        }
        return !is_left;
    });
    std::erase_if(frame.spheres, [&](const SphereShape& sphere) {
        if (!is_of_others(sphere.pick)) return false;
        const Spot& spot = spots.at(sphere.centre);
        return spot.has_stick ? !spot.keeps_stick : spot.is_hiding;
    });
    for (MeshShape& mesh : frame.meshes) {
        clip_mesh(mesh, [&](const MeshVertex& vertex) {
            return is_of_others(vertex.pick) && silhouette.is_hiding(vertex.place);
        });
    }
}

}  // namespace palpa
