// Names: wwPDB Chemical Component Dictionary and the files of older programs. That the sugar is
// deoxyribose is recognised by its atoms, not here.
#include "molecule/component_tables.h"

#include <array>

namespace palpa {
namespace {

constexpr auto nucleotide_table = std::to_array<Component>({
    {"A", "ADE", "", "adenosine"},        {"C", "CYT", "", "cytidine"},
    {"G", "GUA", "", "guanosine"},        {"U", "URA", "", "uridine"},
    {"T", "THY", "", "thymidine"},        {"DA", "ADE", "", "deoxyadenosine"},
    {"DC", "CYT", "", "deoxycytidine"},   {"DG", "GUA", "", "deoxyguanosine"},
    {"DT", "THY", "", "thymidine"},       {"DU", "URA", "", "deoxyuridine"},
    {"ADE", "ADE", "", "adenosine"},      {"CYT", "CYT", "", "cytidine"},
    {"GUA", "GUA", "", "guanosine"},      {"URA", "URA", "", "uridine"},
    {"THY", "THY", "", "thymidine"},      {"RA", "ADE", "", "adenosine"},
    {"RC", "CYT", "", "cytidine"},        {"RG", "GUA", "", "guanosine"},
    {"RU", "URA", "", "uridine"},         {"DA5", "ADE", "", "deoxyadenosine"},
    {"DA3", "ADE", "", "deoxyadenosine"}, {"DC5", "CYT", "", "deoxycytidine"},
    {"DC3", "CYT", "", "deoxycytidine"},  {"DG5", "GUA", "", "deoxyguanosine"},
    {"DG3", "GUA", "", "deoxyguanosine"}, {"DT5", "THY", "", "thymidine"},
    {"DT3", "THY", "", "thymidine"},      {"A5", "ADE", "", "adenosine"},
    {"A3", "ADE", "", "adenosine"},       {"C5", "CYT", "", "cytidine"},
    {"C3", "CYT", "", "cytidine"},        {"G5", "GUA", "", "guanosine"},
    {"G3", "GUA", "", "guanosine"},       {"U5", "URA", "", "uridine"},
    {"U3", "URA", "", "uridine"},         {"RA5", "ADE", "", "adenosine"},
    {"RA3", "ADE", "", "adenosine"},      {"RC5", "CYT", "", "cytidine"},
    {"RC3", "CYT", "", "cytidine"},       {"RG5", "GUA", "", "guanosine"},
    {"RG3", "GUA", "", "guanosine"},      {"RU5", "URA", "", "uridine"},
    {"RU3", "URA", "", "uridine"},        {"5CM", "CYT", "5MC2", "5-methyl-deoxycytidine"},
    {"I", "GUA", "INO1", "inosine"},      {"DI", "GUA", "INO1", "deoxyinosine"},
});

}  // namespace

std::span<const Component> nucleotides() noexcept { return nucleotide_table; }

}  // namespace palpa
