#include "charmm/parameter_reader.h"

#include "charmm/residue_reader.h"
#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// Adds what was not there, or replaces it; something else under the name is noted.
template <class Map, class Value, class Same>
void add_or_replace(const Statements& statements, ForceField& into, Map& map,
                    const typename Map::key_type& key, const Value& value, std::string what,
                    const Same& same) {
    const auto [old, is_new] = map.try_emplace(key, value);
    if (is_new || same(old->second, value)) return;
    note_replaced(into, statements, std::move(what), old->second.place);
    old->second = value;
}

constexpr std::array section_names =
    std::to_array<std::string_view>({"ATOMS", "BONDS", "ANGLES", "THETAS", "DIHEDRALS", "PHI",
                                     "IMPROPERS", "IMPHI", "CMAP", "NONBONDED", "NBFIX", "HBOND"});

bool is_wildcard(const std::string& type) { return type == "X"; }

// CHARMM takes any force constant; its own files have Urey-Bradley terms and impropers below 0.
void note_negative(const Statements& statements, ForceField& into, double k, std::string_view of) {
    if (k >= 0) return;
    into.notes.push_back(
        {ForceFieldNote::Kind::Negative, statements.place(), fmt::format("{} of {}", k, of), {}});
}

bool is_same_term(const DihedralTerm& a, const DihedralTerm& b) {
    return a.multiplicity == b.multiplicity && a.k == b.k && a.phase_deg == b.phase_deg;
}

// Which of the forms that CHARMM looks for four types have.
bool has_valid_wildcards(const std::array<std::string, 4>& types, bool is_improper) {
    std::string form;
    for (const std::string& type : types) form += is_wildcard(type) ? 'X' : 'A';
    if (form == "AAAA" || form == "XAAX") return true;
    // The rest in either direction.
    return is_improper &&
           (form == "AXXA" || form == "XAAA" || form == "AAAX" || form == "XXAA" || form == "AAXX");
}

}  // namespace

std::optional<ParameterReader::Section> ParameterReader::find_section(std::string_view keyword) {
    if (keyword == "ATOM") return Section::Atoms;
    if (keyword == "BOND") return Section::Bonds;
    if (keyword == "ANGL" || keyword == "THET") return Section::Angles;
    if (keyword == "DIHE" || keyword == "PHI") return Section::Dihedrals;
    if (keyword == "IMPR" || keyword == "IMPH") return Section::Impropers;
    if (keyword == "CMAP") return Section::Cmap;
    if (keyword == "NONB") return Section::Nonbonded;
    if (keyword == "NBFI") return Section::Nbfix;
    if (keyword == "HBON") return Section::HydrogenBonds;
    return std::nullopt;
}

void ParameterReader::read() {
    // Only these headers carry options on their line; a type may be called like any other.
    const std::optional<Section> section = find_section(statements_.keyword());
    if (section && (statements_.words().size() == 1 || *section == Section::Nonbonded ||
                    *section == Section::Nbfix || *section == Section::HydrogenBonds)) {
        return start_section(*section);
    }
    // No line of a section is a single word, but for numbers of a map.
    if (statements_.words().size() == 1 && !is_inside_map() &&
        !find_near_name(statements_.words()[0], section_names).empty()) {
        fail_section();
    }
    switch (section_) {
        case Section::Atoms:
            if (statements_.keyword() == "MASS") return read_mass(statements_, into_);
            break;
        case Section::Bonds:
            return read_bond();
        case Section::Angles:
            return read_angle();
        case Section::Dihedrals:
            return read_dihedral(false);
        case Section::Impropers:
            return read_dihedral(true);
        case Section::Cmap:
            return read_cmap();
        case Section::Nonbonded:
            return read_nonbonded();
        case Section::Nbfix:
            return read_nbfix();
        case Section::HydrogenBonds:
            return;
        case Section::None:
            break;
    }
    fail_section();
}

void ParameterReader::fail_section() const {
    statements_.fail(
        fmt::format("'{}' is not a section of a parameter file; expected BONDS, ANGLES, "
                    "NONBONDED or the like{}",
                    statements_.words()[0], near_name_hint(statements_.words()[0], section_names)));
}

void ParameterReader::start_section(Section section) {
    end_cmap();
    section_ = section;
    if (section == Section::Nonbonded) check_nonbonded_options();
}

void ParameterReader::end_part() {
    start_section(Section::None);
    note_replaced_dihedrals();
}

void ParameterReader::read_bond() {
    statements_.expect_form("type1 type2 k r0");
    const std::pair<std::string, std::string> types =
        in_order(statements_.name(0, "atom type"), statements_.name(1, "second atom type"));
    const HarmonicParameter bond{statements_.real(2, "force constant"),
                                 statements_.real(3, "bond length"), statements_.place()};
    const std::string what = fmt::format("bond {} {}", types.first, types.second);
    note_negative(statements_, into_, bond.k, what);
    add_or_replace(statements_, into_, into_.bonds, types, bond, what,
                   [](const HarmonicParameter& a, const HarmonicParameter& b) {
                       return a.k == b.k && a.value == b.value;
                   });
}

