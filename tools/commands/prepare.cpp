#include "tools/commands/prepare.h"

#include "app/fetch_structure.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/shell_word.h"
#include "core/text.h"
#include "experiments/make_scene.h"
#include "tools/commands/command.h"
#include "tools/commands/force_field.h"
#include "tools/commands/progress.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

// "LEFT=RIGHT"; `form`: what would be right.
std::pair<std::string, std::string> split(const std::string& text, const char* option,
                                          std::string_view form, char at = '=') {
    const std::size_t by = text.find(at);
    if (by == std::string::npos || by == 0 || by + 1 == text.size()) {
        throw LoadError({fmt::format("{} {}", option, text)}, fmt::format("expected {}", form));
    }
    return {text.substr(0, by), text.substr(by + 1)};
}

// "CHAIN:NUMBER", or ":NUMBER" of a file without chains.
ResidueChoice read_choice(const std::string& text, const char* option, std::string_view form) {
    const std::size_t by = text.rfind(':');
    if (by == std::string::npos || by + 1 == text.size()) {
        throw LoadError({fmt::format("{} {}", option, text)}, fmt::format("expected {}", form));
    }
    return {text.substr(0, by), text.substr(by + 1)};
}

PrepareSettings build_settings(const PrepareOptions& options) {
    PrepareSettings settings = options.settings;
    settings.entry = options.structure;
    if (!settings.ligand_files.empty() && !settings.approximates_ligands) {
        throw LoadError({"--ligand " + settings.ligand_files.front().string()},
                        "expected --approximate-ligands with it");
    }
    for (const std::string& text : options.as) {
        const auto [from, to] = split(text, "--as", "NAME=NAME, as in CSO=CYS");
        settings.residue_names.emplace_back(upper_case(from), upper_case(to));
    }
    for (const std::string& text : options.protonation) {
        constexpr std::string_view form = "CHAIN:NUMBER=STATE, as in A:25=ASPP";
        const auto [where, state] = split(text, "--protonation", form);
        settings.protonation.emplace_back(read_choice(where, "--protonation", form),
                                          upper_case(state));
    }
    for (const std::string& text : options.alternates) {
        constexpr std::string_view form = "CHAIN:NUMBER=LETTER, as in A:53=B";
        const auto [where, letter] = split(text, "--altloc", form);
        if (letter.size() != 1) {
            throw LoadError({fmt::format("--altloc {}", text)}, fmt::format("expected {}", form));
        }
        settings.alternates.emplace_back(read_choice(where, "--altloc", form), letter[0]);
    }
    for (const std::string& text : options.first) {
        auto [chain, patch] = split(text, "--first", "CHAIN=PATCH, as in A=NNEU");
        settings.first.emplace_back(chain, upper_case(patch));
    }
    for (const std::string& text : options.last) {
        auto [chain, patch] = split(text, "--last", "CHAIN=PATCH, as in A=CNEU");
        settings.last.emplace_back(chain, upper_case(patch));
    }
    for (const std::string& text : options.disulphides) {
        constexpr std::string_view form = "CHAIN:NUMBER-CHAIN:NUMBER, as in A:3-A:40";
        const auto [one, other] = split(text, "--disulphide", form, '-');
        settings.disulphides.emplace_back(read_choice(one, "--disulphide", form),
                                          read_choice(other, "--disulphide", form));
    }
    for (const std::string& text : options.structural_waters) {
        settings.structural_waters.push_back(
            read_choice(text, "--structural-water", "CHAIN:NUMBER, as in A:301"));
    }
    for (const std::string& text : options.flips) {
        settings.turned_over.push_back(read_choice(text, "--flip", "CHAIN:NUMBER, as in A:40"));
    }
    if (options.solvent == "none" && !options.structural_waters.empty()) {
        throw LoadError(
            {"--structural-water " + options.structural_waters.front()},
            "belongs to implicit water; for explicit water use --keep-waters with --solvent none");
    }
    settings.solvent.reset();
    for (std::size_t i = 0; i < solvent_names.size(); ++i) {
        if (options.solvent == solvent_names[i]) settings.solvent = static_cast<Solvent>(i);
    }
    if (!options.x_along.empty()) {
        settings.align = AlignSettings{options.x_along, {}};
        if (!options.y_towards.empty()) {
            constexpr std::string_view form = "CHAIN:NUMBER-CHAIN:NUMBER, as in A:25-A:50";
            const auto [one, other] = split(options.y_towards, "--y-towards", form, '-');
            settings.align->up = {read_choice(one, "--y-towards", form),
                                  read_choice(other, "--y-towards", form)};
        }
    }
    return settings;
}

