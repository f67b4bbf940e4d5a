// What holds of every trajectory that a reader opens.
#pragma once
#include "formats/lines.h"
#include "formats/trajectory.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/or_refused.h"

#include <cmath>
#include <cstddef>
#include <memory>

namespace palpa::test {

// Nothing where it is refused.
template <class Open>
std::unique_ptr<Trajectory> open_or_refuse(const Open& open) {
    return or_refused(open).value_or(nullptr);
}

// Whether the frame is one; into `frame`.
inline bool read_or_refuse_frame(Trajectory& trajectory, std::size_t i, TrajectoryFrame& frame) {
    const auto read = [&] {
        trajectory.read_frame(i, frame);
        return true;
    };
    return or_refused(read).has_value();
}

inline void expect_whole_frame(const Trajectory& trajectory, const TrajectoryFrame& frame) {
    const std::size_t count = trajectory.atom_count();
    PALPA_EXPECT(frame.positions.size() == count);
    PALPA_EXPECT(frame.velocities.empty() || frame.velocities.size() == count);
    PALPA_EXPECT(frame.forces.empty() || frame.forces.size() == count);
    for (const Vec3& position : frame.positions) {
        PALPA_EXPECT(position.cwiseAbs().maxCoeff() <= farthest_coordinate);
    }
    for (const auto* const vectors : {&frame.velocities, &frame.forces}) {
        for (const Vec3& vector : *vectors) PALPA_EXPECT(vector.allFinite());
    }
    PALPA_EXPECT(!frame.box || frame.box->allFinite());
    PALPA_EXPECT(!frame.time_ps || std::isfinite(*frame.time_ps));
}

// Reads all frames, the last first.
inline void expect_whole(Trajectory& trajectory) {
    PALPA_EXPECT(trajectory.atom_count() > 0 && trajectory.frame_count() > 0);
    TrajectoryFrame frame;
    for (std::size_t i = trajectory.frame_count(); i-- > 0;) {
        if (read_or_refuse_frame(trajectory, i, frame)) expect_whole_frame(trajectory, frame);
    }
    PALPA_EXPECT(!read_or_refuse_frame(trajectory, trajectory.frame_count(), frame));
}

}  // namespace palpa::test
