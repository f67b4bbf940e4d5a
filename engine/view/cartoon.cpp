#include "view/cartoon.h"

#include "view/build_frame.h"
#include "view/cartoon_nucleotides.h"
#include "view/residue_structure.h"
#include "view/ribbon_path.h"
#include "view/sweep.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

namespace palpa {
namespace {

// Half of what is seen, Å.
constexpr float coil_radius = 0.28F;
constexpr float helix_half_width = 1.25F, helix_half_thickness = 0.25F;
constexpr float strand_half_width = 1.0F, strand_half_thickness = 0.25F;
constexpr float head_half_width = 1.7F;
constexpr float arrowhead_length = 1.5F;  // in residues
constexpr double longest_alpha_step = 4.5;

enum class Kind { Coil, Helix, Strand };

Kind kind_of(SecondaryStructure structure) {
    switch (structure) {
        case SecondaryStructure::AlphaHelix:
        case SecondaryStructure::ThreeTenHelix:
        case SecondaryStructure::PiHelix:
            return Kind::Helix;
        case SecondaryStructure::Strand:
            return Kind::Strand;
        case SecondaryStructure::Coil:
        case SecondaryStructure::Bridge:
            break;
    }
    return Kind::Coil;
}

// Residues of one kind behind each other, of a chain.
struct Run {
    Kind kind;
    std::size_t first, end;

    std::size_t size() const { return end - first; }
};

// Those too short for their kind are coil.
std::vector<Run> find_runs(std::span<const Kind> kinds) {
    std::vector<Run> runs;
    for (std::size_t first = 0, end = 0; first < kinds.size(); first = end) {
        while (end < kinds.size() && kinds[end] == kinds[first]) ++end;
        Run run{kinds[first], first, end};
        const std::size_t least = run.kind == Kind::Helix ? 3 : 2;
        if (run.size() < least) run.kind = Kind::Coil;
        runs.push_back(run);
    }
    return runs;
}

// One chain without a gap.
struct Chain {
    std::vector<std::size_t> alphas,
        oxygens;  // atoms; as many oxygens, SIZE_MAX where there is none
    std::vector<Kind> kinds;
};

class Ribbon {
public:
    Ribbon(const AtomTable& atoms, const Chain& chain, std::span<const glm::vec3> colours,
           const CartoonDetail& detail)
        : atoms_(atoms),
          chain_(chain),
          colours_(colours),
          detail_(detail),
          runs_(find_runs(chain.kinds)),
          path_(guides()) {
        path_.turn(asides());
    }

    void add(MeshShape& mesh, CartoonParts& parts) const {
        float done = 0;
        for (const Run& run : runs_) {
            parts.helices += run.kind == Kind::Helix ? 1 : 0;
            if (run.kind != Kind::Strand) continue;
            const Reach reach = reach_of(run);
            add_rounded({done, reach.start}, mesh);
            done = reach.end;
            add_strand(run, mesh);
            ++parts.strands;
            ++parts.arrowheads;
        }
        add_rounded({done, path_.end()}, mesh);
    }

private:
    glm::vec3 alpha(std::size_t i) const { return as_float(atoms_.positions[chain_.alphas[i]]); }

    // Of the path's parameter.
    struct Reach {
        float start, end;
    };

    // Half way to the residues beside it.
    Reach reach_of(const Run& run) const {
        const std::size_t last = chain_.alphas.size() - 1;
        return {std::max(0.0F, static_cast<float>(run.first) - 0.5F),
                std::min(static_cast<float>(last), static_cast<float>(run.end) - 0.5F)};
    }

    // Atoms CA; of strands their means with the neighbours', so that these have no pleats, of coil
    // a little of that, so that it has no corners.
    std::vector<glm::vec3> guides() const {
        std::vector<glm::vec3> places(chain_.alphas.size());
        for (std::size_t i = 0; i < places.size(); ++i) places[i] = alpha(i);
        const std::vector<glm::vec3> alphas = places;
        for (const Run& run : runs_) {
            if (run.kind == Kind::Helix) continue;
            smooth(alphas, run.first, run.end, run.kind == Kind::Strand ? 2.0F : 6.0F, places);
        }
        if (runs_.front().kind == Kind::Strand) places.front() = unpleated(alphas, 0, 1, 2);
        const std::size_t last = places.size() - 1;
        if (runs_.back().kind == Kind::Strand)
            places.back() = unpleated(alphas, last, last - 1, last - 2);
        // Once more within strands: the ends stay, so that they do not shrink.
        const std::vector<glm::vec3> once = places;
        for (const Run& run : runs_)
            if (run.kind == Kind::Strand) smooth(once, run.first + 1, run.end - 1, 2, places);
        return places;
    }

    // Of a chain's end: as far to its side as the mean of the next one is to the other.
    static glm::vec3 unpleated(std::span<const glm::vec3> alphas, std::size_t end, std::size_t next,
                               std::size_t third) {
        if (alphas.size() < 3) return alphas[end];
        return alphas[end] - (alphas[end] - 2.0F * alphas[next] + alphas[third]) / 4.0F;
    }

