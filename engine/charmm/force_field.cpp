#include "charmm/force_field.h"

#include "core/files.h"
#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace palpa {
namespace {

using Words = std::span<const std::string_view>;

// Keywords count by their first four letters. Those of a topology file that carry nothing a rigid
// molecule needs.
constexpr std::array topology_passed_over =
    std::to_array<std::string_view>({"GROU", "ANGL", "THET", "DIHE", "IMPR", "IMPH", "CMAP", "DONO",
                                     "ACCE", "IC", "BILD", "PATC", "DELE", "DEFA", "AUTO", "DECL"});
constexpr std::array script_passed_over =
    std::to_array<std::string_view>({"SET", "IF", "RETU", "BOML", "WRNL"});

// Sections of a parameter file, and whether we read what stands in them.
enum class Section { None, Atoms, Bonds, Angles, PassedOver, Nonbonded, Nbfix };

std::optional<Section> find_section(std::string_view keyword) {
    if (keyword == "ATOM") return Section::Atoms;
    if (keyword == "BOND") return Section::Bonds;
    if (keyword == "ANGL" || keyword == "THET") return Section::Angles;
    if (keyword == "NONB") return Section::Nonbonded;
    if (keyword == "NBFI") return Section::Nbfix;
    for (const std::string_view name : {"DIHE", "PHI", "IMPR", "IMPH", "CMAP", "HBON"}) {
        if (keyword == name) return Section::PassedOver;
    }
    return std::nullopt;
}

bool contains(std::span<const std::string_view> names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

class Parser {
public:
    Parser(std::string_view text, const std::string& file, ForceField& into)
        : lines_(split_lines(text)), file_(file), into_(into) {}

    void parse() {
        while (next_statement()) {
            const std::vector<std::string_view> words = split_words(statement_);
            const std::string keyword(words[0].substr(0, 4));
            if (keyword == "END") {
                end_part();
            } else if (keyword == "READ") {
                start_part(words);
            } else if (part_ == Part::Parameters || (part_ == Part::None && find_section(keyword) &&
                                                     (keyword != "ATOM" || words.size() == 1))) {
                part_ = Part::Parameters;
                parse_parameters(keyword, words);
            } else if (part_ == Part::None && contains(script_passed_over, keyword)) {
                continue;
            } else {
                parse_topology(keyword, words);
            }
        }
    }

private:
    enum class Part { None, Topology, Parameters };

    [[noreturn]] void fail(const std::string& what) const { throw LoadError(place(), what); }

    TextPlace place() const { return {file_, statement_line_, 0}; }

    // The next line that says something, upper case, without comment, with the lines that a '-' at
    // its end continues it on. False at the end of the file.
    bool next_statement() {
        statement_.clear();
        for (bool continued = true; continued && at_ < lines_.size();) {
            const std::string_view raw = lines_[at_];
            std::string_view line = trimmed(raw.substr(0, raw.find('!')));
            ++at_;
            const bool ends_open = line.ends_with('-');
            if (ends_open) line = trimmed(line.substr(0, line.size() - 1));
            if (statement_.empty() && (line.empty() || line.starts_with('*'))) continue;
            if (statement_.empty()) statement_line_ = at_;
            continued = ends_open;
            statement_ += upper_case(line) + " ";
        }
        return !statement_.empty();
    }

    void start_part(Words words) {
        const std::string_view what = words.size() > 1 ? words[1].substr(0, 4) : "";
        if (what == "RTF") {
            part_ = Part::Topology;
        } else if (what == "PARA") {
            part_ = Part::Parameters;
        } else {
            fail(fmt::format("'{}' cannot be read; expected 'read rtf' or 'read para'",
                             trimmed(statement_)));
        }
        end_residue();
    }

    void end_part() {
        end_residue();
        part_ = Part::None;
        section_ = Section::None;
    }

    void end_residue() {
        residue_ = nullptr;
        in_patch_ = false;
    }

    double real(Words words, std::size_t at, const char* what) const {
        if (at >= words.size()) fail(fmt::format("no {} here", what));
        const std::optional<double> value = find_real(words[at]);
        if (!value) fail(fmt::format("'{}' is not a number; expected the {}", words[at], what));
        return *value;
    }

    std::string name(Words words, std::size_t at, const char* what) const {
        if (at >= words.size()) fail(fmt::format("no {} here", what));
        return std::string(words[at]);
    }

    // Adds what was not there; the same again is no mistake, something else under its name is.
    template <class Map, class Key, class Value, class Same>
    void add_once(Map& map, Key key, Value value, const std::string& what, Same same) {
        const auto [old, is_new] = map.emplace(std::move(key), value);
        if (!is_new && !same(old->second, value)) {
            fail(fmt::format("{} again with other values, first in {}", what,
                             to_string(old->second.place)));
        }
    }

    void parse_topology(const std::string& keyword, Words words) {
        part_ = Part::Topology;
        if (find_integer(words[0])) return;  // the file's version, "36 1"
        if (keyword == "MASS") return parse_mass(words);
        if (keyword == "RESI") return start_residue(words);
        if (keyword == "PRES") {
            end_residue();
            in_patch_ = true;
            return;
        }
        if (keyword == "ATOM" && in_patch_) return;
        if (keyword == "ATOM") return parse_residue_atom(words);
        for (const std::string_view bond : {"BOND", "DOUB", "TRIP", "AROM"}) {
            if (keyword == bond) return parse_residue_bonds(words);
        }
        if (!contains(topology_passed_over, keyword)) {
            fail(
                fmt::format("'{}' is not a line of a topology file; expected MASS, RESI, ATOM or "
                            "the like",
                            words[0]));
        }
    }

    // MASS number type mass [element]; the number is -1, or what old structure files call the type.
    void parse_mass(Words words) {
        const double number = real(words, 1, "atom type's number");
        const std::string type = name(words, 2, "atom type");
        AtomType entry{number >= 1 && number < 1e9 ? static_cast<std::int64_t>(number) : -1,
                       real(words, 3, "mass"), words.size() > 4 ? std::string(words[4]) : "",
                       place()};
        if (!(entry.mass >= 0))
            fail(fmt::format("a mass of {} amu; expected 0 or more", entry.mass));
        // CHARMM's own files round one mass differently in topology and parameters; the first
        // counts.
        add_once(
            into_.types, type, entry, fmt::format("mass of type '{}'", type),
            [](const AtomType& a, const AtomType& b) { return std::abs(a.mass - b.mass) < 0.01; });
    }

    void start_residue(Words words) {
        end_residue();
        const std::string residue = name(words, 1, "residue name");
        const auto [added, is_new] = into_.residues.emplace(
            residue, Residue{real(words, 2, "residue's charge"), {}, {}, place()});
        if (!is_new) {
            fail(fmt::format("residue '{}' again, first in {}", residue,
                             to_string(added->second.place)));
        }
        residue_ = &added->second;
    }

    void parse_residue_atom(Words words) {
        if (!residue_) fail("an ATOM line outside of a residue; expected a RESI line before it");
        ResidueAtom atom{name(words, 1, "atom name"), name(words, 2, "atom type"),
                         real(words, 3, "charge"), place()};
        for (const ResidueAtom& other : residue_->atoms) {
            if (other.name == atom.name) {
                fail(
                    fmt::format("atom '{}' again, first in {}", atom.name, to_string(other.place)));
            }
        }
        residue_->atoms.push_back(std::move(atom));
    }

    // BOND a b a b ...; bonds of patches are passed over like the rest of them.
    void parse_residue_bonds(Words words) {
        if (in_patch_) return;
        if (!residue_) fail("a BOND line outside of a residue; expected a RESI line before it");
        if (words.size() % 2 == 0) fail("a BOND line with an odd number of atoms; expected pairs");
        for (std::size_t i = 1; i + 1 < words.size(); i += 2) {
            residue_->bonds.push_back({std::string(words[i]), std::string(words[i + 1])});
        }
    }

    void parse_parameters(const std::string& keyword, Words words) {
        if (keyword == "MASS" && section_ == Section::Atoms) return parse_mass(words);
        // Only these headers carry options on their line; a type may be called like any other.
        const std::optional<Section> section = find_section(keyword);
        if (section && (words.size() == 1 || *section == Section::Nonbonded ||
                        *section == Section::Nbfix || *section == Section::PassedOver)) {
            section_ = *section;
            return;
        }
        switch (section_) {
            case Section::Bonds:
                return parse_bond(words);
            case Section::Angles:
                return parse_angle(words);
            case Section::Nonbonded:
                return parse_nonbonded(words);
            case Section::Nbfix:
                return parse_nbfix(words);
            case Section::PassedOver:
                return;
            case Section::Atoms:
            case Section::None:
                break;
        }
        fail(
            fmt::format("'{}' is not a section of a parameter file; expected BONDS, ANGLES, "
                        "NONBONDED or the like",
                        words[0]));
    }

    static std::pair<std::string, std::string> in_order(std::string a, std::string b) {
        if (b < a) std::swap(a, b);
        return {std::move(a), std::move(b)};
    }

    static bool same_values(const HarmonicParameter& a, const HarmonicParameter& b) {
        return a.k == b.k && a.value == b.value;
    }

    void parse_bond(Words words) {
        auto key = in_order(name(words, 0, "atom type"), name(words, 1, "second atom type"));
        const HarmonicParameter bond{real(words, 2, "force constant"),
                                     real(words, 3, "bond length"), place()};
        const std::string what = fmt::format("bond {} {}", key.first, key.second);
        add_once(into_.bonds, std::move(key), bond, what, same_values);
    }

    void parse_angle(Words words) {
        std::array<std::string, 3> key{name(words, 0, "atom type"),
                                       name(words, 1, "second atom type"),
                                       name(words, 2, "third atom type")};
        if (key[2] < key[0]) std::swap(key[0], key[2]);
        const HarmonicParameter angle{real(words, 3, "force constant"), real(words, 4, "angle"),
                                      place()};
        const std::string what = fmt::format("angle {} {} {}", key[0], key[1], key[2]);
        add_once(into_.angles, std::move(key), angle, what, same_values);
    }

    // type type -epsilon Rmin [the same of 1-4 pairs]
    void parse_nbfix(Words words) {
        auto key = in_order(name(words, 0, "atom type"), name(words, 1, "second atom type"));
        const double epsilon = real(words, 2, "well depth");
        const double rmin = real(words, 3, "Rmin");
        const std::string what = fmt::format("NBFIX of '{}' and '{}'", key.first, key.second);
        if (epsilon > 0 || rmin < 0) {
            fail(
                fmt::format("well depth {} and Rmin {} in the {}; CHARMM writes the depth as "
                            "-epsilon and Rmin as 0 or more",
                            epsilon, rmin, what));
        }
        add_once(into_.nbfix, std::move(key), NbfixPair{-epsilon, rmin, place()}, what,
                 [](const NbfixPair& a, const NbfixPair& b) {
                     return a.epsilon == b.epsilon && a.rmin == b.rmin;
                 });
    }

    // type ignored -epsilon Rmin/2 [ignored -epsilon Rmin/2 of 1-4 pairs]
    void parse_nonbonded(Words words) {
        const std::string type = name(words, 0, "atom type");
        real(words, 1, "unused first number");
        const double epsilon = real(words, 2, "well depth");
        const double half_rmin = real(words, 3, "half of Rmin");
        if (epsilon > 0 || half_rmin < 0) {
            fail(
                fmt::format("well depth {} and Rmin/2 {} of type '{}'; CHARMM writes the depth as "
                            "-epsilon and Rmin/2 as 0 or more",
                            epsilon, half_rmin, type));
        }
        add_once(into_.nonbonded, type, NonbondedType{-epsilon, half_rmin, place()},
                 fmt::format("non-bonded parameters of type '{}'", type),
                 [](const NonbondedType& a, const NonbondedType& b) {
                     return a.epsilon == b.epsilon && a.half_rmin == b.half_rmin;
                 });
    }

    std::vector<std::string_view> lines_;
    std::size_t at_ = 0;  // the line to be read next
    const std::string& file_;
    ForceField& into_;

    std::string statement_;
    std::size_t statement_line_ = 0;
    Part part_ = Part::None;
    Section section_ = Section::None;
    Residue* residue_ = nullptr;  // that ATOM lines belong to
    bool in_patch_ = false;
};

}  // namespace

void parse_force_field(std::string_view text, const std::string& file, ForceField& into) {
    Parser(text, file, into).parse();
    into.files.push_back(file);
}

ForceField read_force_field(std::span<const std::filesystem::path> files) {
    ForceField force_field;
    for (const std::filesystem::path& file : files) {
        parse_force_field(read_text_file(file), file.string(), force_field);
    }
    return force_field;
}

}  // namespace palpa
