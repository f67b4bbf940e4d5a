// A smooth curve through points, with the orientation of a ribbon along it.
#pragma once
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace palpa {

// The unit vector of `v`, or `otherwise` if `v` is zero.
glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& otherwise) noexcept;

// Position of a cross section and its directions, orthogonal unit vectors.
struct RibbonFrame {
    glm::vec3 place{0};
    glm::vec3 along{0, 0, 1};
    glm::vec3 aside{1, 0, 0};  // across the ribbon, in its plane

    glm::vec3 up() const noexcept;  // normal to its plane
};

// A natural cubic spline; the parameter rises by 1 from one guide to the next.
class RibbonPath {
public:
    // At least two guides, Å. They may coincide.
    explicit RibbonPath(std::vector<glm::vec3> guides);

    std::size_t size() const noexcept { return guides_.size(); }
    float end() const noexcept { return static_cast<float>(size() - 1); }

    glm::vec3 place(float u) const noexcept;
    glm::vec3 slope(float u) const noexcept;
    glm::vec3 along(float u) const noexcept;  // unit vector

    // Sets the orientation at each guide: `aside`, or zero if unknown. A ribbon looks the same
    // upside down, so the sign with the smaller rotation is used. Between known orientations the
    // ribbon twists as little as possible.
    void turn(std::span<const glm::vec3> aside);

    // The frame at u; call `turn` first.
    RibbonFrame frame(float u) const noexcept;

private:
    struct Piece {
        std::size_t guide;
        float t;  // 0 to 1, from this guide to the next
    };
    Piece piece_of(float u) const noexcept;
    glm::vec3 carry_aside(const glm::vec3& aside, std::size_t to) const noexcept;
    void turn_gap(std::size_t before, std::size_t behind);

    std::vector<glm::vec3> guides_;
    std::vector<glm::vec3> bends_;   // second derivatives
    std::vector<glm::vec3> asides_;  // unit vectors
};

}  // namespace palpa
