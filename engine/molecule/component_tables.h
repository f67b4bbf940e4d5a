// The tables behind molecule/components.h, one for each kind of residue.
#pragma once
#include "molecule/components.h"

namespace palpa {

std::span<const Component> sugars() noexcept;
std::span<const Component> nucleotides() noexcept;
std::span<const Component> cofactors() noexcept;
std::span<const Component> lipids() noexcept;
std::span<const Component> amino_acids() noexcept;
std::span<const Component> ions() noexcept;
std::span<const Component> crystal_components() noexcept;

}  // namespace palpa
