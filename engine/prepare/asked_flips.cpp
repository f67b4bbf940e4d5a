#include "prepare/asked_flips.h"

#include "prepare/residues.h"
#include "prepare/turned_sites.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <string>

namespace palpa {
namespace {

constexpr std::array<std::string_view, 6> turning{"ASN", "GLN", "HIS", "HSD", "HSE", "HSP"};

const ResidueRange* find_chosen(const Structure& structure, std::span<const ResidueRange> residues,
                                const ResidueChoice& choice) {
    const auto found = std::ranges::find_if(residues, [&](const ResidueRange& residue) {
        return chain_of(structure, residue.first) == choice.chain &&
               structure.names[residue.first].number == choice.number;
    });
    return found == residues.end() ? nullptr : &*found;
}

// Why a residue cannot be turned; empty: it can.
std::string find_obstacle(const Structure& structure, const ResidueRange& residue,
                          std::span<const ResidueLink> bonds) {
    const std::string label = residue_label(structure, residue);
    const std::string& name = structure.names[residue.first].residue;
    if (std::ranges::find(turning, name) == turning.end()) {
        return fmt::format("{} cannot be flipped; expected an ASN, GLN or HIS", label);
    }
    const TurnedAtoms turned = turned_atoms_of(name);
    std::vector<std::string_view> needed(turned.axis.begin(), turned.axis.end());
    needed.insert(needed.end(), turned.atoms.begin(), turned.atoms.end());
    for (const std::string_view atom : needed) {
        if (!find_atom(structure, residue, atom)) {
            return fmt::format("{} cannot be flipped: the file has no atom {} of it", label, atom);
        }
    }
    const auto is_turned = [&](std::size_t atom) {
        return atom >= residue.first && atom < residue.end() &&
               std::ranges::find(turned.atoms, structure.names[atom].atom) != turned.atoms.end();
    };
    for (const ResidueLink& bond : bonds) {
        if (std::ranges::any_of(bond.atoms, is_turned)) {
            return fmt::format("{} cannot be flipped because of the bond between {} and {}", label,
                               to_string(structure.names[bond.atoms[0]]),
                               to_string(structure.names[bond.atoms[1]]));
        }
    }
    return {};
}

}  // namespace

std::vector<std::size_t> turn_as_asked(std::span<const ResidueChoice> flips,
                                       std::span<const ResidueLink> bonds, Structure& structure,
                                       Report& report, Missing& missing) {
    const std::vector<ResidueRange> residues = find_residues(structure);
    std::vector<std::size_t> turned;
    for (const ResidueChoice& choice : flips) {
        const ResidueRange* const residue = find_chosen(structure, residues, choice);
        const std::string obstacle =
            residue ? find_obstacle(structure, *residue, bonds)
                    : fmt::format("no residue {}:{} here", choice.chain, choice.number);
        if (!obstacle.empty()) {
            missing.add({structure.file}, fmt::format("--flip: {}", obstacle));
            continue;
        }
        if (std::ranges::find(turned, residue->first) != turned.end()) continue;
        flip(structure, *residue);
        turned.push_back(residue->first);
        report.add(turned_heading,
                   fmt::format("{}: flipped, as requested", residue_label(structure, *residue)));
    }
    std::ranges::sort(turned);
    return turned;
}

}  // namespace palpa
