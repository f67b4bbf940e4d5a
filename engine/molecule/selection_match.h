// Tests names and numbers against those of an expression.
#pragma once
#include "molecule/selection_tree.h"

#include <span>
#include <string_view>

namespace palpa {

// Whether a name matches; in a pattern * stands for any letters, ? for one.
bool fits(const NamePattern& name, std::string_view text) noexcept;
bool fits_any(std::span<const NamePattern> names, std::string_view text) noexcept;

// One number is that alone; a range has all codes of the numbers at its ends that have none.
bool is_in(const NumberSpan& span, const ResidueNumber& value) noexcept;

bool holds(Comparison comparison, double a, double b) noexcept;

// The chain in a segment's name: of CHARMM-GUI's "PROA" that is "A", of all others the name.
std::string_view chain_in(std::string_view segment) noexcept;

}  // namespace palpa
