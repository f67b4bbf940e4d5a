// Writes the atoms of a world to structure files: present coordinates and connectivity.
#pragma once
#include "core/files.h"
#include "ecs/world.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// What all atoms of the world are and which are bonded, in the order of the atom table. Angles and
// dihedrals are there only where something mobile has asked for them.
Connectivity list_connectivity(const World& world);

// Whether the table has the atoms of `known`, in its order: by name, type, charge and mass.
bool has_same_atoms(const AtomTable& atoms, const Connectivity& known) noexcept;

// The numbers in the table of the atoms of these molecules, in the table's order; of all that are
// shown where `molecules` is empty. Throws LoadError for a name that no molecule has, and where
// there is no atom.
std::vector<std::uint32_t> select_atoms(const World& world, std::span<const std::string> molecules);

// A structure of these atoms at their present positions. Chains are the segments; a chain ends with
// its molecule.
Structure build_structure(const World& world, std::span<const std::uint32_t> atoms);

// By the ending: .pdb, .ent, .cif, .mmcif, .gro, .crd, .cor; .psf is the topology, with the
// coordinates in a file beside it that ends in .crd. `title`: printable ASCII.
// Throws LoadError for another ending, and where a name does not fit the format.
std::vector<TextFile> format_coordinates(const World& world, std::span<const std::uint32_t> atoms,
                                         const std::filesystem::path& file, std::string_view title);

// The files that format_coordinates makes of such a name, for who looks before the work. Throws
// LoadError for another ending.
std::vector<std::filesystem::path> list_coordinate_files(const std::filesystem::path& file);

// Stands near the beginning of each of these files, by which it is known again.
std::string coordinates_mark(const std::filesystem::path& file);

}  // namespace palpa
