#include "formats/box.h"

#include <cmath>
#include <numbers>

namespace palpa {

std::optional<Mat3> find_box(const Vec3& lengths, const Vec3& cosines) noexcept {
    // Written so that what is not a number fails.
    if (!(lengths.minCoeff() > 0) || !lengths.allFinite() || !cosines.allFinite()) return {};
    const double sine_squared = 1 - cosines.z() * cosines.z();
    if (!(sine_squared > 0)) return {};
    const double sine = std::sqrt(sine_squared);
    const double along_y = (cosines.x() - cosines.y() * cosines.z()) / sine;
    const double along_z_squared = 1 - cosines.y() * cosines.y() - along_y * along_y;
    if (!(along_z_squared > 0)) return {};
    Mat3 box;
    box.col(0) = Vec3(lengths.x(), 0, 0);
    box.col(1) = lengths.y() * Vec3(cosines.z(), sine, 0);
    box.col(2) = lengths.z() * Vec3(cosines.y(), along_y, std::sqrt(along_z_squared));
    return box;
}

std::optional<Mat3> find_box_deg(const Vec3& lengths, const Vec3& angles_deg) noexcept {
    Vec3 cosines;
    for (Eigen::Index i = 0; i < 3; ++i) {
        if (!(angles_deg[i] > 0 && angles_deg[i] < 180)) return {};
        cosines[i] = std::sin((90 - angles_deg[i]) * std::numbers::pi / 180);
    }
    return find_box(lengths, cosines);
}

Vec3 lengths_of(const Mat3& box) noexcept {
    return {box.col(0).norm(), box.col(1).norm(), box.col(2).norm()};
}

Vec3 cosines_of(const Mat3& box) noexcept {
    const Vec3 lengths = lengths_of(box);
    return {box.col(1).dot(box.col(2)) / (lengths.y() * lengths.z()),
            box.col(0).dot(box.col(2)) / (lengths.x() * lengths.z()),
            box.col(0).dot(box.col(1)) / (lengths.x() * lengths.y())};
}

bool is_lower_box(const Mat3& box) noexcept {
    const double most = 1e-6 * lengths_of(box).maxCoeff();
    return box.allFinite() && box(0, 0) > 0 && box(1, 1) > 0 && box(2, 2) > 0 &&
           std::abs(box(1, 0)) <= most && std::abs(box(2, 0)) <= most &&
           std::abs(box(2, 1)) <= most;
}

}  // namespace palpa
