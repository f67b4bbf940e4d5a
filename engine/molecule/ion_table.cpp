// Names: wwPDB Chemical Component Dictionary and the files of other programs; residues of
// toppar_water_ions.str and toppar_ions_won.str of July 2024. An oxidation state that a name leaves
// open is the usual one in proteins.
#include "molecule/component_tables.h"

#include <array>

namespace palpa {
namespace {

constexpr auto ion_table = std::to_array<Component>({
    {"NA", "SOD", "", "sodium"},           {"K", "POT", "", "potassium"},
    {"CL", "CLA", "", "chloride"},         {"CA", "CAL", "", "calcium"},
    {"MG", "MG", "", "magnesium"},         {"LI", "LIT", "", "lithium"},
    {"RB", "RUB", "", "rubidium"},         {"CS", "CES", "", "caesium"},
    {"BA", "BAR", "", "barium"},           {"ZN", "ZN2", "", "zinc"},
    {"CD", "CD2", "", "cadmium"},          {"MN", "MN2P", "", "manganese(II)"},
    {"MN3", "MN3P", "", "manganese(III)"}, {"FE2", "FE2P", "", "iron(II)"},
    {"FE", "FE3P", "", "iron(III)"},       {"CO", "CO2P", "", "cobalt(II)"},
    {"3CO", "CO3P", "", "cobalt(III)"},    {"NI", "NI2P", "", "nickel(II)"},
    {"CU", "CU2P", "", "copper(II)"},      {"CU1", "CU1P", "", "copper(I)"},
    {"HG", "HG2P", "", "mercury(II)"},     {"PB", "PB2P", "", "lead(II)"},
    {"SR", "SR2P", "", "strontium"},       {"AG", "AG1P", "", "silver(I)"},
    {"AU", "AU1P", "", "gold(I)"},         {"AU3", "AU3P", "", "gold(III)"},
    {"PT", "PT2P", "", "platinum(II)"},    {"PD", "PD2P", "", "palladium(II)"},
    {"CR", "CR3P", "", "chromium(III)"},   {"AL", "AL3P", "", "aluminium"},
    {"GA", "GA3P", "", "gallium"},         {"IN", "IN3P", "", "indium"},
    {"TL", "TL1P", "", "thallium(I)"},     {"BE", "BE2P", "", "beryllium"},
    {"Y1", "Y3P", "", "yttrium"},          {"YT3", "Y3P", "", "yttrium"},
    {"LA", "LA3P", "", "lanthanum"},       {"CE", "CE3P", "", "cerium"},
    {"PR", "PR3P", "", "praseodymium"},    {"SM", "SM3P", "", "samarium"},
    {"EU", "EU2P", "", "europium(II)"},    {"EU3", "EU3P", "", "europium(III)"},
    {"GD", "GD3P", "", "gadolinium"},      {"GD3", "GD3P", "", "gadolinium"},
    {"TB", "TB3P", "", "terbium"},         {"DY", "DY3P", "", "dysprosium"},
    {"HO", "HO3P", "", "holmium"},         {"HO3", "HO3P", "", "holmium"},
    {"ER3", "ER3P", "", "erbium"},         {"YB", "YB3P", "", "ytterbium"},
    {"YB2", "YB2P", "", "ytterbium(II)"},  {"LU", "LU3P", "", "lutetium"},
    {"BS3", "BI3P", "", "bismuth"},
});

}  // namespace

std::span<const Component> ions() noexcept { return ion_table; }

}  // namespace palpa
