// palpa connect: a remote engine under the hand, without a scene file.
#include "core/files.h"
#include "core/load_error.h"
#include "core/shell_word.h"
#include "core/text.h"
#include "formats/gro.h"
#include "formats/psf.h"
#include "formats/structure.h"
#include "molecule/alternatives.h"
#include "scene/check_scene.h"
#include "scene/find_scene.h"
#include "scene/read_scene.h"
#include "scene/write_scene.h"
#include "session/recording.h"
#include "tools/commands/command.h"
#include "tools/commands/command_line.h"
#include "tools/commands/run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace palpa {
namespace {

namespace fs = std::filesystem;

struct ConnectOptions {
    RunOptions run;
    std::string address;
    fs::path topology;
    std::optional<fs::path> coordinates, scene;  // `scene`: to write
    std::string hold;
    std::array<double, 3> lead{};
    EngineDescription engine;
    std::string program = "unknown", protocol = "any";
    double spring = 5, seconds = 60, period_ms = 10;
};

// A run of atoms of one segment.
struct Part {
    std::string segment;
    std::size_t first = 0, count = 0;
    bool is_solvent = false;  // water or ions
};

void check_topology_name(const fs::path& path) {
    constexpr std::array<std::string_view, 7> endings{".PDB", ".ENT", ".CIF", ".MMCIF",
                                                      ".CRD", ".COR", ".GRO"};
    constexpr const char* expected =
        "expected a .psf, .gro, .pdb, .cif or .crd file, which lists the engine's atoms";
    std::error_code error;
    if (fs::is_directory(path, error))
        throw LoadError({path.string()}, fmt::format("is a folder; {}", expected));
    const bool is_packed = upper_case(path.extension().string()) == ".GZ";
    const std::string ending = (is_packed ? path.stem() : path).extension().string();
    if (std::ranges::find(endings, upper_case(ending)) != endings.end()) return;
    throw LoadError(
        {path.string()},
        fmt::format("does not have the ending of a structure or topology file; {}", expected));
}

std::vector<AtomName> read_names(const fs::path& path) {
    if (is_topology(path)) return read_psf(path).names;
    check_topology_name(path);
    const Structure structure = read_structure(path);
    refuse_alternatives(structure);
    return structure.names;
}

bool is_solvent(const std::vector<AtomName>& names, const Part& part) {
    // Water, or a first residue of one atom.
    const AtomName& name = names[part.first];
    if (is_water_residue(name.residue)) return true;
    return part.count == 1 || !is_same_residue(name, names[part.first + 1]);
}

std::vector<Part> find_parts(const fs::path& file, const std::vector<AtomName>& names) {
    std::vector<Part> parts;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::string& segment = names[i].segment;
        if (segment.empty()) {
            throw LoadError({file.string()},
                            fmt::format("{} has neither segment nor chain; expected a PSF or GRO "
                                        "file, or chains with names",
                                        to_string(names[i])));
        }
        if (parts.empty() || parts.back().segment != segment) {
            if (std::ranges::find(parts, segment, &Part::segment) != parts.end()) {
                throw LoadError({file.string()},
                                fmt::format("segment '{}' is in several parts; expected the atoms "
                                            "of each together, as in a PSF or GRO file",
                                            segment));
            }
            parts.push_back({segment, i, 0, false});
        }
        ++parts.back().count;
    }
    for (Part& part : parts) part.is_solvent = is_solvent(names, part);
    return parts;
}

struct Hold {
    std::string molecule, atom;
};

Hold hold_atom(const std::vector<Part>& parts, std::size_t atom) {
    const auto part = std::ranges::find_if(
        parts, [&](const Part& p) { return atom >= p.first && atom - p.first < p.count; });
    return {part->segment, fmt::format("#{}", atom - part->first + 1)};
}

[[noreturn]] void refuse_hold(const std::string& hold, const std::string& why,
                              const std::vector<Part>& parts) {
    std::vector<std::string> names;
    for (const Part& part : parts) names.push_back(part.segment);
    throw LoadError(
        {"--hold"},
        fmt::format("\"{}\" {}; expected the number of an atom in the file (\"17\"), its name and "
                    "residue number (\"CA 25\", \"SEGMENT CA 25\"), or a segment: {}",
                    hold, why, fmt::join(names, ", ")));
}