    // The mean of a place and its neighbours, itself counted `own` times; but of the chain's ends.
    static void smooth(std::span<const glm::vec3> from, std::size_t first, std::size_t end,
                       float own, std::span<glm::vec3> to) {
        for (std::size_t i = std::max<std::size_t>(first, 1); i < std::min(end, from.size() - 1);
             ++i)
            to[i] = (from[i - 1] + own * from[i] + from[i + 1]) / (2 + own);
    }

    // Where it is known how the ribbon lies: in helices and strands.
    std::vector<glm::vec3> asides() const {
        std::vector<glm::vec3> result(path_.size(), glm::vec3(0));
        for (const Run& run : runs_) {
            if (run.kind == Kind::Helix) turn_helix(run, result);
            if (run.kind == Kind::Strand) turn_strand(run, result);
        }
        return result;
    }

    // At right angles to the path and to where it bends: along the helix.
    glm::vec3 across_bend(std::size_t i) const {
        if (i == 0 || i + 1 >= path_.size()) return glm::vec3(0);
        const glm::vec3 bend = alpha(i - 1) - 2.0F * alpha(i) + alpha(i + 1);
        return unit_or(glm::cross(alpha(i + 1) - alpha(i - 1), bend), glm::vec3(0));
    }

    void turn_helix(const Run& helix, std::span<glm::vec3> result) const {
        for (std::size_t i = helix.first + 1; i + 1 < helix.end; ++i) result[i] = across_bend(i);
        result[helix.first] = result[helix.first + 1];
        result[helix.end - 1] = result[helix.end - 2];
    }

    // In the plane of a peptide bond, at right angles to the way from CA to CA: as C=O points.
    glm::vec3 across_peptide(std::size_t i) const {
        if (i + 1 >= path_.size()) return glm::vec3(0);
        if (chain_.oxygens[i] == SIZE_MAX) return across_bend(i);
        const glm::vec3 along = unit_or(alpha(i + 1) - alpha(i), glm::vec3(0));
        const glm::vec3 oxygen = as_float(atoms_.positions[chain_.oxygens[i]]) - alpha(i);
        return unit_or(oxygen - glm::dot(oxygen, along) * along, glm::vec3(0));
    }

    // C=O points to either side in turn. A residue lies as the mean of the bonds before and behind
    // it, and its neighbours.
    void turn_strand(const Run& strand, std::span<glm::vec3> result) const {
        const std::size_t first = strand.first == 0 ? 0 : strand.first - 1;
        std::vector<glm::vec3> bonds;  // from `first` on
        for (std::size_t i = first; i < strand.end; ++i) {
            glm::vec3 across = across_peptide(i);
            if (across == glm::vec3(0) && !bonds.empty()) across = bonds.back();
            if (!bonds.empty() && glm::dot(across, bonds.back()) < 0) across = -across;
            bonds.push_back(across);
        }
        const auto bond = [&](std::ptrdiff_t i) {
            const auto last = static_cast<std::ptrdiff_t>(bonds.size()) - 1;
            return bonds[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, last))];
        };
        for (std::size_t i = strand.first; i < strand.end; ++i) {
            const auto k = static_cast<std::ptrdiff_t>(i - first);
            result[i] = unit_or(bond(k - 2) + 3.0F * bond(k - 1) + 3.0F * bond(k) + bond(k + 1),
                                glm::vec3(0));
        }
    }

    // As the nearest residue of a body looks, also where it meets another body.
    Ring ring_at(float u, const Reach& body, float half_width, float half_thickness) const {
        const float nearest =
            std::clamp(std::round(u), std::ceil(body.start), std::floor(body.end));
        const std::size_t atom = chain_.alphas[static_cast<std::size_t>(nearest)];
        return {path_.frame(u), half_width, half_thickness, colours_[atom],
                static_cast<std::uint32_t>(atom)};
    }

    // Calls with parameters from its start to its end, about as far apart as the detail says, and
    // with their share of the way.
    template <class Visit>
    void each_step(const Reach& part, Visit visit) const {
        const auto& [start, end] = part;
        const int steps = std::max(
            1, static_cast<int>(std::lround((end - start) * static_cast<float>(detail_.pieces))));
        for (int i = 0; i <= steps; ++i) {
            const float share = static_cast<float>(i) / static_cast<float>(steps);
            visit(glm::mix(start, end, share), share);
        }
    }

    // How much of a helix there is at a place: it widens within a residue, but at the chain's ends.
    float share_of_helix(const Run& helix, float u) const {
        const auto& [start, end] = reach_of(helix);
        float share = helix.first == 0 ? 1 : glm::smoothstep(0.0F, 1.0F, u - start);
        if (helix.end < chain_.alphas.size()) share *= glm::smoothstep(0.0F, 1.0F, end - u);
        return share;
    }

