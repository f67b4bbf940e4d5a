#include "ui/shown_names.h"

#include "core/translate.h"

#include <array>
#include <cstddef>

namespace palpa {
namespace {

constexpr std::array representations{
    for_translation("ball-and-stick"), for_translation("space-filling"),
    for_translation("licorice"),       for_translation("in-hand"),
    for_translation("pocket"),         for_translation("lines"),
    for_translation("cartoon"),        for_translation("surface")};
static_assert(representations.size() == representation_names.size());

constexpr std::array colourings{
    for_translation("element"),        for_translation("chain"),    for_translation("residue"),
    for_translation("structure"),      for_translation("charge"),   for_translation("b-factor"),
    for_translation("force"),          for_translation("activity"), for_translation("potential"),
    for_translation("hydrophobicity"), for_translation("error")};
static_assert(colourings.size() == colouring_names.size());

}  // namespace

const char* shown_name(Representation representation) {
    return translated(representations[static_cast<std::size_t>(representation)]);
}

const char* shown_name(Colouring colouring) {
    return translated(colourings[static_cast<std::size_t>(colouring)]);
}

}  // namespace palpa
