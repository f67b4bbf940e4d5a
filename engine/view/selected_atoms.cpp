#include "view/selected_atoms.h"

#include "core/load_error.h"
#include "core/text.h"
#include "molecule/select.h"
#include "molecule/selection_keywords.h"
#include "render/renderer.h"
#include "simulation/select_in_world.h"
#include "view/palette.h"
#include "view/residue_structure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cctype>
#include <functional>
#include <glm/common.hpp>
#include <optional>
#include <set>
#include <string_view>

namespace palpa {
namespace {

struct ResidueAtoms {
    std::uint32_t first = 0, end = 0;
};

std::vector<ResidueAtoms> residues_of(const AtomDirectory& directory, const AtomRange& atoms) {
    std::vector<ResidueAtoms> residues;
    for (std::uint32_t i = atoms.first; i < atoms.first + atoms.count; ++i) {
        const bool goes_on =
            i > atoms.first && directory.residue_of[i - 1] == directory.residue_of[i];
        if (!goes_on) residues.push_back({i, i});
        residues.back().end = i + 1;
    }
    return residues;
}

// Atoms that `chosen` says nothing of are not chosen.
bool is_chosen(const std::vector<bool>& chosen, std::size_t atom) {
    return atom < chosen.size() && chosen[atom];
}

std::size_t count_in(const ResidueAtoms& residue, const std::vector<bool>& chosen) {
    std::size_t count = 0;
    for (std::uint32_t i = residue.first; i < residue.end; ++i)
        if (is_chosen(chosen, i)) ++count;
    return count;
}

// A name that is spelt as a word of the language, or has other signs than letters, in quotes.
std::string as_name(const std::string& name) {
    const bool is_plain = std::ranges::all_of(name, [](char letter) {
        return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_';
    });
    std::string lower = name;
    for (char& letter : lower)
        letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    const bool is_word = find_selection_keyword(lower) != nullptr;
    return is_plain && !is_word && !name.empty() ? name : fmt::format("\"{}\"", name);
}

// The numbers without their letters of residues that have one and are not chosen: "4" for 4A.
std::set<std::string, std::less<>> list_unchosen_letters(const AtomDirectory& directory,
                                                         std::span<const ResidueAtoms> residues,
                                                         const std::vector<bool>& chosen) {
    std::set<std::string, std::less<>> numbers;
    for (const ResidueAtoms& residue : residues) {
        const std::string& number = directory.names[residue.first].number;
        const bool has_letter =
            !number.empty() && std::isdigit(static_cast<unsigned char>(number.back())) == 0;
        if (has_letter && count_in(residue, chosen) == 0)
            numbers.insert(number.substr(0, number.size() - 1));
    }
    return numbers;
}

// The residues' numbers; three or more that follow each other as a range. A range also selects the
// residues with letters of its numbers (1:4 selects 4A), so those of `no_range` stand alone.
std::string list_numbers(const AtomDirectory& directory, std::span<const ResidueAtoms> residues,
                         const std::set<std::string, std::less<>>& no_range) {
    const auto number = [&](std::size_t i) -> const std::string& {
        return directory.names[residues[i].first].number;
    };
    const auto follows = [&](std::size_t i) {
        if (no_range.contains(number(i - 1)) || no_range.contains(number(i))) return false;
        const std::optional<std::int64_t> before = find_integer(number(i - 1)),
                                          now = find_integer(number(i));
        return residues[i - 1].end == residues[i].first && before && now && *before >= 0 &&
               *now == *before + 1;
    };
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < residues.size();) {
        std::size_t last = i;
        while (last + 1 < residues.size() && follows(last + 1)) ++last;
        if (last < i + 2) last = i;
        parts.push_back(last == i ? number(i) : fmt::format("{}:{}", number(i), number(last)));
        i = last + 1;
    }
    return fmt::format("{}", fmt::join(parts, " "));
}

}  // namespace

std::vector<bool> select_as_seen(const World& world, const std::string& expression) {
    const AtomTable& atoms = world.resource<AtomTable>();
    const std::vector<ResidueSpan> residues = find_residues(world);
    ResidueStructure found;
    return select_in_world(world, parse_selection(expression),
                           per_atom(atoms, residues, found.update(atoms, residues)));
}

std::string describe_count(const AtomDirectory& directory, const std::vector<bool>& chosen) {
    std::size_t residues = 0, atoms = 0;
    for (const AtomDirectory::Entry& molecule : directory.molecules) {
        for (const ResidueAtoms& residue : residues_of(directory, molecule.atoms)) {
            const std::size_t count = count_in(residue, chosen);
            residues += count > 0 ? 1 : 0;
            atoms += count;
        }
    }
    return fmt::format("{} residue{}, {} atom{}", residues, residues == 1 ? "" : "s", atoms,
                       atoms == 1 ? "" : "s");
}

