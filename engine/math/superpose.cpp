#include "math/superpose.h"

#include "core/assertion.h"

#include <Eigen/SVD>
#include <cstddef>

namespace palpa {
namespace {

Vec3 mean_of(std::span<const Vec3> points) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& point : points) sum += point;
    return sum / static_cast<double>(points.size());
}

}  // namespace

RigidMotion superpose(std::span<const Vec3> from, std::span<const Vec3> to) {
    PALPA_ASSERT(from.size() == to.size());
    if (from.empty()) return {};
    const Vec3 from_centre = mean_of(from), to_centre = mean_of(to);
    Mat3 covariance = Mat3::Zero();
    for (std::size_t i = 0; i < from.size(); ++i)
        covariance += (to[i] - to_centre) * (from[i] - from_centre).transpose();
    const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Mat3 flip = Mat3::Identity();
    if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) flip(2, 2) = -1;
    RigidMotion motion;
    motion.rotation = svd.matrixU() * flip * svd.matrixV().transpose();
    motion.translation = to_centre - motion.rotation * from_centre;
    return motion;
}

}  // namespace palpa
