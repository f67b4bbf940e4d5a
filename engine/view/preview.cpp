#include "view/preview.h"

#include "molecule/element.h"
#include "molecule/residue_kinds.h"
#include "view/colour_scales.h"
#include "view/lines.h"
#include "view/palette.h"
#include "view/place.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {
namespace {

constexpr float trace_radius = 0.5F, ball_radius = 0.4F, preview_stick = 0.16F,
                marked_radius = 0.6F;
constexpr double longest_bond = 2.0, longest_gap = 8.0;  // Å, between atoms; along a chain

std::string element_of_atom(const Structure& structure, std::size_t atom) {
    if (!structure.records.empty() && !structure.records[atom].element.empty())
        return structure.records[atom].element;
    return find_element_of_name(structure.names[atom].atom, structure.names[atom].residue);
}

// Whether it is of the first model and location, no hydrogen and no water.
bool is_shown(const Structure& structure, std::size_t atom) {
    const AtomName& name = structure.names[atom];
    if (is_water(name.residue)) return false;
    if (!structure.records.empty()) {
        const AtomRecord& record = structure.records[atom];
        if (record.model != structure.records.front().model) return false;
        if (record.alternate != ' ' && record.alternate != 'A' && record.alternate != '1')
            return false;
    }
    return element_of_atom(structure, atom) != "H";
}

bool is_on_trace(const AtomName& name) { return name.atom == "CA" || name.atom == "P"; }

void add_trace(const Structure& structure, std::span<const std::uint32_t> atoms,
               FrameScene& frame) {
    std::size_t chain = 0;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const AtomName& name = structure.names[atoms[i]];
        if (i > 0 && structure.names[atoms[i - 1]].segment != name.segment) ++chain;
        const LineLook look{trace_radius, categorical_colour(2 + chain)};
        const glm::vec3 place = as_float(structure.positions[atoms[i]]);
        add_ball(place, look, frame);
        if (i == 0 || structure.names[atoms[i - 1]].segment != name.segment) continue;
        const Vec3& before = structure.positions[atoms[i - 1]];
        if ((structure.positions[atoms[i]] - before).norm() < longest_gap)
            add_stick(as_float(before), place, look, frame);
    }
}

// Bonds by distance, within a residue; neighbours in the file are close to each other.
void add_small(const Structure& structure, std::span<const std::uint32_t> atoms,
               FrameScene& frame) {
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const AtomName& name = structure.names[atoms[i]];
        const glm::vec3 place = as_float(structure.positions[atoms[i]]);
        const glm::vec3 colour = look_of(element_of_atom(structure, atoms[i])).colour;
        frame.spheres.push_back({place, ball_radius, colour});
        for (std::size_t k = i + 1;
             k < atoms.size() && is_same_residue(structure.names[atoms[k]], name); ++k) {
            const Vec3& other = structure.positions[atoms[k]];
            if ((other - structure.positions[atoms[i]]).norm() < longest_bond)
                add_stick(place, as_float(other), {preview_stick, colour}, frame);
        }
    }
}

}  // namespace

FrameScene build_preview(const Structure& structure, std::span<const std::uint32_t> marked) {
    FrameScene frame;
    std::vector<std::uint32_t> trace, small;
    for (std::size_t i = 0; i < structure.names.size();) {
        std::size_t end = i;
        bool is_of_chain = false;
        for (; end < structure.names.size() &&
               is_same_residue(structure.names[i], structure.names[end]);
             ++end)
            is_of_chain = is_of_chain || is_on_trace(structure.names[end]);
        const bool is_ion = end - i == 1;  // a calcium is called CA
        for (std::size_t atom = i; atom < end; ++atom) {
            if (!is_shown(structure, atom)) continue;
            const bool is_traced = is_of_chain && !is_ion;
            if (is_traced && !is_on_trace(structure.names[atom])) continue;
            (is_traced ? trace : small).push_back(static_cast<std::uint32_t>(atom));
        }
        i = end;
    }
    add_trace(structure, trace, frame);
    add_small(structure, small, frame);
    for (const std::uint32_t atom : marked)
        if (is_shown(structure, atom))
            frame.spheres.push_back(
                {as_float(structure.positions[atom]), marked_radius, grabbed_carbon});
    return frame;
}

}  // namespace palpa
