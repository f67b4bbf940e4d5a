#include "view/atom_colours.h"

#include "core/units.h"
#include "math/angles.h"
#include "molecule/hydropathy.h"
#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "statics/joint_answers.h"
#include "statics/torsion_state.h"
#include "view/colour_scales.h"
#include "view/elements.h"
#include "view/force_parts.h"
#include "view/in_hand.h"
#include "view/palette.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

using Colours = std::vector<glm::vec3>;

constexpr glm::vec3 no_value{0.45F};

// Carbons of what is held in their own colour, others by element or chain.
Colours colour_elements(const World& world, bool by_chain) {
    const AtomTable& atoms = world.resource<AtomTable>();
    const std::vector<bool> held = find_held_atoms(world);
    std::size_t chain = 0;
    const AtomName* before = nullptr;  // the last that is not held
    Colours colours;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        if (!held[i]) {
            if (before && before->segment != atoms.names[i].segment) ++chain;
            before = &atoms.names[i];
        }
        const std::string_view element = element_of(atoms, i);
        colours.push_back(look_of(element).colour);
        if (element != "C") continue;
        if (held[i]) {
            colours.back() = grabbed_carbon;
        } else if (by_chain) {
            colours.back() = chain_carbons[chain % chain_carbons.size()];
        }
    }
    return colours;
}

// Indices of categorical_colour.
struct ResidueClass {
    std::string_view text;
    std::size_t colour;
    std::array<std::string_view, 12> names;
};
constexpr std::array residue_classes = std::to_array<ResidueClass>({
    {"acidic", 6, {"ASP", "GLU", "ASPP", "GLUP", "ASH", "GLH"}},
    {"basic", 5, {"ARG", "LYS", "HSP", "HIP"}},
    {"polar", 2, {"SER", "THR", "ASN", "GLN", "HIS", "HSD", "HSE", "HID", "HIE", "CYS", "CYX"}},
    {"aromatic", 7, {"PHE", "TYR", "TRP"}},
    {"aliphatic", 1, {"ALA", "VAL", "LEU", "ILE", "MET", "PRO", "GLY", "MSE"}},
    {"adenine", 3, {"ADE", "DA", "A"}},
    {"guanine", 4, {"GUA", "DG", "G"}},
    {"cytosine", 5, {"CYT", "DC", "C"}},
    {"thymine, uracil", 6, {"THY", "URA", "DT", "U"}},
});

const ResidueClass* class_of(std::string_view residue) {
    const auto found = std::ranges::find_if(residue_classes, [&](const ResidueClass& of) {
        return std::ranges::find(of.names, residue) != of.names.end();
    });
    return found == residue_classes.end() ? nullptr : &*found;
}

constexpr std::array structure_colours = std::to_array<std::pair<glm::vec3, std::string_view>>({
    {{0.68F, 0.06F, 0.14F}, "helix"},
    {{0.80F, 0.52F, 0.03F}, "strand"},
    {{0.60F, 0.62F, 0.66F}, "neither"},
});

void colour_structure(std::span<const ResidueSpan> residues,
                      std::span<const SecondaryStructure> structure, Colours& colours) {
    for (std::size_t i = 0; i < residues.size(); ++i) {
        if (residues[i].alpha == residues[i].end) continue;
        const std::size_t kind = is_helix(structure[i])                       ? 0
                                 : structure[i] == SecondaryStructure::Strand ? 1
                                                                              : 2;
        std::fill(colours.begin() + static_cast<std::ptrdiff_t>(residues[i].first),
                  colours.begin() + static_cast<std::ptrdiff_t>(residues[i].end),
                  structure_colours[kind].first);
    }
}

// A colour for each residue, where `colour_of` has one.
template <class ColourOf>
void colour_residues(std::span<const ResidueSpan> residues, Colours& colours,
                     const ColourOf& colour_of) {
    for (const ResidueSpan& residue : residues) {
        const std::optional<glm::vec3> colour = colour_of(residue);
        if (!colour) continue;
        std::fill(colours.begin() + static_cast<std::ptrdiff_t>(residue.first),
                  colours.begin() + static_cast<std::ptrdiff_t>(residue.end), *colour);
    }
}

// Of each atom, between the ends.
Colours colour_scale(std::span<const double> values, double low, double high) {
    Colours colours;
    for (const double value : values) {
        const double share = high > low ? (value - low) / (high - low) : 0;
        colours.push_back(sequential_colour(std::clamp(share, 0.0, 1.0)));
    }
    return colours;
}

