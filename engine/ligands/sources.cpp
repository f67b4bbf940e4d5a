#include "ligands/sources.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "ligands/add_hydrogens.h"
#include "ligands/bond_orders.h"
#include "ligands/chem_comp.h"
#include "ligands/match.h"
#include "ligands/orders_of_places.h"
#include "ligands/sdf.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <set>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

std::size_t count_hydrogens(const MoleculeGraph& graph) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < graph.size(); ++i) count += graph.is_hydrogen(i) ? 1 : 0;
    return count;
}

bool has_hydrogen_on_carbon(const MoleculeGraph& graph) {
    return std::any_of(graph.bonds.begin(), graph.bonds.end(), [&](const GraphBond& bond) {
        const std::string& a = graph.atoms[bond.a].element;
        const std::string& b = graph.atoms[bond.b].element;
        return (a == "H" && b == "C") || (a == "C" && b == "H");
    });
}

// Free valences of atoms in bonds that a file calls aromatic, where it has no hydrogens: one of
// carbon; of nitrogen and oxygen three and two less their bonds.
std::vector<int> open_ends(const LigandFile& file) {
    const BondLists bonds = bonds_of_atoms(file.graph);
    std::vector<int> open(file.graph.size());
    for (std::uint32_t i = 0; i < file.graph.size(); ++i) {
        int sum = 0;
        bool has_open = false;
        for (const std::uint32_t bond : bonds[i]) {
            sum += file.graph.bonds[bond].order;
            has_open = has_open || file.open_bonds[bond];
        }
        if (!has_open) continue;
        const GraphAtom& atom = file.graph.atoms[i];
        const int shift = atom.element == "C" ? 0 : atom.charge;
        const int valence = usual_valence(atom.element, sum) + shift;
        open[i] = std::clamp(valence - sum, 0, 1);
    }
    return open;
}

// Orders and hydrogens of a description. `at_its_word`: what a user's file states holds.
MoleculeGraph complete(LigandFile file, bool at_its_word, std::vector<std::string>& notes) {
    MoleculeGraph& graph = file.graph;
    const bool has_open =
        std::find(file.open_bonds.begin(), file.open_bonds.end(), true) != file.open_bonds.end();
    const bool has_hydrogens = has_hydrogen_on_carbon(graph);
    if (has_hydrogens) {
        if (has_open && !assign_bond_orders(graph)) {
            notes.emplace_back(
                "its aromatic bonds and hydrogens leave a carbon with a free valence");
        }
        charge_by_valence(graph);
    } else if (has_open && !pair_marked_bonds(graph, file.open_bonds, open_ends(file))) {
        notes.emplace_back("its aromatic bonds leave a carbon with a free valence");
    }
    if (at_its_word && (has_hydrogens || file.states_charges)) {
        return has_hydrogens ? std::move(graph) : with_hydrogens(graph);
    }
    MoleculeGraph neutral = with_hydrogens(graph);
    charge_at_ph_7(neutral, notes);
    return with_hydrogens(neutral);
}

// Names and positions of the structure. `match`: which of `known` its heavy atoms are.
MoleculeGraph with_names_of(MoleculeGraph known, const MoleculeGraph& found,
                            const std::vector<std::uint32_t>& match) {
    const bool keeps_names = std::all_of(known.atoms.begin(), known.atoms.end(),
                                         [](const GraphAtom& atom) { return !atom.name.empty(); });
    const BondLists of_known = bonds_of_atoms(known), of_found = bonds_of_atoms(found);
    std::set<std::string> names;
    std::vector<bool> is_named(known.size());
    for (GraphAtom& atom : known.atoms) atom.position.reset();
    const auto name = [&](std::uint32_t to, const GraphAtom& as) {
        known.atoms[to].name = as.name;
        known.atoms[to].position = as.position;
        is_named[to] = names.insert(as.name).second;
    };
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < found.size(); ++i) {
        if (found.is_hydrogen(i)) continue;
        const std::uint32_t heavy = match[next++];
        name(heavy, found.atoms[i]);
        std::vector<std::uint32_t> hydrogens;
        for (const std::uint32_t bond : of_known[heavy]) {
            const std::uint32_t other = other_end(known.bonds[bond], heavy);
            if (known.is_hydrogen(other)) hydrogens.push_back(other);
        }
        for (const std::uint32_t bond : of_found[i]) {
            const std::uint32_t other = other_end(found.bonds[bond], i);
            if (!found.is_hydrogen(other) || hydrogens.empty()) continue;
            name(hydrogens.front(), found.atoms[other]);
            hydrogens.erase(hydrogens.begin());
        }
    }
    std::size_t number = 0;
    for (std::uint32_t i = 0; i < known.size(); ++i) {
        if (is_named[i]) continue;
        std::string& own = known.atoms[i].name;
        if (keeps_names && names.insert(own).second) continue;
        do {
            own = fmt::format("{}{}{}", known.atoms[i].element, ++number,
                              known.is_hydrogen(i) ? "" : "X");
        } while (!names.insert(own).second);
    }
    return known;
}

