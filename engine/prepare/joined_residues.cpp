#include "prepare/joined_residues.h"

#include "molecule/components.h"
#include "prepare/residues.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

using CapAtom = std::pair<std::string_view, std::string_view>;

constexpr std::string_view joined_heading = "Residue names";

// Makes the atoms part of the residue that `of` is in.
void join_residue(Structure& structure, const ResidueRange& cap, std::size_t of) {
    for (std::size_t i = cap.first; i < cap.end(); ++i) {
        structure.names[i].segment = structure.names[of].segment;
        structure.names[i].residue = structure.names[of].residue;
        structure.names[i].number = structure.names[of].number;
        if (structure.records.empty()) continue;
        structure.records[i].residue_number = structure.records[of].residue_number;
        structure.records[i].insertion_code = structure.records[of].insertion_code;
        structure.records[i].chain = structure.records[of].chain;
    }
}

struct Cap {
    std::string_view residue;
    bool is_first;
    std::span<const CapAtom> atoms;  // heavy ones: as files name them, as CHARMM's patches do
};

constexpr auto acetyl = std::to_array<CapAtom>({{"CH3", "CAY"}, {"C", "CY"}, {"O", "OY"}});
constexpr auto methylamide = std::to_array<CapAtom>({{"N", "NT"}, {"CH3", "CAT"}, {"C", "CAT"}});
constexpr auto amide = std::to_array<CapAtom>({{"N", "NT"}});

constexpr std::array caps{Cap{"ACE", true, acetyl}, Cap{"NME", false, methylamide},
                          Cap{"NMA", false, methylamide}, Cap{"NH2", false, amide}};

class ComponentJoiner {
public:
    ComponentJoiner(const ForceField& force_field, Structure& structure, Report& report)
        : force_field_(force_field), structure_(structure), report_(report) {}

    void join(const StatedLinks& stated) {
        bool has_any = false;
        for (const AtomName& name : structure_.names) {
            has_any = has_any || std::any_of(joined_components().begin(), joined_components().end(),
                                             [&](const JoinedComponent& one) {
                                                 return one.ligand == name.residue;
                                             });
        }
        if (!has_any || structure_.records.empty()) return;
        std::map<std::size_t, std::size_t> host_of;  // by the ligand's atoms: an atom of the host
        for (const ResidueLink& link : find_residue_links(force_field_, structure_, stated)) {
            for (const auto& [a, b] : {std::pair(link.atoms[0], link.atoms[1]),
                                       std::pair(link.atoms[1], link.atoms[0])}) {
                join_component(a, b, host_of);
            }
        }
        move_behind(host_of);
    }

private:
    void join_component(std::size_t ligand, std::size_t host,
                        std::map<std::size_t, std::size_t>& host_of) {
        const AtomName& atom = structure_.names[ligand];
        const AtomName& other = structure_.names[host];
        for (const JoinedComponent& one : joined_components()) {
            const bool is_it = one.ligand == atom.residue && one.host == other.residue &&
                               one.host_atom == other.atom &&
                               force_field_.residues.contains(std::string(one.charmm));
            if (!is_it) continue;
            const ResidueRange part = residue_with(ligand), whole = residue_with(host);
            report_.add(joined_heading, fmt::format("{}: bonded to {}, together CHARMM's {}",
                                                    residue_label(structure_, part),
                                                    residue_label(structure_, whole), one.charmm));
            rename_residue(structure_, whole, one.charmm);
            join_residue(structure_, part, host);
            for (std::size_t i = part.first; i < part.end(); ++i) {
                structure_.records[i].label_chain = structure_.records[host].label_chain;
                host_of[i] = whole.end() - 1;
            }
            return;
        }
    }

    ResidueRange residue_with(std::size_t atom) const {
        for (const ResidueRange& residue : find_residues(structure_)) {
            if (atom >= residue.first && atom < residue.end()) return residue;
        }
        return {atom, 1};
    }

    // A residue's atoms stand together.
    void move_behind(const std::map<std::size_t, std::size_t>& host_of) {
        if (host_of.empty()) return;
        std::map<std::size_t, std::vector<std::size_t>> behind;
        for (const auto& [atom, host] : host_of) behind[host].push_back(atom);
        std::vector<std::size_t> order, end_of(structure_.names.size());
        for (std::size_t i = 0; i < structure_.names.size(); ++i) {
            if (!host_of.contains(i)) order.push_back(i);
            if (const auto found = behind.find(i); found != behind.end()) {
                order.insert(order.end(), found->second.begin(), found->second.end());
            }
            end_of[i] = order.size();
        }
        structure_ = with_order(structure_, order, end_of);
    }

    const ForceField& force_field_;
    Structure& structure_;
    Report& report_;
};

}  // namespace

void join_caps(Structure& structure, Report& report) {
    const std::vector<ResidueRange> residues = find_residues(structure);
    for (std::size_t i = 0; i < residues.size(); ++i) {
        const std::string& name = structure.names[residues[i].first].residue;
        const auto cap =
            std::find_if(caps.begin(), caps.end(), [&](const Cap& c) { return c.residue == name; });
        if (cap == caps.end()) continue;
        if (cap->is_first ? i + 1 == residues.size() : i == 0) continue;
        const ResidueRange& host = residues[cap->is_first ? i + 1 : i - 1];
        if (!find_atom(structure, host, "CA")) continue;
        const std::string label = residue_label(structure, residues[i]);
        for (std::size_t atom = residues[i].first; atom < residues[i].end(); ++atom) {
            std::string& own = structure.names[atom].atom;
            const auto charmm = std::ranges::find(cap->atoms, own, &CapAtom::first);
            if (charmm != cap->atoms.end()) own = charmm->second;
        }
        join_residue(structure, residues[i], host.first);
        report.add(joined_heading,
                   fmt::format("{}: a cap, now part of {}", label, residue_label(structure, host)));
    }
}

void join_components(const ForceField& force_field, const StatedLinks& stated, Structure& structure,
                     Report& report) {
    ComponentJoiner(force_field, structure, report).join(stated);
}

}  // namespace palpa
