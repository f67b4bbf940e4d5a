#include "charmm/force_field.h"

#include "charmm/packed_force_field.h"
#include "charmm/parameter_reader.h"
#include "charmm/residue_reader.h"
#include "charmm/script.h"
#include "charmm/statements.h"
#include "core/files.h"
#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <system_error>

namespace palpa {
namespace {

enum class Part { None, Topology, Parameters };

// READ RTF or READ PARA, whatever options follow.
Part part_to_read(const Statements& statements) {
    const std::vector<std::string_view>& words = statements.words();
    const std::string_view what = words.size() > 1 ? words[1].substr(0, 4) : "";
    if (what == "RTF") return Part::Topology;
    if (what == "PARA") return Part::Parameters;
    statements.fail(
        fmt::format("'{}' cannot be read; expected 'read rtf' or 'read para'", statements.text()));
}

// READ ... NAME file, READ ... UNIT 10
bool reads_other_file(const Statements& statements) {
    return std::ranges::any_of(
        statements.words(), [](std::string_view word) { return word == "NAME" || word == "UNIT"; });
}

// What a file without a READ line is about to say.
Part part_of(const Statements& statements) {
    const std::string_view keyword = statements.keyword();
    const bool is_section = ParameterReader::is_section(keyword) &&
                            (keyword != "ATOM" || statements.words().size() == 1);
    return is_section ? Part::Parameters : Part::Topology;
}

// "36 1", CHARMM's version of a topology file
bool is_version(const Statements& statements) {
    const std::vector<std::string_view>& words = statements.words();
    return words.size() <= 2 && std::all_of(words.begin(), words.end(), [](std::string_view word) {
               return find_integer(word).has_value();
           });
}

// Another kind of file that someone may have given, by the first line that says anything; empty if
// it looks like none.
std::string_view find_other_kind(const Statements& statements) {
    const std::string_view first = statements.words()[0], keyword = statements.keyword();
    constexpr std::array pdb = std::to_array<std::string_view>(
        {"HEAD", "TITL", "REMA", "CRYS", "HETA", "MODE", "COMP", "SEQR"});
    if (std::find(pdb.begin(), pdb.end(), keyword) != pdb.end() ||
        (keyword == "ATOM" && statements.words().size() > 5)) {
        return "coordinates (a PDB file)";
    }
    if (first.starts_with("DATA_") || first == "LOOP_") return "coordinates (an mmCIF file)";
    if (first == "PSF") return "a PSF";
    return find_integer(first) && !is_version(statements) ? "coordinates (a CRD file)" : "";
}

void check_kind(const Statements& statements) {
    const std::string_view other = find_other_kind(statements);
    if (other.empty()) return;
    statements.fail(fmt::format(
        "this looks like {}; expected a topology, parameter or stream file of CHARMM", other));
}

void check_different(std::span<const std::filesystem::path> files) {
    for (std::size_t i = 0; i < files.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            std::error_code none_such;  // reported when the file is read
            if (std::filesystem::equivalent(files[i], files[j], none_such)) {
                throw LoadError({files[i].string()}, "given twice; expected each file once");
            }
        }
    }
}

}  // namespace

void parse_force_field(std::string_view text, const std::string& file, ForceField& into) {
    Statements statements(text, file);
    ResidueReader residues(statements, into);
    ParameterReader parameters(statements, into);
    Script script(statements, into);
    Part part = Part::None;
    const auto end_part = [&] {
        residues.end_part();
        parameters.end_part();
        part = Part::None;
    };
    bool has_returned = false;
    while (!has_returned && statements.next()) {
        const std::string_view keyword = statements.keyword();
        if (keyword == "END") {
            end_part();
            continue;
        }
        if (keyword == "READ") {
            end_part();
            part = part_to_read(statements);
            if (!reads_other_file(statements)) continue;
            script.note_other_file();
            part = Part::None;
            continue;
        }
        if (part == Part::None) {
            if (Script::is_script(keyword)) {
                has_returned = !script.follow();
                continue;
            }
            part = part_of(statements);
        }
        if (part == Part::Parameters) {
            parameters.read();
        } else if (!is_version(statements)) {
            if (!residues.open_residue()) check_kind(statements);
            residues.read();
        }
    }
    const Residue* const residue = residues.open_residue();
    const std::string open = residue ? fmt::format("the residue of line {}", residue->place.line)
                             : parameters.is_open() ? "a section of parameters"
                                                    : "";
    end_part();
    if (!open.empty()) {
        throw LoadError(
            {file, statements.line_count(), 0},
            fmt::format("the file ends inside {}, so it may be cut off; expected END after it",
                        open));
    }
    if (!has_returned) script.check_closed();
    into.files.push_back(file);
}

ForceField read_force_field(std::span<const std::filesystem::path> files) {
    ForceField force_field;
    check_different(files);
    for (std::size_t i = 0; i < files.size(); ++i) {
        const std::string text = read_text_file(files[i]), file = files[i].string();
        if (!is_packed_force_field(text)) {
            parse_force_field(text, file, force_field);
        } else if (i == 0) {
            force_field = unpack_force_field(text, file);
        } else {
            throw LoadError({file},
                            "is a packed force field and cannot be added to other files; expected "
                            "it as the first file");
        }
    }
    return force_field;
}

std::map<std::string, AtomType, std::less<>>::const_iterator find_type(
    const ForceField& force_field, std::string_view name) {
    const auto found = force_field.types.find(name);
    if (found != force_field.types.end()) return found;
    const std::optional<std::int64_t> number = find_integer(name);
    if (!number || *number < 1) return found;
    return std::find_if(force_field.types.begin(), force_field.types.end(),
                        [&](const auto& type) { return type.second.number == *number; });
}

std::pair<std::string, std::string> in_order(std::string a, std::string b) {
    if (b < a) std::swap(a, b);
    return {std::move(a), std::move(b)};
}

std::array<std::string, 3> in_order(std::array<std::string, 3> types) {
    if (types[2] < types[0]) std::swap(types[0], types[2]);
    return types;
}

std::array<std::string, 4> in_order(std::array<std::string, 4> types) {
    if (std::pair(types[3], types[2]) < std::pair(types[0], types[1])) {
        std::reverse(types.begin(), types.end());
    }
    return types;
}

}  // namespace palpa
