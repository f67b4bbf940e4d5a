// Edits of a running scene: an [[edits]] table of a scene file, an edit of simulation/edit.h.
#pragma once
#include "core/load_error.h"
#include "scene/choices.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace palpa {

// A molecule, one of its residues by author number and insertion code, or an atom of that:
// "protease_a", "protease_a:25", "protease_a:25 CA", "protease_a:27A CA". What an address does not
// name is empty. Nothing where the text has not that form.
struct Address {
    std::string molecule, residue, atom;

    friend bool operator==(const Address&, const Address&) = default;
};
std::optional<Address> find_address(std::string_view text);

// The hand takes hold of a molecule as a whole, or of a residue or atom by a spring.
struct TakeEdit {
    std::string what;

    friend bool operator==(const TakeEdit&, const TakeEdit&) = default;
};

struct LetGoEdit {
    friend bool operator==(const LetGoEdit&, const LetGoEdit&) = default;
};

// A residue of the scene's force field, a copy of a molecule, or what is in files, with its
// reference atom there: of a residue and of files the first one.
struct AddEdit {
    std::string residue, copy_of;  // exactly one of residue, copy_of, structure
    std::string name;
    std::array<double, 3> at_angstrom{};
    // As in [molecules.NAME]; without segment: the only one of the file.
    std::filesystem::path structure{}, topology{};
    std::string segment{};

    friend bool operator==(const AddEdit&, const AddEdit&) = default;
};

struct RemoveEdit {
    std::string molecule;

    friend bool operator==(const RemoveEdit&, const RemoveEdit&) = default;
};

// Of one atom a label, of two their distance, of three an angle, of four a dihedral.
struct PinEdit {
    std::vector<std::string> atoms;

    friend bool operator==(const PinEdit&, const PinEdit&) = default;
};

// A spring between two atoms or residues, or from one to a place.
struct RestraintEdit {
    std::vector<std::string> atoms;
    std::optional<std::array<double, 3>> place_angstrom;
    double k_kcal_per_mol_angstrom2 = 20;
    double length_angstrom = 0;

    friend bool operator==(const RestraintEdit&, const RestraintEdit&) = default;
};

// Unset fields stay unchanged.
struct MobilityEdit {
    std::string molecule;
    std::optional<Motion> motion;
    std::optional<Shape> shape;

    friend bool operator==(const MobilityEdit&, const MobilityEdit&) = default;
};

struct AppearanceEdit {
    std::string molecule;
    std::optional<Representation> representation;
    std::optional<Colouring> colouring;
    std::optional<bool> visible;

    friend bool operator==(const AppearanceEdit&, const AppearanceEdit&) = default;
};

// Keys of [coupling] with their values, as `--set` has them without "coupling.": "mode=3".
struct CouplingEdit {
    std::vector<std::string> settings;

    friend bool operator==(const CouplingEdit&, const CouplingEdit&) = default;
};

// Resets the world to the scene's file.
struct ResetEdit {
    friend bool operator==(const ResetEdit&, const ResetEdit&) = default;
};

struct UndoEdit {
    friend bool operator==(const UndoEdit&, const UndoEdit&) = default;
};
struct RedoEdit {
    friend bool operator==(const RedoEdit&, const RedoEdit&) = default;
};

using EditAction =
    std::variant<TakeEdit, LetGoEdit, AddEdit, RemoveEdit, PinEdit, RestraintEdit, MobilityEdit,
                 AppearanceEdit, CouplingEdit, ResetEdit, UndoEdit, RedoEdit>;

// The files that it reads.
std::vector<std::filesystem::path*> list_files(EditAction& action);

// Their keys in a scene file, in that order.
inline constexpr std::array<std::string_view, std::variant_size_v<EditAction>> edit_names{
    "take",     "let_go",     "add",      "remove", "pin",  "restraint",
    "mobility", "appearance", "coupling", "reset",  "undo", "redo"};

inline constexpr std::array<std::string_view, 2> edit_hand_names{"first", "second"};

struct EditDescription {
    double at_s = 0;       // applied before the first step at or after this time
    std::size_t hand = 0;  // hand that makes it: 0 the first, 1 the second
    EditAction action;
    TextPlace place;  // in the scene file, for messages
};

}  // namespace palpa
