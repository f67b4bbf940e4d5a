#include "view/draw_layer.h"

#include "molecule/element.h"
#include "molecule/residue_kinds.h"
#include "molecule/surface/potential.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "view/build_frame.h"
#include "view/elements.h"
#include "view/palette.h"
#include "view/surface_shape.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace palpa {
namespace {

constexpr float ball_share = 0.28F, stick_radius = 0.14F, licorice_radius = 0.28F;
constexpr float thin_radius = 0.11F, line_radius = 0.05F;

// How thick an atom and the sticks at it are drawn (Å); 0: not at all.
struct Thickness {
    float atom = 0, stick = 0;
};

// Of others than what is in hand only hydrogens of hydrogen bonds are drawn where they are thin.
Thickness thickness_of(Representation representation, std::string_view element, bool in_hand) {
    const float size = look_of(element).radius;
    switch (representation) {
        case Representation::SpaceFilling:
            return {size, 0};
        case Representation::Licorice:
            return {licorice_radius, licorice_radius};
        case Representation::Lines:
            return {line_radius, line_radius};
        case Representation::Surface:
            if (in_hand) break;
            return {};
        case Representation::InHand:
        case Representation::Pocket:
            if (in_hand) break;
            return element == "H" ? Thickness{} : Thickness{thin_radius, thin_radius};
        case Representation::BallAndStick:
        case Representation::Cartoon:
            break;
    }
    return {ball_share * size, stick_radius};
}

// Whether the choice of hydrogens is for it; the others have rules of their own.
bool chooses_hydrogens(Representation representation) {
    switch (representation) {
        case Representation::BallAndStick:
        case Representation::SpaceFilling:
        case Representation::Licorice:
        case Representation::Lines:
        case Representation::Cartoon:
            return true;
        case Representation::InHand:
        case Representation::Pocket:
        case Representation::Surface:
            break;
    }
    return false;
}

// Hydrogens that the choice leaves out, but for those of hydrogen bonds.
std::vector<bool> find_left_out(const FrameParts& parts) {
    const AtomTable& atoms = parts.world.resource<AtomTable>();
    std::vector<bool> left_out(atoms.size(), false);
    if (parts.hydrogens == ShownHydrogens::All) return left_out;
    for (std::size_t i = 0; i < atoms.size(); ++i)
        left_out[i] = element_of(atoms, i) == "H" && !parts.takes_part[i];
    if (parts.hydrogens == ShownHydrogens::None) return left_out;
    for (const auto& [a, b] : atoms.bonds) {
        if (is_polar(element_of(atoms, a))) left_out[b] = false;
        if (is_polar(element_of(atoms, b))) left_out[a] = false;
    }
    return left_out;
}

bool is_ribbon(Representation representation) {
    return representation == Representation::Cartoon || representation == Representation::Pocket;
}

// Atoms of molecules that hands hold whole, and that are small enough to be seen as balls and
// sticks: a ligand, a peptide.
std::vector<bool> find_small_held(const World& world) {
    constexpr std::size_t most = 300;  // atoms
    std::vector<bool> small(world.resource<AtomTable>().size(), false);
    for (const Entity hand : find_hands(world)) {
        const std::vector<std::uint32_t> held = held_atoms(world, hand);
        const AtomRange whole = held_range(world, hand);
        if (held.size() > most || held.size() != whole.count) continue;
        for (const std::uint32_t atom : held) small[atom] = true;
    }
    return small;
}

// The atom that says how a residue's ribbon looks.
std::size_t ribbon_atom(const ResidueSpan& residue) {
    return residue.alpha < residue.end ? residue.alpha : residue.first;
}

// Where residues of a chain are missing: dashes from the one atom CA to the next.
void draw_gaps(const FrameParts& parts, std::span<const std::size_t> shown,
               std::span<const glm::vec3> colours, FrameScene& frame) {
    constexpr double longest_bond = 4.5, longest_gap = 40;  // Å, from CA to CA
    constexpr float dash = 0.7F, radius = 0.12F;            // Å
    const AtomTable& atoms = parts.world.resource<AtomTable>();
    for (std::size_t i = 1; i < shown.size(); ++i) {
        const ResidueSpan &before = parts.residues[shown[i - 1]], &after = parts.residues[shown[i]];
        if (before.alpha == before.end || after.alpha == after.end || before.end != after.first ||
            atoms.names[before.alpha].segment != atoms.names[after.alpha].segment)
            continue;
        const Vec3 way = atoms.positions[after.alpha] - atoms.positions[before.alpha];
        if (way.norm() < longest_bond || way.norm() > longest_gap) continue;
        const glm::vec3 from = as_float(atoms.positions[before.alpha]), step = as_float(way);
        const int dashes = std::max(1, static_cast<int>(way.norm() / (2 * double{dash})));
        for (int k = 0; k < dashes; ++k) {
            const float begin = (static_cast<float>(k) + 0.25F) / static_cast<float>(dashes);
            const glm::vec3 a = from + begin * step,
                            b = a + 0.5F / static_cast<float>(dashes) * step;
            frame.cones.push_back({a, b, radius, radius, colours[before.alpha],
                                   colours[before.alpha],
                                   static_cast<std::uint32_t>(before.alpha)});
        }
    }
}

// Draws ribbons, and returns of each residue whether it is in one.
std::vector<bool> draw_ribbons(const FrameParts& parts, std::span<const AtomLook> looks,
                               std::span<const glm::vec3> colours, KeptRibbons& kept,
                               FrameScene& frame) {
    std::vector<std::size_t> shown;
    const std::vector<bool> small = find_small_held(parts.world);
    for (std::size_t i = 0; i < parts.residues.size(); ++i) {
        const std::size_t atom = ribbon_atom(parts.residues[i]);
        const AtomLook& look = looks[atom];
        if (!look.visible || !is_ribbon(look.representation)) continue;
        if (look.representation == Representation::Pocket && small[atom]) continue;
        shown.push_back(i);
    }
    std::vector<bool> in_ribbon(parts.residues.size(), false);
    if (shown.empty()) return in_ribbon;
    const AtomTable& atoms = parts.world.resource<AtomTable>();
    constexpr double hardly = 0.02;  // Å
    const bool is_kept =
        kept.shown_residues == shown && std::ranges::equal(kept.colours, colours) &&
        std::ranges::equal(kept.places, atoms.positions, [](const Vec3& a, const Vec3& b) {
            return (a - b).squaredNorm() < hardly * hardly;
        });
    if (!is_kept) {
        std::vector<ResidueSpan> residues;
        std::vector<SecondaryStructure> structure;
        for (const std::size_t i : shown) {
            residues.push_back(parts.residues[i]);
            structure.push_back(parts.structure[i]);
        }
        FrameScene made;
        kept.parts = add_cartoon(parts.world, residues, structure, colours, made);
        kept.meshes = std::move(made.meshes);
        kept.places = atoms.positions;
        kept.colours.assign(colours.begin(), colours.end());
        kept.shown_residues = shown;
    }
    frame.meshes.insert(frame.meshes.end(), kept.meshes.begin(), kept.meshes.end());
    draw_gaps(parts, shown, colours, frame);
    for (std::size_t i = 0; i < shown.size(); ++i) in_ribbon[shown[i]] = kept.parts.shown[i];
    return in_ribbon;
}

// Of each atom, what it is drawn as beside ribbons and surfaces.
std::vector<Thickness> find_thickness(const FrameParts& parts, std::span<const AtomLook> looks,
                                      const std::vector<bool>& in_ribbon) {
    const AtomTable& atoms = parts.world.resource<AtomTable>();
    const bool has_pocket = std::ranges::any_of(looks, [](const AtomLook& look) {
        return look.visible && look.representation == Representation::Pocket;
    });
    const std::vector<bool> near =
        has_pocket ? find_pocket(parts.world, parts.residues) : std::vector<bool>(atoms.size());
    const std::vector<bool> left_out = find_left_out(parts);
    constexpr std::ptrdiff_t most_shown = 300;  // atoms
    const auto held_count = std::ranges::count(parts.held, true);
    std::vector<Thickness> thickness(atoms.size());
    for (std::size_t i = 0; i < parts.residues.size(); ++i) {
        const ResidueSpan& residue = parts.residues[i];
        const bool is_solvent = is_water(atoms.names[residue.first].residue);
        // What such a side chain is could not be seen from a ribbon: retinal on its lysine.
        const bool is_modified =
            residue.alpha < residue.end && !is_plain_amino_acid(atoms.names[residue.first].residue);
        for (std::size_t atom = residue.first; atom < residue.end; ++atom) {
            const auto [representation, colouring, visible] = looks[atom];
            if (!visible) continue;
            const bool is_pocket = representation == Representation::Pocket;
            const bool is_cartoon = representation == Representation::Cartoon;
            // A whole chain in the hand is a ribbon, of a residue on a spring all is shown.
            const bool is_held = parts.held[atom] && held_count <= most_shown;
            const bool in_hand = representation == Representation::InHand
                                     ? static_cast<bool>(parts.in_hand[atom])
                                     : is_held;
            const bool is_end = in_ribbon[i] && !is_held && parts.bond_ends[atom];
            if (!is_held && in_ribbon[i] && !is_modified && !is_end &&
                (is_cartoon || (is_pocket && !near[atom])))
                continue;
            if (is_cartoon && is_solvent && !is_held) continue;
            if (left_out[atom] && chooses_hydrogens(representation)) continue;
            const std::string_view element = element_of(atoms, atom);
            thickness[atom] = thickness_of(representation, element, in_hand);
            if (is_end && is_cartoon) thickness[atom] = {thin_radius, thin_radius};
            if (thickness[atom].atom == 0 && parts.takes_part[atom] &&
                representation != Representation::Surface)
                thickness[atom] = {thin_radius, thin_radius};
        }
    }
    return thickness;
}

void draw_atoms(const AtomTable& atoms, std::span<const Thickness> thickness,
                std::span<const glm::vec3> colours, FrameScene& frame) {
    const auto count = static_cast<std::size_t>(
        std::ranges::count_if(thickness, [](const Thickness& one) { return one.atom > 0; }));
    frame.spheres.reserve(frame.spheres.size() + count);
    if (std::ranges::any_of(thickness, [](const Thickness& one) { return one.stick > 0; }))
        frame.cones.reserve(frame.cones.size() + count);  // about a bond an atom
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        if (thickness[i].atom == 0) continue;
        frame.spheres.push_back({as_float(atoms.positions[i]), thickness[i].atom, colours[i],
                                 static_cast<std::uint32_t>(i)});
    }
    for (const auto& [a, b] : atoms.bonds) {
        const float radius = std::min(thickness[a].stick, thickness[b].stick);
        if (radius == 0) continue;
        frame.cones.push_back({as_float(atoms.positions[a]), as_float(atoms.positions[b]), radius,
                               radius, colours[a], colours[b], a});
    }
}

