// A way of the hand in real time, at a kilohertz, while another thread renews the model.
#pragma once
#include "scene/description.h"
#include "tools/lab/bench/row.h"
#include "tools/lab/bench/truth.h"

#include <string>

namespace palpa {

// Adds a row: `name`, ms of a step. The hand goes 3 Å along x at 1 Å/s, one step a millisecond,
// contact model included. error_median, error_90 and error_rms are as along other ways;
// missed_share is that of steps that ended after their period, age_90 (Å) the way of the hand since
// the point of linearisation at nine of ten steps.
void bench_real_time_way(const std::string& name, SceneDescription scene, Truth& truth,
                         std::vector<BenchRow>& rows);

}  // namespace palpa