std::string expression_of(const AtomDirectory& directory, const std::vector<bool>& chosen) {
    struct Part {
        const AtomDirectory::Entry* molecule;
        std::size_t of;  // residues in all
        std::vector<ResidueAtoms> residues;
        std::set<std::string, std::less<>> no_range;
    };
    std::vector<Part> parts;
    std::size_t count = 0;
    for (const AtomDirectory::Entry& molecule : directory.molecules) {
        std::vector<ResidueAtoms> residues = residues_of(directory, molecule.atoms);
        const std::size_t all = residues.size();
        std::set<std::string, std::less<>> no_range =
            list_unchosen_letters(directory, residues, chosen);
        std::erase_if(residues, [&](const auto& each) { return count_in(each, chosen) == 0; });
        count += residues.size();
        if (!residues.empty())
            parts.push_back({&molecule, all, std::move(residues), std::move(no_range)});
    }
    std::vector<std::string> texts;
    for (const Part& part : parts) {
        std::string text = fmt::format("molecule {}", as_name(part.molecule->molecule));
        const bool is_whole = part.of == part.residues.size();
        if (!is_whole)
            text +=
                fmt::format(" and resid {}", list_numbers(directory, part.residues, part.no_range));
        const ResidueAtoms& first = part.residues.front();
        if (count == 1 && count_in(first, chosen) < first.end - first.first) {
            text += " and name";
            for (std::uint32_t i = first.first; i < first.end; ++i)
                if (is_chosen(chosen, i))
                    text += fmt::format(" {}", as_name(directory.names[i].atom));
        }
        texts.push_back(std::move(text));
    }
    return texts.empty() ? "none" : fmt::format("{}", fmt::join(texts, " or "));
}

std::string expression_of(const AtomDirectory& directory, std::uint32_t atom) {
    for (const AtomDirectory::Entry& molecule : directory.molecules) {
        if (atom < molecule.atoms.first || atom - molecule.atoms.first >= molecule.atoms.count)
            continue;
        const AtomName& name = directory.names[atom];
        return fmt::format("molecule {} and resid {} and name {}", as_name(molecule.molecule),
                           name.number, as_name(name.atom));
    }
    return "none";
}

std::vector<bool> find_in_box(const FrameScene& frame, std::span<const glm::vec3> places,
                              const PictureBox& box, std::uint32_t width, std::uint32_t height) {
    std::vector<bool> chosen(places.size(), false);
    const auto show = [&](std::uint32_t pick) {
        if (pick < chosen.size()) chosen[pick] = true;
    };
    for (const SphereShape& sphere : frame.spheres) show(sphere.pick);
    for (const ConeShape& cone : frame.cones) show(cone.pick);
    for (const MeshShape& mesh : frame.meshes)
        for (const MeshVertex& vertex : mesh.vertices) show(vertex.pick);
    const glm::vec2 low = glm::min(box.one, box.other), high = glm::max(box.one, box.other);
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!chosen[i]) continue;
        const glm::vec3 seen = project(frame.camera, places[i], width, height);
        chosen[i] = seen.z > frame.camera.near && seen.x >= low.x && seen.x <= high.x &&
                    seen.y >= low.y && seen.y <= high.y;
    }
    return chosen;
}

void highlight(const AtomDirectory& directory, std::span<const glm::vec3> places,
               const std::vector<bool>& chosen, FrameScene& frame) {
    const std::vector<std::uint32_t>& residue_of = directory.residue_of;
    if (chosen.size() != places.size() || residue_of.size() != places.size()) return;
    constexpr float share = 0.75F, thicker = 1.3F, dot_radius = 0.35F;  // Å
    const auto tint = [&](glm::vec3& colour) { colour = glm::mix(colour, selected_colour, share); };
    const std::size_t residues = residue_of.empty() ? 0 : residue_of.back() + std::size_t{1};
    std::vector<bool> has_chosen(residues, false), is_shown(residues, false);
    for (std::size_t i = 0; i < chosen.size(); ++i)
        if (chosen[i]) has_chosen[residue_of[i]] = true;
    const auto show = [&](std::uint32_t pick) {
        if (pick < places.size()) is_shown[residue_of[pick]] = true;
        return pick < places.size();
    };
    for (SphereShape& sphere : frame.spheres) {
        if (!show(sphere.pick) || !chosen[sphere.pick]) continue;
        tint(sphere.colour);
        sphere.radius *= thicker;
    }
    for (ConeShape& cone : frame.cones) {
        if (!show(cone.pick) || !chosen[cone.pick]) continue;
        tint(cone.colour_a);
        tint(cone.colour_b);
        cone.radius_a *= thicker;
        cone.radius_b *= thicker;
    }
    for (MeshShape& mesh : frame.meshes)
        for (MeshVertex& vertex : mesh.vertices)
            if (show(vertex.pick) && has_chosen[residue_of[vertex.pick]]) tint(vertex.colour);
    for (std::size_t i = 0; i < places.size(); ++i)
        if (chosen[i] && !is_shown[residue_of[i]])
            frame.spheres.push_back(
                {places[i], dot_radius, selected_colour, static_cast<std::uint32_t>(i)});
}

}  // namespace palpa
