#include "prepare/residue_links.h"

#include "molecule/components.h"
#include "molecule/element.h"
#include "molecule/point_grid.h"
#include "molecule/residue_kinds.h"
#include "prepare/match_by_bonds.h"
#include "prepare/residues.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>

namespace palpa {
namespace {

constexpr std::string_view links_heading = "Links";
constexpr double longest_stated = 3;      // Å
constexpr double link_slack = 0.25;       // Å, beyond the covalent radii
constexpr double longest_covalent = 2.4;  // Å, of what is looked for by distance

bool is_metal(std::string_view element) {
    constexpr auto others = std::to_array<std::string_view>(
        {"H", "B", "C", "N", "O", "F", "SI", "P", "S", "CL", "SE", "BR", "I", "D"});
    return std::find(others.begin(), others.end(), element) == others.end();
}

// A template with a bond to the next residue.
bool is_of_chain(const ForceField& force_field, std::string_view residue) {
    if (residue == "HIS") return true;
    const auto found = force_field.residues.find(std::string(residue));
    if (found == force_field.residues.end()) return false;
    return std::any_of(found->second.bonds.begin(), found->second.bonds.end(),
                       [](const auto& bond) { return bond[0][0] == '+' || bond[1][0] == '+'; });
}

class LinkFinder {
public:
    LinkFinder(const ForceField& force_field, const Structure& structure, const StatedLinks& stated)
        : structure_(structure), stated_(stated) {
        for (const ResidueRange& residue : find_residues(structure)) {
            const std::string& name = structure.names[residue.first].residue;
            const Kind kind = is_water(name)                   ? Kind::Water
                              : is_of_chain(force_field, name) ? Kind::Chain
                              : residue.count == 1             ? Kind::Single
                                                               : Kind::Molecule;
            kinds_.insert(kinds_.end(), residue.count, kind);
            firsts_.insert(firsts_.end(), residue.count, residue.first);
        }
    }

    std::vector<ResidueLink> find() {
        const PointGrid grid(structure_.positions);
        std::set<std::size_t> stated_lines;
        for (const auto& [a, b] : stated_) stated_lines.insert({a, b});
        for (std::size_t i = 0; i < structure_.names.size(); ++i) {
            const bool is_stated = stated_lines.contains(structure_.lines[i]);
            if (kinds_[i] != Kind::Molecule && !is_stated) continue;
            grid.visit_near(structure_.positions[i], is_stated ? longest_stated : longest_covalent,
                            [&](std::uint32_t other) { look_at(i, other); });
        }
        std::sort(links_.begin(), links_.end(),
                  [](const ResidueLink& a, const ResidueLink& b) { return a.atoms < b.atoms; });
        links_.erase(std::unique(links_.begin(), links_.end(),
                                 [](const ResidueLink& a, const ResidueLink& b) {
                                     return a.atoms == b.atoms;
                                 }),
                     links_.end());
        return std::move(links_);
    }

private:
    enum class Kind { Chain, Molecule, Single, Water };

    void look_at(std::size_t a, std::size_t b) {
        if (firsts_[a] == firsts_[b]) return;
        if (a > b) std::swap(a, b);
        const std::string one = element_of(structure_, a), other = element_of(structure_, b);
        if (one == "H" || other == "H") return;
        const auto lines = std::minmax(structure_.lines[a], structure_.lines[b]);
        const bool is_stated = stated_.contains({lines.first, lines.second});
        const double distance = (structure_.positions[a] - structure_.positions[b]).norm();
        if (!is_stated && !is_near(a, b, distance, covalent_radius(one) + covalent_radius(other))) {
            return;
        }
        if (is_chain_bond(a, b) || (one == "S" && other == "S")) return;
        links_.push_back({{a, b}, distance, is_stated});
    }

    bool is_near(std::size_t a, std::size_t b, double distance, double radii) const {
        const auto may_bond = [&](std::size_t i) {
            return kinds_[i] == Kind::Molecule || kinds_[i] == Kind::Chain;
        };
        const bool has_molecule = kinds_[a] == Kind::Molecule || kinds_[b] == Kind::Molecule;
        return has_molecule && may_bond(a) && may_bond(b) && distance < radii + link_slack;
    }

    bool is_chain_bond(std::size_t a, std::size_t b) const {
        if (kinds_[a] != Kind::Chain || kinds_[b] != Kind::Chain) return false;
        const auto names = std::minmax(structure_.names[a].atom, structure_.names[b].atom);
        const std::pair<std::string_view, std::string_view> pair(names.first, names.second);
        const bool is_peptide = pair == std::pair<std::string_view, std::string_view>("C", "N");
        return is_peptide || (pair.second == "P" && pair.first.starts_with("O3"));
    }

