#include "formats/xtc_packing.h"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <cstdlib>
#include <limits>

namespace palpa {
namespace {

// The sizes of small differences, about 2^(i/3); those below the ninth are not used. A table of the
// format, from xdrf's libxdrf.c, where they are called magicints.
constexpr std::array<std::int32_t, 73> small_sizes{
    0,        0,        0,       0,       0,       0,       0,       0,       0,       8,
    10,       12,       16,      20,      25,      32,      40,      50,      64,      80,
    101,      128,      161,     203,     256,     322,     406,     512,     645,     812,
    1024,     1290,     1625,    2048,    2580,    3250,    4096,    5060,    6501,    8192,
    10321,    13003,    16384,   20642,   26007,   32768,   41285,   52015,   65536,   82570,
    104031,   131072,   165140,  208063,  262144,  330280,  416127,  524287,  660561,  832255,
    1048576,  1321122,  1664510, 2097152, 2642245, 3329021, 4194304, 5284491, 6658042, 8388607,
    10568983, 13316085, 16777216};
constexpr std::int32_t first_small = 9, last_small = small_sizes.size() - 1;

constexpr std::size_t most_small = 8;  // differences of a group
constexpr std::uint32_t most_common_size = 0xffffff;

// Of three numbers that are written as one.
struct Sizes {
    std::array<std::uint32_t, 3> size;  // each number is below
    unsigned bits = 0;                  // of all three
};

// A whole number of 96 bits, the least 32 first.
using Wide = std::array<std::uint32_t, 3>;

void multiply_add(Wide& number, std::uint32_t factor, std::uint32_t summand) {
    std::uint64_t carry = summand;
    for (std::uint32_t& limb : number) {
        carry += std::uint64_t{limb} * factor;
        limb = static_cast<std::uint32_t>(carry);
        carry >>= 32;
    }
}

// Divides, and returns what remains.
std::uint32_t divide(Wide& number, std::uint32_t divisor) {
    std::uint64_t rest = 0;
    for (std::size_t i = number.size(); i-- > 0;) {
        rest = rest << 32 | number[i];
        number[i] = static_cast<std::uint32_t>(rest / divisor);
        rest %= divisor;
    }
    return static_cast<std::uint32_t>(rest);
}

unsigned bits_of(const Wide& number) {
    for (std::size_t i = number.size(); i-- > 0;) {
        if (number[i] != 0) return static_cast<unsigned>(32 * i + std::bit_width(number[i]));
    }
    return 0;
}

// How whole places of one frame are written.
struct WholePlaces {
    WholePlaces(const IntegerPlace& least, const IntegerPlace& greatest) {
        Wide product{1, 0, 0};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t size = std::int64_t{greatest[axis]} - least[axis] + 1;
            sizes.size[axis] = static_cast<std::uint32_t>(size);
            multiply_add(product, sizes.size[axis], 0);
            if (size > most_common_size) apart = true;
        }
        sizes.bits = bits_of(product);
    }

    static bool fits(std::int32_t least, std::int32_t greatest) {
        return greatest >= least &&
               std::int64_t{greatest} - least < std::numeric_limits<std::int32_t>::max() - 2;
    }

    Sizes sizes{};
    bool apart = false;  // each number in bits of its own
};

Sizes sizes_of_small(std::int32_t small) {
    const auto size = static_cast<std::uint32_t>(small_sizes[static_cast<std::size_t>(small)]);
    return {{size, size, size}, static_cast<unsigned>(small)};
}

std::int32_t half_of_small(std::int32_t small) {
    return small_sizes[static_cast<std::size_t>(small)] / 2;
}

class BitReader {
public:
    explicit BitReader(std::string_view bytes) : bytes_(bytes) {}

    bool is_exhausted() const { return exhausted_; }

    // Up to 32 bits; zeros behind the end.
    std::uint32_t take(unsigned count) {
        while (held_ < count) {
            exhausted_ |= next_ >= bytes_.size();
            const auto byte =
                next_ < bytes_.size() ? static_cast<unsigned char>(bytes_[next_++]) : 0U;
            bits_ = bits_ << 8 | byte;
            held_ += 8;
        }
        held_ -= count;
        return static_cast<std::uint32_t>(bits_ >> held_ & ((std::uint64_t{1} << count) - 1));
    }

    std::array<std::uint32_t, 3> take_together(const Sizes& sizes) {
        Wide number{};
        for (unsigned bit = 0; bit < sizes.bits; bit += 8) {
            number[bit / 32] |= take(std::min(8U, sizes.bits - bit)) << bit % 32;
        }
        std::array<std::uint32_t, 3> numbers{};
        numbers[2] = divide(number, sizes.size[2]);
        numbers[1] = divide(number, sizes.size[1]);
        numbers[0] = number[0];
        return numbers;
    }

