// Names: wwPDB Chemical Component Dictionary, and top_all36_prot.rtf and its streams of July 2024.
// Phosphates stand in the state of pH 7, with two charges.
#include "molecule/component_tables.h"

#include <array>

namespace palpa {
namespace {

constexpr auto amino_acid_table = std::to_array<Component>({
    {"MSE", "MET", "", "selenomethionine, taken as methionine"},
    {"SEP", "SER", "SP2", "phosphoserine"},
    {"TPO", "THR", "THPB", "phosphothreonine"},
    {"PTR", "TYR", "TP2", "phosphotyrosine"},
    {"TYS", "TYS", "", "sulphotyrosine"},
    {"MLY", "", "", "N-dimethyl-lysine"},
    {"MLZ", "MLZ", "", "N-methyl-lysine"},
    {"M3L", "MLYS", "", "N-trimethyl-lysine"},
    {"ALY", "ALY", "", "N-acetyl-lysine"},
    {"KCX", "KCX", "", "carboxylated lysine"},
    {"LLP", "LLP", "", "lysine with pyridoxal phosphate"},
    {"HYP", "HYP", "", "hydroxyproline"},
    {"CSO", "CSO", "", "S-hydroxycysteine"},
    {"CME", "CME", "", "S-(2-hydroxyethyl)thiocysteine"},
    {"CGU", "CGU", "", "gamma-carboxyglutamic acid"},
    {"NLE", "NLE", "", "norleucine"},
    {"AIB", "AIB", "", "alpha-aminoisobutyric acid"},
    {"SAR", "MGY", "", "N-methylglycine"},
    {"CIR", "CIR", "", "citrulline"},
    {"ORN", "DORN", "", "ornithine"},
    {"HIC", "HIC", "", "4-methyl-histidine"},
    {"CAS", "", "", "S-dimethylarsinoyl-cysteine"},
    {"CSD", "", "", "cysteine sulphinic acid"},
    {"OCS", "", "", "cysteine sulphonic acid"},
    {"PCA", "", "", "pyroglutamic acid"},
    {"SEC", "", "", "selenocysteine"},
    {"DAL", "DALA", "", "D-alanine"},
    {"DAR", "DARG", "", "D-arginine"},
    {"DSG", "DASN", "", "D-asparagine"},
    {"DAS", "DASP", "", "D-aspartic acid"},
    {"DCY", "DCYS", "", "D-cysteine"},
    {"DGN", "DGLN", "", "D-glutamine"},
    {"DGL", "DGLU", "", "D-glutamic acid"},
    {"DHI", "DHSE", "", "D-histidine"},
    {"DIL", "DILE", "", "D-isoleucine"},
    {"DLE", "DLEU", "", "D-leucine"},
    {"DLY", "DLYS", "", "D-lysine"},
    {"MED", "DMET", "", "D-methionine"},
    {"DPN", "DPHE", "", "D-phenylalanine"},
    {"DPR", "DPRO", "", "D-proline"},
    {"DSN", "DSER", "", "D-serine"},
    {"DTH", "DTHR", "", "D-threonine"},
    {"DTR", "DTRP", "", "D-tryptophan"},
    {"DTY", "DTYR", "", "D-tyrosine"},
    {"DVA", "DVAL", "", "D-valine"},
});

// Where the amino acid and what is bonded to it are one residue in CHARMM36.
constexpr auto joined = std::to_array<JoinedComponent>({
    {"RET", "LYS", "NZ", "LYR"},
    {"PLM", "CYS", "SG", "CYSP"},
    {"MYR", "GLY", "N", "GLYM"},
    {"MYR", "LYS", "NZ", "LYSM"},
    {"FAR", "CYS", "SG", "CYSF"},
    {"GER", "CYS", "SG", "CYSG"},
    {"PLP", "LYS", "NZ", "LLP"},
});

}  // namespace

std::span<const Component> amino_acids() noexcept { return amino_acid_table; }
std::span<const JoinedComponent> joined_components() noexcept { return joined; }

}  // namespace palpa
