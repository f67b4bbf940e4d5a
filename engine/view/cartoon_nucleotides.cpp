#include "view/cartoon_nucleotides.h"

#include "view/build_frame.h"
#include "view/residue_structure.h"
#include "view/ribbon_path.h"
#include "view/sweep.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {
namespace {

// Å
constexpr float strip_half_width = 0.95F, strip_half_thickness = 0.3F;
constexpr float rung_radius = 0.25F, plate_half_thickness = 0.3F;
constexpr float plate_margin = 0.3F;        // beyond the atoms' centres
constexpr double longest_ester_bond = 2.5;  // from O3' to the next P

struct Nucleotide {
    std::size_t residue;
    std::size_t start;           // P, or C5' where there is none
    std::size_t sugar_to_base;   // C1'
    std::size_t sugar_to_next;   // C3'
    std::optional<Vec3> bridge;  // O3'
    bool has_phosphate;
};

// "C1'", in old files "C1*".
std::size_t find_sugar_atom(const AtomTable& atoms, const ResidueSpan& residue, std::string name) {
    const std::size_t found = find_atom(atoms, residue, name);
    if (found != residue.end) return found;
    name.back() = '*';
    return find_atom(atoms, residue, name);
}

std::optional<Nucleotide> find_nucleotide(const AtomTable& atoms,
                                          std::span<const ResidueSpan> residues, std::size_t i) {
    const ResidueSpan& residue = residues[i];
    if (residue.alpha != residue.end) return std::nullopt;
    const std::size_t c1 = find_sugar_atom(atoms, residue, "C1'");
    if (c1 == residue.end) return std::nullopt;
    const std::size_t c3 = find_sugar_atom(atoms, residue, "C3'"),
                      o3 = find_sugar_atom(atoms, residue, "O3'"),
                      phosphorus = find_atom(atoms, residue, "P");
    const bool has_phosphate = phosphorus != residue.end;
    const std::size_t start = has_phosphate ? phosphorus : find_sugar_atom(atoms, residue, "C5'");
    if (c3 == residue.end || start == residue.end) return std::nullopt;
    std::optional<Vec3> bridge;
    if (o3 != residue.end) bridge = atoms.positions[o3];
    return Nucleotide{i, start, c1, c3, bridge, has_phosphate};
}

std::vector<glm::vec3> widened(std::vector<glm::vec3> ring) {
    glm::vec3 centre{0};
    for (const glm::vec3& place : ring) centre += place / static_cast<float>(ring.size());
    for (glm::vec3& place : ring) place += plate_margin * unit_or(place - centre, glm::vec3(0));
    return ring;
}

bool is_bonded(const AtomTable& atoms, const Nucleotide& a, const Nucleotide& b) {
    return a.bridge && b.has_phosphate &&
           atoms.names[a.start].segment == atoms.names[b.start].segment &&
           (*a.bridge - atoms.positions[b.start]).norm() < longest_ester_bond;
}

// One chain of bonded nucleotides.
class Strip {
public:
    Strip(const AtomTable& atoms, std::span<const Nucleotide> chain,
          std::span<const glm::vec3> colours, const CartoonDetail& detail)
        : atoms_(atoms), chain_(chain), colours_(colours), detail_(detail), path_(guides()) {
        path_.turn(asides());
    }

    void add_backbone(MeshShape& mesh) const {
        const int pieces = static_cast<int>(chain_.size()) * detail_.pieces;
        std::vector<Ring> rings;
        for (int i = 0; i <= pieces; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(detail_.pieces);
            const Look look = look_of(std::min(static_cast<std::size_t>(u), chain_.size() - 1));
            rings.push_back(
                {path_.frame(u), strip_half_width, strip_half_thickness, look.colour, look.pick});
        }
        add_sweep(rings, CrossSection::Oval, detail_.sides, mesh);
    }

