// The colours of things. Any two that can be seen side by side differ by at least 15 in CIEDE2000,
// also for people who lack one kind of cone; tests/view/palette_test.cpp checks this.
#pragma once
#include <array>
#include <glm/vec3.hpp>
#include <string_view>

namespace palpa {

// Van der Waals radii: A. Bondi, J. Phys. Chem. 68, 441 (1964). Colours as usual in chemistry:
// oxygen red, nitrogen blue, sulphur yellow.
struct ElementLook {
    std::string_view element;
    float radius;      // Å
    glm::vec3 colour;  // linear RGB, like all colours here
};
inline constexpr std::array element_looks = std::to_array<ElementLook>({
    {"H", 1.20F, {0.938F, 0.953F, 0.948F}},
    {"C", 1.70F, {0.223F, 0.219F, 0.209F}},
    {"N", 1.55F, {0.003F, 0.082F, 0.955F}},
    {"O", 1.52F, {0.624F, 0.003F, 0.004F}},
    {"P", 1.80F, {0.483F, 0.431F, 0.427F}},
    {"S", 1.80F, {0.955F, 0.840F, 0.041F}},
});
inline constexpr ElementLook other_element{"", 1.70F, {0.104F, 0.009F, 0.009F}};

inline const ElementLook& look_of(std::string_view element) noexcept {
    for (const ElementLook& look : element_looks)
        if (look.element == element) return look;
    return other_element;
}

// Carbon colours: of the held molecule, and of the chains in turn.
inline constexpr glm::vec3 grabbed_carbon{0.095F, 0.681F, 0.238F};
inline constexpr std::array chain_carbons = std::to_array<glm::vec3>({{0.474F, 0.616F, 0.830F},
                                                                      {0.317F, 0.235F, 0.136F},
                                                                      {0.302F, 0.274F, 0.578F},
                                                                      {0.100F, 0.125F, 0.083F}});

// Colours of signs: force and torque, target of the hand, hydrogen bonds.
inline constexpr glm::vec3 force_colour{0.849F, 0.232F, 0.002F};
inline constexpr glm::vec3 wish_colour{0.162F, 0.002F, 0.256F};
// Colour of selected atoms, which are also drawn thicker: no colour remains that is 15 from all
// others; this one is 10.
inline constexpr glm::vec3 selected_colour{0.86F, 0.00F, 0.35F};
inline constexpr glm::vec3 hydrogen_bond_colour{0.035F, 0.123F, 0.147F};

// Colours of optional marks. Their shapes distinguish them from atoms and bonds, so their colours
// only have to differ from each other and from those of the signs above. Contacts have M. Okabe and
// K. Ito's sky blue, salt bridges a colour a little lighter than their yellow.
inline constexpr glm::vec3 measure_colour{0.010F};
inline constexpr glm::vec3 contact_colour{0.093F, 0.402F, 0.815F};
inline constexpr glm::vec3 clash_colour{0.584F, 0.003F, 0.032F};
inline constexpr glm::vec3 salt_bridge_colour{0.871F, 0.799F, 0.019F};
inline constexpr glm::vec3 rest_colour{0.47F, 0.34F, 0.53F};  // a paler colour of the target

}  // namespace palpa
