#include "charmm/force_field.h"
#include "tools/lab/commands/commands.h"
#include "tools/lab/experiments/ligand_comparison.h"

#include <fmt/format.h>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace palpa {
namespace {

struct CompareLigandsCommand {
    std::vector<std::filesystem::path> toppar;
    std::vector<std::string> residues;
    int count = 30;
    bool json = false;
};

nlohmann::ordered_json as_json(const LigandComparison& row) {
    nlohmann::ordered_json json{{"residue", row.residue},
                                {"atoms", row.atoms},
                                {"right_types", row.right_types},
                                {"heavy", row.heavy},
                                {"right_heavy", row.right_heavy},
                                {"charge_rms", row.charge_rms},
                                {"analogies", row.analogies},
                                {"highest_penalty", row.highest_penalty},
                                {"wrong", row.wrong}};
    json["poses"] = nlohmann::ordered_json::array();
    for (const WaterPose& pose : row.poses) {
        json["poses"].push_back(
            {{"atom", pose.atom}, {"own", pose.own}, {"approximate", pose.approximate}});
    }
    return json;
}

void print_row(const LigandComparison& row) {
    std::string wrong;
    for (const auto& [atom, own, made] : row.wrong) {
        if (!made.starts_with("H")) wrong += fmt::format(" {}: {}, not {}", atom, made, own);
    }
    fmt::print("| {:<5} | {:3}/{:<3} | {:5.3f} | {:3} | {:5.0f} | {:2} | {:5.2f} |{} |\n",
               row.residue, row.right_types, row.atoms, row.charge_rms, row.analogies,
               row.highest_penalty, row.poses.size(), row.pose_rms(), wrong);
}

void print_sum(const std::vector<LigandComparison>& rows) {
    std::size_t atoms = 0, right = 0, heavy = 0, right_heavy = 0, poses = 0;
    double charges = 0, energies = 0, own = 0;
    for (const LigandComparison& row : rows) {
        atoms += row.atoms;
        right += row.right_types;
        heavy += row.heavy;
        right_heavy += row.right_heavy;
        charges += row.charge_rms * row.charge_rms * static_cast<double>(row.atoms);
        for (const WaterPose& pose : row.poses) {
            ++poses;
            energies += (pose.approximate - pose.own) * (pose.approximate - pose.own);
            own += pose.own;
        }
    }
    const auto mean = [](double sum, std::size_t n) {
        return n == 0 ? 0 : sum / static_cast<double>(n);
    };
    fmt::print(
        "correct types: {} of {} ({:.1f} %), for heavy atoms {} of {} ({:.1f} %); charges: rms "
        "error {:.3f} e; energy with a water at {} places: rms error {:.2f} kcal/mol, mean size "
        "{:.2f} kcal/mol\n",
        right, atoms, 100 * mean(static_cast<double>(right), atoms), right_heavy, heavy,
        100 * mean(static_cast<double>(right_heavy), heavy), std::sqrt(mean(charges, atoms)), poses,
        std::sqrt(mean(energies, poses)), mean(own, poses));
}

int run_compare_ligands(const CompareLigandsCommand& command) {
    const ForceField force_field = read_force_field(command.toppar);
    const std::vector<std::string> residues =
        command.residues.empty()
            ? choose_compounds(force_field, static_cast<std::size_t>(command.count))
            : command.residues;
    const std::vector<LigandComparison> rows = compare_ligands(force_field, residues);
    if (command.json) {
        nlohmann::ordered_json json;
        for (const LigandComparison& row : rows) json["rows"].push_back(as_json(row));
        fmt::print("{}\n", json.dump(2));
        return 0;
    }
    fmt::print(
        "| residue | types right | charges, rms error, e | by analogy | highest penalty | waters | "
        "rms error, kcal/mol | wrong types of heavy atoms |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (const LigandComparison& row : rows) print_row(row);
    print_sum(rows);
    return 0;
}

}  // namespace

void add_compare_ligands(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& compare = *program.add_subcommand("compare-ligands",
                                                "Compare approximate ligands with hidden residues "
                                                "of the force field");
    CompareLigandsCommand& command =
        own_options<CompareLigandsCommand>(compare, chosen, run_compare_ligands);
    describe(compare,
             {"palpa-lab compare-ligands --toppar top_all36_cgenff.rtf par_all36_cgenff.prm "
              "toppar_water_ions.str"});
    add_toppar_option(compare, command.toppar);
    compare.add_option("--residues", command.residues,
                       "residues of the force field to test (default: --count of them)");
    compare
        .add_option("--count", command.count,
                    "number of model compounds, evenly spread over their names")
        ->check(in_range(1, 1000))
        ->capture_default_str();
    compare.add_flag("--json", command.json, "print the results as JSON");
}

}  // namespace palpa