// "CA 25", "25 CA", "PROA CA 25".
Hold hold_named(const std::string& hold, const std::vector<AtomName>& names,
                const std::vector<Part>& parts) {
    std::vector<std::string_view> words = split_words(hold);
    std::optional<std::string_view> segment;
    if (words.size() == 3) {
        segment = words.front();
        words.erase(words.begin());
    }
    if (words.size() != 2) refuse_hold(hold, "is not understood", parts);
    const bool number_first = find_integer(words[0]).has_value();
    const std::string_view number = words[number_first ? 0 : 1], atom = words[number_first ? 1 : 0];
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i].number == number && names[i].atom == atom &&
            (!segment || names[i].segment == *segment))
            found.push_back(i);
    }
    if (found.size() != 1) refuse_hold(hold, fmt::format("names {} atoms", found.size()), parts);
    return hold_atom(parts, found.front());
}

// Where nothing is asked for, the smallest segment that is neither water nor ions, as a whole.
Hold find_hold(const std::string& hold, const std::vector<AtomName>& names,
               const std::vector<Part>& parts) {
    if (hold.empty()) {
        const Part* smallest = nullptr;
        for (const Part& part : parts) {
            if (part.is_solvent) continue;
            if (!smallest || part.count < smallest->count) smallest = &part;
        }
        if (smallest) return {smallest->segment, ""};
        // Of water alone its first molecule's first atom.
        return hold_atom(parts, 0);
    }
    const auto part = std::ranges::find(parts, hold, &Part::segment);
    if (part != parts.end()) return {part->segment, ""};
    if (const auto number = find_integer(hold)) {
        if (*number < 1 || static_cast<std::size_t>(*number) > names.size())
            refuse_hold(hold, fmt::format("is not one of {} atoms", names.size()), parts);
        return hold_atom(parts, static_cast<std::size_t>(*number - 1));
    }
    return hold_named(hold, names, parts);
}

SceneDescription build_scene(const ConnectOptions& options) {
    const bool has_psf = is_topology(options.topology);
    const std::vector<AtomName> names = read_names(options.topology);
    const std::vector<Part> parts = find_parts(options.topology, names);
    SceneDescription scene;
    scene.title = fmt::format("{} at {}", options.topology.filename().string(), options.address);
    for (const Part& part : parts) {
        MoleculeDescription molecule;
        molecule.name = part.segment;
        molecule.structure = options.coordinates.value_or(options.topology);
        if (has_psf) molecule.topology = options.topology;
        molecule.segment = part.segment;
        scene.molecules.push_back(std::move(molecule));
    }
    scene.engine = options.engine;
    scene.engine->address = options.address;
    scene.engine->program = static_cast<EngineProgram>(
        std::ranges::find(engine_program_names, options.program) - engine_program_names.begin());
    scene.engine->protocol = static_cast<EngineProtocol>(
        std::ranges::find(engine_protocol_names, options.protocol) - engine_protocol_names.begin());
    const Hold hold = find_hold(options.hold, names, parts);
    scene.hands.front().grab.molecule = hold.molecule;
    scene.hands.front().grab.atom = hold.atom;
    scene.hands.front().grab.spring_kcal_per_mol_angstrom2 = options.spring;
    scene.hands.front().stroke = Stroke::Hold;
    const bool leads = options.lead != std::array<double, 3>{};
    constexpr double begin_s = 0.5;
    if (leads) {
        scene.hands.front().stroke = Stroke::Lead;
        PathPoint start, end;
        start.time_s = begin_s;
        end.time_s = std::max(begin_s + 0.5, options.seconds - begin_s);
        end.place = options.lead;
        scene.hands.front().path = {start, end};
    }
    scene.view.representation = Representation::InHand;
    scene.seconds = options.seconds;
    scene.period_ms = options.period_ms;
    return scene;
}

