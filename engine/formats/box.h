// Periodic boxes, by their edges or by lengths and angles. A box is a matrix whose columns are its
// edges a, b, c, Å.
#pragma once
#include "math/vec.h"

#include <optional>

namespace palpa {

// `cosines` are of alpha (between b and c), beta (a, c), gamma (a, b). a lies along x, b in the
// plane of x and y, as crystallographers have it. Nothing where no box has these: a length that is
// not positive, angles that do not close.
std::optional<Mat3> find_box(const Vec3& lengths, const Vec3& cosines) noexcept;

// With angles in degrees; a right angle is exactly one.
std::optional<Mat3> find_box_deg(const Vec3& lengths, const Vec3& angles_deg) noexcept;

Vec3 lengths_of(const Mat3& box) noexcept;
Vec3 cosines_of(const Mat3& box) noexcept;

// Whether a lies along x and b in the plane of x and y, to a millionth of the longest edge, so that
// lengths and angles say all of it; and whether it has a volume.
bool is_lower_box(const Mat3& box) noexcept;

}  // namespace palpa