// Whether the folder can be made.
void check_missing_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::path missing = folder;
    while (!missing.parent_path().empty() && !std::filesystem::exists(missing.parent_path(), error))
        missing = missing.parent_path();
    const std::filesystem::path parent = missing.parent_path();
    if (!parent.empty() && !std::filesystem::is_directory(parent, error)) {
        throw LoadError({folder.string()},
                        fmt::format("cannot be made: {} is not a folder", parent.string()));
    }
    (void)check_output(missing, prepared_mark, false);
}

// Before the work: whether its results can be written.
void check_outputs(const PrepareOptions& options) {
    std::error_code error;
    if (!std::filesystem::exists(options.folder, error)) {
        check_missing_folder(options.folder);
        return;
    }
    for (const char* const name : prepared_names) {
        (void)check_output(options.folder / name, prepared_mark, options.overwrites);
    }
}

// The built-in one with what --toppar adds to it, or --toppar's alone.
SceneRequest build_request(const PrepareOptions& options, const PrepareSettings& settings) {
    std::vector<std::filesystem::path> files = expand_folders(options.toppar);
    files.insert(files.end(), options.parameters.begin(), options.parameters.end());
    if (options.only_toppar && files.empty())
        throw LoadError({"--only-toppar"}, "expected --toppar FILE with it");
    return {.structure = options.structure,
            .topology = options.topology,
            .force_field = std::move(files),
            .only_these_files = options.only_toppar,
            .settings = settings,
            .makes_scene = options.makes_scene,
            .grab = options.grab,
            .title = options.title};
}

// What the force field lacks, a line for each kind of residue.
void print_unknown(const std::vector<UnknownResidue>& residues) {
    fmt::print(stderr, "Not in the force field:\n");
    for (const UnknownResidue& one : residues) {
        constexpr std::size_t most_shown = 4;
        const std::size_t shown = std::min(one.where.size(), most_shown);
        std::string where = fmt::format(
            "{}", fmt::join(one.where.begin(),
                            one.where.begin() + static_cast<std::ptrdiff_t>(shown), " "));
        if (shown < one.where.size()) where += fmt::format(" +{}", one.where.size() - shown);
        fmt::print(stderr, "  {:<6} {:>3} atoms  {}{}\n{:9}{}\n", one.name, one.atoms, where,
                   one.meaning.empty() ? "" : "  (" + one.meaning + ")", "",
                   advise(one, AdviceFor::CommandLine));
    }
}

nlohmann::ordered_json json_of(const std::vector<UnknownResidue>& residues) {
    auto json = nlohmann::ordered_json::array();
    for (const UnknownResidue& one : residues) {
        json.push_back({{"name", one.name},
                        {"meaning", one.meaning},
                        {"residues", one.where},
                        {"atoms", one.atoms},
                        {"advice", advise(one, AdviceFor::CommandLine)}});
    }
    return json;
}

void print_json(const PreparedSystem& system, const TunedScene& scene) {
    nlohmann::ordered_json json;
    json["atoms"] = system.structure.names.size();
    json["bonds"] = system.connectivity.bonds.size();
    json["angles"] = system.connectivity.angles.size();
    json["dihedrals"] = system.connectivity.dihedrals.size();
    json["impropers"] = system.connectivity.impropers.size();
    json["cmaps"] = system.connectivity.cmaps.size();
    json["residues_unknown"] = nlohmann::ordered_json::array();
    json["warnings"] = system.report.warnings();
    json["approximate"] = nlohmann::ordered_json::array();
    for (const ApproximatePart& part : system.approximate) {
        json["approximate"].push_back({{"residue", part.residue},
                                       {"bonds_from", part.source},
                                       {"charge", part.charge},
                                       {"type_penalty", part.type_penalty},
                                       {"parameters_by_analogy", part.analogies},
                                       {"highest_penalty", part.highest_penalty},
                                       {"rigid_bonds", part.rigid_bonds}});
    }
    if (!scene.files.empty()) {
        json["scene"] = {{"in_hand", scene.in_hand},
                         {"felt_N", scene.felt_newton},
                         {"moved_angstrom", scene.moved_angstrom}};
    }
    fmt::print("{}\n", json.dump(2));
}

// Replaces the code of a PDB entry, or a link to it, by its file.
void fetch_if_code(PrepareOptions& options, ProgressLine& progress) {
    const std::string code = name_screen({options.structure}).code;
    if (!code.empty()) {
        const EntrySource source = find_entry_source(PreferencesFile(find_preferences_file()));
        const FetchedEntry entry = fetch_entry(code, source, options.again, progress.stages());
        progress.wipe();
        print_notes({describe(entry)});
        options.structure = entry.file;
    } else if (options.again) {
        throw LoadError({"--again"}, "needs the code of a PDB entry; expected one such as 1hsg");
    } else {
        note_file_before_code(options.structure.string());
    }
}