constexpr double least_push_pN = 1, most_push_pN = 1000;

Colours colour_pushes(const World& world) {
    std::vector<double> shares;
    for (const double push : find_pushes(world)) {
        const double pN = push * units::piconewton_per_kcal_per_mol_angstrom;
        shares.push_back(pN > 0 ? std::log10(pN / least_push_pN) : -1);
    }
    Colours colours = colour_scale(shares, 0, std::log10(most_push_pN / least_push_pN));
    const Colours elements = colour_elements(world, false);
    const std::vector<bool> held = find_held_atoms(world);
    for (std::size_t i = 0; i < colours.size(); ++i)
        if (held[i]) colours[i] = elements[i];
    return colours;
}

constexpr double least_answer_deg = 0.001, most_answer_deg = 1;  // logarithmic

// Of each atom what its body has; 0 of those that are in none.
std::vector<double> of_atoms(const World& world, std::span<const double> of_bodies) {
    std::vector<double> values(world.resource<AtomTable>().size(), 0);
    const std::vector<std::uint32_t>& body_of = model_of(world).tree.bodies.body_of;
    for (std::uint32_t atom = 0; atom < body_of.size(); ++atom) {
        if (body_of[atom] < of_bodies.size())
            values[model_atoms_of(world).number_in_table(atom)] = of_bodies[body_of[atom]];
    }
    return values;
}

// Of each atom, by the size of its joint's angle (rad).
Colours colour_answers(const World& world, std::span<const double> angles) {
    std::vector<double> shares;
    for (const double angle : of_atoms(world, angles)) {
        const double deg = degrees_per_radian * std::abs(angle);
        shares.push_back(deg > 0 ? std::log10(deg / least_answer_deg) : -1);
    }
    return colour_scale(shares, 0, std::log10(most_answer_deg / least_answer_deg));
}

Colours colour_activity(const World& world) {
    const std::vector<double> joints = find_joint_activity(world);
    switch (joint_activity(world)) {
        case JointActivity::BeyondFirstOrder:
            return colour_answers(world, joints);
        case JointActivity::Active:
            return colour_scale(of_atoms(world, joints), 0, 1);
        case JointActivity::Nothing:
            break;
    }
    return Colours(world.resource<AtomTable>().size(), no_value);
}

Colours colour_errors(const World& world) {
    const std::optional<std::vector<double>> errors = estimate_joint_errors(world);
    return errors ? colour_answers(world, *errors)
                  : Colours(world.resource<AtomTable>().size(), no_value);
}

std::pair<double, double> find_b_factors(const AtomTable& atoms) {
    if (atoms.b_factor.empty()) return {0, 0};
    const auto [low, high] = std::ranges::minmax(atoms.b_factor);
    return {low, high};
}

std::vector<LegendEntry> legend_of_scale(std::string low, std::string middle, std::string high) {
    return {{sequential_colour(0), std::move(low)},
            {sequential_colour(0.5), std::move(middle)},
            {sequential_colour(1), std::move(high)}};
}

}  // namespace

std::vector<double> find_pushes(const World& world) {
    constexpr double reach = 12;  // Å
    const std::vector<bool> in_hand = find_held_atoms(world);
    std::vector<std::uint32_t> held;
    for (std::uint32_t i = 0; i < in_hand.size(); ++i)
        if (in_hand[i]) held.push_back(i);
    std::vector<double> pushes;
    for (const Vec3& force :
         find_forces_by_atoms(world, gather_held(world, std::move(held)), reach))
        pushes.push_back(force.norm());
    return pushes;
}

