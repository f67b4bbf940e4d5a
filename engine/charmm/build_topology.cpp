#include "charmm/build_topology.h"

#include "charmm/find_parameters.h"
#include "charmm/missing.h"
#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr double radian_per_degree = std::numbers::pi / 180;

// What stands as types in the key of a parameter.
Types<2> types_of(const std::pair<std::string, std::string>& key) {
    return {key.first, key.second};
}
template <std::size_t Size>
Types<Size> types_of(const Types<Size>& key) {
    return key;
}

// The hint of the entry that has all types but one, read either way.
template <std::size_t Size, class Map>
std::string near_types_hint(const Types<Size>& types, const Map& map) {
    const std::string wanted = fmt::format("{}", fmt::join(types, " "));
    std::vector<std::string> near;
    for (const auto& entry : map) {
        Types<Size> known = types_of(entry.first);
        for (int direction = 0; direction < 2; ++direction) {
            std::size_t differing = 0;
            for (std::size_t i = 0; i < Size; ++i) differing += known[i] == types[i] ? 0 : 1;
            if (differing == 1) near.push_back(fmt::format("{}", fmt::join(known, " ")));
            std::reverse(known.begin(), known.end());
        }
    }
    return near_name_hint(wanted, std::vector<std::string_view>(near.begin(), near.end()));
}

class Builder {
public:
    Builder(const Connectivity& connectivity, const ForceField& force_field)
        : connectivity_(connectivity), force_field_(force_field) {}

    Topology build() {
        add_types();
        check_parameters();
        topology_.charge = connectivity_.charge;
        add_bonds();
        add_angles();
        add_dihedrals();
        add_impropers();
        add_cmaps();
        missing_.throw_if_any();
        add_lennard_jones();
        topology_.exclusions = build_exclusions(topology_.bonds, topology_.size());
        return std::move(topology_);
    }

private:
    void add_types() {
        std::map<std::string_view, std::uint32_t> index_of;  // by what the structure calls the type
        for (std::size_t i = 0; i < connectivity_.type.size(); ++i) {
            const auto [known, is_new] = index_of.try_emplace(connectivity_.type[i], 0);
            if (is_new) {
                known->second = add_type(connectivity_.type[i],
                                         {connectivity_.file, connectivity_.lines[i], 0});
            }
            topology_.type.push_back(known->second);
        }
    }

    std::uint32_t add_type(const std::string& called, const TextPlace& place) {
        const auto* const type = find_type(force_field_, called, place, missing_);
        const std::string& name = type ? type->first : called;
        if (type) find_nonbonded(force_field_, name, place, missing_);
        const auto found = std::find(type_names_.begin(), type_names_.end(), name);
        const auto index = static_cast<std::uint32_t>(found - type_names_.begin());
        if (found == type_names_.end()) {
            type_names_.push_back(name);
            type_is_known_.push_back(type != nullptr);
        }
        return index;
    }

    // Without any parameters every term would lack its own.
    void check_parameters() const {
        if (force_field_.bonds.empty() && force_field_.nonbonded.empty()) missing_.throw_if_any();
    }

    // The parameter of some atoms, looked up once for each tuple of types; null, noted as missing
    // on the line of the first atom, where there is none.
    template <std::size_t Size, class Parameter, class Find, class Map>
    const Parameter* find_once(const std::array<std::uint32_t, Size>& atoms,
                               std::map<std::array<std::uint32_t, Size>, const Parameter*>& known,
                               const char* what, const Map& parameters, const Find& find) {
        std::array<std::uint32_t, Size> indices{};
        for (std::size_t i = 0; i < Size; ++i) indices[i] = topology_.type[atoms[i]];
        const auto [entry, is_new] = known.try_emplace(indices, nullptr);
        if (!is_new) return entry->second;
        // An unknown type has been reported.
        if (!std::all_of(indices.begin(), indices.end(),
                         [&](std::uint32_t type) { return type_is_known_[type]; })) {
            return nullptr;
        }
        Types<Size> types;
        for (std::size_t i = 0; i < Size; ++i) types[i] = type_names_[indices[i]];
        entry->second = find(force_field_, types);
        if (!entry->second) {
            missing_.add({connectivity_.file, connectivity_.lines[atoms[0]], 0},
                         fmt::format("no {} parameters for {}{}", what, fmt::join(types, " "),
                                     near_types_hint(types, parameters)));
        }
        return entry->second;
    }

    void add_bonds() {
        std::map<std::array<std::uint32_t, 2>, const HarmonicParameter*> known;
        for (const auto& atoms : connectivity_.bonds) {
            const auto* const bond = find_once(atoms, known, "bond", force_field_.bonds, find_bond);
            if (bond) topology_.bonds.push_back({atoms[0], atoms[1], bond->k, bond->value});
        }
    }

