#include "charmm/generate.h"

#include "charmm/missing.h"
#include "charmm/residue_checks.h"
#include "charmm/residue_instances.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>

namespace palpa {
namespace {

class Generator {
public:
    Generator(const ForceField& force_field, const Structure& structure,
              const GenerateSettings& settings)
        : force_field_(force_field), structure_(structure), settings_(settings) {}

    Connectivity generate() {
        Missing missing;
        residues_ = build_residue_instances(force_field_, structure_, settings_, missing);
        check_residues(force_field_, structure_, residues_, false, missing);
        missing.throw_if_any();
        add_atoms();
        add_terms();
        generate_angles();
        generate_dihedrals();
        return std::move(result_);
    }

private:
    void add_atoms() {
        const std::size_t count = structure_.names.size();
        result_.file = structure_.file;
        result_.names = structure_.names;
        result_.lines = structure_.lines;
        result_.type.resize(count);
        result_.charge.resize(count);
        result_.mass.resize(count);
        residue_of_.resize(count);
        for (std::size_t i = 0; i < residues_.instances.size(); ++i) {
            const ResidueInstance& instance = residues_.instances[i];
            for (const auto& [name, numbers] : instance.wanted) {
                const auto type = find_type(force_field_, numbers->type);
                const std::uint32_t atom = instance.present.find(name)->second;
                result_.type[atom] = type->first;
                result_.charge[atom] = numbers->charge;
                result_.mass[atom] = type->second.mass;
                residue_of_[atom] = i;
            }
        }
    }

    // The tuples of a template whose atoms are all there.
    template <std::size_t Size>
    std::vector<std::array<std::uint32_t, Size>> find_tuples(
        const TemplateUse& use, const std::vector<std::array<std::string, Size>>& names) const {
        std::vector<std::array<std::uint32_t, Size>> tuples;
        for (const auto& tuple : names) {
            if (const auto atoms = find_atoms(residues_, use, tuple)) tuples.push_back(*atoms);
        }
        return tuples;
    }

    template <std::size_t Size>
    static std::array<std::uint32_t, Size> lower_way(std::array<std::uint32_t, Size> atoms) {
        if (atoms.back() < atoms.front()) std::reverse(atoms.begin(), atoms.end());
        return atoms;
    }

    // Takes `deleted` in either direction from `terms`.
    template <std::size_t Size>
    static void erase_term(std::vector<std::array<std::uint32_t, Size>>& terms,
                           const std::array<std::uint32_t, Size>& deleted) {
        std::erase_if(terms,
                      [&](const auto& term) { return lower_way(term) == lower_way(deleted); });
    }

    // Before the patch's own terms, which may put others in place of them.
    void delete_terms(const TemplateUse& use, std::set<std::array<std::uint32_t, 2>>& bonded) {
        for (const auto& bond : find_tuples(use, use.residue->deleted_bonds)) {
            if (bonded.erase(lower_way(bond)) > 0) erase_term(result_.bonds, bond);
        }
        for (const auto& angle : find_tuples(use, use.residue->deleted_angles)) {
            deleted_angles_.insert(lower_way(angle));
            if (angles_.erase(lower_way(angle)) > 0) erase_term(result_.angles, angle);
        }
        for (const auto& dihedral : find_tuples(use, use.residue->deleted_dihedrals)) {
            deleted_dihedrals_.insert(lower_way(dihedral));
            if (dihedrals_.erase(lower_way(dihedral)) > 0) erase_term(result_.dihedrals, dihedral);
        }
        for (const auto& improper : find_tuples(use, use.residue->deleted_impropers)) {
            erase_term(result_.impropers, improper);
        }
        for (const auto& cmap : find_tuples(use, use.residue->deleted_cmaps)) {
            std::erase(result_.cmaps, cmap);
        }
    }

