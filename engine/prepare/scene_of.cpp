#include "prepare/scene_of.h"

#include "core/file_versions.h"
#include "core/units.h"
#include "prepare/residues.h"
#include "scene/write_scene.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>

namespace palpa {
namespace {

// As scene files name an atom.
std::string atom_text(const Structure& structure, std::uint32_t atom) {
    return fmt::format("{} {}", structure.names[atom].number, structure.names[atom].atom);
}

// The heavy atom that is nearest to a place, or farthest from it.
std::uint32_t find_atom_by(const Structure& structure, std::span<const std::uint32_t> atoms,
                           const Vec3& place, bool farthest) {
    std::uint32_t found = atoms.front();
    double best = std::numeric_limits<double>::infinity();
    for (const std::uint32_t atom : atoms) {
        const double distance = (structure.positions[atom] - place).norm();
        const double rank = farthest ? -distance : distance;
        if (element_of(structure, atom) == "H" || rank >= best) continue;
        best = rank;
        found = atom;
    }
    return found;
}

// Whose body is the molecule's base: in its middle, but what is on a spring must be able to move.
std::uint32_t find_reference(const Structure& structure, const SystemSegment& segment,
                             const HandChoice& hand) {
    const std::uint32_t middle =
        find_atom_by(structure, segment.atoms, middle_of(structure, segment.atoms), false);
    if (segment.name != hand.segment || hand.atom.empty()) return middle;
    constexpr double apart = 8;  // Å
    const Vec3 held = middle_of(structure, hand.held);
    if ((structure.positions[middle] - held).norm() > apart) return middle;
    return find_atom_by(structure, segment.atoms, held, true);
}

// Distances are measured from a molecule that stays: the largest that the hand does not move.
std::string find_origin(std::span<const SystemSegment> segments, const HandChoice& hand) {
    if (!hand.atom.empty()) return hand.segment;
    const SystemSegment* largest = nullptr;
    for (const SystemSegment& segment : segments) {
        if (segment.name == hand.segment) continue;
        if (!largest || segment.atoms.size() > largest->atoms.size()) largest = &segment;
    }
    return largest ? largest->name : hand.segment;
}

std::string format_path(const Vec3& way) {
    constexpr double out = 4;  // Å
    constexpr std::array<std::array<double, 2>, 4> path{{{0.5, 0}, {3, out}, {4, out}, {6.5, 0}}};
    std::string text;
    for (const auto& [time_s, distance] : path) {
        const Vec3 place = distance * way;
        fmt::format_to(std::back_inserter(text), "{}[{}, {:.3f}, {:.3f}, {:.3f}]",
                       text.empty() ? "" : ", ", time_s, place.x(), place.y(), place.z());
    }
    return text;
}

std::string format_note(const std::string& note) {
    return note.empty() ? "" : fmt::format("# {}\n", note);
}

std::string format_statics(std::size_t atoms, Solvent solvent, const SceneTuning& tuning) {
    std::string text = "\n[statics]\nrest_kcal_per_mol = 0.5\n";
    if (tuning.relax_steps) text += fmt::format("relax_steps = {}\n", *tuning.relax_steps);
    if (atoms <= most_atoms_all_pairs) {
        text += "steps = 2\n";
    } else if (solvent == Solvent::None) {
        text += "cutoff_angstrom = 12.0\n";
    }
    return text;
}

std::string format_texts(const std::vector<std::string>& texts) {
    std::vector<std::string> quoted;
    for (const std::string& text : texts) quoted.push_back(in_quotes(text));
    return fmt::format("[{}]", fmt::join(quoted, ", "));
}

// The key `approximate` where the segment has such residues.
std::string format_approximate(const Structure& structure, const SystemSegment& segment,
                               const std::vector<std::string>& approximate) {
    std::vector<std::string> here;
    for (const std::string& residue : approximate) {
        const bool has = std::any_of(
            segment.atoms.begin(), segment.atoms.end(),
            [&](std::uint32_t atom) { return structure.names[atom].residue == residue; });
        if (has) here.push_back(residue);
    }
    return here.empty() ? "" : fmt::format("approximate = {}\n", format_texts(here));
}

// Bonds that do not turn, and the region in which others do.
std::string format_joints(const std::vector<std::string>& rigid, const SceneTuning& tuning) {
    std::string text;
    if (!rigid.empty()) text += fmt::format("rigid = {}\n", format_texts(rigid));
    if (tuning.region_angstrom) {
        text += fmt::format("{}region_angstrom = {}\n", format_note(tuning.region_note),
                            *tuning.region_angstrom);
    }
    return text.empty() ? text : "\n[joints]\n" + text;
}

// So that what is in the hand is seen: of some hundred atoms one sees all, and nothing stands
// before a ligand.
std::string format_view(std::size_t atoms, const HandChoice& hand) {
    constexpr std::size_t most_all_seen = 400, most_in_pocket = 300;
    if (atoms <= most_all_seen) return "";
    const bool is_in_pocket = hand.atom.empty() && hand.held.size() <= most_in_pocket;
    return fmt::format("\n[view]\nrepresentation = \"pocket\"\n{}",
                       is_in_pocket ? "clip = true\n" : "");
}

std::string format_coupling(const SceneTuning& tuning) {
    const std::string text = "\n[coupling]\n" + format_note(tuning.coupling_note);
    if (!tuning.feel_pN) {
        return text +
               "force_law = \"constant\"\ndisplacement_law = \"constant\"\nA_f = 0.1e9\n"
               "A_d = 0.05e9\n";
    }
    const auto [weakest, strongest] = *tuning.feel_pN;
    return text + fmt::format("feel_pN = [{}, {}]\n", weakest, strongest);
}

}  // namespace

std::string format_scene(const Structure& structure, std::span<const SystemSegment> segments,
                         const HandChoice& hand, const Vec3& way, const SceneText& text,
                         const SceneTuning& tuning) {
    std::string scene = fmt::format(
        "# Written by palpa prepare. Every key: palpa help keys.\nformat = \"{}\"\ntitle = "
        "{}\nabout "
        "= {}\nmade_by = {}\n\n[force_field]\nfiles = [\"system.prm\"]\n",
        to_string(scene_version), in_quotes(text.title), in_quotes(text.about),
        in_quotes(text.made_by));
    const bool has_solvent = text.solvent != Solvent::None;
    if (has_solvent) {
        scene += fmt::format("solvent = \"{}\"\n",
                             solvent_names[static_cast<std::size_t>(text.solvent)]);
    }
    if (text.dielectric != 1) {
        scene += fmt::format(
            "# A dielectric of {}, for nucleic acids without water.\n"
            "coulomb_constant = {:.4f}\n",
            text.dielectric, units::charmm_coulomb_constant / text.dielectric);
    }
    for (const SystemSegment& segment : segments) {
        const std::string name = in_quotes(segment.name);
        const std::uint32_t reference = find_reference(structure, segment, hand);
        fmt::format_to(std::back_inserter(scene),
                       "\n[molecules.{}]\nstructure = {}\ntopology = {}\nsegment = {}\n"
                       "reference_atom = {}\n",
                       name, in_quotes(text.structure), in_quotes(text.topology), name,
                       in_quotes(atom_text(structure, reference)));
        scene += format_approximate(structure, segment, text.approximate);
        if (segment.kind == SegmentKind::Molecule) scene += "shape = \"flexible\"\n";
        if (segment.kind == SegmentKind::Water && has_solvent) scene += "structural_water = true\n";
        if (segment.name == hand.segment && hand.atom.empty()) {
            scene += "motion = \"translate-and-turn\"\n";
        }
    }
    scene += format_joints(text.rigid, tuning);
    scene += format_statics(structure.names.size(), text.solvent, tuning);
    scene += fmt::format("\n[grab]\nmolecule = {}\nmeasured_from = {}\n", in_quotes(hand.segment),
                         in_quotes(find_origin(segments, hand)));
    if (!hand.atom.empty()) scene += fmt::format("atom = {}\n", in_quotes(hand.atom));
    scene += fmt::format("\n[hand]\nstroke = \"lead\"\npath = [{}]\n", format_path(way));
    scene += format_coupling(tuning);
    scene += format_view(structure.names.size(), hand);
    scene += fmt::format("\n[run]\n{}period_ms = {}\n", format_note(tuning.period_note),
                         tuning.period_ms);
    if (!tuning.measured_on.empty())
        scene += fmt::format("measured_on = {}\n", in_quotes(tuning.measured_on));
    scene += "seconds = 10\n";
    return scene;
}

}  // namespace palpa