    void add_angles() {
        std::map<std::array<std::uint32_t, 3>, const AngleParameter*> known;
        for (const auto& atoms : connectivity_.angles) {
            const auto* const angle =
                find_once(atoms, known, "angle", force_field_.angles, find_angle);
            if (!angle) continue;
            topology_.angles.push_back(
                {atoms[0], atoms[1], atoms[2], angle->k, angle->value * radian_per_degree});
            if (angle->urey_bradley_k != 0) {
                topology_.urey_bradleys.push_back(
                    {atoms[0], atoms[2], angle->urey_bradley_k, angle->urey_bradley_s0});
            }
        }
    }

    // Entries with n = 0 are harmonic, others a cosine, whichever section they come from.
    void add_terms(const std::array<std::uint32_t, 4>& atoms,
                   const std::vector<DihedralTerm>& terms) {
        const auto [a, b, c, d] = atoms;
        for (const DihedralTerm& term : terms) {
            if (term.k == 0) continue;
            const double phase = term.phase_deg * radian_per_degree;
            if (term.multiplicity == 0) {
                topology_.impropers.push_back({a, b, c, d, term.k, phase});
            } else {
                topology_.dihedrals.push_back({a, b, c, d, term.multiplicity, term.k, phase});
            }
        }
    }

    void add_dihedrals() {
        std::map<std::array<std::uint32_t, 4>, const std::vector<DihedralTerm>*> known;
        std::set<std::array<std::uint32_t, 4>> seen;
        for (const auto& atoms : connectivity_.dihedrals) {
            const std::array reversed{atoms[3], atoms[2], atoms[1], atoms[0]};
            if (!seen.insert(std::min(atoms, reversed)).second) continue;
            const auto* const terms =
                find_once(atoms, known, "dihedral", force_field_.dihedrals, find_dihedral);
            if (terms) add_terms(atoms, *terms);
        }
    }

    void add_impropers() {
        std::map<std::array<std::uint32_t, 4>, const std::vector<DihedralTerm>*> known;
        for (const auto& atoms : connectivity_.impropers) {
            const auto* const terms =
                find_once(atoms, known, "improper", force_field_.impropers, find_improper);
            if (terms) add_terms(atoms, *terms);
        }
    }

    void add_cmaps() {
        std::map<std::array<std::uint32_t, 8>, const CmapParameter*> known;
        std::map<const CmapParameter*, std::uint32_t> index_of;
        for (const auto& atoms : connectivity_.cmaps) {
            const auto* const cmap = find_once(atoms, known, "CMAP", force_field_.cmaps, find_cmap);
            if (!cmap) continue;
            const auto [map, is_new] =
                index_of.try_emplace(cmap, static_cast<std::uint32_t>(topology_.cmap_maps.size()));
            if (is_new) topology_.cmap_maps.push_back(build_cmap_map(cmap->energies));
            topology_.cmap_terms.push_back({{atoms[0], atoms[1], atoms[2], atoms[3]},
                                            {atoms[4], atoms[5], atoms[6], atoms[7]},
                                            map->second});
        }
    }

    // Of the types that occur.
    void add_lennard_jones() {
        std::vector<LennardJonesType> plain, special;
        std::map<std::string_view, std::uint32_t> index_of;
        for (const std::string& name : type_names_) {
            const NonbondedType& type = force_field_.nonbonded.find(name)->second;
            index_of.emplace(name, static_cast<std::uint32_t>(plain.size()));
            plain.push_back({type.epsilon, type.half_rmin});
            special.push_back({type.epsilon14, type.half_rmin14});
        }
        std::vector<Nbfix> nbfix, nbfix14;
        for (const auto& [types, pair] : force_field_.nbfix) {
            const auto a = index_of.find(types.first), b = index_of.find(types.second);
            if (a == index_of.end() || b == index_of.end()) continue;
            nbfix.push_back({a->second, b->second, {pair.epsilon, pair.rmin}});
            nbfix14.push_back({a->second, b->second, {pair.epsilon14, pair.rmin14}});
        }
        topology_.lennard_jones = build_lennard_jones_table(plain, nbfix);
        topology_.lennard_jones14 = build_lennard_jones_table(special, nbfix14);
    }

    const Connectivity& connectivity_;
    const ForceField& force_field_;
    Missing missing_;
    std::vector<std::string> type_names_;  // of the types that occur, by index
    std::vector<bool> type_is_known_;      // likewise
    Topology topology_;
};

}  // namespace

Topology build_topology(const Connectivity& connectivity, const ForceField& force_field) {
    return Builder(connectivity, force_field).build();
}

}  // namespace palpa
