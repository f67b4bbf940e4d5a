// The hydropathy of amino acids.
#pragma once
#include <optional>
#include <string_view>

namespace palpa {

// The hydropathy index of J. Kyte and R. F. Doolittle, J. Mol. Biol. 157, 105 (1982), table 2: from
// -4.5 (arginine, likes water) to 4.5 (isoleucine). Residues by PDB's and CHARMM's names,
// protonation states like their amino acid; nothing for all that is no amino acid.
std::optional<double> find_hydropathy(std::string_view residue) noexcept;

}  // namespace palpa
