// Makes scenes/water's inputs from CHARMM's own water file: the reduced parameter file and two
// waters in the orientation of the dimer's lowest energy.
//   make_water_scene TOPPAR_WATER_IONS.str FOLDER
#include "charmm/force_field.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/units.h"
#include "field/pair_field.h"
#include "formats/crd.h"
#include "math/vec.h"
#include "molecule/atoms.h"

#include <fmt/format.h>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

namespace {

using palpa::Vec3;

constexpr double start_distance = 7;  // Å between the oxygens

struct Water {
    double bond = 0;                                      // Å
    double angle = 0;                                     // rad
    std::vector<double> charge, sqrt_epsilon, half_rmin;  // O, H, H
};

// O at `place`, the hydrogens at half the angle on both sides of `bisector` towards `across`.
std::vector<Vec3> build_water(const Water& water, const Vec3& place, const Vec3& bisector,
                              const Vec3& across) {
    const double along = water.bond * std::cos(water.angle / 2);
    const double aside = water.bond * std::sin(water.angle / 2);
    return {place, place + along * bisector + aside * across,
            place + along * bisector - aside * across};
}

// The dimer of lowest energy is symmetric about the xz plane: the acceptor's hydrogens stand on
// both sides of it, the donor lies in it. That leaves three variables: the distance of the oxygens
// and the direction of either bisector in the plane, as angles from x.
using Variables = Eigen::Vector3d;  // Å, rad, rad

std::vector<Vec3> acceptor(const Water& water, double direction) {
    return build_water(water, Vec3::Zero(), {std::cos(direction), 0, std::sin(direction)},
                       Vec3::UnitY());
}

std::vector<Vec3> donor(const Water& water, double distance, double direction) {
    return build_water(water, {distance, 0, 0}, {std::cos(direction), 0, std::sin(direction)},
                       {-std::sin(direction), 0, std::cos(direction)});
}

double energy(const Water& water, const Variables& v) {
    const std::vector<Vec3> fixed = acceptor(water, v(1)), moved = donor(water, v(0), v(2));
    return palpa::evaluate_pair_field({moved, water.charge, water.sqrt_epsilon, water.half_rmin},
                                      {fixed, water.charge, water.sqrt_epsilon, water.half_rmin},
                                      {palpa::units::charmm_coulomb_constant})
        .energy();
}

Variables gradient(const Water& water, const Variables& v) {
    constexpr double h = 1e-4;
    Variables slope;
    for (int i = 0; i < 3; ++i) {
        const Variables d = h * Variables::Unit(i);
        slope(i) = (8 * (energy(water, v + d) - energy(water, v - d)) -
                    (energy(water, v + 2 * d) - energy(water, v - 2 * d))) /
                   (12 * h);
    }
    return slope;
}

// Scan of both directions, then Newton's method.
Variables find_lowest(const Water& water) {
    constexpr double degree = std::numbers::pi / 180;
    Variables best(2.8, 0, 0);
    for (int a = 0; a < 360; a += 4) {
        for (int b = 0; b < 360; b += 4) {
            const Variables v(2.8, a * degree, b * degree);
            if (energy(water, v) < energy(water, best)) best = v;
        }
    }
    for (int iteration = 0; iteration < 50; ++iteration) {
        constexpr double h = 1e-4;
        Eigen::Matrix3d curvature;
        for (int i = 0; i < 3; ++i) {
            const Variables d = h * Variables::Unit(i);
            curvature.col(i) = (gradient(water, best + d) - gradient(water, best - d)) / (2 * h);
        }
        Variables step = -curvature.inverse() * gradient(water, best);
        if (const double length = step.norm(); length > 0.05) step *= 0.05 / length;
        if (energy(water, best + step) > energy(water, best) + 1e-9) step *= 0.1;
        best += step;
        if (step.norm() < 1e-11) break;
    }
    return best;
}

Water find_water(const palpa::ForceField& force_field) {
    Water water;
    water.bond = force_field.bonds.at({"HT", "OT"}).value;
    water.angle = force_field.angles.at({"HT", "OT", "HT"}).value * std::numbers::pi / 180;
    for (const palpa::ResidueAtom& atom : force_field.residues.at("TIP3").atoms) {
        const palpa::NonbondedType& type = force_field.nonbonded.at(atom.type);
        water.charge.push_back(atom.charge);
        water.sqrt_epsilon.push_back(std::sqrt(type.epsilon));
        water.half_rmin.push_back(type.half_rmin);
    }
    return water;
}

std::string format_parameters(const palpa::ForceField& force_field, const std::string& origin) {
    std::string text = fmt::format(
        "* TIP3P water, CHARMM's variant with Lennard-Jones on the hydrogens: only what\n"
        "* two rigid waters need of CHARMM36's {}\n"
        "* (additive force field, July 2024 release). W.L. Jorgensen, J. Chandrasekhar,\n"
        "* J.D. Madura, R.W. Impey, M.L. Klein, J. Chem. Phys. 79, 926 (1983). The CHARMM\n"
        "* force field is freely distributed; cite it where you use it.\n"
        "* Made by make_water_scene; see scenes/water/README.md.\n*\n\nread rtf card\n* TIP3P\n*\n"
        "36 1\n",
        origin);
    for (const char* const name : {"HT", "OT"}) {
        const palpa::AtomType& type = force_field.types.at(name);
        text += fmt::format("MASS -1 {:<4}{:10.5f} {}\n", name, type.mass, type.element);
    }
    const palpa::Residue& residue = force_field.residues.at("TIP3");
    text += fmt::format("\nRESI TIP3 {:8.3f}\n", residue.charge);
    for (const palpa::ResidueAtom& atom : residue.atoms) {
        text += fmt::format("ATOM {:<4} {:<4}{:8.3f}\n", atom.name, atom.type, atom.charge);
    }
    text += "BOND OH2 H1  OH2 H2\nEND\n\nread para card\n* TIP3P\n*\n\nNONBONDED\n";
    for (const char* const name : {"HT", "OT"}) {
        const palpa::NonbondedType& type = force_field.nonbonded.at(name);
        text += fmt::format("{:<4} 0.0 {:9.4f} {:9.4f}\n", name, -type.epsilon, type.half_rmin);
    }
    return text + "END\n";
}

std::string format_dimer(const Water& water, const Variables& lowest) {
    palpa::Structure dimer;
    const auto add = [&](const char* segment, const std::vector<Vec3>& places) {
        const std::array<const char*, 3> names{"OH2", "H1", "H2"};
        for (std::size_t i = 0; i < names.size(); ++i) {
            dimer.names.push_back({segment, "TIP3", "1", names[i]});
            // Six decimals are far below what matters, and the same from every compiler.
            dimer.positions.emplace_back(1e-6 * (1e6 * places[i]).array().round());
        }
    };
    add("FIX", acceptor(water, lowest(1)));
    add("MOV", donor(water, start_distance, lowest(2)));
    return palpa::format_crd(
        dimer,
        fmt::format(
            "Two rigid TIP3P waters (O-H {} A, H-O-H {:.2f} deg), oxygens on the x axis\n"
            "{} A apart, turned as in the dimer of lowest energy: {:.4f} kcal/mol at {:.4f} A.\n"
            "Made by make_water_scene; see scenes/water/README.md.",
            water.bond, water.angle * 180 / std::numbers::pi, start_distance, energy(water, lowest),
            lowest(0)));
}

int make_scene(const std::filesystem::path& toppar, const std::filesystem::path& folder) {
    const std::vector<std::filesystem::path> files{toppar};
    const palpa::ForceField force_field = palpa::read_force_field(files);
    const Water water = find_water(force_field);
    const Variables lowest = find_lowest(water);
    palpa::write_text_file(folder / "tip3p.str",
                           format_parameters(force_field, toppar.filename().string()));
    palpa::write_text_file(folder / "dimer.crd", format_dimer(water, lowest));
    fmt::print("lowest energy {:.4f} kcal/mol at {:.4f} Å between the oxygens\n",
               energy(water, lowest), lowest(0));
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc == 3) return make_scene(argv[1], argv[2]);
        fmt::print(stderr, "usage: make_water_scene TOPPAR_WATER_IONS.str FOLDER\n");
    } catch (const std::exception& error) {
        fmt::print(stderr, "make_water_scene: {}\n", error.what());
    }
    return 2;
}