void ParameterReader::read_angle() {
    statements_.expect_form("type1 type2 type3 k angle [k_UB S0]");
    const std::array<std::string, 3> types = in_order(
        std::array{statements_.name(0, "atom type"), statements_.name(1, "second atom type"),
                   statements_.name(2, "third atom type")});
    AngleParameter angle{.k = statements_.real(3, "force constant"),
                         .value = statements_.real(4, "angle"),
                         .place = statements_.place()};
    if (statements_.words().size() > 5) {
        angle.urey_bradley_k = statements_.real(5, "force constant of Urey-Bradley");
        angle.urey_bradley_s0 = statements_.real(6, "distance of Urey-Bradley");
    }
    const std::string what = fmt::format("angle {}", fmt::join(types, " "));
    note_negative(statements_, into_, angle.k, what);
    note_negative(statements_, into_, angle.urey_bradley_k, "Urey-Bradley " + what);
    add_or_replace(statements_, into_, into_.angles, types, angle, what,
                   [](const AngleParameter& a, const AngleParameter& b) {
                       return a.k == b.k && a.value == b.value &&
                              a.urey_bradley_k == b.urey_bradley_k &&
                              a.urey_bradley_s0 == b.urey_bradley_s0;
                   });
}

void ParameterReader::read_dihedral(bool is_improper) {
    statements_.expect_form("type1 type2 type3 type4 k n phase");
    std::array<std::string, 4> types;
    for (std::size_t i = 0; i < 4; ++i) types[i] = statements_.name(i, "atom type");
    const DihedralTerm term{statements_.real(4, "force constant"),
                            static_cast<int>(std::clamp<std::int64_t>(
                                statements_.whole_number(5, "multiplicity"), -1, 100)),
                            statements_.real(6, "phase"), statements_.place()};
    if (term.multiplicity < 0 || term.multiplicity > 12) {
        statements_.fail(
            fmt::format("the multiplicity is {}; expected 0 to 12", statements_.words()[5]));
    }
    if (!has_valid_wildcards(types, is_improper)) {
        statements_.fail(fmt::format(
            "wildcards as in '{}' are not supported; expected {}", fmt::join(types, " "),
            is_improper ? "A X X D, X B C D, X B C X or X X C D" : "X B C X"));
    }
    types = in_order(std::move(types));
    const std::string what =
        fmt::format("{} {}", is_improper ? "improper" : "dihedral", fmt::join(types, " "));
    add_dihedral((is_improper ? into_.impropers : into_.dihedrals)[types], term, what);
}

// A further multiplicity joins those of its own part; one with n = 0 stands alone.
void ParameterReader::add_dihedral(std::vector<DihedralTerm>& terms, const DihedralTerm& term,
                                   const std::string& what) {
    const bool is_first = of_this_part_.insert(&terms).second;
    if (is_first && !terms.empty()) replaced_.push_back({&terms, std::exchange(terms, {}), what});
    const auto old = std::find_if(terms.begin(), terms.end(), [&](const DihedralTerm& other) {
        return other.multiplicity == term.multiplicity;
    });
    if (old != terms.end()) {
        if (is_same_term(*old, term)) return;
        note_replaced(into_, statements_, fmt::format("{} {}", what, term.multiplicity),
                      old->place);
        *old = term;
        return;
    }
    if (!terms.empty() && (terms[0].multiplicity == 0 || term.multiplicity == 0)) {
        statements_.fail(
            fmt::format("{} has multiplicities {} and {} (first in {}); a multiplicity of 0 "
                        "(harmonic) cannot be combined with others",
                        what, terms[0].multiplicity, term.multiplicity, to_string(terms[0].place)));
    }
    terms.push_back(term);
}

// Once all multiplicities of the part are known.
void ParameterReader::note_replaced_dihedrals() {
    for (const ReplacedDihedral& earlier : replaced_) {
        if (std::ranges::is_permutation(earlier.terms, *earlier.now, is_same_term)) continue;
        into_.notes.push_back({ForceFieldNote::Kind::Replaced, earlier.now->front().place,
                               earlier.what, earlier.terms.front().place});
    }
    replaced_.clear();
    of_this_part_.clear();
}

bool ParameterReader::is_inside_map() const {
    return open_map_ && open_map_->parameter.energies.size() < open_map_->count;
}

// Numbers of the open map, as many on a line as there are.
void ParameterReader::read_cmap_energies(OpenMap& map) const {
    std::vector<double>& energies = map.parameter.energies;
    const std::string place = to_string(map.parameter.place);
    for (const std::string_view word : statements_.words()) {
        if (energies.size() == map.count) {
            statements_.fail(fmt::format("'{}' is more than the {} numbers of the map of {}", word,
                                         map.count, place));
        }
        const std::optional<double> energy = find_real(word);
        if (!energy) {
            statements_.fail(
                fmt::format("'{}' is not a number; expected energy {} of {} of the map "
                            "of {}",
                            word, energies.size() + 1, map.count, place));
        }
        energies.push_back(*energy);
    }
}

