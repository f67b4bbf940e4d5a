#include "charmm/residue_reader.h"

#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

// Lines that say nothing which a force field needs: hydrogen bonds, and names for them.
constexpr std::array passed_over = std::to_array<std::string_view>({"DONO", "ACCE", "DECL"});

// Those that belong to a residue or patch.
constexpr std::array residue_lines = std::to_array<std::string_view>(
    {"ATOM", "GROU", "BOND", "DOUB", "TRIP", "AROM", "ANGL", "THET", "DIHE", "PHI", "IMPR", "IMPH",
     "CMAP", "IC", "BILD", "PATC", "DELE", "LONE"});

// The same and all else that begins a line, in full, for a hint.
constexpr std::array line_names = std::to_array<std::string_view>(
    {"MASS",     "RESI",     "PRES",   "DEFAULT", "AUTOGENERATE", "DECLARE",   "ATOM",
     "GROUP",    "BOND",     "DOUBLE", "TRIPLE",  "AROMATIC",     "ANGLE",     "THETA",
     "DIHEDRAL", "IMPROPER", "CMAP",   "IC",      "PATCHING",     "DELETE",    "LONEPAIR",
     "DONOR",    "ACCEPTOR", "BONDS",  "ANGLES",  "DIHEDRALS",    "IMPROPERS", "NONBONDED",
     "NBFIX",    "HBOND",    "READ",   "END"});

// "X" is what CHARMM calls a lone pair's.
constexpr std::array elements = std::to_array<std::string_view>(
    {"H",  "HE", "LI", "BE", "B",  "C",  "N",  "O",  "F",  "NE", "NA", "MG", "AL", "SI",
     "P",  "S",  "CL", "AR", "K",  "CA", "SC", "TI", "V",  "CR", "MN", "FE", "CO", "NI",
     "CU", "ZN", "GA", "GE", "AS", "SE", "BR", "KR", "RB", "SR", "Y",  "ZR", "NB", "MO",
     "TC", "RU", "RH", "PD", "AG", "CD", "IN", "SN", "SB", "TE", "I",  "XE", "CS", "BA",
     "LA", "CE", "PR", "ND", "PM", "SM", "EU", "GD", "TB", "DY", "HO", "ER", "TM", "YB",
     "LU", "HF", "TA", "W",  "RE", "OS", "IR", "PT", "AU", "HG", "TL", "PB", "BI", "PO",
     "AT", "RN", "FR", "RA", "AC", "TH", "PA", "U",  "NP", "PU", "AM", "CM", "X"});

