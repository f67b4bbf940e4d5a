// Whether two force fields say the same to the last bit, whatever their files and places.
#pragma once
#include "charmm/force_field.h"

#include <fmt/format.h>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <utility>

namespace palpa::test {

// A line for each entry, with all names, and numbers as their bits.
class ForceFieldLines {
public:
    static std::string of(const ForceField& field) {
        ForceFieldLines lines;
        lines.add(field);
        return std::move(lines.text_);
    }

private:
    void put(const std::string& name) { text_ += name + ' '; }
    void put(double value) { text_ += fmt::format("{:x} ", std::bit_cast<std::uint64_t>(value)); }
    void put_count(std::int64_t value) { text_ += fmt::format("{} ", value); }
    template <class Names>
    void put_names(const Names& names) {
        for (const std::string& name : names) put(name);
    }
    template <class Tuples>
    void put_tuples(const char* what, const Tuples& tuples) {
        put(std::string(what));
        for (const auto& tuple : tuples) put_names(tuple);
        text_ += '\n';
    }

    void add_residue(const std::string& name, const Residue& residue) {
        put(name);
        put(residue.charge);
        put_names(std::array{residue.first_patch, residue.last_patch});
        put_count(residue.has_generated_angles);
        put_count(residue.has_generated_dihedrals);
        put_count(residue.lone_pair_line != 0);
        for (const ResidueAtom& atom : residue.atoms) {
            put_names(std::array{atom.name, atom.type});
            put(atom.charge);
            put_count(atom.group);
        }
        put_tuples("bonds", residue.bonds);
        put_tuples("angles", residue.angles);
        put_tuples("dihedrals", residue.dihedrals);
        put_tuples("impropers", residue.impropers);
        put_tuples("cmaps", residue.cmaps);
        put_names(residue.deleted_atoms);
        put_tuples("deleted bonds", residue.deleted_bonds);
        put_tuples("deleted angles", residue.deleted_angles);
        put_tuples("deleted dihedrals", residue.deleted_dihedrals);
        put_tuples("deleted impropers", residue.deleted_impropers);
        put_tuples("deleted cmaps", residue.deleted_cmaps);
        for (const auto& [named, line] : residue.named_on) put(named);
        for (const InternalCoordinate& ic : residue.internal_coordinates) {
            put_names(ic.atoms);
            put_count(ic.is_improper);
            for (const double value : {ic.first_bond, ic.first_angle_deg, ic.dihedral_deg,
                                       ic.last_angle_deg, ic.last_bond}) {
                put(value);
            }
        }
        text_ += '\n';
    }

    template <class Dihedrals>
    void add_dihedrals(const Dihedrals& dihedrals) {
        for (const auto& [types, terms] : dihedrals) {
            put_names(types);
            for (const DihedralTerm& term : terms) {
                put(term.k);
                put_count(term.multiplicity);
                put(term.phase_deg);
            }
            text_ += '\n';
        }
    }

    void add(const ForceField& field) {
        for (const auto& [name, type] : field.types) {
            put_names(std::array{name, type.element});
            put_count(type.number);
            put(type.mass);
        }
        for (const auto& [name, residue] : field.residues) add_residue(name, residue);
        text_ += "patches\n";
        for (const auto& [name, patch] : field.patches) add_residue(name, patch);
        put_count(field.generates_angles);
        put_count(field.generates_dihedrals);
        for (const auto& [name, type] : field.nonbonded) {
            put(name);
            for (const double value :
                 {type.epsilon, type.half_rmin, type.epsilon14, type.half_rmin14}) {
                put(value);
            }
        }
        for (const auto& [types, bond] : field.bonds) {
            put_names(std::array{types.first, types.second});
            put(bond.k);
            put(bond.value);
        }
        for (const auto& [types, angle] : field.angles) {
            put_names(types);
            for (const double value :
                 {angle.k, angle.value, angle.urey_bradley_k, angle.urey_bradley_s0}) {
                put(value);
            }
        }
        text_ += "dihedrals\n";
        add_dihedrals(field.dihedrals);
        text_ += "impropers\n";
        add_dihedrals(field.impropers);
        for (const auto& [types, map] : field.cmaps) {
            put_names(types);
            for (const double energy : map.energies) put(energy);
        }
        text_ += "nbfix\n";
        for (const auto& [types, pair] : field.nbfix) {
            put_names(std::array{types.first, types.second});
            for (const double value : {pair.epsilon, pair.rmin, pair.epsilon14, pair.rmin14}) {
                put(value);
            }
        }
    }

    std::string text_;
};

inline bool is_same_force_field(const ForceField& a, const ForceField& b) {
    return ForceFieldLines::of(a) == ForceFieldLines::of(b);
}

}  // namespace palpa::test