    // Its rings as plates, and a rung from the backbone. Returns how many plates.
    std::size_t add_base(std::size_t i, const ResidueSpan& residue, MeshShape& mesh) const {
        const std::vector<glm::vec3> six = find_ring(residue, {"N1", "C2", "N3", "C4", "C5", "C6"});
        const std::vector<glm::vec3> five = find_ring(residue, {"N9", "C8", "N7", "C5", "C4"});
        if (six.empty()) return 0;
        const Look look = look_of(i);
        std::size_t plates = 0;
        for (const std::vector<glm::vec3>& ring : {six, five})
            plates += add_plate(widened(ring), plate_half_thickness, look, mesh) ? 1 : 0;
        add_rung(i, five.empty() ? six[0] : five[0], look, mesh);
        return plates;
    }

private:
    glm::vec3 at(std::size_t atom) const { return as_float(atoms_.positions[atom]); }

    Look look_of(std::size_t i) const {
        const std::size_t atom = chain_[i].sugar_to_next;
        return {colours_[atom], static_cast<std::uint32_t>(atom)};
    }

    // Places between the ends a little towards the mean of their neighbours, as those of coil are.
    std::vector<glm::vec3> guides() const {
        std::vector<glm::vec3> places;
        for (const Nucleotide& each : chain_) places.push_back(at(each.start));
        places.push_back(at(chain_.back().sugar_to_next));
        const std::vector<glm::vec3> atoms = places;
        for (std::size_t i = 1; i + 1 < places.size(); ++i)
            places[i] = (atoms[i - 1] + 6.0F * atoms[i] + atoms[i + 1]) / 8.0F;
        return places;
    }

    // The strip's broad sides face the bases and away from them.
    std::vector<glm::vec3> asides() const {
        std::vector<glm::vec3> result;
        for (std::size_t i = 0; i <= chain_.size(); ++i) {
            const glm::vec3 before = at(chain_[i == 0 ? 0 : i - 1].sugar_to_base);
            const glm::vec3 behind = at(chain_[std::min(i, chain_.size() - 1)].sugar_to_base);
            const auto u = static_cast<float>(i);
            const glm::vec3 inward = (before + behind) / 2.0F - path_.place(u);
            result.push_back(unit_or(glm::cross(inward, path_.along(u)), glm::vec3(0)));
        }
        return result;
    }

    // The places of atoms, or none where one is missing.
    std::vector<glm::vec3> find_ring(const ResidueSpan& residue,
                                     std::initializer_list<std::string_view> names) const {
        std::vector<glm::vec3> places;
        for (const std::string_view name : names) {
            const std::size_t atom = find_atom(atoms_, residue, name);
            if (atom == residue.end) return {};
            places.push_back(at(atom));
        }
        return places;
    }

    // From the backbone to the atom of the base that is bonded to the sugar.
    void add_rung(std::size_t i, const glm::vec3& base, const Look& look, MeshShape& mesh) const {
        RibbonPath rung({path_.place(static_cast<float>(i) + 0.5F), base});
        rung.turn(std::array{glm::vec3(0), glm::vec3(0)});
        std::vector<Ring> rings;
        for (const float u : {0.0F, 1.0F})
            rings.push_back({rung.frame(u), rung_radius, rung_radius, look.colour, look.pick});
        add_sweep(rings, CrossSection::Oval, detail_.sides, mesh);
    }

    const AtomTable& atoms_;
    std::span<const Nucleotide> chain_;
    std::span<const glm::vec3> colours_;
    CartoonDetail detail_;
    RibbonPath path_;
};

}  // namespace

void add_nucleic_acids(const AtomTable& atoms, std::span<const ResidueSpan> residues,
                       std::span<const glm::vec3> colours, const CartoonDetail& detail,
                       MeshShape& mesh, CartoonParts& parts) {
    std::vector<Nucleotide> chain;
    const auto finish = [&] {
        if (chain.size() > 1) {
            const Strip strip(atoms, chain, colours, detail);
            strip.add_backbone(mesh);
            for (std::size_t i = 0; i < chain.size(); ++i) {
                parts.base_plates += strip.add_base(i, residues[chain[i].residue], mesh);
                parts.shown[chain[i].residue] = true;
            }
        }
        chain.clear();
    };
    for (std::size_t i = 0; i < residues.size(); ++i) {
        const std::optional<Nucleotide> found = find_nucleotide(atoms, residues, i);
        if (!chain.empty() && !(found && is_bonded(atoms, chain.back(), *found))) finish();
        if (found) chain.push_back(*found);
    }
    finish();
}

}  // namespace palpa