    void add_terms() {
        std::set<std::array<std::uint32_t, 2>> bonded;
        for (const TemplateUse& use : residues_.uses) {
            delete_terms(use, bonded);
            const bool has_own_terms =
                !use.residue->deleted_angles.empty() || !use.residue->deleted_dihedrals.empty();
            for (const auto& bond : find_tuples(use, use.residue->bonds)) {
                if (has_own_terms) ungenerated_.insert(lower_way(bond));
                if (bonded.insert(lower_way(bond)).second) result_.bonds.push_back(bond);
            }
            for (const auto& angle : find_tuples(use, use.residue->angles)) {
                deleted_angles_.erase(lower_way(angle));
                if (angles_.insert(lower_way(angle)).second) result_.angles.push_back(angle);
            }
            for (const auto& dihedral : find_tuples(use, use.residue->dihedrals)) {
                deleted_dihedrals_.erase(lower_way(dihedral));
                if (dihedrals_.insert(lower_way(dihedral)).second) {
                    result_.dihedrals.push_back(dihedral);
                }
            }
            for (const auto& improper : find_tuples(use, use.residue->impropers)) {
                result_.impropers.push_back(improper);
            }
            for (const auto& cmap : find_tuples(use, use.residue->cmaps)) {
                result_.cmaps.push_back(cmap);
            }
        }
        bonded_.resize(result_.names.size());
        for (const auto& [a, b] : result_.bonds) {
            bonded_[a].push_back(b);
            bonded_[b].push_back(a);
        }
        for (std::vector<std::uint32_t>& atoms : bonded_) std::sort(atoms.begin(), atoms.end());
    }

    bool has_generated_angles(std::uint32_t atom) const {
        const ResidueInstance& instance = residues_.instances[residue_of_[atom]];
        return instance.has_generated_terms && instance.residue->has_generated_angles;
    }

    bool has_generated_dihedrals(std::uint32_t atom) const {
        const ResidueInstance& instance = residues_.instances[residue_of_[atom]];
        return instance.has_generated_terms && instance.residue->has_generated_dihedrals;
    }

    // Whether one of the bonds along these atoms has its own terms.
    template <std::size_t Size>
    bool is_ungenerated(const std::array<std::uint32_t, Size>& atoms) const {
        if (ungenerated_.empty()) return false;
        for (std::size_t i = 1; i < Size; ++i) {
            if (ungenerated_.contains(lower_way(std::array{atoms[i - 1], atoms[i]}))) return true;
        }
        return false;
    }

    // All pairs of bonds of an atom.
    void generate_angles() {
        if (!force_field_.generates_angles) return;
        for (std::uint32_t b = 0; b < bonded_.size(); ++b) {
            if (!has_generated_angles(b)) continue;
            for (std::size_t i = 0; i < bonded_[b].size(); ++i) {
                for (std::size_t j = i + 1; j < bonded_[b].size(); ++j) {
                    const std::array angle{bonded_[b][i], b, bonded_[b][j]};
                    if (angles_.contains(angle) || deleted_angles_.contains(angle)) continue;
                    if (is_ungenerated(angle)) continue;
                    result_.angles.push_back(angle);
                }
            }
        }
    }

    // All chains of three bonds; in a ring of three, whose ends would be one atom, there are none.
    void generate_dihedrals() {
        if (!force_field_.generates_dihedrals) return;
        for (std::uint32_t b = 0; b < bonded_.size(); ++b) {
            if (!has_generated_dihedrals(b)) continue;
            for (const std::uint32_t c : bonded_[b]) {
                if (c < b || !has_generated_dihedrals(c)) continue;
                for (const std::uint32_t a : bonded_[b]) {
                    for (const std::uint32_t d : bonded_[c]) {
                        if (a == c || d == b || a == d) continue;
                        const std::array dihedral{a, b, c, d};
                        const auto key = lower_way(dihedral);
                        if (dihedrals_.contains(key) || deleted_dihedrals_.contains(key)) continue;
                        if (is_ungenerated(dihedral)) continue;
                        result_.dihedrals.push_back(dihedral);
                    }
                }
            }
        }
    }

    const ForceField& force_field_;
    const Structure& structure_;
    const GenerateSettings& settings_;
    ResidueInstances residues_;
    std::vector<std::size_t> residue_of_;               // instance of each atom
    std::vector<std::vector<std::uint32_t>> bonded_;    // to each atom
    std::set<std::array<std::uint32_t, 3>> angles_;     // given by residues
    std::set<std::array<std::uint32_t, 4>> dihedrals_;  // likewise
    // Those that patches take away from what is generated.
    std::set<std::array<std::uint32_t, 3>> deleted_angles_;
    std::set<std::array<std::uint32_t, 4>> deleted_dihedrals_;
    std::set<std::array<std::uint32_t, 2>> ungenerated_;  // bonds of such patches
    Connectivity result_;
};

}  // namespace

Connectivity build_connectivity(const ForceField& force_field, const Structure& structure,
                                const GenerateSettings& settings) {
    return Generator(force_field, structure, settings).generate();
}

}  // namespace palpa
