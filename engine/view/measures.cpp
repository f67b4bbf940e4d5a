#include "view/measures.h"

#include "core/assertion.h"
#include "math/angles.h"
#include "molecule/measure.h"
#include "view/lines.h"
#include "view/palette.h"
#include "view/place.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

namespace palpa {
namespace {

constexpr LineLook line{0.045F, measure_colour, measure_pick};
constexpr LineLook thin{0.03F, measure_colour, measure_pick};
constexpr double in_line = 1e-6;  // rad, Å: what has no direction has no arc

// From the direction of `first` towards `second`, across the axis `normal`.
void add_measured_arc(const Vec3& centre, const Vec3& first, const Vec3& normal, double radius,
                      double angle, const std::string& text, FrameScene& frame,
                      std::vector<ViewLabel>& labels) {
    const Vec3 right = first.normalized(), up = normal.normalized().cross(right);
    const Arc arc{as_float(centre), as_float(right), as_float(up), static_cast<float>(radius),
                  static_cast<float>(angle)};
    add_arc(arc, thin, frame);
    labels.push_back({arc.place(0.5F * arc.sweep), text});
}

void add_angle(std::span<const Vec3> p, FrameScene& frame, std::vector<ViewLabel>& labels) {
    constexpr double share = 0.4, most = 0.9;  // of the shorter leg; Å
    const Vec3 first = p[0] - p[1], second = p[2] - p[1], normal = first.cross(second);
    const double angle = find_angle(p[0], p[1], p[2]);
    const std::string text = fmt::format("{:.1f}°", degrees_per_radian * angle);
    if (!(normal.norm() > in_line * first.norm() * second.norm())) {
        labels.push_back({as_float(p[1]), text});
        return;
    }
    const double radius = std::min(share * std::min(first.norm(), second.norm()), most);
    add_measured_arc(p[1], first, normal, radius, angle, text, frame, labels);
}

void add_dihedral(std::span<const Vec3> p, FrameScene& frame, std::vector<ViewLabel>& labels) {
    constexpr double radius = 0.6;  // Å
    const Vec3 axis = p[2] - p[1], centre = 0.5 * (p[1] + p[2]);
    const double dihedral = find_dihedral(p[0], p[1], p[2], p[3]);
    const std::string text = fmt::format("{:+.1f}°", degrees_per_radian * dihedral);
    const auto across_axis = [&](const Vec3& v) -> Vec3 {
        return v - v.dot(axis) / axis.squaredNorm() * axis;
    };
    if (!(axis.norm() > in_line) || !(across_axis(p[0] - p[1]).norm() > in_line) ||
        !(across_axis(p[3] - p[2]).norm() > in_line)) {
        labels.push_back({as_float(centre), text});
        return;
    }
    for (const Vec3& side : {across_axis(p[0] - p[1]), across_axis(p[3] - p[2])})
        add_stick(as_float(centre), as_float(centre + radius * side.normalized()), thin, frame);
    add_measured_arc(centre, across_axis(p[0] - p[1]), axis, radius, dihedral, text, frame, labels);
}

}  // namespace

Vec3 find_centre(std::span<const Vec3> positions, const std::vector<bool>& chosen) {
    Vec3 sum = Vec3::Zero();
    std::size_t count = 0;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        if (!chosen[i]) continue;
        sum += positions[i];
        ++count;
    }
    PALPA_ASSERT(count > 0);
    return sum / static_cast<double>(count);
}

void add_measure(std::span<const Vec3> places, FrameScene& frame, std::vector<ViewLabel>& labels) {
    constexpr float dash = 0.2F;  // Å
    PALPA_ASSERT(places.size() >= 2 && places.size() <= 4);
    for (std::size_t i = 0; i + 1 < places.size(); ++i)
        add_dashes(as_float(places[i]), as_float(places[i + 1]), dash, line, frame);
    if (places.size() == 2) {
        const double distance = (places[1] - places[0]).norm();
        labels.push_back(
            {as_float(0.5 * (places[0] + places[1])), fmt::format("{:.2f} Å", distance)});
    } else if (places.size() == 3) {
        add_angle(places, frame, labels);
    } else {
        add_dihedral(places, frame, labels);
    }
}

}  // namespace palpa
