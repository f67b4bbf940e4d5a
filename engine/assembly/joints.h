// Decides which bonds of a molecule can turn, by chemical rules that need only masses and bonds.
#pragma once
#include "molecule/connectivity.h"

#include <array>
#include <cstdint>
#include <vector>

namespace palpa {

// The class of a bond for these rules. Only a bridge of the bond graph with further atoms at both
// ends can turn; rings are rigid.
enum class JointKind : std::uint8_t {
    Torsion,   // all others: phi, psi, chi including Arg chi5, C(=O)-O of an ester or carbamate
    Hydroxyl,  // X-OH, also in acids
    Thiol,     // X-SH
    Ammonium,  // X-NH3, and X-NH2 where X is no planar carbon
    Methyl,    // X-CH3
    Amide,     // C(=O)-N of amides (omega), carbamates and ureas, C(=S)-N too
    AmideNH2,  // the same with NH2, and NH2 on an aromatic ring
    GuanidiniumNH2,  // C-NH2 where the carbon has further nitrogens: guanidinium, amidinium
    DoubleOrLinear,  // C=C, C=N, N=N; all bonds of a carbon in line with both its neighbours
};

enum class BondMotion : std::uint8_t { Turn, Rigid, Spring };

// The setting of a scene for one bond, in place of the rules. `Turn` needs a bridge with further
// atoms at both ends (springs do not count); `Spring` needs a bond of a ring, which is opened
// there.
struct JointOverride {
    std::array<std::uint32_t, 2> bond;  // its two atoms, in either order
    BondMotion motion;
};

// Which classes turn. Torsions always do, double bonds never; overrides come first.
struct JointRules {
    bool hydroxyl = true, thiol = true, ammonium = true;
    bool methyl = false, amide = false, amide_nh2 = false, guanidinium_nh2 = false;
    std::vector<JointOverride> overrides;
};

struct Joint {
    std::array<std::uint32_t, 2> bond;  // lower atom first
    JointKind kind;
};

struct Joints {
    std::vector<Joint> joints;  // bonds that turn, in the order of the bonds
    // Bonds that close a loop and are held by a spring instead: disulphides, in the order of the
    // bonds. One in a ring of eight atoms or fewer is a bond of a rigid ring as any other, and one
    // without which the molecule falls apart is a torsion.
    std::vector<std::array<std::uint32_t, 2>> springs;
};

// Elements follow from masses, bond orders from the number of neighbours: a carbon with three
// is planar; whether a chain's bond between two planar atoms is double follows from how many of
// them want a partner on one side of it. That is blind to odd charges (a pyridinium beside a biaryl
// bond): such a bond needs an override. Throws LoadError naming every override that cannot be met.
Joints build_joints(const Connectivity& connectivity, const JointRules& rules = {});

// Whether the bond is phi or psi of a protein, by its atom names.
bool is_backbone(const Connectivity& connectivity,
                 const std::array<std::uint32_t, 2>& bond) noexcept;

}  // namespace palpa
