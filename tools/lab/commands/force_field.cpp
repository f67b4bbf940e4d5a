// palpa-lab force-field: the force field that comes with the program, and packing one.
#include "tools/commands/force_field.h"

#include "charmm/built_in_force_field.h"
#include "charmm/packed_force_field.h"
#include "core/files.h"
#include "core/text.h"
#include "tools/lab/commands/commands.h"

#include <fmt/format.h>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

struct ForceFieldOptions {
    std::string what;  // "pack", "show"
    std::vector<std::filesystem::path>
        files;  // CHARMM's, or folders of them; to show: a packed one
    std::optional<std::filesystem::path> output, about;
    bool overwrites = false;  // an earlier packed file
    bool json = false;
};

// Lists what a file has, in its order: topology, then parameters.
std::vector<std::pair<const char*, std::size_t>> count_contents(const ForceField& field) {
    return {{"atom_types", field.types.size()},    {"residues", field.residues.size()},
            {"patches", field.patches.size()},     {"nonbonded", field.nonbonded.size()},
            {"bonds", field.bonds.size()},         {"angles", field.angles.size()},
            {"dihedrals", field.dihedrals.size()}, {"impropers", field.impropers.size()},
            {"cmaps", field.cmaps.size()},         {"nbfix", field.nbfix.size()}};
}

void print_contents(const ForceFieldOptions& options, const ForceField& field,
                    const std::filesystem::path& file, std::size_t bytes) {
    if (options.json) {
        nlohmann::ordered_json json{{"file", file.string()}, {"bytes", bytes}};
        for (const auto& [name, count] : count_contents(field)) json[name] = count;
        json["about"] = field.about;
        json["warnings"] = nlohmann::ordered_json::array();
        for (const ForceFieldNote& note : field.notes) {
            json["warnings"].push_back(describe_note(note));
        }
        fmt::print("{}\n", json.dump(2));
        return;
    }
    for (const std::string& line : field.about) fmt::print("{}\n", line);
    fmt::print("\n{}, {} bytes\n", file.string(), bytes);
    for (const auto& [name, count] : count_contents(field)) {
        std::string words = name;
        for (char& letter : words) letter = letter == '_' ? ' ' : letter;
        fmt::print("  {:<12}{:>7}\n", words, count);
    }
}

int pack(const ForceFieldOptions& options) {
    if (options.files.empty() || !options.output || !options.about) {
        throw LoadError({"pack"},
                        "expected CHARMM's files or a folder of them, --about FILE and -o FILE");
    }
    const Existing existing = check_output(*options.output, packed_mark, options.overwrites);
    std::vector<std::string> about;
    const std::string about_text = read_text_file(*options.about);
    for (const std::string_view line : split_lines(about_text)) {
        about.emplace_back(line);
    }
    ForceField field = read_force_field(expand_folders(options.files));
    const std::string bytes = pack_force_field(field, about);
    write_text_file(*options.output, bytes, existing);
    field.about = std::move(about);
    if (!options.json) warn_of_notes(field);
    print_contents(options, field, *options.output, bytes.size());
    return 0;
}

int show(const ForceFieldOptions& options) {
    if (options.files.size() > 1) {
        throw LoadError({options.files[1].string()},
                        "is a second file; expected one packed force field to show");
    }
    const std::filesystem::path file =
        options.files.empty() ? find_built_in_force_field() : options.files[0];
    const std::string bytes = read_text_file(file);
    print_contents(options, unpack_force_field(bytes, file.string()), file, bytes.size());
    return 0;
}

int force_field_command(const ForceFieldOptions& options) {
    return options.what == "pack" ? pack(options) : show(options);
}

}  // namespace

void add_force_field(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& command =
        *program.add_subcommand("force-field", "Show a packed force field, or pack CHARMM's files");
    ForceFieldOptions& options =
        own_options<ForceFieldOptions>(command, chosen, force_field_command);
    describe(command, {"palpa-lab force-field show",
                       "palpa-lab force-field pack toppar --about about.txt -o mine.ff"});
    command
        .add_option("what", options.what,
                    "show: a packed force field, the built-in one unless named; pack: write one")
        ->required()
        ->check(CLI::IsMember({"show", "pack"}));
    command.add_option("files", options.files,
                       "CHARMM topology, parameter and stream files, or a folder of them");
    command
        .add_option("--about", options.about,
                    "text file: title, then lines on date, origin and what to cite")
        ->type_name("FILE");
    command.add_option("-o,--output", options.output, "packed file to write")->type_name("FILE");
    add_overwrite_flag(command, options.overwrites);
    command.add_flag("--json", options.json, "print counts and warnings as JSON");
}

}  // namespace palpa