class Search {
public:
    explicit Search(const LigandQuery& query) : query_(query), found_(query.found) {
        if (found_.size() > most_ligand_atoms) {
            throw LoadError({found_.name}, fmt::format("{} atoms; expected at most {} for a ligand",
                                                       found_.size(), most_ligand_atoms));
        }
        find_bonds(found_);
    }

    FoundLigand find() {
        for (const std::filesystem::path& file : query_.files) {
            if (auto given = from_file(file)) return std::move(*given);
        }
        if (auto own = from_own_hydrogens()) return std::move(*own);
        if (auto entry = from_entry()) return std::move(*entry);
        if (auto library = from_libraries()) return std::move(*library);
        return from_places();
    }

private:
    std::optional<FoundLigand> from_file(const std::filesystem::path& path) {
        std::vector<std::string> notes;
        auto fitted = fit(read_ligand_file(path), true, path.filename().string(), notes);
        if (fitted) fitted->file = path;
        return fitted;
    }

    std::optional<FoundLigand> from_own_hydrogens() {
        if (!has_hydrogen_on_carbon(found_)) return std::nullopt;
        MoleculeGraph graph = found_;
        if (!assign_bond_orders(graph)) return std::nullopt;
        return FoundLigand{std::move(graph), "the structure's own hydrogens", {}, {}};
    }

    std::optional<FoundLigand> from_entry() {
        const std::string ending = upper_case(query_.entry.extension().string());
        if (ending != ".CIF" && ending != ".MMCIF") return std::nullopt;
        return from_cif(query_.entry, "the entry's chem_comp_bond");
    }

    std::optional<FoundLigand> from_libraries() {
        for (const std::filesystem::path& library : query_.libraries) {
            std::string folder(1, found_.name.empty() ? '_' : found_.name[0]);
            if (folder[0] >= 'A' && folder[0] <= 'Z') {
                folder[0] = static_cast<char>(folder[0] - 'A' + 'a');
            }
            const std::filesystem::path path = library / folder / (found_.name + ".cif");
            std::error_code error;
            if (!std::filesystem::is_regular_file(path, error)) continue;
            if (auto result = from_cif(path, "the monomer library")) return result;
        }
        return std::nullopt;
    }

    std::optional<FoundLigand> from_cif(const std::filesystem::path& path, const char* source) {
        const auto file = find_chem_comp(read_text_file(path), path.string(), found_.name);
        std::vector<std::string> notes;
        return file ? fit(*file, false, source, notes) : std::nullopt;
    }

    std::optional<FoundLigand> fit(const LigandFile& file, bool at_its_word,
                                   const std::string& source, std::vector<std::string>& notes) {
        MoleculeGraph named = file.graph;
        named.name = found_.name;
        if (!file.names_atoms) {
            for (GraphAtom& atom : named.atoms) atom.name.clear();
        }
        const auto match = match_atoms(named, found_);
        if (!match) return std::nullopt;
        // Names first, so that notes and hydrogens speak of the structure's atoms.
        LigandFile renamed = file;
        renamed.graph = with_names_of(std::move(named), found_, *match);
        MoleculeGraph graph = complete(std::move(renamed), at_its_word, notes);
        add_hydrogen_places(graph);
        return FoundLigand{std::move(graph), source, std::move(notes), {}};
    }

    // Hydrogens that were added to heavy atoms take the structure's names and places.
    void add_hydrogen_places(MoleculeGraph& graph) {
        std::vector<std::uint32_t> match;
        if (count_hydrogens(found_) == 0) return;
        for (const GraphAtom& atom : found_.atoms) {
            if (atom.element == "H") continue;
            const auto at = std::find_if(graph.atoms.begin(), graph.atoms.end(),
                                         [&](const GraphAtom& a) { return a.name == atom.name; });
            match.push_back(static_cast<std::uint32_t>(at - graph.atoms.begin()));
        }
        graph = with_names_of(std::move(graph), found_, match);
    }

    FoundLigand from_places() {
        std::vector<std::string> notes;
        notes.emplace_back("its bond orders are guessed from distances and angles; check them");
        std::vector<bool> is_hydrogen(found_.size());
        for (std::size_t i = 0; i < found_.size(); ++i) is_hydrogen[i] = found_.is_hydrogen(i);
        MoleculeGraph heavy = without_atoms(found_, is_hydrogen);
        guess_orders(heavy);
        MoleculeGraph neutral = with_hydrogens(heavy);
        charge_at_ph_7(neutral, notes);
        MoleculeGraph graph = with_hydrogens(neutral);
        add_hydrogen_places(graph);
        return {std::move(graph), "the positions of its atoms", std::move(notes), {}};
    }

    const LigandQuery& query_;
    MoleculeGraph found_;
};

}  // namespace

std::vector<std::filesystem::path> monomer_libraries() {
    std::vector<std::filesystem::path> libraries;
    if (const char* const own = std::getenv("CLIBD_MON")) libraries.emplace_back(own);
    libraries.emplace_back("/usr/share/refmac/monomers");
    return libraries;
}

FoundLigand find_ligand(const LigandQuery& query) { return Search(query).find(); }

}  // namespace palpa
