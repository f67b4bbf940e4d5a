// Names: wwPDB Chemical Component Dictionary, and top_all36_carb.rtf of July 2024.
#include "molecule/component_tables.h"

#include <algorithm>
#include <array>
#include <utility>

namespace palpa {
namespace {

constexpr auto sugar_table = std::to_array<Component>({
    {"NAG", "BGLCNA", "", "N-acetyl-beta-D-glucosamine"},
    {"NDG", "AGLCNA", "", "N-acetyl-alpha-D-glucosamine"},
    {"NGA", "BGALNA", "", "N-acetyl-beta-D-galactosamine"},
    {"A2G", "AGALNA", "", "N-acetyl-alpha-D-galactosamine"},
    {"BMA", "BMAN", "", "beta-D-mannose"},
    {"MAN", "AMAN", "", "alpha-D-mannose"},
    {"GAL", "BGAL", "", "beta-D-galactose"},
    {"GLA", "AGAL", "", "alpha-D-galactose"},
    {"BGC", "BGLC", "", "beta-D-glucose"},
    {"GLC", "AGLC", "", "alpha-D-glucose"},
    {"FUC", "AFUC", "", "alpha-L-fucose"},
    {"FUL", "BFUC", "", "beta-L-fucose"},
    {"SIA", "ANE5AC", "", "N-acetyl-alpha-neuraminic acid (sialic acid)"},
    {"SLB", "BNE5AC", "", "N-acetyl-beta-neuraminic acid (sialic acid)"},
    {"XYP", "BXYL", "", "beta-D-xylose"},
    {"XYS", "AXYL", "", "alpha-D-xylose"},
    {"RAM", "ARHM", "", "alpha-L-rhamnose"},
    {"RM4", "BRHM", "", "beta-L-rhamnose"},
    {"BDP", "BGLCA", "", "beta-D-glucuronic acid"},
    {"GCU", "AGLCA", "", "alpha-D-glucuronic acid"},
    {"IDR", "AIDOA", "", "alpha-L-iduronic acid"},
    {"AFD", "AALL", "", "alpha-D-allose"},
    {"ALL", "BALL", "", "beta-D-allose"},
    {"GL0", "BGUL", "", "beta-D-gulose"},
    {"SHD", "AALT", "", "alpha-D-altrose"},
    {"ABE", "ABEQ", "", "abequose"},
    {"FRU", "BFRU", "", "beta-D-fructofuranose"},
    {"Z9N", "AFRU", "", "alpha-D-fructofuranose"},
    {"RIB", "ARIB", "", "alpha-D-ribofuranose"},
    {"BDR", "BRIB", "", "beta-D-ribofuranose"},
    {"INS", "INI1", "", "myo-inositol"},
    {"SOR", "DGLUOL", "", "D-sorbitol"},
    {"MTL", "DMANOL", "", "D-mannitol"},
    {"SGN", "", "", "N,O6-disulpho-glucosamine"},
    {"ADA", "", "", "alpha-D-galacturonic acid"},
});

using Ring = std::pair<std::string_view, std::string_view>;

// Chairs: 4C1 of D sugars, 1C4 of fucose, rhamnose and iduronic acid.
constexpr auto rings = std::to_array<Ring>(
    {{"AGLC", "abbb"},   {"BGLC", "bbbb"},   {"AGAL", "abba"},   {"BGAL", "bbba"},
     {"AMAN", "aabb"},   {"BMAN", "babb"},   {"AALL", "abab"},   {"BALL", "bbab"},
     {"AALT", "aaab"},   {"BALT", "baab"},   {"AGUL", "abaa"},   {"BGUL", "bbaa"},
     {"AIDO", "aaaa"},   {"BIDO", "baaa"},   {"ATAL", "aaba"},   {"BTAL", "baba"},
     {"AXYL", "abbb"},   {"BXYL", "bbbb"},   {"AFUC", "abba"},   {"BFUC", "bbba"},
     {"ARHM", "aabb"},   {"BRHM", "babb"},   {"AGLCA", "abbb"},  {"BGLCA", "bbbb"},
     {"AIDOA", "aaaa"},  {"BIDOA", "baaa"},  {"AGLCNA", "abbb"}, {"BGLCNA", "bbbb"},
     {"AGALNA", "abba"}, {"BGALNA", "bbba"}, {"ABEQ", "aaba"}});

}  // namespace

std::span<const Component> sugars() noexcept { return sugar_table; }

std::string_view find_ring_oxygens(std::string_view charmm) noexcept {
    const auto* const found = std::find_if(rings.begin(), rings.end(),
                                           [&](const Ring& ring) { return ring.first == charmm; });
    return found == rings.end() ? std::string_view() : found->second;
}

}  // namespace palpa
