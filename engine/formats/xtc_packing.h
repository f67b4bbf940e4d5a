// Whole-number coordinates packed into few bits, as XTC files hold them.
//
// The algorithm is that of the xdrf library (F. van Hoesel, 1995), which GROMACS's reference manual
// names; nothing but its format is used here:
// - Atoms come in groups: one at a whole place, counted from the least coordinates, and up to 8
//   more, each by its small difference from the atom before.
// - Three numbers below s0, s1, s2 are one number (n0 s1 + n1) s2 + n2 of as many bits as the
//   product s0 s1 s2 has. It is written byte by byte, the least first and what remains of bits
//   last; the bits of a byte begin with the highest.
// - A whole place whose range exceeds 2^24 - 1 along some axis is three numbers of their own bits.
// - Differences d are written as d + s/2, below s in each coordinate. s is one of 73 sizes; three
//   numbers below the i-th take i bits. A frame begins with its first i.
// - Behind the whole place stands a bit: 0, if the group has as many small differences as the one
//   before, and i stays; 1, and five more bits, 3 small + change + 1, where i changes behind the
//   group by -1, 0 or 1.
// - If there are small differences, the first two atoms of the group are exchanged: a water is its
//   first hydrogen, the oxygen near that and the other hydrogen near the oxygen.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

using IntegerPlace = std::array<std::int32_t, 3>;

struct PackedPlaces {
    IntegerPlace least{}, greatest{};  // range of all atoms along each axis
    std::int32_t small = 0;            // the initial i
    std::string bits;
};

// Of at least one atom. Nothing where a range exceeds 2^31 - 3, which other readers do not take.
std::optional<PackedPlaces> pack_places(std::span<const IntegerPlace> places);

// Fills `places`. Returns an empty text, or what is wrong, half a sentence.
std::string unpack_places(const IntegerPlace& least, const IntegerPlace& greatest,
                          std::int32_t small, std::string_view bits,
                          std::span<IntegerPlace> places);

// The largest number of atoms that these bytes can contain.
std::uint64_t most_packed_places(std::uint64_t bytes) noexcept;

}  // namespace palpa
