// Makes scenes/water's inputs from CHARMM's own water file: the reduced parameter file and two
// waters in the orientation of the dimer's lowest energy.
//   make_water_scene TOPPAR_WATER_IONS.str FOLDER
#include "charmm/force_field.h"
#include "core/files.h"
#include "core/load_error.h"
#include "formats/crd.h"
#include "math/vec.h"
#include "tools/lab/experiments/water_dimer.h"

#include <fmt/format.h>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

namespace {

using palpa::Vec3;

constexpr double start_distance = 7;  // Å between the oxygens

std::string format_parameters(const palpa::ForceField& force_field, const std::string& origin) {
    std::string text = fmt::format(
        "* TIP3P water, CHARMM's variant with Lennard-Jones on the hydrogens: only what\n"
        "* waters need of CHARMM36's {}\n"
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
    text += "BOND OH2 H1  OH2 H2\nANGLE H1 OH2 H2\nEND\n\nread para card\n* TIP3P\n*\n\nBONDS\n";
    const palpa::HarmonicParameter& bond = force_field.bonds.at(palpa::in_order("OT", "HT"));
    const palpa::AngleParameter& angle = force_field.angles.at({"HT", "OT", "HT"});
    text += fmt::format(
        "HT   OT   {:9.1f} {:9.4f}\n\nANGLES\nHT   OT   HT   {:9.1f} {:9.2f}\n\nNONBONDED\n",
        bond.k, bond.value, angle.k, angle.value);
    for (const char* const name : {"HT", "OT"}) {
        const palpa::NonbondedType& type = force_field.nonbonded.at(name);
        text += fmt::format("{:<4} 0.0 {:9.4f} {:9.4f}\n", name, -type.epsilon, type.half_rmin);
    }
    return text + "END\n";
}

std::string format_dimer(const palpa::RigidWater& water, const palpa::WaterDimer& lowest) {
    palpa::Structure dimer;
    const auto add = [&](const char* segment, const std::vector<Vec3>& places) {
        const std::array<const char*, 3> names{"OH2", "H1", "H2"};
        for (std::size_t i = 0; i < names.size(); ++i) {
            dimer.names.push_back({segment, "TIP3", "1", names[i]});
            // Six decimals are far below what matters, and the same from every compiler.
            dimer.positions.emplace_back(1e-6 * (1e6 * places[i]).array().round());
        }
    };
    add("FIX", palpa::place_acceptor(water, lowest.acceptor));
    add("MOV", palpa::place_donor(water, start_distance, lowest.donor));
    return palpa::format_crd(
        dimer,
        fmt::format(
            "Two rigid TIP3P waters (O-H {} A, H-O-H {:.2f} deg), oxygens on the x axis\n"
            "{} A apart, turned as in the dimer of lowest energy: {:.4f} kcal/mol at {:.4f} A.\n"
            "Made by make_water_scene; see scenes/water/README.md.",
            water.bond, water.angle * 180 / std::numbers::pi, start_distance, lowest.energy,
            lowest.distance));
}

// Nothing is replaced.
void check_is_new(const std::filesystem::path& file) {
    if (std::filesystem::exists(file))
        throw palpa::LoadError({file.string()}, "is there already; expected another folder");
}

int make_scene(const std::filesystem::path& toppar, const std::filesystem::path& folder) {
    check_is_new(folder / "tip3p.str");
    check_is_new(folder / "dimer.crd");
    const std::vector<std::filesystem::path> files{toppar};
    const palpa::ForceField force_field = palpa::read_force_field(files);
    const palpa::RigidWater water = palpa::find_water(force_field);
    const palpa::WaterDimer lowest = palpa::find_lowest_dimer(water);
    palpa::write_text_file(folder / "tip3p.str",
                           format_parameters(force_field, toppar.filename().string()));
    palpa::write_text_file(folder / "dimer.crd", format_dimer(water, lowest));
    fmt::print("lowest energy {:.4f} kcal/mol at {:.4f} Å between the oxygens\n", lowest.energy,
               lowest.distance);
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