// Waters and what hands hold have no part in a surface that does not name them alone.
std::vector<std::uint32_t> find_surface_atoms(const FrameParts& parts,
                                              std::span<const AtomLook> looks) {
    const AtomTable& atoms = parts.world.resource<AtomTable>();
    const auto is_shown = [&](std::size_t i) {
        return looks[i].visible && looks[i].representation == Representation::Surface;
    };
    std::vector<std::uint32_t> all, chosen;
    for (std::uint32_t i = 0; i < atoms.size(); ++i) {
        if (!is_shown(i)) continue;
        all.push_back(i);
        if (!parts.held[i] && !is_water(atoms.names[i].residue)) chosen.push_back(i);
    }
    return chosen.empty() ? all : chosen;
}

// By chain a surface has one colour: of each residue that of its first carbon.
std::vector<glm::vec3> find_chain_colours(const FrameParts& parts,
                                          std::span<const std::uint32_t> chosen,
                                          std::span<const glm::vec3> colours) {
    const AtomTable& atoms = parts.world.resource<AtomTable>();
    std::vector<glm::vec3> of_residues(colours.begin(), colours.end());
    for (const ResidueSpan& residue : parts.residues) {
        std::size_t carbon = residue.first;
        while (carbon < residue.end && element_of(atoms, carbon) != "C") ++carbon;
        if (carbon == residue.end) continue;
        for (std::size_t i = residue.first; i < residue.end; ++i) of_residues[i] = colours[carbon];
    }
    std::vector<glm::vec3> found;
    for (const std::uint32_t atom : chosen) found.push_back(of_residues[atom]);
    return found;
}

