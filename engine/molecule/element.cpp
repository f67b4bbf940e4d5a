#include "molecule/element.h"

#include "core/text.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace palpa {
namespace {

constexpr std::array symbols = std::to_array<std::string_view>(
    {"AC", "AG", "AL", "AM", "AR", "AS", "AT", "AU", "B",  "BA", "BE", "BH", "BI", "BK", "BR",
     "C",  "CA", "CD", "CE", "CF", "CL", "CM", "CN", "CO", "CR", "CS", "CU", "D",  "DB", "DS",
     "DY", "ER", "ES", "EU", "F",  "FE", "FL", "FM", "FR", "GA", "GD", "GE", "H",  "HE", "HF",
     "HG", "HO", "HS", "I",  "IN", "IR", "K",  "KR", "LA", "LI", "LR", "LU", "LV", "MC", "MD",
     "MG", "MN", "MO", "MT", "N",  "NA", "NB", "ND", "NE", "NH", "NI", "NO", "NP", "O",  "OG",
     "OS", "P",  "PA", "PB", "PD", "PM", "PO", "PR", "PT", "PU", "RA", "RB", "RE", "RF", "RG",
     "RH", "RN", "RU", "S",  "SB", "SC", "SE", "SG", "SI", "SM", "SN", "SR", "TA", "TB", "TC",
     "TE", "TH", "TI", "TL", "TM", "TS", "U",  "V",  "W",  "XE", "Y",  "YB", "ZN", "ZR"});
static_assert(std::is_sorted(symbols.begin(), symbols.end()));

// CHARMM's names of ions (toppar_water_ions.str).
constexpr std::array charmm_ions =
    std::to_array<std::pair<std::string_view, std::string_view>>({{"BAR", "BA"},
                                                                  {"CAD", "CD"},
                                                                  {"CAL", "CA"},
                                                                  {"CES", "CS"},
                                                                  {"CLA", "CL"},
                                                                  {"LIT", "LI"},
                                                                  {"POT", "K"},
                                                                  {"RUB", "RB"},
                                                                  {"SOD", "NA"}});

// Names of no other element's atoms, with digits or nothing behind.
constexpr std::array plain_pairs =
    std::to_array<std::string_view>({"BR", "CL", "CU", "FE", "MG", "MN", "SE", "ZN"});

constexpr std::array radii = std::to_array<std::pair<std::string_view, double>>({{"H", 0.31},
                                                                                 {"B", 0.84},
                                                                                 {"C", 0.76},
                                                                                 {"N", 0.71},
                                                                                 {"O", 0.66},
                                                                                 {"F", 0.57},
                                                                                 {"SI", 1.11},
                                                                                 {"P", 1.07},
                                                                                 {"S", 1.05},
                                                                                 {"CL", 1.02},
                                                                                 {"SE", 1.20},
                                                                                 {"BR", 1.20},
                                                                                 {"I", 1.39}});

constexpr std::array bondi_radii =
    std::to_array<std::pair<std::string_view, double>>({{"H", 1.20},
                                                        {"D", 1.20},
                                                        {"C", 1.70},
                                                        {"N", 1.55},
                                                        {"O", 1.52},
                                                        {"F", 1.47},
                                                        {"SI", 2.10},
                                                        {"P", 1.80},
                                                        {"S", 1.80},
                                                        {"CL", 1.75},
                                                        {"AS", 1.85},
                                                        {"SE", 1.90},
                                                        {"BR", 1.85},
                                                        {"I", 1.98}});

}  // namespace

bool is_element(std::string_view symbol) noexcept {
    return std::binary_search(symbols.begin(), symbols.end(), symbol);
}

std::string find_element_of_name(std::string_view atom, std::string_view residue) {
    constexpr std::string_view not_letters = "0123456789+-*'\"";
    const std::string name = upper_case(atom);
    if (name == upper_case(residue)) {
        for (const auto& [ion, element] : charmm_ions) {
            if (name == ion) return std::string(element);
        }
        const std::string symbol = name.substr(0, name.find_first_of(not_letters));
        if (is_element(symbol)) return symbol;
    }
    const std::size_t first = name.find_first_not_of(not_letters);
    if (first == std::string::npos) return {};
    const std::string letters = name.substr(first, name.find_first_of(not_letters, first) - first);
    const bool plain =
        std::find(plain_pairs.begin(), plain_pairs.end(), letters) != plain_pairs.end();
    const std::string symbol = plain ? letters : letters.substr(0, 1);
    return is_element(symbol) ? symbol : std::string();
}

double covalent_radius(std::string_view element) noexcept {
    const auto* const found =
        std::ranges::find(radii, element, &std::pair<std::string_view, double>::first);
    constexpr double other = 1.4;
    return found == radii.end() ? other : found->second;
}

double van_der_waals_radius(std::string_view element) noexcept {
    const auto* const found =
        std::ranges::find(bondi_radii, element, &std::pair<std::string_view, double>::first);
    return found == bondi_radii.end() ? 0 : found->second;
}

double largest_van_der_waals_radius() noexcept {
    return std::ranges::max(bondi_radii, {}, &std::pair<std::string_view, double>::second).second;
}

}  // namespace palpa
