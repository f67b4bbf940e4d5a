// Pick numbers of shapes other than atoms. Atoms, and bonds by their first atom, are picked by
// their index.
#pragma once
#include <cstdint>

namespace palpa {

inline constexpr std::uint32_t arrow_pick = UINT32_MAX - 1, wish_pick = UINT32_MAX - 2,
                               torque_pick = UINT32_MAX - 3, hydrogen_bond_pick = UINT32_MAX - 4,
                               snap_pick = UINT32_MAX - 5, measure_pick = UINT32_MAX - 6,
                               contact_pick = UINT32_MAX - 7, clash_pick = UINT32_MAX - 8,
                               salt_bridge_pick = UINT32_MAX - 9, force_part_pick = UINT32_MAX - 10,
                               ghost_pick = UINT32_MAX - 11, trail_pick = UINT32_MAX - 12,
                               rest_pick = UINT32_MAX - 13, first_sign_pick = rest_pick;

}  // namespace palpa
