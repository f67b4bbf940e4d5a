// Enumerations of scene keys that lower modules use as well, with their names in scene files and on
// the command line, in the order of the enumerators.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

namespace palpa {

// How firmly a hand holds the handle; models of the hands: haptics/hand.h.
enum class HandGrip { None, Light, Slack, Medium, Firm, FirmGrip };
inline constexpr std::array<std::string_view, 6> grip_names{"none",   "light", "slack",
                                                            "medium", "firm",  "firm-grip"};

// Whether A_d is a scalar, or raised only along directions in which the molecule is stiff.
enum class GainShape { Scalar, Tensor };
inline constexpr std::array<std::string_view, 2> gain_shape_names{"scalar", "tensor"};

// Method of relaxing flexible molecules (statics/relax_joints.h).
enum class RelaxMethod : std::uint8_t {
    QuasiStatic,  // repeated quasi-static steps of the paper
    SecondOrder,  // statics/second_order_step.h; without a hand L-BFGS
};
inline constexpr std::array<std::string_view, 2> relax_method_names{"quasi-static", "second-order"};

}  // namespace palpa
