// The two forces of the paper's device, a Phantom Omni, that laws and limits refer to.
#pragma once

namespace palpa {

// The largest force of its motors, N.
inline constexpr double omni_peak_newton = 3.3;
// The largest force that is sent, N: "forces higher than 3N are truncated" (section 2.2).
inline constexpr double truncation_newton = 3;

}  // namespace palpa
