#include "prepare/approximate_unknown.h"

#include "ligands/approximate.h"
#include "ligands/sources.h"
#include "molecule/element.h"
#include "prepare/residue_names.h"
#include "prepare/residues.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>

namespace palpa {
namespace {

constexpr std::string_view ligands_heading = "Approximate ligands";

using ByName = std::map<std::string, std::vector<ResidueRange>>;

// Those that the naming leaves out.
ByName find_unknown(const ForceField& force_field, const Structure& structure,
                    const PrepareSettings& settings) {
    Report scratch;
    const NamedResidues named = name_residues(force_field, structure, settings, scratch);
    const std::set<std::size_t> known(named.structure.lines.begin(), named.structure.lines.end());
    ByName unknown;
    for (const ResidueRange& residue : find_residues(structure)) {
        bool is_known = false;
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            is_known = is_known || known.contains(structure.lines[i]);
        }
        if (!is_known) unknown[structure.names[residue.first].residue].push_back(residue);
    }
    return unknown;
}

bool can_be_covalent(const std::string& element) {
    return element == "C" || element == "N" || element == "O" || element == "S" || element == "P";
}

// An atom of another residue that one of these is bonded to.
std::optional<std::size_t> find_bond_out(const Structure& structure, const ResidueRange& residue) {
    for (std::size_t i = residue.first; i < residue.end(); ++i) {
        const std::string own = element_of(structure, i);
        if (!can_be_covalent(own)) continue;
        for (std::size_t j = 0; j < structure.names.size(); ++j) {
            if (j >= residue.first && j < residue.end()) continue;
            const double gap = (structure.positions[i] - structure.positions[j]).norm();
            if (gap > 2.5) continue;
            const std::string other = element_of(structure, j);
            constexpr double slack = 0.2;  // Å
            if (can_be_covalent(other) &&
                gap < covalent_radius(own) + covalent_radius(other) + slack) {
                return j;
            }
        }
    }
    return std::nullopt;
}

MoleculeGraph graph_of(const Structure& structure, const ResidueRange& residue) {
    MoleculeGraph graph;
    graph.name = structure.names[residue.first].residue;
    for (std::size_t i = residue.first; i < residue.end(); ++i) {
        graph.atoms.push_back(
            {structure.names[i].atom, element_of(structure, i), 0, structure.positions[i]});
    }
    return graph;
}

ApproximatePart part_of(const ApproximateLigand& ligand, const ForceField& force_field) {
    ApproximatePart part;
    part.residue = ligand.name;
    part.source = ligand.source;
    part.charge = total_charge(ligand.graph);
    for (const TypeChoice& choice : ligand.types) part.type_penalty += choice.penalty;
    part.type_penalty /= static_cast<double>(ligand.types.size());
    part.analogies = ligand.analogies.size();
    for (const Analogy& analogy : ligand.analogies) {
        part.highest_penalty = std::max(part.highest_penalty, analogy.penalty);
    }
    for (const auto& [a, b] : ligand.doubtful_turns) {
        part.rigid_bonds.push_back({ligand.graph.atoms[a].name, ligand.graph.atoms[b].name});
    }
    part.stream = format_stream(ligand, force_field);
    return part;
}

class Approximation {
public:
    Approximation(const ForceField& force_field, const Structure& structure,
                  const PrepareSettings& settings, Report& report)
        : settings_(settings), report_(report), result_{force_field, structure, {}, {}} {}

    ApproximatedUnknown approximate() {
        const ByName unknown = find_unknown(result_.force_field, result_.structure, settings_);
        std::optional<LigandModel> model;
        std::vector<bool> kept(result_.structure.names.size(), true);
        for (const auto& [name, residues] : unknown) {
            if (count_heavy(residues.front()) < 2) continue;
            if (!model) model = build_ligand_model(result_.force_field);
            try {
                add(residues, *model, kept);
            } catch (const LoadError& error) {
                result_.refused.push_back(error);
            }
        }
        for (const std::filesystem::path& file : settings_.ligand_files) check_used(file, unknown);
        result_.structure = keep_atoms(result_.structure, kept);
        return std::move(result_);
    }

private:
    std::size_t count_heavy(const ResidueRange& residue) const {
        std::size_t count = 0;
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            if (element_of(result_.structure, i) != "H") ++count;
        }
        return count;
    }

    void add(const std::vector<ResidueRange>& residues, const LigandModel& model,
             std::vector<bool>& kept) {
        const Structure& structure = result_.structure;
        const TextPlace place{structure.file, structure.lines[residues[0].first], 0};
        for (const ResidueRange& residue : residues) {
            const auto other = find_bond_out(structure, residue);
            if (!other) continue;
            throw LoadError(place, fmt::format("{} is bonded to {}; --approximate-ligands takes "
                                               "only molecules without bonds to others",
                                               residue_label(structure, residue),
                                               to_string(structure.names[*other])));
        }
        const ResidueRange most = *std::max_element(
            residues.begin(), residues.end(), [&](const ResidueRange& a, const ResidueRange& b) {
                return count_heavy(a) < count_heavy(b);
            });
        FoundLigand found = find_ligand({graph_of(structure, most), settings_.ligand_files,
                                         settings_.entry, monomer_libraries()});
        if (found.file) used_.insert(*found.file);
        ForceField& into = result_.force_field;
        ApproximateLigand ligand = approximate_ligand(found.graph, model, into);
        ligand.source = std::move(found.source);
        ligand.notes = std::move(found.notes);
        for (const ResidueRange& residue : residues) leave_out_hydrogens(ligand, residue, kept);
        tell(ligand);
        result_.parts.push_back(part_of(ligand, into));
    }

    // Those that the residue does not have are built anew under its names.
    void leave_out_hydrogens(const ApproximateLigand& ligand, const ResidueRange& residue,
                             std::vector<bool>& kept) const {
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            if (element_of(result_.structure, i) != "H") continue;
            const std::string& name = result_.structure.names[i].atom;
            kept[i] = std::any_of(ligand.graph.atoms.begin(), ligand.graph.atoms.end(),
                                  [&](const GraphAtom& atom) { return atom.name == name; });
        }
    }

    void tell(const ApproximateLigand& ligand) {
        const std::vector<std::string> lines = describe(ligand);
        for (const std::string& line : lines) report_.add(ligands_heading, line);
        report_.warn(fmt::format("approximate: {}; see approximate.str; {}", lines.front(),
                                 real_parameters_advice));
        for (const std::string& note : ligand.notes) {
            report_.warn(fmt::format("{}: {}", ligand.name, note));
        }
    }

    void check_used(const std::filesystem::path& file, const ByName& unknown) const {
        if (used_.contains(file)) return;
        std::vector<std::string> names;
        for (const auto& [name, residues] : unknown) names.push_back(name);
        throw LoadError(
            {file.string()},
            fmt::format(
                "--ligand: matches none of the residues without a topology ({}); expected the same "
                "heavy atoms and bonds, or the same atom names",
                names.empty() ? "none is missing" : fmt::format("{}", fmt::join(names, ", "))));
    }

    const PrepareSettings& settings_;
    Report& report_;
    ApproximatedUnknown result_;
    std::set<std::filesystem::path> used_;
};

}  // namespace

ApproximatedUnknown approximate_unknown(const ForceField& force_field, const Structure& structure,
                                        const PrepareSettings& settings, Report& report) {
    return Approximation(force_field, structure, settings, report).approximate();
}

}  // namespace palpa
