// The fields of a packed force field in their order, for writing and for reading alike: what one
// forgets the other does not know either.
//
// A count is a whole number in groups of seven bits, the lowest first. A name is 0, its length and
// its letters where it is new, else 1 + its place among the names so far. A number is the count of
// its decimals (0 to 17) and its digits as a whole number (even: 2 n; odd: -n of 2 n - 1), or 255
// and the eight bytes of the double where that would change it. Maps are in the order of their
// keys.
#pragma once
#include "charmm/force_field.h"

#include <array>
#include <cstddef>
#include <string>

namespace palpa {

// By which digits are divided, which rounds as reading the decimal does: they are exact.
inline constexpr std::array packed_powers = {1e0, 1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,
                                             1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17};

// Allowed range of a number, which must be finite.
enum class PackedNumber { Any, NotNegative };

// Whose name it is: those of a residue's atoms stand once, and those in terms are remembered.
enum class PackedName { Any, MayBeEmpty, Atom, Term };

template <class Archive, class Names>
void visit_names(Archive& archive, Names& names) {
    for (auto& name : names) archive.name(name);
}

template <class Archive, class Tuples>
void visit_tuples(Archive& archive, Tuples& tuples) {
    archive.list(tuples, [&](auto& tuple) {
        for (auto& name : tuple) archive.name(name, PackedName::Term);
    });
}

template <class Archive, class Coordinate>
void visit_internal_coordinate(Archive& archive, Coordinate& ic) {
    visit_names(archive, ic.atoms);
    archive.flag(ic.is_improper);
    for (auto* value : {&ic.first_bond, &ic.first_angle_deg, &ic.dihedral_deg, &ic.last_angle_deg,
                        &ic.last_bond}) {
        archive.number(*value);
    }
}

template <class Archive, class OneResidue>
void visit_residue(Archive& archive, OneResidue& residue) {
    archive.number(residue.charge);
    archive.list(residue.atoms, [&](auto& atom) {
        archive.name(atom.name, PackedName::Atom);
        archive.name(atom.type, PackedName::Any);
        archive.number(atom.charge);
        archive.count(atom.group);
    });
    visit_tuples(archive, residue.bonds);
    visit_tuples(archive, residue.angles);
    visit_tuples(archive, residue.dihedrals);
    visit_tuples(archive, residue.impropers);
    visit_tuples(archive, residue.cmaps);
    archive.list(residue.internal_coordinates,
                 [&](auto& ic) { visit_internal_coordinate(archive, ic); });
    archive.list(residue.deleted_atoms, [&](auto& name) { archive.name(name); });
    visit_tuples(archive, residue.deleted_bonds);
    visit_tuples(archive, residue.deleted_angles);
    visit_tuples(archive, residue.deleted_dihedrals);
    visit_tuples(archive, residue.deleted_impropers);
    visit_tuples(archive, residue.deleted_cmaps);
    archive.name(residue.first_patch);
    archive.name(residue.last_patch);
    archive.flag(residue.has_generated_angles);
    archive.flag(residue.has_generated_dihedrals);
    archive.count(residue.lone_pair_line);
    archive.finish(residue);
}

template <class Archive, class Terms>
void visit_dihedral_terms(Archive& archive, Terms& terms) {
    archive.list(terms, [&](auto& term) {
        archive.number(term.k);
        archive.count(term.multiplicity);
        archive.number(term.phase_deg);
        archive.finish(term);
    });
}

template <class Archive, class Field>
void visit_topology(Archive& archive, Field& field) {
    const auto one_name = [&](auto& key) { archive.name(key); };
    archive.map(field.types, one_name, [&](auto& type) {
        archive.optional_count(type.number);
        archive.number(type.mass, PackedNumber::NotNegative);
        archive.name(type.element, PackedName::MayBeEmpty);
        archive.finish(type);
    });
    const auto residue = [&](auto& one) { visit_residue(archive, one); };
    archive.map(field.residues, one_name, residue);
    archive.map(field.patches, one_name, residue);
    archive.flag(field.generates_angles);
    archive.flag(field.generates_dihedrals);
}

template <class Archive, class Field>
void visit_parameters(Archive& archive, Field& field) {
    constexpr PackedNumber not_negative = PackedNumber::NotNegative;
    const auto one_name = [&](auto& key) { archive.name(key); };
    const auto two_names = [&](auto& key) {
        archive.name(key.first);
        archive.name(key.second);
    };
    const auto names = [&](auto& key) { visit_names(archive, key); };
    archive.map(field.nonbonded, one_name, [&](auto& type) {
        for (auto* value : {&type.epsilon, &type.half_rmin, &type.epsilon14, &type.half_rmin14}) {
            archive.number(*value, not_negative);
        }
        archive.finish(type);
    });
    archive.map(field.bonds, two_names, [&](auto& bond) {
        archive.number(bond.k);
        archive.number(bond.value);
        archive.finish(bond);
    });
    archive.map(field.angles, names, [&](auto& angle) {
        for (auto* value :
             {&angle.k, &angle.value, &angle.urey_bradley_k, &angle.urey_bradley_s0}) {
            archive.number(*value);
        }
        archive.finish(angle);
    });
    const auto terms = [&](auto& value) { visit_dihedral_terms(archive, value); };
    archive.map(field.dihedrals, names, terms);
    archive.map(field.impropers, names, terms);
    archive.map(field.cmaps, names, [&](auto& map) {
        archive.list(map.energies, [&](auto& energy) { archive.number(energy); });
        archive.finish(map);
    });
    archive.map(field.nbfix, two_names, [&](auto& pair) {
        for (auto* value : {&pair.epsilon, &pair.rmin, &pair.epsilon14, &pair.rmin14}) {
            archive.number(*value, not_negative);
        }
        archive.finish(pair);
    });
}

template <class Archive, class Field>
void visit_force_field(Archive& archive, Field& field) {
    visit_topology(archive, field);
    visit_parameters(archive, field);
}

}  // namespace palpa
