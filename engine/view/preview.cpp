#include "view/preview.h"

#include "molecule/element.h"
#include "molecule/residue_kinds.h"
#include "view/colour_scales.h"
#include "view/lines.h"
#include "view/palette.h"
#include "view/place.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {
namespace {

constexpr float trace_radius = 0.5F, ball_radius = 0.4F, preview_stick = 0.16F,
                marked_radius = 0.6F;
constexpr std::size_t most_between = 40, shortest_trace = 4;
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

// Finds the atom of a residue that its chain's trace goes through: CA of an amino acid, P of a
// nucleotide. A calcium, which is called CA too, a phosphate and a cofactor have none.
std::optional<std::size_t> find_trace_atom(const Structure& structure, std::size_t begin,
                                           std::size_t end) {
    const auto find = [&](std::string_view name) -> std::optional<std::size_t> {
        for (std::size_t atom = begin; atom < end; ++atom)
            if (structure.names[atom].atom == name && is_shown(structure, atom)) return atom;
        return std::nullopt;
    };
    const std::optional<std::size_t> carbon = find("CA");
    const bool is_amino_acid =
        carbon && element_of_atom(structure, *carbon) == "C" && (end - begin == 1 || find("N"));
    if (is_amino_acid) return carbon;
    return find("C1'") && find("O3'") ? find("P") : std::nullopt;
}

struct ResidueRange {
    std::size_t begin, end;
    std::optional<std::size_t> trace;
};

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

// Bonds by distance, to atoms of the same segment that stand near in the file.
void add_small(const Structure& structure, std::span<const std::uint32_t> atoms,
               FrameScene& frame) {
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const AtomName& name = structure.names[atoms[i]];
        const glm::vec3 place = as_float(structure.positions[atoms[i]]);
        const glm::vec3 colour = look_of(element_of_atom(structure, atoms[i])).colour;
        frame.spheres.push_back({place, ball_radius, colour});
        for (std::size_t k = i + 1; k < std::min(atoms.size(), i + most_between) &&
                                    structure.names[atoms[k]].segment == name.segment;
             ++k) {
            const Vec3& other = structure.positions[atoms[k]];
            if ((other - structure.positions[atoms[i]]).norm() < longest_bond)
                add_stick(place, as_float(other), {preview_stick, colour}, frame);
        }
    }
}

}  // namespace

FrameScene build_preview(const Structure& structure, std::span<const std::uint32_t> marked) {
    std::vector<ResidueRange> residues;
    std::map<std::string, std::size_t> lengths;  // of each segment's trace
    for (std::size_t i = 0; i < structure.names.size();) {
        std::size_t end = i;
        while (end < structure.names.size() &&
               is_same_residue(structure.names[i], structure.names[end]))
            ++end;
        residues.push_back({i, end, find_trace_atom(structure, i, end)});
        lengths[structure.names[i].segment] += residues.back().trace.has_value();
        i = end;
    }
    std::vector<std::uint32_t> trace, small;
    for (const ResidueRange& residue : residues) {
        const bool is_traced =
            residue.trace && lengths[structure.names[residue.begin].segment] >= shortest_trace;
        for (std::size_t atom = residue.begin; atom < residue.end; ++atom) {
            if (!is_shown(structure, atom) || (is_traced && atom != *residue.trace)) continue;
            (is_traced ? trace : small).push_back(static_cast<std::uint32_t>(atom));
        }
    }
    FrameScene frame;
    add_trace(structure, trace, frame);
    add_small(structure, small, frame);
    for (const std::uint32_t atom : marked)
        if (is_shown(structure, atom))
            frame.spheres.push_back(
                {as_float(structure.positions[atom]), marked_radius, grabbed_carbon});
    return frame;
}

}  // namespace palpa