// Residues that the force field does not have are listed before the error.
MadeScene make_or_list_unknown(const SceneRequest& request, const PrepareOptions& options,
                               ProgressLine& progress) {
    try {
        return make_scene(request, progress.stages());
    } catch (const UnknownResidues& error) {
        progress.wipe();
        if (options.json) {
            nlohmann::ordered_json json;
            json["residues_unknown"] = json_of(error.residues());
            json["warnings"] = {error.what()};
            fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
        } else {
            print_unknown(error.residues());
        }
        if (options.json || !error.is_all()) throw;
        const std::size_t kinds = error.residues().size();
        throw LoadError({options.structure.string()},
                        kinds == 1
                            ? "a residue is not in the force field; the list above says what to do"
                            : fmt::format("{} kinds of residues are not in the force field; the "
                                          "list above says what to do",
                                          kinds));
    }
}

}  // namespace

int prepare_command(const PrepareOptions& given) {
    PrepareOptions options = given;
    PrepareSettings settings = build_settings(options);
    check_outputs(options);
    ProgressLine progress(!options.json);
    fetch_if_code(options, progress);
    settings.entry = options.structure;
    const MadeScene made =
        make_or_list_unknown(build_request(options, settings), options, progress);
    const PreparedSystem& system = made.system;
    const TunedScene& scene = made.scene;
    tell(progress.stages(), "writing");
    write_prepared(system, options.folder, made.title, scene.files,
                   options.overwrites ? Existing::Replace : Existing::Refuse);
    progress.wipe();
    if (options.json) {
        print_json(system, scene);
        return 0;
    }
    const std::string folder = options.folder.string();
    fmt::print("{}written: {}\n", system.report.to_text(), folder);
    if (!scene.files.empty()) {
        fmt::print(
            "in the hand: {}\nfeel it in a window:   palpa run {}   (hold Space and move "
            "the mouse)\nplay it without one:   palpa run {} --headless\n",
            scene.in_hand, shell_word(folder), shell_word(folder));
    }
    return 0;
}

