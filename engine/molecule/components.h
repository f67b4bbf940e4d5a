// Tables of PDB residues: the CHARMM36 residue of each, its meaning in words, and which ones only
// the crystal needed.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace palpa {

struct Component {
    std::string_view name;     // name in the PDB: "NAG"
    std::string_view charmm;   // residue of CHARMM36: "BGLCNA"; empty: none
    std::string_view patch;    // patch on that residue; empty: none
    std::string_view meaning;  // in words: "N-acetyl-beta-D-glucosamine"
};

// A table of one kind, and the CHARMM36 files with its residues.
struct ComponentTable {
    std::string_view kind;  // "a sugar"
    std::string_view files;
    std::span<const Component> components;
};

// Residues that may be called alike come first in the table whose files have them.
std::span<const ComponentTable> component_tables() noexcept;

struct FoundComponent {
    const ComponentTable* table;
    const Component* component;
};
std::optional<FoundComponent> find_component(std::string_view name) noexcept;

// What a crystal or a membrane program leaves in a file and the molecule does without: "sulphate";
// empty for all else.
std::string_view crystal_only(std::string_view name) noexcept;

// A residue that is bonded to an amino acid for good, and what CHARMM36 has for both together.
struct JoinedComponent {
    std::string_view ligand, host, host_atom, charmm;
};
std::span<const JoinedComponent> joined_components() noexcept;

// For each of the carbons 1 to 4 of a sugar's ring of CHARMM's: 'a', its oxygen is axial, or 'b',
// equatorial. Empty for residues that are none.
std::string_view find_ring_oxygens(std::string_view charmm) noexcept;

}  // namespace palpa
