// The list of edits of a running scene. Each is one type: its fields, checks and name in the
// history are in scene/edits/, what it does to a world in loading/edits/. Scene files
// ([[edits]]), commands, journals, undo and windows go by this list.
#pragma once
#include "core/hands.h"
#include "core/load_error.h"
#include "scene/edits/add.h"
#include "scene/edits/appearance.h"
#include "scene/edits/coupling.h"
#include "scene/edits/grab.h"
#include "scene/edits/kind.h"
#include "scene/edits/mobility.h"
#include "scene/edits/pin.h"
#include "scene/edits/put_back.h"
#include "scene/edits/relax.h"
#include "scene/edits/release.h"
#include "scene/edits/remove.h"
#include "scene/edits/rename.h"
#include "scene/edits/reset.h"
#include "scene/edits/restraint.h"
#include "scene/edits/undo.h"

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

using EditAction = std::variant<GrabEdit, ReleaseEdit, PutBackEdit, AddEdit, RemoveEdit, RenameEdit,
                                PinEdit, RestraintEdit, MobilityEdit, AppearanceEdit, RelaxEdit,
                                CouplingEdit, ResetEdit, UndoEdit, RedoEdit>;

inline const EditKind& kind_of(const EditAction& action) {
    return std::visit([](const auto& edit) -> const EditKind& { return edit.kind; }, action);
}

// The files that it reads.
std::vector<std::filesystem::path*> list_files(EditAction& action);

// True if it makes something mobile that was not.
bool makes_mobile(const EditAction& action);

// The name in the history: "grip of TL-3"; empty for undo and redo.
std::string undo_name(const EditAction& action);

template <class... Edits>
constexpr auto list_keys(const std::variant<Edits...>* /*of*/) {
    return std::array{Edits::kind.key...};
}
// Keys in a scene file, in the order of the list.
inline constexpr auto edit_names = list_keys(static_cast<const EditAction*>(nullptr));

template <class... Edits>
std::vector<std::string_view> list_with_engine(const std::variant<Edits...>* /*of*/) {
    std::vector<std::string_view> keys;
    (void)((Edits::kind.with_engine ? keys.push_back(Edits::kind.key) : void(), 0) + ...);
    return keys;
}
// Keys of the edits that are possible if a remote engine places the atoms.
inline std::vector<std::string_view> list_edits_with_engine() {
    return list_with_engine(static_cast<const EditAction*>(nullptr));
}

inline constexpr std::array<std::string_view, most_hands> edit_hand_names{"first", "second",
                                                                          "third", "fourth"};

struct EditDescription {
    double at_s = 0;       // applied before the first step at or after this time
    std::size_t hand = 0;  // hand that makes it, from 0
    EditAction action;
    TextPlace place;  // in the scene file, for messages
};

}  // namespace palpa