template <class Names>
bool contains(const Names& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

void note_replaced(ForceField& into, const Statements& statements, std::string what,
                   const TextPlace& earlier) {
    into.notes.push_back(
        {ForceFieldNote::Kind::Replaced, statements.place(), std::move(what), earlier});
}

void read_mass(const Statements& statements, ForceField& into) {
    statements.expect_form("MASS number type mass [element]");
    const double number = statements.real(1, "atom type's number");
    const std::string type = statements.name(2, "atom type");
    const AtomType entry{number >= 1 && number < 1e9 ? static_cast<std::int64_t>(number) : -1,
                         statements.real(3, "mass"),
                         statements.words().size() > 4 ? std::string(statements.words()[4]) : "",
                         statements.place()};
    if (!(entry.mass >= 0)) {
        statements.fail(fmt::format("the mass is {} amu; expected 0 or more", entry.mass));
    }
    if (!entry.element.empty() && !contains(elements, entry.element)) {
        statements.fail(fmt::format("unknown element '{}'; expected a symbol such as C, or nothing",
                                    entry.element));
    }
    // CHARMM's own files round one mass differently in topology and parameters; the first counts.
    const auto [old, is_new] = into.types.emplace(type, entry);
    if (is_new || std::abs(old->second.mass - entry.mass) < 0.01) return;
    note_replaced(into, statements, "mass of " + type, old->second.place);
    old->second = entry;
}

void ResidueReader::end_part() {
    residue_ = nullptr;
    first_patch_ = last_patch_ = "NONE";
}

void ResidueReader::read() {
    const std::string_view keyword = statements_.keyword();
    if (keyword == "MASS") return read_mass(statements_, into_);
    if (keyword == "RESI" || keyword == "PRES") return start_residue(keyword == "PRES");
    if (keyword == "DEFA") return read_chain_ends(first_patch_, last_patch_);
    if (keyword == "AUTO") return read_autogenerate();
    if (contains(passed_over, keyword)) return;
    if (!contains(residue_lines, keyword)) {
        statements_.fail(fmt::format(
            "'{}' is not a line of a topology file; expected MASS, RESI, ATOM or "
            "the like{}",
            statements_.words()[0], near_name_hint(statements_.words()[0], line_names)));
    }
    if (!residue_) {
        statements_.fail(fmt::format(
            "{} {} line outside of a residue; expected a RESI line before it",
            std::string_view("AEIO").find(keyword[0]) == std::string_view::npos ? "a" : "an",
            keyword));
    }
    if (keyword == "ATOM") return read_atom();
    if (keyword == "GROU") {
        if (!residue_->atoms.empty() && residue_->atoms.back().group == group_) ++group_;
        return;
    }
    if (keyword == "ANGL" || keyword == "THET") return read_tuples<3>(residue_->angles);
    if (keyword == "DIHE" || keyword == "PHI") return read_tuples<4>(residue_->dihedrals);
    if (keyword == "IMPR" || keyword == "IMPH") return read_tuples<4>(residue_->impropers);
    if (keyword == "CMAP") return read_tuples<8>(residue_->cmaps);
    if (keyword == "IC" || keyword == "BILD") return read_internal_coordinate();
    if (keyword == "PATC") return read_chain_ends(residue_->first_patch, residue_->last_patch);
    if (keyword == "DELE") return read_delete();
    if (keyword == "LONE") {
        if (residue_->lone_pair_line == 0) residue_->lone_pair_line = statements_.place().line;
        return;
    }
    read_tuples<2>(residue_->bonds);  // BOND, DOUBLE, TRIPLE, AROMATIC
}

void ResidueReader::start_residue(bool is_patch) {
    statements_.expect_form(is_patch ? "PRES name charge [NOANG] [NODIH]"
                                     : "RESI name charge [NOANG] [NODIH]");
    const char* const kind = is_patch ? "patch" : "residue";
    const std::string name = statements_.name(1, is_patch ? "patch name" : "residue name");
    Residue residue;
    residue.charge = statements_.real(2, is_patch ? "patch's charge" : "residue's charge");
    residue.first_patch = first_patch_;
    residue.last_patch = last_patch_;
    residue.place = statements_.place();
    for (std::size_t i = 3; i < statements_.words().size(); ++i) {
        const std::string_view option = statements_.words()[i].substr(0, 4);
        if (option == "NOAN") {
            residue.has_generated_angles = false;
        } else if (option == "NODI") {
            residue.has_generated_dihedrals = false;
        } else {
            statements_.fail(fmt::format("'{}' is not an option of a {}; expected NOANG or NODIH",
                                         statements_.words()[i], kind));
        }
    }
    Residue& there = (is_patch ? into_.patches : into_.residues)[name];
    const bool is_new = there.place.file.empty();
    if (!is_new) {
        note_replaced(into_, statements_, fmt::format("{} {}", kind, name), there.place);
    }
    there = std::move(residue);
    residue_ = &there;
    at_line_.clear();
    group_ = 0;
}

// What stands behind the charge of an ATOM line: numbers and Drude's polarizabilities would change
// what it says, others are drawings or remarks, of which CHARMM's own files have some without '!'.
void ResidueReader::check_extra_words() const {
    const std::vector<std::string_view>& words = statements_.words();
    for (std::size_t i = 4; i < words.size(); ++i) {
        const std::string_view keyword = words[i].substr(0, 4);
        if (find_real(words[i]) || keyword == "ALPH" || keyword == "THOL") {
            return statements_.expect_form("ATOM name type charge");
        }
    }
    if (words.size() <= 4) return statements_.expect_form("ATOM name type charge");
    into_.notes.push_back({ForceFieldNote::Kind::ExtraWord,
                           statements_.place(),
                           fmt::format("extra word '{}' at the end of an ATOM line", words[4]),
                           {}});
}

void ResidueReader::read_atom() {
    check_extra_words();
    ResidueAtom atom{statements_.name(1, "atom name"), statements_.name(2, "atom type"),
                     statements_.real(3, "charge"), group_, statements_.place()};
    const auto [first, is_new] = at_line_.emplace(atom.name, atom.place.line);
    if (!is_new) {
        statements_.fail(fmt::format("atom '{}' is repeated, first in {}", atom.name,
                                     to_string({atom.place.file, first->second, 0})));
    }
    residue_->atoms.push_back(std::move(atom));
}

// KEYWORD a b a b ..., as many names as make whole tuples.
template <std::size_t Size, class Tuples>
void ResidueReader::read_tuples(Tuples& tuples, std::size_t from) const {
    const std::vector<std::string_view>& words = statements_.words();
    if ((words.size() - from) % Size != 0) {
        statements_.fail(fmt::format("a {1} line has {0} names; expected a multiple of {2}",
                                     words.size() - from, words[0], Size));
    }
    for (std::size_t i = from; i < words.size(); i += Size) {
        auto& tuple = tuples.emplace_back();
        for (std::size_t j = 0; j < Size; ++j) {
            tuple[j] = words[i + j];
            residue_->named_on.try_emplace(tuple[j], statements_.place().line);
        }
    }
}

// DELETE ATOM name ..., DELETE ANGLE a b c ... and the like.
void ResidueReader::read_delete() {
    const std::string what = statements_.name(1, "kind of what is deleted").substr(0, 4);
    if (what == "ACCE" || what == "DONO") return;
    if (what == "ATOM") {
        for (std::size_t i = 2; i < statements_.words().size(); ++i) {
            residue_->deleted_atoms.emplace_back(statements_.words()[i]);
        }
    } else if (what == "BOND" || what == "DOUB") {
        read_tuples<2>(residue_->deleted_bonds, 2);
    } else if (what == "ANGL" || what == "THET") {
        read_tuples<3>(residue_->deleted_angles, 2);
    } else if (what == "DIHE" || what == "PHI") {
        read_tuples<4>(residue_->deleted_dihedrals, 2);
    } else if (what == "IMPR" || what == "IMPH") {
        read_tuples<4>(residue_->deleted_impropers, 2);
    } else if (what == "CMAP") {
        read_tuples<8>(residue_->deleted_cmaps, 2);
    } else {
        statements_.fail(
            fmt::format("'{}' cannot be deleted; expected DELETE ATOM, BOND, ANGLE, "
                        "DIHE, IMPR or CMAP",
                        statements_.words()[1]));
    }
}

// A star before the third atom: an improper.
void ResidueReader::read_internal_coordinate() {
    statements_.expect_form("IC a b c d first-bond first-angle dihedral last-angle last-bond");
    InternalCoordinate ic;
    for (std::size_t i = 0; i < 4; ++i) ic.atoms[i] = statements_.name(i + 1, "atom name");
    if (ic.atoms[2].size() > 1 && ic.atoms[2].front() == '*') {
        ic.is_improper = true;
        ic.atoms[2].erase(0, 1);
    }
    ic.first_bond = statements_.real(5, "first bond length");
    ic.first_angle_deg = statements_.real(6, "first angle");
    ic.dihedral_deg = statements_.real(7, "dihedral angle");
    ic.last_angle_deg = statements_.real(8, "last angle");
    ic.last_bond = statements_.real(9, "last bond length");
    residue_->internal_coordinates.push_back(std::move(ic));
}

// KEYWORD [FIRST patch] [LAST patch]
void ResidueReader::read_chain_ends(std::string& first, std::string& last) const {
    for (std::size_t i = 1; i < statements_.words().size(); i += 2) {
        const std::string_view end = statements_.words()[i].substr(0, 4);
        if (end != "FIRS" && end != "LAST") {
            statements_.fail(fmt::format("'{}' is not an end of a chain; expected FIRST or LAST",
                                         statements_.words()[i]));
        }
        (end == "LAST" ? last : first) = statements_.name(i + 1, "patch name");
    }
}

// AUTO [ANGLES] [DIHEDRALS] [PATCH] [DRUDE] [OFF]. Patched residues get theirs in any case, and
// there are no Drude particles.
void ResidueReader::read_autogenerate() {
    for (std::size_t i = 1; i < statements_.words().size(); ++i) {
        const std::string_view what = statements_.words()[i].substr(0, 4);
        if (what == "ANGL") {
            into_.generates_angles = true;
        } else if (what == "DIHE") {
            into_.generates_dihedrals = true;
        } else if (what == "OFF") {
            into_.generates_angles = into_.generates_dihedrals = false;
        } else if (what != "PATC" && what != "DRUD") {
            statements_.fail(
                fmt::format("'{}' cannot be generated; expected ANGLES, DIHEDRALS, PATCH or OFF",
                            statements_.words()[i]));
        }
    }
}

}  // namespace palpa
