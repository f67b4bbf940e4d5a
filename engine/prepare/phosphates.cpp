#include "prepare/phosphates.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace palpa {
namespace {

class PhosphateFinder {
public:
    explicit PhosphateFinder(const Connectivity& connectivity)
        : connectivity_(connectivity), bonded_(connectivity.names.size()) {
        for (const auto& [a, b] : connectivity.bonds) {
            bonded_[a].push_back(b);
            bonded_[b].push_back(a);
        }
    }

    // The free oxygens of the phosphate at an atom, where it is one that joins two residues.
    std::optional<std::array<std::uint32_t, 2>> find(std::uint32_t phosphorus) const {
        if (!is_element(phosphorus, 'P', 30) || bonded_[phosphorus].size() != 4) return {};
        std::vector<std::uint32_t> free, ends;
        for (const std::uint32_t oxygen : bonded_[phosphorus]) {
            if (!is_element(oxygen, 'O', 15)) return {};
            if (bonded_[oxygen].size() == 1) free.push_back(oxygen);
            for (const std::uint32_t next : bonded_[oxygen]) {
                if (next != phosphorus && is_element(next, 'C', 12)) ends.push_back(next);
            }
        }
        if (free.size() != 2 || ends.size() != 2) return {};
        const auto& names = connectivity_.names;
        if (is_same_residue(names[ends[0]], names[ends[1]])) return {};
        return std::array{free[0], free[1]};
    }

private:
    // By the first letter of its name and its mass, within 2 u.
    bool is_element(std::uint32_t atom, char letter, double mass) const {
        const double off = connectivity_.mass[atom] - mass;
        return connectivity_.names[atom].atom.starts_with(letter) && off > -2 && off < 2;
    }

    const Connectivity& connectivity_;
    std::vector<std::vector<std::uint32_t>> bonded_;
};

}  // namespace

std::size_t reduce_phosphates(const Connectivity& connectivity, std::span<double> charge) {
    const PhosphateFinder finder(connectivity);
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < connectivity.names.size(); ++i) {
        const auto oxygens = finder.find(i);
        if (!oxygens) continue;
        for (const std::uint32_t oxygen : *oxygens) {
            charge[oxygen] += (reduced_phosphate_charge + 1) / 2;
        }
        ++count;
    }
    return count;
}

}  // namespace palpa