    std::array<std::uint32_t, 3> take_whole(const WholePlaces& whole) {
        if (!whole.apart) return take_together(whole.sizes);
        std::array<std::uint32_t, 3> numbers{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            numbers[axis] = take(static_cast<unsigned>(std::bit_width(whole.sizes.size[axis])));
        }
        return numbers;
    }

private:
    std::string_view bytes_;
    std::size_t next_ = 0;
    std::uint64_t bits_ = 0;  // the last taken from bytes
    unsigned held_ = 0;       // how many of them are still to be given, from the lowest
    bool exhausted_ = false;
};

class BitWriter {
public:
    void put(std::uint32_t value, unsigned count) {
        bits_ = bits_ << count | value;
        for (held_ += count; held_ >= 8; held_ -= 8) {
            bytes_ += static_cast<char>(static_cast<unsigned char>(bits_ >> (held_ - 8)));
        }
    }

    void put_together(const std::array<std::uint32_t, 3>& numbers, const Sizes& sizes) {
        Wide number{numbers[0], 0, 0};
        multiply_add(number, sizes.size[1], numbers[1]);
        multiply_add(number, sizes.size[2], numbers[2]);
        for (unsigned bit = 0; bit < sizes.bits; bit += 8) {
            put(number[bit / 32] >> bit % 32 & 0xff, std::min(8U, sizes.bits - bit));
        }
    }

    void put_whole(const std::array<std::uint32_t, 3>& numbers, const WholePlaces& whole) {
        if (!whole.apart) return put_together(numbers, whole.sizes);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            put(numbers[axis], static_cast<unsigned>(std::bit_width(whole.sizes.size[axis])));
        }
    }

    std::string take() {
        if (held_ > 0) put(0, 8 - held_);
        return std::move(bytes_);
    }

private:
    std::string bytes_;
    std::uint64_t bits_ = 0;
    unsigned held_ = 0;  // of the lowest bits, not yet a byte
};

// Sums that wrap, as damaged files may ask for.
std::int32_t wrapped_sum(std::int32_t a, std::uint32_t b) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + b);
}

// The packer's choices; every other choice unpacks alike.
class Packer {
public:
    explicit Packer(std::span<const IntegerPlace> places, const PackedPlaces& range)
        : places_(places),
          least_(range.least),
          whole_(range.least, range.greatest),
          // A difference costs i bits, a whole place one more than it has; beyond that it is none.
          most_(std::min(last_small, static_cast<std::int32_t>(whole_.sizes.bits) - 1)) {}

    void pack(PackedPlaces& into) {
        small_ = std::clamp(smallest_of_all(), first_small, last_small);
        into.small = small_;
        while (next_ < places_.size()) add_group();
        into.bits = bits_.take();
    }

private:
    // The least i for the difference between two atoms, or one more than there are.
    std::int32_t find_small(std::size_t a, std::size_t b) const {
        std::int64_t greatest = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            greatest =
                std::max(greatest, std::abs(std::int64_t{places_[a][axis]} - places_[b][axis]));
        }
        std::int32_t small = first_small;
        while (small <= last_small && half_of_small(small) <= greatest) ++small;
        return small;
    }

    // Which most of the near neighbours fit, to begin with.
    std::int32_t smallest_of_all() const {
        std::array<std::size_t, last_small + 2> count{};
        for (std::size_t i = 1; i < places_.size(); ++i) {
            ++count[static_cast<std::size_t>(find_small(i - 1, i))];
        }
        const auto end = count.begin() + std::max(first_small, most_) + 1;
        return static_cast<std::int32_t>(std::max_element(count.begin(), end) - count.begin());
    }

    void add_group() {
        const std::size_t first = next_;
        // The least i that would do for each difference; the greatest of those that are used.
        std::size_t small_count = 0;
        std::int32_t needed = first_small;
        const auto extend = [&](std::size_t a, std::size_t b) {
            const std::int32_t one = b < places_.size() ? find_small(a, b) : last_small + 1;
            if (one > small_) return false;
            needed = std::max(needed, one);
            ++small_count;
            return true;
        };
        if (extend(first, first + 1)) {
            std::size_t last = first;  // behind the exchange
            std::size_t next = first + 2;
            while (small_count < most_small && extend(last, next)) last = next++;
        }
        next_ = first + 1 + small_count;

        // The next group decides whether i grows, both whether it shrinks.
        const std::int32_t wanted =
            next_ + 1 < places_.size() ? find_small(next_, next_ + 1) : small_;
        std::int32_t change = 0;
        if (wanted > small_ && wanted <= most_) change = 1;
        if (std::max(wanted, needed) < small_ && small_ > first_small) change = -1;
        write_group(first, small_count, change);
        small_ += change;
    }

    void write_group(std::size_t first, std::size_t small_count, std::int32_t change) {
        const bool exchanged = small_count > 0;
        bits_.put_whole(differences(places_[first + (exchanged ? 1 : 0)], least_, 0), whole_);
        const bool is_changed = small_count != last_count_ || change != 0;
        bits_.put(is_changed ? 1 : 0, 1);
        if (is_changed)
            bits_.put(static_cast<std::uint32_t>(3 * small_count + 1) +
                          static_cast<std::uint32_t>(change),
                      5);
        last_count_ = small_count;
        const Sizes sizes = sizes_of_small(small_);
        const std::int32_t half = half_of_small(small_);
        for (std::size_t i = 0; i < small_count; ++i) {
            const std::size_t atom = i == 0 ? first : first + i + 1;
            const std::size_t before = i == 0 ? first + 1 : i == 1 ? first : first + i;
            bits_.put_together(differences(places_[atom], places_[before], half), sizes);
        }
    }

    static std::array<std::uint32_t, 3> differences(const IntegerPlace& place,
                                                    const IntegerPlace& from, std::int32_t half) {
        std::array<std::uint32_t, 3> numbers{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            numbers[axis] =
                static_cast<std::uint32_t>(std::int64_t{place[axis]} - from[axis] + half);
        }
        return numbers;
    }

    std::span<const IntegerPlace> places_;
    IntegerPlace least_;
    WholePlaces whole_;
    std::int32_t most_;  // the greatest i that is worth it
    BitWriter bits_;
    std::size_t next_ = 0;  // atom
    std::int32_t small_ = 0;
    std::size_t last_count_ = most_small + 1;  // the first group says its own
};

}  // namespace

