// EEF1's numbers of atoms by type, from tests/data/solvent.
#pragma once
#include "charmm/solvation.h"
#include "tests/support/paths.h"

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>

namespace palpa::test {

// Hydrogens have nothing; another type without a row throws. Off 298.15 K as CHARMM scales them.
inline Solvation solvation_of(std::span<const std::string> types,
                              const std::string& table = "eef1sb.csv",
                              double temperature = 298.15) {
    constexpr double T0 = 298.15;
    std::ifstream file(test_data("solvent/" + table));
    std::map<std::string, std::array<double, 7>> rows;
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
        std::istringstream words(line);
        std::string type, word;
        std::getline(words, type, ',');
        for (double& number : rows[type]) {
            std::getline(words, word, ',');
            number = std::stod(word);
        }
    }
    Solvation solvation;
    for (const std::string& type : types) {
        std::array<double, 7> row{0, 0, 0, 0, 0, 1, 0};
        if (const auto found = rows.find(type); found != rows.end()) {
            row = found->second;
        } else if (type.empty() || type[0] != 'H') {
            throw std::runtime_error("no row for type " + type);
        }
        const auto& [volume, dg_ref, dg_free, dh_ref, dcp_ref, lambda, radius] = row;
        const double dg =
            dg_ref - (temperature - T0) / T0 * (dh_ref - dg_ref) -
            dcp_ref / 1000 * (temperature * std::log(temperature / T0) - (temperature - T0));
        solvation.volume.push_back(volume);
        solvation.dg_ref.push_back(dg);
        solvation.dg_free.push_back(dg_ref == 0 ? 0 : dg_free * dg / dg_ref);
        solvation.lambda.push_back(lambda);
        solvation.radius.push_back(radius);
    }
    return solvation;
}

}  // namespace palpa::test
