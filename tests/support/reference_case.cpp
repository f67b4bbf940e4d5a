#include "tests/support/reference_case.h"

#include "tests/support/read_json.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace palpa::test {

ReferenceCase read_reference_case(const std::filesystem::path& path) {
    constexpr double radian = std::numbers::pi / 180;
    constexpr double half = 0.5 * kcal_per_kilojoule;
    constexpr double half_per_angstrom2 = half / (angstrom_per_nm * angstrom_per_nm);
    const double rmin_per_sigma = angstrom_per_nm * std::pow(2, 1.0 / 6);
    const nlohmann::json json = read_json(path);
    ReferenceCase result;
    Topology& topology = result.topology;

    std::map<std::string, std::uint32_t> type_of_name;
    std::vector<LennardJonesType> types;
    for (const auto& row : json["atoms"]["rows"]) {
        const LennardJonesType type{row[7].get<double>() * kcal_per_kilojoule,
                                    row[6].get<double>() * rmin_per_sigma / 2};
        const auto [found, is_new] = type_of_name.try_emplace(
            row[3].get<std::string>(), static_cast<std::uint32_t>(types.size()));
        if (is_new) types.push_back(type);
        if (types[found->second].epsilon != type.epsilon ||
            types[found->second].half_rmin != type.half_rmin)
            throw std::runtime_error("type " + found->first + " has two sets of numbers");
        topology.type.push_back(found->second);
        topology.charge.push_back(row[5]);
        result.atoms.push_back({row[0], row[1], row[3], row[2], row[4], row[5], {}});
        if (row.size() > 8) result.atoms.back().segment = row[8];
    }
    for (const auto& t : json["bond"]) {
        topology.bonds.push_back(
            {t[0], t[1], t[3].get<double>() * half_per_angstrom2, t[2].get<double>() * 10});
    }
    for (const auto& t : json["angle"]) {
        topology.angles.push_back(
            {t[0], t[1], t[2], t[4].get<double>() * half, t[3].get<double>() * radian});
    }
    for (const auto& t : json["urey"]) {
        topology.urey_bradleys.push_back(
            {t[0], t[1], t[3].get<double>() * half_per_angstrom2, t[2].get<double>() * 10});
    }
    for (const auto& t : json["proper"]) {
        topology.dihedrals.push_back({t[0], t[1], t[2], t[3], t[6],
                                      t[5].get<double>() * kcal_per_kilojoule,
                                      t[4].get<double>() * radian});
    }
    for (const auto& t : json["improper"]) {
        topology.impropers.push_back(
            {t[0], t[1], t[2], t[3], t[5].get<double>() * half, t[4].get<double>() * radian});
    }
    for (const auto& t : json["cmap"]) {
        topology.cmap_terms.push_back({{t[0], t[1], t[2], t[3]}, {t[1], t[2], t[3], t[4]}, t[5]});
    }
    for (const auto& map : json["cmap_maps"]) {
        std::vector<double> energies;
        for (const double energy : map) energies.push_back(energy * kcal_per_kilojoule);
        topology.cmap_maps.push_back(build_cmap_map(energies));
    }

    std::vector<Nbfix> nbfix;
    if (json.contains("nbfix")) {
        for (const auto& t : json["nbfix"]) {
            nbfix.push_back(
                {type_of_name.at(t[0]),
                 type_of_name.at(t[1]),
                 {t[3].get<double>() * kcal_per_kilojoule, t[2].get<double>() * rmin_per_sigma}});
        }
    }
    topology.lennard_jones = build_lennard_jones_table(types, nbfix);
    // The file gives the numbers of every 1-4 pair; they follow from the two types.
    std::vector<Nbfix> given14;
    for (const auto& t : json["pair14"]) {
        const std::uint32_t a = t[0], b = t[1];
        topology.exclusions.pairs14.push_back({a, b});
        given14.push_back(
            {topology.type[a],
             topology.type[b],
             {t[3].get<double>() * kcal_per_kilojoule, t[2].get<double>() * rmin_per_sigma}});
    }
    topology.lennard_jones14 = build_lennard_jones_table(types, given14);
    topology.exclusions.first.push_back(0);
    for (const auto& row : json["exclusions"]) {
        for (const std::uint32_t other : row) topology.exclusions.atoms.push_back(other);
        topology.exclusions.first.push_back(
            static_cast<std::uint32_t>(topology.exclusions.atoms.size()));
    }
    return result;
}

std::vector<ReferenceFrame> read_reference_frames(const std::filesystem::path& path) {
    const auto vectors = [](const nlohmann::json& rows, double factor) {
        std::vector<Vec3> result;
        for (const auto& row : rows) {
            result.push_back(
                factor * Vec3(row[0].get<double>(), row[1].get<double>(), row[2].get<double>()));
        }
        return result;
    };
    constexpr double force = kcal_per_kilojoule / angstrom_per_nm;
    std::vector<ReferenceFrame> frames;
    const nlohmann::json file = read_json(path);
    for (const auto& json : file["frames"]) {
        ReferenceFrame frame;
        frame.name = json["name"];
        for (const auto& [term, energy] : json["energy"].items()) {
            frame.energy[term] = energy.get<double>() * kcal_per_kilojoule;
        }
        frame.positions = vectors(json["x"], angstrom_per_nm);
        frame.forces = vectors(json["f"], force);
        if (json.contains("f_terms")) {
            for (const auto& [term, forces] : json["f_terms"].items()) {
                frame.forces_by_term[term] = vectors(forces, force);
            }
        }
        frames.push_back(frame);
    }
    return frames;
}

}  // namespace palpa::test