    const Structure& structure_;
    const StatedLinks& stated_;
    std::vector<Kind> kinds_;          // by atom
    std::vector<std::size_t> firsts_;  // first atom of its residue, by atom
    std::vector<ResidueLink> links_;
};

// One end of a link.
struct LinkEnd {
    std::size_t atom;
    std::string_view residue, name;
};

// The patch for a bond from one end to the other, in this direction.
std::optional<LinkPatch> find_patch(const LinkEnd& one, const LinkEnd& other) {
    const auto named = [&](std::string name) {
        return LinkPatch{std::move(name), {one.atom, other.atom}};
    };
    const std::string_view ring = find_ring_oxygens(other.residue);
    if (!ring.empty() && other.name == "C1") {
        const char anomer = ring[0] == 'a' ? 'A' : 'B';
        if (one.residue == "ASN" && one.name == "ND2") return named(fmt::format("NGL{}", anomer));
        if (one.residue == "SER" && one.name == "OG") return named(fmt::format("SGP{}", anomer));
        if (one.residue == "THR" && one.name == "OG1") return named(fmt::format("TGP{}", anomer));
        const std::string_view acceptor = find_ring_oxygens(one.residue);
        if (acceptor.empty() || one.name.size() != 2 || one.name[0] != 'O') return std::nullopt;
        if (one.name[1] == '6') return named(fmt::format("16{}T", anomer));
        if (one.name[1] < '1' || one.name[1] > '4') return std::nullopt;
        const auto place = static_cast<std::size_t>(one.name[1] - '1');
        const char there = acceptor[place] == 'a' ? 'A' : 'B';
        if (place == 0) return named(fmt::format("11{}{}", there, anomer));
        return named(fmt::format("1{}{}{}", one.name[1], anomer, there));
    }
    if (other.residue == "ANE5AC" && other.name == "C2") {
        if (one.name == "O3") return named("SA23AB");
        if (one.name == "O6") return named("SA26AT");
        if (one.name == "O8") return named("SA28AA");
        if (one.name == "O9") return named("SA29AT");
    }
    if (one.residue.starts_with("HS") || one.residue == "HIS") {
        if (one.name == "NE2" && other.residue == "HEME" && other.name == "FE") {
            return named("PHEM");
        }
    }
    return std::nullopt;
}

std::string atom_in_words(const Structure& structure, std::size_t atom) {
    const AtomName& name = structure.names[atom];
    const std::string& chain = chain_of(structure, atom);
    return fmt::format("{} {}{}{} {}", name.residue, chain, chain.empty() ? "" : " ", name.number,
                       name.atom);
}

}  // namespace

StatedLinks find_stated_links(const Structure& structure) {
    StatedLinks stated;
    if (structure.links.empty() || structure.records.empty()) return stated;
    using Key = std::tuple<std::string_view, std::string_view, std::string_view>;
    std::map<Key, std::size_t> atoms;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        const AtomName& name = structure.names[i];
        atoms.try_emplace({structure.records[i].chain, name.number, name.atom}, i);
    }
    for (const StructureLink& link : structure.links) {
        const auto a = atoms.find({link.a.chain, link.a.number, link.a.atom});
        const auto b = atoms.find({link.b.chain, link.b.number, link.b.atom});
        if (a == atoms.end() || b == atoms.end()) continue;
        const auto lines = std::minmax(structure.lines[a->second], structure.lines[b->second]);
        stated.insert({lines.first, lines.second});
    }
    return stated;
}

std::vector<ResidueLink> find_residue_links(const ForceField& force_field,
                                            const Structure& structure, const StatedLinks& stated) {
    return LinkFinder(force_field, structure, stated).find();
}

std::vector<LinkPatch> patch_links(const ForceField& force_field, const Structure& structure,
                                   const std::vector<ResidueLink>& links, Report& report) {
    std::vector<LinkPatch> patches;
    std::size_t contacts = 0;
    for (const ResidueLink& link : links) {
        const auto end = [&](std::size_t i) {
            const AtomName& name = structure.names[link.atoms[i]];
            return LinkEnd{link.atoms[i], name.residue, name.atom};
        };
        auto patch = find_patch(end(0), end(1));
        if (!patch) patch = find_patch(end(1), end(0));
        const std::string words =
            fmt::format("{} and {}, {:.2f} Å apart", atom_in_words(structure, link.atoms[0]),
                        atom_in_words(structure, link.atoms[1]), link.distance);
        const std::string_view why = link.is_stated ? "as the file says" : "by distance";
        if (patch && force_field.patches.contains(patch->patch)) {
            report.add(links_heading,
                       fmt::format("{}: bonded {}, patch {}", words, why, patch->patch));
            patches.push_back(std::move(*patch));
        } else if (is_metal(element_of(structure, link.atoms[0])) ||
                   is_metal(element_of(structure, link.atoms[1]))) {
            ++contacts;
        } else {
            report.warn(
                fmt::format("{}: bonded {}, but the force field has no patch for this bond{}; "
                            "without it they repel each other (leave one out with --without)",
                            words, why, patch ? " " + patch->patch : ""));
        }
    }
    if (contacts > 0) {
        report.add(links_heading, fmt::format("{} contact{} of metal ions in the file: no bonds "
                                              "made, charges hold the ions in place",
                                              contacts, contacts == 1 ? "" : "s"));
    }
    return patches;
}

}  // namespace palpa
