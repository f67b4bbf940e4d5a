// The torsion trees of the reference molecules, with the forces of their frames.
#pragma once
#include "tests/support/torsion_oracles.h"

#include <filesystem>
#include <string>

namespace palpa::test {

// That of CASE.torsion.json.
TorsionCase read_torsion_case(const std::filesystem::path& folder, const std::string& name);

// What the same file says of their accelerations.
TorsionAccelerations read_torsion_accelerations(const std::filesystem::path& folder,
                                                const std::string& name, const TorsionCase& c);

}  // namespace palpa::test