namespace {

// What of the file is taken, and as what.
void add_prepare_choices(CLI::App& prepare, PrepareOptions& options) {
    PrepareSettings& settings = options.settings;
    prepare
        .add_option("--without", settings.without,
                    "leave out residue names (MK1), chains (chain:B) or residues (A:101)")
        ->type_name("WHAT");
    prepare
        .add_option(
            "--keep", settings.kept,
            "keep molecules that only the crystal needed (SO4, GOL, DUM ...), named likewise")
        ->type_name("WHAT");
    prepare.add_option("--as", options.as, "take a residue as another one, CSO=CYS");
    prepare
        .add_option("--protonation", options.protonation,
                    "protonation of a residue: a residue name (HSE) or a patch (ASPP)")
        ->type_name("CHAIN:NUMBER=STATE");
    prepare.add_option("--first", options.first, "patch for the first residue of a chain, or NONE")
        ->type_name("CHAIN=PATCH");
    prepare.add_option("--last", options.last, "patch for the last residue of a chain, or NONE")
        ->type_name("CHAIN=PATCH");
    prepare
        .add_option("--disulphide", options.disulphides,
                    "CHAIN:NUMBER-CHAIN:NUMBER: a disulphide bond in addition to those found")
        ->type_name("PAIR");
    add_negation(prepare, "--no-disulphides", settings.finds_disulphides,
                 "do not search for disulphide bonds");
    prepare.add_flag("--approximate-ligands", settings.approximates_ligands,
                     "for ligands without parameters: take types, charges and parameters from "
                     "similar residues of CGenFF (written to approximate.str)");
    prepare
        .add_option(
            "--ligand", settings.ligand_files,
            "file with bonds and hydrogens of such a ligand: .sdf, .mol or .mol2 (default: from "
            "the structure file, a monomer library (Debian: refmac-dictionary), or distances)")
        ->type_name("FILE");
    prepare
        .add_option(
            "--parameters", options.parameters,
            "stream files of ligands, as the CGenFF server writes them (read after --toppar)")
        ->type_name("FILE");
    prepare.add_flag("--keep-waters", settings.keeps_waters, "keep waters (default: left out)");
    prepare
        .add_option("--solvent", options.solvent,
                    "eef1-sb: implicit water with neutral ionic groups; none: vacuum; auto: "
                    "eef1-sb if it covers every atom type, else none")
        ->check(CLI::IsMember({"none", "eef1-sb", "auto"}))
        ->capture_default_str();
    prepare.add_flag(
        "--full-phosphates", settings.keeps_phosphate_charges,
        "keep the full charge of phosphates in vacuum (default: -0.32 e for each phosphate of "
        "nucleic acids and a dielectric of 4, to replace counterions and water)");
    prepare
        .add_option("--structural-water", options.structural_waters,
                    "CHAIN:NUMBER: keep this water as part of the structure")
        ->type_name("CHAIN:NUMBER");
    add_negation(prepare, "--no-ions", settings.keeps_ions, "leave out ions (default: kept)");
    prepare.add_option("--model", settings.model, "model number (default: the first)");
    prepare
        .add_option(
            "--assembly", settings.assembly,
            "build this biological assembly by symmetry, often 1 (default: the chains of the file)")
        ->check(in_range(1, 1e6));
    prepare
        .add_option("--altloc", options.alternates,
                    "CHAIN:NUMBER=LETTER: use this alternate location, not the most occupied")
        ->type_name("CHAIN:NUMBER=LETTER");
    add_negation(prepare, "--no-flips", settings.flips, "do not flip amides and imidazoles");
    prepare
        .add_option("--flip", options.flips,
                    "CHAIN:NUMBER: flip this amide or imidazole in any case")
        ->type_name("CHAIN:NUMBER");
    add_negation(prepare, "--no-relax", settings.relaxes, "do not relax clashes");
}

// How the result stands, and what of it is in the hand.
void add_prepare_scene(CLI::App& prepare, PrepareOptions& options) {
    CLI::Option* const x_along =
        prepare
            .add_option(
                "--x-along", options.x_along,
                "turn the system: the long axis of this segment becomes x, its middle the origin")
            ->type_name("SEGMENT");
    prepare
        .add_option("--y-towards", options.y_towards,
                    "CHAIN:NUMBER-CHAIN:NUMBER: y points from one residue to the other; :NUMBER is "
                    "the mean over all chains")
        ->type_name("PAIR")
        ->needs(x_along);
    prepare
        .add_option("--grab", options.grab,
                    "what the hand holds in the scene: a SEGMENT, or SEGMENT:RESIDUE by a spring "
                    "(default: a small molecule or an exposed residue)")
        ->type_name("WHAT");
    add_negation(prepare, "--no-scene", options.makes_scene, "do not make a scene (faster)");
}

}  // namespace

void add_prepare(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& prepare = *program.add_subcommand(
        "prepare", "Prepare a structure: add hydrogens, patches and topology, make a scene");
    PrepareOptions& options = own_options<PrepareOptions>(prepare, chosen, prepare_command);
    describe(
        prepare,
        {"palpa prepare 1hsg.pdb --without MK1 -o my-protease",
         "palpa prepare 1hsg --without MK1 -o my-protease",
         "palpa prepare complex.pdb -o complex --toppar ligand.str",
         "palpa prepare step1.crd --topology step1.psf -o mine"},
        "A PDB entry comes over HTTPS from download_from of the preferences, CODE.cif.gz below\n"
        "it (default: the wwPDB's service), and is kept in the user's cache folder.");
    prepare
        .add_option("structure", options.structure,
                    "structure file: .pdb, .ent, .cif or .crd, also with .gz; or the code of a PDB "
                    "entry (1hsg), or a link to it, which is downloaded")
        ->required();
    prepare.add_flag("--again", options.again,
                     "download the PDB entry again (default: from the cache, if it is there)");
    prepare
        .add_option("--toppar", options.toppar,
                    "CHARMM topology, parameter and stream files, in order, or a folder of them; "
                    "added to the built-in CHARMM36")
        ->type_name("FILE");
    prepare.add_flag("--only-toppar", options.only_toppar,
                     "use only the files of --toppar, without the built-in CHARMM36");
    prepare
        .add_option("-o,--output", options.folder,
                    "folder for system.psf, .pdb, .crd, .prm, report.txt and scene.toml")
        ->required();
    prepare
        .add_option("--topology", options.topology,
                    "a .psf of all atoms of the structure: names, types, charges and bonds are "
                    "taken as they are, nothing is built")
        ->type_name("FILE.psf");
    add_prepare_choices(prepare, options);
    add_prepare_scene(prepare, options);
    prepare.add_option("--title", options.title, "title in the files")->type_name("TEXT");
    add_overwrite_flag(prepare, options.overwrites);
    prepare.add_flag("--json", options.json, "print counts and warnings as JSON");
}

}  // namespace palpa