struct Charges {
    std::vector<Vec3> places;     // Å
    std::vector<double> charges;  // e
};

// All of the scene but what hands hold; of a surface of that alone, its own.
Charges find_charges(const FrameParts& parts, std::span<const std::uint32_t> chosen) {
    const AtomTable& atoms = parts.world.resource<AtomTable>();
    const bool is_of_held = std::ranges::all_of(
        chosen, [&](std::uint32_t atom) { return static_cast<bool>(parts.held[atom]); });
    Charges found;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        if (parts.held[i] != is_of_held) continue;
        found.places.push_back(atoms.positions[i]);
        found.charges.push_back(atoms.charge[i]);
    }
    return found;
}

// So far that potentials have to be summed again.
bool have_moved(std::span<const Vec3> before, std::span<const Vec3> now) {
    constexpr double far = 0.5;  // Å
    return !std::ranges::equal(before, now, [](const Vec3& a, const Vec3& b) {
        return (a - b).squaredNorm() < far * far;
    });
}

// The finer, the fewer atoms there are; of many the solvent-excluded one would take too long to
// follow them.
SurfaceSettings surface_settings(std::size_t atoms) {
    constexpr std::size_t few = 500, some = 2000, many = 20000;
    SurfaceSettings settings;
    settings.kind = atoms <= some ? SurfaceKind::Excluded : SurfaceKind::Gaussian;
    settings.spacing = atoms <= few ? 0.4 : atoms <= some ? 0.8 : atoms <= many ? 1 : 2;
    settings.tolerance = 0.05;
    return settings;
}

