// Which bonds of a molecule turn: rules of chemistry, from masses and bonds alone.
#pragma once
#include "molecule/connectivity.h"

#include <array>
#include <cstdint>
#include <vector>

namespace palpa {

// What a bond is to the rules. Only a bridge of the bond graph with further atoms at both ends can
// turn anything; rings are rigid.
enum class JointKind : std::uint8_t {
    Torsion,   // none of those below: phi, psi, chi with Arg chi5, C(=O)-O of an ester or carbamate
    Hydroxyl,  // X-OH, of acids too
    Thiol,     // X-SH
    Ammonium,  // X-NH3, and X-NH2 where X is no planar carbon
    Methyl,    // X-CH3
    Amide,     // C(=O)-N of amides (omega), carbamates and ureas, C(=S)-N too
    AmideNH2,  // the same with NH2, and NH2 on an aromatic ring
    GuanidiniumNH2,  // C-NH2 where the carbon has further nitrogens: guanidinium, amidinium
    DoubleOrLinear,  // C=C, C=N, N=N; all bonds of a carbon in line with both its neighbours
};

enum class BondMotion : std::uint8_t { Turn, Rigid, Spring };

// What a scene says of one bond, whatever the rules say. `Turn` asks for a bridge with further
// atoms at both ends, springs not counted, `Spring` for a bond of a ring, which is opened there.
struct JointOverride {
    std::array<std::uint32_t, 2> bond;  // atoms, either way round
    BondMotion motion;
};

// Which kinds turn. Torsions do, double bonds never do; overrides go before all.
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

// Told by names: phi or psi of a protein.
bool is_backbone(const Connectivity& connectivity,
                 const std::array<std::uint32_t, 2>& bond) noexcept;

}  // namespace palpa
