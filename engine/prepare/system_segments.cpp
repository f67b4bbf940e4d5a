#include "prepare/system_segments.h"

#include "molecule/residue_kinds.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <numeric>

namespace palpa {
namespace {

// Which of so many things belong together.
class Groups {
public:
    explicit Groups(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    // The lowest of the group.
    std::uint32_t first_of(std::uint32_t i) noexcept {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    void join(std::uint32_t a, std::uint32_t b) noexcept {
        const std::uint32_t first = first_of(a), other = first_of(b);
        parent_[std::max(first, other)] = std::min(first, other);
    }

private:
    std::vector<std::uint32_t> parent_;
};

Groups find_pieces(const Connectivity& connectivity, std::size_t atoms) {
    Groups pieces(atoms);
    for (const auto& [a, b] : connectivity.bonds) pieces.join(a, b);
    return pieces;
}

SegmentKind kind_of(const SystemSegment& segment, const Structure& structure, Groups& pieces) {
    const auto is_of_water = [&](std::uint32_t atom) {
        return is_water(structure.names[atom].residue);
    };
    if (std::ranges::all_of(segment.atoms, is_of_water)) return SegmentKind::Water;
    constexpr std::size_t largest_ion = 3;  // atoms
    const bool is_whole = std::ranges::all_of(segment.atoms, [&](std::uint32_t atom) {
        return pieces.first_of(atom) == pieces.first_of(segment.atoms.front());
    });
    return is_whole && segment.atoms.size() > largest_ion ? SegmentKind::Molecule
                                                          : SegmentKind::Other;
}

// The number of each atom's segment, in the order of their first atoms.
std::vector<std::uint32_t> number_segments(const Structure& structure) {
    std::map<std::string, std::uint32_t> numbers;
    std::vector<std::uint32_t> result;
    result.reserve(structure.names.size());
    for (const AtomName& name : structure.names) {
        const auto next = static_cast<std::uint32_t>(numbers.size());
        result.push_back(numbers.try_emplace(name.segment, next).first->second);
    }
    return result;
}

}  // namespace

std::vector<SystemSegment> find_segments(const Structure& structure,
                                         const Connectivity& connectivity) {
    std::vector<SystemSegment> segments;
    const std::vector<std::uint32_t> numbers = number_segments(structure);
    for (std::uint32_t atom = 0; atom < numbers.size(); ++atom) {
        if (numbers[atom] == segments.size()) {
            segments.push_back({structure.names[atom].segment, {}, {}});
        }
        segments[numbers[atom]].atoms.push_back(atom);
    }
    Groups pieces = find_pieces(connectivity, numbers.size());
    for (SystemSegment& segment : segments) segment.kind = kind_of(segment, structure, pieces);
    return segments;
}

std::vector<std::vector<std::string>> join_bonded_segments(Structure& structure,
                                                           Connectivity& connectivity) {
    const std::vector<std::uint32_t> numbers = number_segments(structure);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (numbers[i] == names.size()) names.push_back(structure.names[i].segment);
    }
    Groups groups(names.size());
    for (const auto& [a, b] : connectivity.bonds) groups.join(numbers[a], numbers[b]);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const std::uint32_t first = groups.first_of(numbers[i]);
        if (first == numbers[i]) continue;
        for (AtomName* const name : {&structure.names[i], &connectivity.names[i]}) {
            name->number = names[numbers[i]] + ":" + name->number;
            name->segment = names[first];
        }
    }
    std::map<std::uint32_t, std::vector<std::string>> joined;
    for (std::uint32_t i = 0; i < names.size(); ++i) joined[groups.first_of(i)].push_back(names[i]);
    std::vector<std::vector<std::string>> result;
    for (auto& [first, members] : joined) {
        if (members.size() > 1) result.push_back(std::move(members));
    }
    return result;
}

}  // namespace palpa