std::vector<glm::vec3> find_colours(const World& world, Colouring colouring,
                                    std::span<const ResidueSpan> residues,
                                    std::span<const SecondaryStructure> structure) {
    const AtomTable& atoms = world.resource<AtomTable>();
    if (colouring == Colouring::Force) return colour_pushes(world);
    if (colouring == Colouring::Activity) return colour_activity(world);
    if (colouring == Colouring::Error) return colour_errors(world);
    Colours colours = colour_elements(world, colouring == Colouring::Chain);
    const Colours elements = colours;
    switch (colouring) {
        case Colouring::Element:
        case Colouring::Chain:
        case Colouring::Force:
        case Colouring::Activity:
        case Colouring::Error:
            return colours;
        case Colouring::Potential:
            return colour_elements(world, true);
        case Colouring::Charge:
            colour_residues(residues, colours, [&](const ResidueSpan& residue) {
                double charge = 0;
                for (std::size_t i = residue.first; i < residue.end; ++i) charge += atoms.charge[i];
                return std::optional(diverging_colour(charge, 1));
            });
            return colours;
        case Colouring::Residue:
            colour_residues(residues, colours, [&](const ResidueSpan& residue) {
                const ResidueClass* const of = class_of(atoms.names[residue.first].residue);
                return of ? std::optional(categorical_colour(of->colour)) : std::nullopt;
            });
            break;
        case Colouring::Structure:
            colour_structure(residues, structure, colours);
            break;
        case Colouring::Hydrophobicity:
            colour_residues(residues, colours, [&](const ResidueSpan& residue) {
                const auto index = find_hydropathy(atoms.names[residue.first].residue);
                return index ? std::optional(hydropathy_colour(index)) : std::nullopt;
            });
            break;
        case Colouring::BFactor:
            if (const auto [low, high] = find_b_factors(atoms); high > low) {
                colours = colour_scale(atoms.b_factor, low, high);
            } else {
                colours.assign(atoms.size(), no_value);
            }
            break;
    }
    const std::vector<bool> held = find_held_atoms(world);
    for (std::size_t i = 0; i < atoms.size(); ++i)
        if (held[i]) colours[i] = elements[i];
    return colours;
}

std::vector<LegendEntry> find_legend(const World& world, Colouring colouring) {
    std::vector<LegendEntry> legend;
    switch (colouring) {
        case Colouring::Element:
        case Colouring::Chain:
            return {};
        case Colouring::Residue:
            for (const ResidueClass& of : residue_classes) {
                const auto is_of_it = [&](const AtomName& name) {
                    return class_of(name.residue) == &of;
                };
                if (std::ranges::any_of(world.resource<AtomTable>().names, is_of_it))
                    legend.push_back({categorical_colour(of.colour), std::string(of.text)});
            }
            return legend;
        case Colouring::Structure:
            for (const auto& [colour, text] : structure_colours)
                legend.push_back({colour, std::string(text)});
            return legend;
        case Colouring::Charge:
            return {{diverging_colour(-1, 1), "-1 e, of the residue"},
                    {diverging_colour(0, 1), "0"},
                    {diverging_colour(1, 1), "+1 e"}};
        case Colouring::Potential:
            return {{potential_colour(-potential_end),
                     fmt::format("surface at {} kT/e", -potential_end)},
                    {potential_colour(0), "0"},
                    {potential_colour(potential_end), fmt::format("+{} kT/e", potential_end)}};
        case Colouring::Hydrophobicity:
            return {{hydropathy_colour(-4.5), "hydrophilic (Arg, -4.5)"},
                    {hydropathy_colour(4.5), "hydrophobic (Ile, 4.5)"}};
        case Colouring::BFactor: {
            const auto [low, high] = find_b_factors(world.resource<AtomTable>());
            if (!(high > low)) return {{no_value, "the files have no B-factors"}};
            return legend_of_scale(fmt::format("B = {:.0f} Å²", low),
                                   fmt::format("{:.0f} Å²", 0.5 * (low + high)),
                                   fmt::format("{:.0f} Å²", high));
        }
        case Colouring::Force:
            return legend_of_scale("1 pN or less on the molecule in hand", "30 pN", "1 nN or more");
        case Colouring::Activity:
            switch (joint_activity(world)) {
                case JointActivity::BeyondFirstOrder:
                    return legend_of_scale("joint angle beyond first order: 0.001° or less",
                                           "0.03°", "1° or more");
                case JointActivity::Active:
                    return {{sequential_colour(0), "joint or base at rest"},
                            {sequential_colour(1), "active now"}};
                case JointActivity::Nothing:
                    break;
            }
            return {{no_value, "no molecule has joints that can turn"}};
        case Colouring::Error:
            if (joint_activity(world) != JointActivity::BeyondFirstOrder)
                return {{no_value, "no estimate (only with the second-order method)"}};
            return legend_of_scale("estimated joint error: 0.001° or less", "0.03°", "1° or more");
    }
    return {};
}

}  // namespace palpa
