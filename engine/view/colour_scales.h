// Colours that stand for numbers, and colours that distinguish many things. Linear RGB.
#pragma once
#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>

namespace palpa {

// Red at -end and below, white at 0, blue at end and above: how chemists draw potentials. A number
// that is not finite is grey.
glm::vec3 diverging_colour(double value, double end);

// Of an electrostatic potential, kT/e: red is negative.
inline constexpr double potential_end = 5;
inline glm::vec3 potential_colour(double potential) {
    return diverging_colour(potential, potential_end);
}

// Of a hydropathy index (molecule/hydropathy.h): blue-green where it likes water, ochre where not,
// nearly white between; grey for what has none.
glm::vec3 hydropathy_colour(std::optional<double> hydropathy);

// Dark violet at 0 by blue and green to yellow at 1, ever lighter, also for people who lack one
// kind of cone: viridis, of matplotlib, by S. van der Walt and N. Smith (2015, CC0), at nine
// points.
glm::vec3 sequential_colour(double share);

// M. Okabe and K. Ito, Color Universal Design (2002): black, orange, sky blue, bluish green,
// yellow, blue, vermilion, reddish purple; from 8 on they begin again.
glm::vec3 categorical_colour(std::size_t index);

}  // namespace palpa
