// Colour scales for numbers, and distinct colours for categories. Linear RGB.
#pragma once
#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>

namespace palpa {

// Red at -end and below, white at 0, blue at end and above, as usual for potentials. Grey for a
// number that is not finite.
glm::vec3 diverging_colour(double value, double end);

// End of the scale of electrostatic potentials, kT/e: red is negative.
inline constexpr double potential_end = 5;
inline glm::vec3 potential_colour(double potential) {
    return diverging_colour(potential, potential_end);
}

// The colour of a hydropathy index (molecule/hydropathy.h): blue-green for hydrophilic, ochre for
// hydrophobic, nearly white between; grey without an index.
glm::vec3 hydropathy_colour(std::optional<double> hydropathy);

// Dark violet at 0 by blue and green to yellow at 1, ever lighter, also for people who lack one
// kind of cone: viridis, of matplotlib, by S. van der Walt and N. Smith (2015, CC0), at nine
// points.
glm::vec3 sequential_colour(double share);

// M. Okabe and K. Ito, Color Universal Design (2002): black, orange, sky blue, bluish green,
// yellow, blue, vermilion, reddish purple; repeated from index 8 on.
glm::vec3 categorical_colour(std::size_t index);

}  // namespace palpa
