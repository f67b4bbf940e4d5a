// The keywords of selection expressions.
#pragma once
#include "molecule/selection_tree.h"

#include <string>
#include <string_view>
#include <variant>

namespace palpa {

// Words that join or open expressions.
enum class SelectionOperator {
    And,
    Or,
    Not,
    Within,
    WithinOthers,
    Of,
    Same,
    As,
    ByResidue,
    To,
    Polar
};

struct SelectionKeyword {
    std::string_view word;
    std::variant<AtomClass, NameProperty, NumberProperty, SelectionOperator> meaning;
};

// The keyword of a word in lower case; null if it is none.
const SelectionKeyword* find_selection_keyword(std::string_view lower) noexcept;

// "; did you mean 'protein'?" or nothing.
std::string near_selection_keyword(std::string_view word);

}  // namespace palpa
