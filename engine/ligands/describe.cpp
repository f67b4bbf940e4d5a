#include "ligands/approximate.h"

#include "charmm/find_parameters.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <iterator>

namespace palpa {
namespace {

std::string_view name_of(Surroundings level) {
    constexpr std::array<std::string_view, surroundings_levels> names{
        "its element alone",     "its bonds",     "its neighbours' elements", "its rings",
        "its neighbours' bonds", "one bond away", "two bonds away",           "three bonds away"};
    return names[static_cast<std::size_t>(level)];
}

double mean_penalty(const ApproximateLigand& ligand) {
    double sum = 0;
    for (const TypeChoice& choice : ligand.types) sum += choice.penalty;
    return ligand.types.empty() ? 0 : sum / static_cast<double>(ligand.types.size());
}

double highest_type_penalty(const ApproximateLigand& ligand) {
    double highest = 0;
    for (const TypeChoice& choice : ligand.types) highest = std::max(highest, choice.penalty);
    return highest;
}

double highest_penalty(const ApproximateLigand& ligand) {
    double highest = 0;
    for (const Analogy& analogy : ligand.analogies) highest = std::max(highest, analogy.penalty);
    return highest;
}

std::string join_types(const std::vector<std::string>& types) {
    return fmt::format("{}", fmt::join(types, "-"));
}

// Dihedrals whose types occur among the residue's own.
template <class Map>
void format_torsions(const Map& map, const Analogy& analogy, std::string& text) {
    const std::vector<std::string>& t = analogy.types;
    const auto found = map.find(in_order(std::array{t[0], t[1], t[2], t[3]}));
    if (found == map.end()) return;
    for (const DihedralTerm& term : found->second) {
        fmt::format_to(std::back_inserter(text),
                       "{:<7} {:<7} {:<7} {:<7} {:10.4f} {:2d} {:8.2f} ! from {}, penalty {:.0f}\n",
                       t[0], t[1], t[2], t[3], term.k, term.multiplicity, term.phase_deg,
                       join_types(analogy.from), analogy.penalty);
    }
}

void format_entry(const ForceField& force_field, const Analogy& analogy, std::string& text) {
    const std::vector<std::string>& t = analogy.types;
    const auto out = std::back_inserter(text);
    if (analogy.kind == TermKind::Bond) {
        const HarmonicParameter& bond = *find_bond(force_field, {t[0], t[1]});
        fmt::format_to(out, "{:<7} {:<7} {:9.3f} {:9.4f} ! from {}, penalty {:.0f}\n", t[0], t[1],
                       bond.k, bond.value, join_types(analogy.from), analogy.penalty);
    } else if (analogy.kind == TermKind::Angle) {
        const AngleParameter& angle = *find_angle(force_field, {t[0], t[1], t[2]});
        fmt::format_to(out, "{:<7} {:<7} {:<7} {:9.3f} {:9.3f}", t[0], t[1], t[2], angle.k,
                       angle.value);
        if (angle.urey_bradley_k != 0) {
            fmt::format_to(out, " {:8.3f} {:9.5f}", angle.urey_bradley_k, angle.urey_bradley_s0);
        }
        fmt::format_to(out, " ! from {}, penalty {:.0f}\n", join_types(analogy.from),
                       analogy.penalty);
    } else {
        format_torsions(
            analogy.kind == TermKind::Dihedral ? force_field.dihedrals : force_field.impropers,
            analogy, text);
    }
}

void format_section(const ApproximateLigand& ligand, const ForceField& force_field, TermKind kind,
                    std::string_view header, std::string& text) {
    std::string entries;
    for (const Analogy& analogy : ligand.analogies) {
        if (analogy.kind == kind) format_entry(force_field, analogy, entries);
    }
    if (!entries.empty()) fmt::format_to(std::back_inserter(text), "{}\n{}\n", header, entries);
}

std::string format_residue(const ApproximateLigand& ligand) {
    std::string text = fmt::format("RESI {} {:.3f}\nGROUP\n", ligand.name, ligand.residue.charge);
    for (std::size_t i = 0; i < ligand.graph.size(); ++i) {
        const TypeChoice& choice = ligand.types[i];
        fmt::format_to(std::back_inserter(text),
                       "ATOM {:<6} {:<7} {:7.3f} ! penalty {:.0f}, as in {}\n",
                       ligand.graph.atoms[i].name, choice.type, ligand.charges[i], choice.penalty,
                       choice.example);
    }
    for (const auto& [a, b] : ligand.residue.bonds) {
        fmt::format_to(std::back_inserter(text), "BOND {} {}\n", a, b);
    }
    for (const auto& atoms : ligand.residue.impropers) {
        fmt::format_to(std::back_inserter(text), "IMPR {}\n", fmt::join(atoms, " "));
    }
    return text + "PATC FIRS NONE LAST NONE\n";
}

}  // namespace

std::string format_stream(const ApproximateLigand& ligand, const ForceField& force_field) {
    std::string text = fmt::format(
        "* {}: approximate types, charges and parameters by likeness to CGenFF's residues.\n"
        "* Bonds and hydrogens: {}. Not from the CGenFF program.\n*\n\n"
        "read rtf card append\n* approximate\n*\n36 1\n\nAUTO ANGLES DIHE\n\n{}\nEND\n\n",
        ligand.name, ligand.source, format_residue(ligand));
    if (ligand.analogies.empty()) return text + "RETURN\n";
    text += "read param card flex append\n* approximate\n*\n\n";
    format_section(ligand, force_field, TermKind::Bond, "BONDS", text);
    format_section(ligand, force_field, TermKind::Angle, "ANGLES", text);
    format_section(ligand, force_field, TermKind::Dihedral, "DIHEDRALS", text);
    format_section(ligand, force_field, TermKind::Improper, "IMPROPERS", text);
    return text + "END\n\nRETURN\n";
}

std::vector<std::string> describe(const ApproximateLigand& ligand) {
    std::vector<std::string> lines;
    lines.push_back(
        fmt::format("{}: {} atoms, charge {:+d} e; bonds from {}; penalty of types {:.1f} in the "
                    "mean, {:.0f} at most; {} parameters by analogy, {:.0f} at most",
                    ligand.name, ligand.graph.size(), total_charge(ligand.graph), ligand.source,
                    mean_penalty(ligand), highest_type_penalty(ligand), ligand.analogies.size(),
                    highest_penalty(ligand)));
    for (const std::string& note : ligand.notes) lines.push_back(ligand.name + ": " + note);
    for (const auto& [a, b] : ligand.doubtful_turns) {
        lines.push_back(fmt::format("{}: the torsion barrier about {}-{} is a guess", ligand.name,
                                    ligand.graph.atoms[a].name, ligand.graph.atoms[b].name));
    }
    for (std::size_t i = 0; i < ligand.graph.size(); ++i) {
        const TypeChoice& choice = ligand.types[i];
        lines.push_back(
            fmt::format("{} {:<5} {:<7} {:+.3f} e, penalty {:3.0f}: taken from {}, alike in {}",
                        ligand.name, ligand.graph.atoms[i].name, choice.type, ligand.charges[i],
                        choice.penalty, choice.example, name_of(choice.level)));
    }
    for (const Analogy& analogy : ligand.analogies) {
        lines.push_back(fmt::format("{} {} {}: as {}, penalty {:.0f}", ligand.name,
                                    name_of(analogy.kind), join_types(analogy.types),
                                    join_types(analogy.from), analogy.penalty));
    }
    return lines;
}

}  // namespace palpa