    // Tubes and helices: one body between two strands.
    void add_rounded(const Reach& body, MeshShape& mesh) const {
        if (!(body.end > body.start)) return;
        std::vector<Ring> rings;
        auto run = runs_.begin();
        each_step(body, [&](float u, float) {
            while (run + 1 != runs_.end() && reach_of(*run).end < u) ++run;
            const float share = run->kind == Kind::Helix ? share_of_helix(*run, u) : 0;
            rings.push_back(ring_at(u, body, glm::mix(coil_radius, helix_half_width, share),
                                    glm::mix(coil_radius, helix_half_thickness, share)));
        });
        add_sweep(rings, CrossSection::Oval, detail_.sides, mesh);
    }

    // A shaft and a head, each a body.
    void add_strand(const Run& strand, MeshShape& mesh) const {
        const Reach body = reach_of(strand);
        const float neck = body.end - std::min(arrowhead_length, 0.6F * (body.end - body.start));
        std::vector<Ring> shaft, head;
        each_step({body.start, neck}, [&](float u, float) {
            shaft.push_back(ring_at(u, body, strand_half_width, strand_half_thickness));
        });
        each_step({neck, body.end}, [&](float u, float share) {
            head.push_back(ring_at(u, body, glm::mix(head_half_width, coil_radius, share),
                                   strand_half_thickness));
        });
        add_sweep(shaft, CrossSection::Box, 4, mesh);
        add_sweep(head, CrossSection::Box, 4, mesh);
    }

    const AtomTable& atoms_;
    const Chain& chain_;
    std::span<const glm::vec3> colours_;
    CartoonDetail detail_;
    std::vector<Run> runs_;
    RibbonPath path_;
};

std::size_t find_oxygen(const AtomTable& atoms, const ResidueSpan& residue) {
    std::size_t oxygen = find_atom(atoms, residue, "O");
    if (oxygen == residue.end) oxygen = find_atom(atoms, residue, "OT1");
    return oxygen == residue.end ? SIZE_MAX : oxygen;
}

bool is_next(const AtomTable& atoms, const ResidueSpan& a, const ResidueSpan& b) {
    return atoms.names[a.alpha].segment == atoms.names[b.alpha].segment &&
           (atoms.positions[a.alpha] - atoms.positions[b.alpha]).norm() < longest_alpha_step;
}

void add_proteins(const AtomTable& atoms, std::span<const ResidueSpan> residues,
                  std::span<const SecondaryStructure> structure, std::span<const glm::vec3> colours,
                  const CartoonDetail& detail, MeshShape& mesh, CartoonParts& parts) {
    for (std::size_t first = 0, end = 0; first < residues.size(); first = end) {
        end = first + 1;
        if (residues[first].alpha == residues[first].end) continue;
        while (end < residues.size() && residues[end].alpha != residues[end].end &&
               is_next(atoms, residues[end - 1], residues[end]))
            ++end;
        if (end - first < 2) continue;
        Chain chain;
        for (std::size_t i = first; i < end; ++i) {
            chain.alphas.push_back(residues[i].alpha);
            chain.oxygens.push_back(find_oxygen(atoms, residues[i]));
            chain.kinds.push_back(kind_of(structure[i]));
            parts.shown[i] = true;
        }
        Ribbon(atoms, chain, colours, detail).add(mesh, parts);
    }
}

}  // namespace

CartoonDetail cartoon_detail(std::size_t residues) noexcept {
    if (residues <= 1000) return {8, 12};
    if (residues <= 4000) return {6, 10};
    return {3, 6};
}

CartoonParts add_cartoon(const AtomTable& atoms, std::span<const ResidueSpan> residues,
                         std::span<const SecondaryStructure> structure,
                         std::span<const glm::vec3> colours, const CartoonDetail& detail,
                         FrameScene& frame) {
    const CartoonDetail fine{std::max(detail.pieces, 2), std::max(detail.sides, 4)};
    CartoonParts parts;
    parts.shown.assign(residues.size(), false);
    MeshShape mesh;
    mesh.is_closed = true;  // every body of it is
    // About as many as there will be: growing would cost as much as the rest.
    const auto chain_residues = static_cast<std::size_t>(std::ranges::count_if(
        residues, [](const ResidueSpan& residue) { return residue.alpha != residue.end; }));
    const std::size_t rings = chain_residues * static_cast<std::size_t>(fine.pieces);
    mesh.vertices.reserve(rings * static_cast<std::size_t>(fine.sides) * 9 / 8);
    mesh.indices.reserve(rings * static_cast<std::size_t>(fine.sides) * 6);
    add_proteins(atoms, residues, structure, colours, fine, mesh, parts);
    add_nucleic_acids(atoms, residues, colours, fine, mesh, parts);
    if (!mesh.vertices.empty()) frame.meshes.push_back(std::move(mesh));
    return parts;
}

CartoonParts add_cartoon(const World& world, std::span<const ResidueSpan> residues,
                         std::span<const SecondaryStructure> structure,
                         std::span<const glm::vec3> colours, FrameScene& frame) {
    return add_cartoon(world.resource<AtomTable>(), residues, structure, colours,
                       cartoon_detail(residues.size()), frame);
}

}  // namespace palpa
