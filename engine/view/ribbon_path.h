// A smooth curve through places, and which way a ribbon along it is turned.
#pragma once
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace palpa {

// `v` of length 1, or what else there is where it has none.
glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& otherwise) noexcept;

// Where a cross section is, and its directions, unit vectors at right angles to each other.
struct RibbonFrame {
    glm::vec3 place{0};
    glm::vec3 along{0, 0, 1};
    glm::vec3 aside{1, 0, 0};  // across the ribbon, in its plane

    glm::vec3 up() const noexcept;  // out of its plane
};

// A natural cubic spline, a unit of its parameter from one guide to the next.
class RibbonPath {
public:
    // At least two guides, Å. They may coincide.
    explicit RibbonPath(std::vector<glm::vec3> guides);

    std::size_t size() const noexcept { return guides_.size(); }
    float end() const noexcept { return static_cast<float>(size() - 1); }

    glm::vec3 place(float u) const noexcept;
    glm::vec3 slope(float u) const noexcept;
    glm::vec3 along(float u) const noexcept;  // unit vector

    // How the ribbon is turned at each guide: `aside` where it is known, zero where it is not. A
    // ribbon looks the same upside down, so directions are taken with either sign, whichever turns
    // less. In between it turns as little as it can.
    void turn(std::span<const glm::vec3> aside);

    // As the ribbon is turned; `turn` comes before.
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
