// Makes scenes/hiv's inputs from the reference set's HIV-1 protease with TL-3: structure,
// coordinates and the reduced parameter file.
//   make_hiv_scene FORCE_FIELD.json FRAME.json FOLDER
#include "core/files.h"
#include "core/load_error.h"
#include "core/units.h"
#include "formats/crd.h"
#include "formats/psf.h"
#include "math/vec.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

using palpa::Vec3;

constexpr double angstrom_per_nm = 10;
constexpr std::string_view ligand = "TL3";

// The protein's chains and the inhibitor, under names that say what they are.
std::string segment_name(const std::string& name) {
    return name == "S0" ? "PROA" : name == "S1" ? "PROB" : std::string(ligand);
}

struct Lennard {
    double epsilon = 0, rmin = 0;  // kcal/mol, Å
};

Lennard from_sigma(double sigma_nm, double epsilon_kJ) {
    return {epsilon_kJ * 1e3 / palpa::units::joule_per_kcal,
            sigma_nm * angstrom_per_nm * std::pow(2.0, 1.0 / 6)};
}

struct Type {
    double mass = 0;  // amu
    Lennard lennard;
};

struct System {
    palpa::Connectivity connectivity;
    std::map<std::string, Type> types;
    std::map<std::pair<std::string, std::string>, Lennard> nbfix;
};

System build_system(const nlohmann::json& force_field) {
    System system;
    for (const nlohmann::json& row : force_field.at("atoms").at("rows")) {
        const auto type = row.at(3).get<std::string>();
        palpa::Connectivity& connectivity = system.connectivity;
        connectivity.names.push_back({segment_name(row.at(8)), row.at(1),
                                      fmt::format("{}", row.at(2).get<int>()), row.at(0)});
        connectivity.type.push_back(type);
        connectivity.mass.push_back(row.at(4));
        connectivity.charge.push_back(row.at(5));
        system.types[type] = {row.at(4), from_sigma(row.at(6), row.at(7))};
    }
    for (const nlohmann::json& bond : force_field.at("bond")) {
        system.connectivity.bonds.push_back({bond.at(0), bond.at(1)});
    }
    for (const nlohmann::json& pair : force_field.at("nbfix")) {
        system.nbfix[{pair.at(0), pair.at(1)}] = from_sigma(pair.at(2), pair.at(3));
    }
    return system;
}

std::vector<Vec3> read_places(const nlohmann::json& frame) {
    std::vector<Vec3> places;
    for (const nlohmann::json& place : frame.at("frames").at(0).at("x")) {
        places.emplace_back(place.at(0), place.at(1), place.at(2));
        places.back() *= angstrom_per_nm;
    }
    return places;
}

// Mean place of the atoms that a rule picks.
template <class Rule>
Vec3 mean_place(const palpa::Connectivity& connectivity, const std::vector<Vec3>& places,
                const Rule& rule) {
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!rule(connectivity.names[i], connectivity.mass[i])) continue;
        sum += places[i];
        ++count;
    }
    return sum / count;
}

bool is_heavy_ligand_atom(const palpa::AtomName& name, double mass) {
    return name.segment == ligand && mass > 2;
}

// Turns everything so that the inhibitor's long axis, and with it the tunnel, lies along x, from
// chain A towards chain B, that y goes from the catalytic aspartates to the flaps, and that the
// inhibitor's middle is at the origin. Six decimals are far below what matters, and the same from
// every compiler.
std::vector<Vec3> orient(const palpa::Connectivity& connectivity, std::vector<Vec3> places) {
    const Vec3 middle = mean_place(connectivity, places, is_heavy_ligand_atom);
    palpa::Mat3 spread = palpa::Mat3::Zero();
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!is_heavy_ligand_atom(connectivity.names[i], connectivity.mass[i])) continue;
        spread += (places[i] - middle) * (places[i] - middle).transpose();
    }
    const auto place_of = [&](std::string_view segment, std::string_view number,
                              std::string_view atom) {
        return mean_place(connectivity, places, [&](const palpa::AtomName& name, double) {
            return name.segment != ligand && (segment.empty() || name.segment == segment) &&
                   name.number == number && name.atom == atom;
        });
    };
    Vec3 x = Eigen::SelfAdjointEigenSolver<palpa::Mat3>(spread).eigenvectors().col(2);
    if (x.dot(place_of("PROB", "25", "CA") - place_of("PROA", "25", "CA")) < 0) x = -x;
    Vec3 y = place_of("", "50", "CA") - place_of("", "25", "CG");
    y = (y - y.dot(x) * x).normalized();
    palpa::Mat3 turn;
    turn << x.transpose(), y.transpose(), x.cross(y).transpose();
    for (Vec3& place : places) {
        place = 1e-6 * (1e6 * (turn * (place - middle))).array().round();
    }
    return places;
}