// Eight types and the number of points along one angle, then as many numbers squared.
void ParameterReader::read_cmap() {
    const std::vector<std::string_view>& words = statements_.words();
    const bool is_header = words.size() == 9 && !find_real(words[0]) && find_integer(words[8]);
    if (open_map_ && !is_header && (is_inside_map() || find_real(words[0]))) {
        return read_cmap_energies(*open_map_);
    }
    end_cmap();
    statements_.expect_form("type1 type2 type3 type4 type5 type6 type7 type8 points");
    OpenMap map;
    for (std::size_t i = 0; i < 8; ++i) map.types[i] = statements_.name(i, "atom type");
    const std::int64_t size = statements_.whole_number(8, "number of points");
    if (size < 2 || size > 360) {
        statements_.fail(
            fmt::format("the CMAP has {} points along each angle; expected 2 to 360", size));
    }
    map.count = static_cast<std::size_t>(size * size);
    map.parameter.place = statements_.place();
    open_map_ = std::move(map);
}

void ParameterReader::end_cmap() {
    if (!open_map_) return;
    const OpenMap map = std::move(*open_map_);
    open_map_.reset();
    if (map.parameter.energies.size() != map.count) {
        throw LoadError(map.parameter.place, fmt::format("the CMAP has {} numbers; expected {}",
                                                         map.parameter.energies.size(), map.count));
    }
    const auto [old, is_new] = into_.cmaps.try_emplace(map.types, map.parameter);
    if (is_new || old->second.energies == map.parameter.energies) return;
    into_.notes.push_back({ForceFieldNote::Kind::Replaced, map.parameter.place,
                           fmt::format("CMAP {}", fmt::join(map.types, " ")), old->second.place});
    old->second = map.parameter;
}

std::array<double, 2> ParameterReader::read_well(std::size_t at, const char* distance) const {
    const double depth = statements_.real(at, "well depth");
    const double length = statements_.real(at + 1, distance);
    if (depth > 0 || length < 0) {
        statements_.fail(
            fmt::format("the well depth is {} kcal/mol and {} is {} Å; expected -epsilon (0 or "
                        "less) and {} of 0 or more",
                        depth, distance, length, distance));
    }
    return {-depth, length};
}

// NONBONDED's options tell how to sum, which a scene does; but not what would change the numbers.
void ParameterReader::check_nonbonded_options() const {
    for (std::size_t i = 1; i < statements_.words().size(); ++i) {
        const std::string_view option = statements_.words()[i];
        if (option.starts_with("GEOM")) {
            statements_.fail(
                fmt::format("'{}' is not supported; radii are always combined by their sum "
                            "(arithmetic mean of Rmin)",
                            option));
        }
        if (option.starts_with("E14F") && statements_.real(i + 1, "factor") != 1) {
            statements_.fail(fmt::format("{} {} is not supported; expected 1", option,
                                         statements_.words()[i + 1]));
        }
    }
}

void ParameterReader::read_nonbonded() {
    statements_.expect_form("type unused -epsilon Rmin/2 [unused -epsilon14 Rmin14/2]");
    const std::string type = statements_.name(0, "atom type");
    statements_.real(1, "unused first number");
    const std::array<double, 2> plain = read_well(2, "Rmin/2");
    std::array<double, 2> special = plain;
    if (statements_.words().size() > 4) {
        statements_.real(4, "unused fourth number");
        special = read_well(5, "Rmin/2");
    }
    const NonbondedType entry{plain[0], plain[1], special[0], special[1], statements_.place()};
    add_or_replace(statements_, into_, into_.nonbonded, type, entry, "non-bonded type " + type,
                   [](const NonbondedType& a, const NonbondedType& b) {
                       return a.epsilon == b.epsilon && a.half_rmin == b.half_rmin &&
                              a.epsilon14 == b.epsilon14 && a.half_rmin14 == b.half_rmin14;
                   });
}

void ParameterReader::read_nbfix() {
    statements_.expect_form("type1 type2 -epsilon Rmin [-epsilon14 Rmin14]");
    const std::string a = statements_.name(0, "atom type");
    const std::string b = statements_.name(1, "second atom type");
    const std::array<double, 2> plain = read_well(2, "Rmin");
    const std::array<double, 2> special =
        statements_.words().size() > 4 ? read_well(4, "Rmin") : plain;
    const NbfixPair entry{plain[0], plain[1], special[0], special[1], statements_.place()};
    add_or_replace(statements_, into_, into_.nbfix, in_order(a, b), entry,
                   fmt::format("NBFIX {} {}", a, b), [](const NbfixPair& x, const NbfixPair& y) {
                       return x.epsilon == y.epsilon && x.rmin == y.rmin &&
                              x.epsilon14 == y.epsilon14 && x.rmin14 == y.rmin14;
                   });
}

}  // namespace palpa