int connect_command(const ConnectOptions& options) {
    if (!is_engine_address(options.address)) {
        throw LoadError({options.address},
                        "is not the address of an engine; expected HOST:PORT with a numeric host "
                        "and a port from 1 to 65535, such as 127.0.0.1:8888");
    }
    if (options.run.record) check_record_folder(*options.run.record, options.run.overwrites);
    SceneDescription description = build_scene(options);
    const auto absolute = [](const fs::path& path) { return fs::absolute(path).generic_string(); };
    const std::string text = format_scene(description, absolute);
    std::vector<std::string> settings = options.run.settings;
    settings.emplace_back(allow_outside);  // the files were named by hand
    const fs::path file = options.scene.value_or("palpa connect");
    const SceneDescription scene = parse_scene(text, file, settings);
    if (options.scene) {
        const auto beside = [&](const fs::path& path) {
            return fs::proximate(path, fs::absolute(*options.scene).parent_path()).generic_string();
        };
        write_text_file(*options.scene, format_scene(scene, beside),
                        options.run.overwrites ? Existing::Replace : Existing::Refuse);
        fmt::print("written: {}; run it with: palpa run {} {}\n", options.scene->string(),
                   shell_word(options.scene->string()), allow_outside);
    }
    return run_scene(scene, options.run);
}

}  // namespace

void add_connect(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& connect = *program.add_subcommand(
        "connect", "Feel a running engine (GROMACS, LAMMPS, NAMD) over IMD");
    ConnectOptions& options = own_options<ConnectOptions>(connect, chosen, connect_command);
    describe(connect,
             {"palpa connect 127.0.0.1:8888 --topology system.psf",
              "palpa connect 127.0.0.1:8888 --topology run.gro --program gromacs --hold \"CA 25\"",
              "palpa connect 127.0.0.1:8888 --topology system.psf --headless --seconds 10 --lead "
              "5,0,0 --record recordings/pull"},
             "Exit code 4: no engine answered, or its connection was lost.");
    connect.add_option("address", options.address, "HOST:PORT of the engine, with a numeric host")
        ->required();
    connect
        .add_option("--topology", options.topology,
                    "the engine's atoms in its order: .psf, .gro, .pdb, .cif or .crd")
        ->required();
    connect.add_option("--coordinates", options.coordinates,
                       "coordinates before its first frame, needed with a .psf");
    connect.add_option(
        "--hold", options.hold,
        "what the hand holds: the number of an atom in that file, its name and residue number "
        "(\"CA 25\"), or a segment (default: the smallest segment that is neither water nor ions)");
    connect
        .add_option("--spring", options.spring,
                    "stiffness of the spring between hand and atoms, kcal/mol/Å² (default 5)")
        ->check(in_range(1e-3, 1e4));
    connect
        .add_option("--program", options.program,
                    "gromacs, lammps or namd; decides the unit of energies")
        ->check(CLI::IsMember({"unknown", "gromacs", "lammps", "namd"}));
    connect.add_option("--protocol", options.protocol, "required IMD version: 2 or 3")
        ->check(CLI::IsMember({"any", "2", "3"}));
    connect
        .add_option("--rate", options.engine.rate,
                    "steps of the engine between two frames (default: the engine's setting)")
        ->check(in_range(1, 1e6));
    connect
        .add_option("--wait", options.engine.wait_s,
                    "seconds to wait for its first frame (default 10)")
        ->check(in_range(0.0, 1e5));
    connect.add_option("--write-scene", options.scene,
                       "also write this connection as a scene file");
    connect.option_defaults()->group("Without a window");
    connect.add_flag("--headless", options.run.headless,
                     "run without a window, as fast as frames arrive; the emulated hand holds "
                     "still, or leads (--lead)");
    connect
        .add_option("--seconds", options.seconds,
                    "length of the run in seconds, counted in periods of --period-ms, not in "
                    "engine time or wall time (default 60)")
        ->check(in_range(1e-3, 1e5));
    connect
        .add_option("--lead", options.lead,
                    "X,Y,Z in Å: displacement to which the emulated hand leads what it holds")
        ->delimiter(',')
        ->check(in_range(-1e5, 1e5))
        ->type_name("");
    connect.add_flag("--json", options.run.json, "print the summary as JSON");
    connect.option_defaults()->group("With and without a window");
    connect.add_option("--period-ms", options.period_ms, "time between two steps, ms (default 10)")
        ->check(in_range(1.0, 1e4));
    connect.add_option("--record", options.run.record, "record into this folder")
        ->type_name("FOLDER");
    add_overwrite_flag(connect, options.run.overwrites);
    connect.add_option("--device", options.run.device, "haptic device (default mouse)");
    add_set_option(connect, options.run.settings);
}

}  // namespace palpa