constexpr std::string_view origin =
    "HIV-1 protease with the inhibitor TL-3: a stand-in for PDB entry 2AZ8.\n"
    "Protein 5VEA, TL-3 of 5W5W superposed on it, hydrogens built, all of it\n"
    "relaxed for 300 steps in CHARMM36m; both Asp 25 charged. TL-3 has a draft\n"
    "CGenFF-typed residue, its charges by analogy. See scenes/hiv/README.md.\n"
    "Made by make_hiv_scene.";

std::string format_parameters(const System& system) {
    std::string text;
    for (const std::string_view line :
         {"HIV-1 protease with the inhibitor TL-3: only what the rigid scene needs of",
          "CHARMM36m (protein, July 2024 release) and CGenFF 4.6 (TL-3). The CHARMM force",
          "field is freely distributed; cite J. Huang et al., Nat. Methods 14, 71 (2017) and",
          "K. Vanommeslaeghe et al., J. Comput. Chem. 31, 671 (2010) where you use it.",
          "Made by make_hiv_scene; see scenes/hiv/README.md."}) {
        text += fmt::format("* {}\n", line);
    }
    text += "*\n\nATOMS\n";
    for (const auto& [name, type] : system.types) {
        const char* const element = type.mass < 2    ? "H"
                                    : type.mass < 13 ? "C"
                                    : type.mass < 15 ? "N"
                                    : type.mass < 17 ? "O"
                                                     : "S";
        text += fmt::format("MASS -1 {:<6}{:10.5f} {}\n", name, type.mass, element);
    }
    text += "\nNONBONDED\n";
    for (const auto& [name, type] : system.types) {
        text += fmt::format("{:<6} 0.0 {:10.6f} {:10.6f}\n", name, -type.lennard.epsilon,
                            type.lennard.rmin / 2);
    }
    text += "\nNBFIX\n";
    for (const auto& [types, lennard] : system.nbfix) {
        text += fmt::format("{:<6} {:<6} {:10.6f} {:10.6f}\n", types.first, types.second,
                            -lennard.epsilon, lennard.rmin);
    }
    return text + "END\n";
}

nlohmann::json read_json(const std::filesystem::path& path) {
    return nlohmann::json::parse(palpa::read_text_file(path));
}

int make_scene(const std::filesystem::path& force_field, const std::filesystem::path& frame,
               const std::filesystem::path& folder) {
    const System system = build_system(read_json(force_field));
    const std::vector<Vec3> places = read_places(read_json(frame));
    if (places.size() != system.connectivity.names.size()) {
        throw palpa::LoadError({frame.string()},
                               fmt::format("{} atoms; expected the {} of the force field",
                                           places.size(), system.connectivity.names.size()));
    }
    palpa::Structure structure;
    structure.names = system.connectivity.names;
    structure.positions = orient(system.connectivity, places);
    palpa::write_text_file(
        folder / "system.psf",
        palpa::format_psf(system.connectivity, fmt::format("{}\nAtoms and bonds only: all that "
                                                           "rigid molecules need.",
                                                           origin)));
    palpa::write_text_file(folder / "system.crd", palpa::format_crd(structure, origin));
    palpa::write_text_file(folder / "system.prm", format_parameters(system));
    fmt::print("{} atoms, {} bonds, {} types, {} replaced pairs\n", places.size(),
               system.connectivity.bonds.size(), system.types.size(), system.nbfix.size());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc == 4) return make_scene(argv[1], argv[2], argv[3]);
        fmt::print(stderr, "usage: make_hiv_scene FORCE_FIELD.json FRAME.json FOLDER\n");
    } catch (const std::exception& error) {
        fmt::print(stderr, "make_hiv_scene: {}\n", error.what());
    }
    return 2;
}