void draw_surface(const FrameParts& parts, std::span<const AtomLook> looks,
                  std::span<const glm::vec3> colours, float opacity, KeptSurface& kept,
                  FrameScene& frame) {
    const AtomTable& table = parts.world.resource<AtomTable>();
    const std::vector<std::uint32_t> chosen = find_surface_atoms(parts, looks);
    if (chosen.empty()) return;
    const bool by_potential = looks[chosen.front()].colouring == Colouring::Potential;
    std::vector<Vec3> places;
    std::vector<glm::vec3> atom_colours;
    for (const std::uint32_t atom : chosen) {
        places.push_back(table.positions[atom]);
        atom_colours.push_back(colours[atom]);
    }
    if (looks[chosen.front()].colouring == Colouring::Chain)
        atom_colours = find_chain_colours(parts, chosen, colours);
    std::optional<SurfaceBudget> budget;
    if (!kept.cache || kept.atoms != chosen) {
        std::vector<double> radii;
        for (const std::uint32_t atom : chosen)
            radii.push_back(static_cast<double>(look_of(element_of(table, atom)).radius));
        kept.cache.emplace(std::move(radii), surface_settings(chosen.size()));
        kept.atoms = chosen;
        kept.potentials.clear();
    } else {
        constexpr std::size_t blocks = 8;  // some milliseconds
        budget.emplace().blocks = blocks;
        budget->near = held_place(parts.world, hand_at(parts.world, 0));
    }
    const SurfaceUpdate update = kept.cache->update(places, budget);
    for (const BlockIndex& block : update.changed) kept.potentials.erase(block);
    const Charges charges = by_potential ? find_charges(parts, chosen) : Charges{};
    if (by_potential && have_moved(kept.charge_places, charges.places)) {
        kept.potentials.clear();
        kept.charge_places = charges.places;
    }
    for (const auto& [index, block] : kept.cache->blocks()) {
        if (by_potential) {
            std::vector<float>& potentials = kept.potentials[index];
            if (potentials.size() != block.mesh.places.size())
                potentials = find_potentials(block.mesh, charges.places, charges.charges);
            frame.meshes.push_back(shape_by_potential(block.mesh, potentials, chosen, opacity));
        } else {
            frame.meshes.push_back(shape_by_atom(block.mesh, atom_colours, chosen, opacity));
        }
    }
}

}  // namespace

void draw_layer(const FrameParts& parts, std::span<const AtomLook> looks,
                std::span<const glm::vec3> colours, float opacity, KeptLayer& kept,
                FrameScene& frame) {
    const std::vector<bool> in_ribbon = draw_ribbons(parts, looks, colours, kept.ribbons, frame);
    draw_atoms(parts.world.resource<AtomTable>(), find_thickness(parts, looks, in_ribbon), colours,
               frame);
    draw_surface(parts, looks, colours, opacity, kept.surface, frame);
}

}  // namespace palpa