std::optional<PackedPlaces> pack_places(std::span<const IntegerPlace> places) {
    PackedPlaces packed{places[0], places[0], 0, {}};
    for (const IntegerPlace& place : places) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            packed.least[axis] = std::min(packed.least[axis], place[axis]);
            packed.greatest[axis] = std::max(packed.greatest[axis], place[axis]);
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!WholePlaces::fits(packed.least[axis], packed.greatest[axis])) return {};
    }
    Packer(places, packed).pack(packed);
    return packed;
}

std::string unpack_places(const IntegerPlace& least, const IntegerPlace& greatest,
                          std::int32_t small, std::string_view bits,
                          std::span<IntegerPlace> places) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (WholePlaces::fits(least[axis], greatest[axis])) continue;
        return fmt::format("coordinates from {} to {}; expected a range up to 2^31 - 3",
                           least[axis], greatest[axis]);
    }
    const WholePlaces whole(least, greatest);
    BitReader reader(bits);
    std::size_t small_count = 0;  // stays until a group changes it
    for (std::size_t atom = 0; atom < places.size();) {
        if (small < first_small || small > last_small) {
            return fmt::format("differences of {} bits after atom {}; expected {} to {} bits",
                               small, atom, first_small, last_small);
        }
        IntegerPlace place = least;
        const auto from_least = reader.take_whole(whole);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            place[axis] = wrapped_sum(place[axis], from_least[axis]);
        }
        std::int32_t change = 0;
        if (reader.take(1) == 1) {
            const std::uint32_t code = reader.take(5);
            small_count = code / 3;
            change = static_cast<std::int32_t>(code % 3) - 1;
        }
        if (reader.is_exhausted())
            return fmt::format("packed coordinates end in atom {}", atom + 1);
        if (small_count >= places.size() - atom) {
            return fmt::format("a group of {} atoms behind atom {} of {}", small_count + 1, atom,
                               places.size());
        }
        const std::size_t exchanged = small_count > 0 ? 1 : 0;
        places[atom + exchanged] = place;
        const Sizes sizes = sizes_of_small(small);
        const std::int32_t half = half_of_small(small);
        for (std::size_t i = 0; i < small_count; ++i) {
            const auto numbers = reader.take_together(sizes);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                place[axis] = wrapped_sum(wrapped_sum(place[axis], numbers[axis]),
                                          static_cast<std::uint32_t>(-half));
            }
            places[i == 0 ? atom : atom + i + 1] = place;
        }
        atom += small_count + 1;
        if (reader.is_exhausted()) return fmt::format("packed coordinates end in atom {}", atom);
        small += change;
    }
    return {};
}

std::uint64_t most_packed_places(std::uint64_t bytes) noexcept {
    return 4 * bytes;  // a bit for the place, where all are at one, and one behind it
}

}  // namespace palpa
