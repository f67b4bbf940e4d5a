// Choices of a scene file that modules below it make as well, with the names that scene files and
// the command line have for them, in the order of the enumerators.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

namespace palpa {

// How firmly a handle is held; the hands themselves: haptics/hand.h.
enum class HandGrip { None, Light, Slack, Medium, Firm, FirmGrip };
inline constexpr std::array<std::string_view, 6> grip_names{"none",   "light", "slack",
                                                            "medium", "firm",  "firm-grip"};

// Whether A_d is one number, or larger only along directions in which the molecule is stiff.
enum class GainShape { Scalar, Tensor };
inline constexpr std::array<std::string_view, 2> gain_shape_names{"scalar", "tensor"};

// How flexible molecules come to rest (statics/relax_joints.h).
enum class RelaxMethod : std::uint8_t {
    QuasiStatic,    // the paper's step, again and again
    LimitedMemory,  // BFGS with a limited memory, each coordinate as stiff as its atoms are far out
    InverseMass,    // the same, coordinates coupled as they are by the mass matrix
    SecondOrder,    // statics/second_order_step.h; where there is no hand to follow, InverseMass
};
inline constexpr std::array<std::string_view, 4> relax_method_names{
    "quasi-static", "limited-memory", "inverse-mass", "second-order"};

}  // namespace palpa
