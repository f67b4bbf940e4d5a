// Names: wwPDB Chemical Component Dictionary, and the streams of toppar_c36 of July 2024 named in
// components.cpp.
#include "molecule/component_tables.h"

#include <array>

namespace palpa {
namespace {

constexpr auto cofactor_table = std::to_array<Component>({
    {"HEM", "HEME", "", "heme"},
    {"HEB", "", "", "heme B, hydroxylated"},
    {"HEC", "", "", "heme C, bonded to cysteines"},
    {"HEA", "", "", "heme A"},
    {"CMO", "CO", "", "carbon monoxide"},
    {"OXY", "O2", "", "oxygen"},
    {"NAD", "NAD", "", "NAD+"},
    {"NAI", "NAI", "", "NADH"},
    {"NAP", "NAP", "", "NADP+"},
    {"NDP", "NDP", "", "NADPH"},
    {"FAD", "FAD", "", "FAD"},
    {"FMN", "FMN", "", "FMN"},
    {"RBF", "RBF", "", "riboflavin"},
    {"ATP", "ATP", "", "ATP"},
    {"ADP", "ADP", "", "ADP"},
    {"AMP", "AMP", "", "AMP"},
    {"GTP", "GTP", "", "GTP"},
    {"GDP", "GDP", "", "GDP"},
    {"5GP", "GMP", "", "GMP"},
    {"CTP", "CTP", "", "CTP"},
    {"CDP", "CDP", "", "CDP"},
    {"C5P", "CMP", "", "CMP"},
    {"UTP", "UTP", "", "UTP"},
    {"UDP", "UDP", "", "UDP"},
    {"U5P", "UMP", "", "UMP"},
    {"TTP", "TTP", "", "TTP"},
    {"TYD", "TDP", "", "TDP"},
    {"TMP", "TMP", "", "TMP"},
    {"SAM", "SAM", "", "S-adenosylmethionine"},
    {"SAH", "ADE", "SAHC", "S-adenosylhomocysteine"},
    {"FOL", "FOL", "", "folic acid"},
    {"DHF", "DHF", "", "dihydrofolate"},
    {"THG", "THG", "", "tetrahydrofolate"},
    {"H4B", "H4B", "", "tetrahydrobiopterin"},
    {"COM", "COM", "", "coenzyme M"},
    {"TP7", "COB", "", "coenzyme B"},
    {"F43", "F430", "", "coenzyme F430"},
    {"RET", "RTAL", "", "retinal"},
    {"RTL", "RTOL", "", "retinol"},
    {"REA", "RTAC", "", "retinoic acid"},
    {"POP", "PPI2", "", "diphosphate"},
    {"ANP", "", "", "AMP-PNP, an analogue of ATP"},
    {"AP5", "", "", "Ap5A, an analogue of ATP and AMP"},
    {"COA", "", "", "coenzyme A"},
    {"PLP", "", "", "pyridoxal phosphate"},
    {"TPP", "", "", "thiamine diphosphate"},
    {"CLA", "", "", "chlorophyll A"},
});

constexpr auto lipid_table = std::to_array<Component>({
    {"CLR", "CHL1", "", "cholesterol"},
    {"CHL", "CHL1", "", "cholesterol"},
    {"ERG", "ERG", "", "ergosterol"},
    {"Y01", "CHSD", "", "cholesteryl hemisuccinate"},
    {"POV", "POPC", "", "POPC, palmitoyl-oleoyl-phosphatidylcholine"},
    {"PCW", "DOPC", "", "DOPC, dioleoyl-phosphatidylcholine"},
    {"PX4", "DMPC", "", "DMPC, dimyristoyl-phosphatidylcholine"},
    {"MC3", "DMPC", "", "DMPC, dimyristoyl-phosphatidylcholine"},
    {"PCF", "DPPC", "", "DPPC, dipalmitoyl-phosphatidylcholine"},
    {"6PL", "", "", "a phosphatidylcholine"},
    {"PC1", "DSPC", "", "DSPC, distearoyl-phosphatidylcholine"},
    {"PEE", "DOPE", "", "DOPE, dioleoyl-phosphatidylethanolamine"},
    {"PEV", "POPE", "", "POPE, palmitoyl-oleoyl-phosphatidylethanolamine"},
    {"3PE", "DSPE", "", "DSPE, distearoyl-phosphatidylethanolamine"},
    {"LHG", "DPPG", "", "DPPG, dipalmitoyl-phosphatidylglycerol"},
    {"LPP", "DPPA", "", "DPPA, dipalmitoyl-phosphatidic acid"},
    {"PSF", "", "", "a phosphatidylserine"},
    {"CDL", "", "", "cardiolipin"},
    {"PLM", "", "", "palmitic acid"},
    {"MYR", "", "", "myristic acid"},
    {"STE", "", "", "stearic acid"},
    {"OLA", "", "", "oleic acid"},
    {"OLC", "", "", "monoolein"},
    {"OLB", "", "", "monoolein"},
});

}  // namespace

std::span<const Component> cofactors() noexcept { return cofactor_table; }
std::span<const Component> lipids() noexcept { return lipid_table; }

}  // namespace palpa
